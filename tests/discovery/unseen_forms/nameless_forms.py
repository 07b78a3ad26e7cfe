"""Forms that no effect of the vocabulary describes: the right answer is "unknown"."""

from __future__ import annotations

import numpy as np

from .forms import UNKNOWN, arrivals, each_stick, form
from .motion import World


@form(UNKNOWN, source="McMillan 1997; Wojewoda, Stefanski, Wiercigroch and Kapitaniak 2008")
def friction_of_acceleration(w: World, a: float) -> None:
    """Sliding friction is lower while the relative speed grows and higher while it falls."""
    base, rig, size = w.rig.mu_k, w.nominal, 0.25 * a * w.nominal.gap
    scale = 0.3 * 0.5 * rig.slip_length * rig.pulsation**2
    w.mu_k = lambda s: (
        base
        - size
        * np.tanh(
            -s.direction * (s.a + s.direction * base * w.normal_force / w.rig.mass) / scale,
        )
    )


@form(UNKNOWN, source="Ruina 1983; Gu, Rice, Ruina and Tse 1984 (period doubling by memory of the last slip)")
def slips_alternate(w: World, a: float) -> None:
    rig, most = w.rig, 0.15 * a * w.nominal.gap
    usual = 2.0 * rig.gap * w.normal_force / rig.stiffness

    def remember(s) -> None:
        w.memory["s"] = rig.mu_s
        if s is not None and most > 0.0:
            w.memory["s"] -= most * np.tanh(1.8 * rig.gap * (s.slip / usual - 1.0) / most)

    each_stick(w, remember)
    w.mu_s = lambda s: w.memory["s"]


@form(
    UNKNOWN,
    "correlated_coefficients",
    source="Crassous, Bocquet, Ciliberto and Laroche 1999 (humid contact that remembers many slips)",
)
def humid_memory(w: World, a: float) -> None:
    """Dry and humid spells of many slips come at random; the coefficients follow slowly, one up, the other down."""
    rig, size = w.rig, a * w.nominal.gap

    def remember(s) -> None:
        level, spell = w.memory.get("level", 0.5), w.memory.get("spell", 0.0)
        if w.rng.random() < 0.07:
            spell = 1.0 - spell
        level += 0.2 * (spell - level)
        w.memory.update(level=level, spell=spell)

    each_stick(w, remember)
    w.mu_s = lambda s: rig.mu_s + 0.3 * size * (w.memory["level"] - 0.5)
    w.mu_k = lambda s: rig.mu_k - 0.25 * size * (w.memory["level"] - 0.5)


@form(UNKNOWN, source="Bouc 1967; Wen 1976")
def spring_with_hysteresis(w: World, a: float) -> None:
    k, share, yields = w.rig.stiffness, 0.3 * a, 0.7 * w.nominal.reach
    w.q0 = (0.0,)
    w.rates = lambda s: (
        float(s.v) * (1.0 - s.q[0] / yields * (0.6 * np.sign(s.v) + 0.4 * np.sign(s.v) * np.sign(s.v * s.q[0]))),
    )
    w.spring = lambda s: k * ((1.0 - share) * s.x + share * s.q[0])


@form(UNKNOWN, source="Spencer, Dyke, Sain and Carlson 1997 (magnetorheological damper that is switched)")
def damper_switched(w: World, a: float) -> None:
    force, soft, unit = 0.25 * a * w.nominal.gap * w.nominal.normal_force, 0.8 * w.nominal.peak_speed, 7.0 * w.nominal.period
    w.load = lambda s: -force * np.tanh(s.v / soft) * (np.mod(s.t / unit, 2.0) > 1.0)


@form(UNKNOWN, "correlated_coefficients", source="Godet 1984; Fillot, Iordanoff and Berthier 2007 (third body)")
def debris_in_bursts(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap

    def shed(s) -> None:
        level = 0.7 * w.memory.get("debris", 0.0)
        w.memory["debris"] = 1.0 if w.rng.random() < 0.06 else level

    each_stick(w, shed)
    w.mu_s = lambda s: rig.mu_s - 0.15 * a * gap * w.memory["debris"]
    w.mu_k = lambda s: rig.mu_k + 0.25 * a * gap * w.memory["debris"]


@form(UNKNOWN, source="Irschik and Holl 2004 (a hopper that fills)")
def mass_that_grows(w: World, a: float) -> None:
    mass, span = w.rig.mass, 60.0 * w.nominal.period
    w.mass = lambda t: mass * (1.0 + 0.35 * a * np.minimum(t / span, 1.0))


@form(UNKNOWN, source="Abrate 1992 (belt joint that slaps the box's guide and stiffens it)")
def belt_joint(w: World, a: float) -> None:
    k, turn = w.rig.stiffness, 8.7 * w.nominal.slip_length
    slap = 0.5 * a * w.nominal.gap * w.nominal.normal_force

    def at_joint(s):
        u = np.mod(s.travel / turn + 0.4, 1.0)
        return 0.5 * (np.tanh((u - 0.3) / 0.01) - np.tanh((u - 0.5) / 0.01)), np.exp(-(((u - 0.3) / 0.01) ** 2))

    w.spring = lambda s: k * s.x * (1.0 + 0.35 * a * at_joint(s)[0])
    w.load = lambda s: -slap * at_joint(s)[1]


@form(UNKNOWN, source="Fraden 2016, chapter 3 (nonlinearity of the gain)")
def sensor_gain_bends(w: World, a: float) -> None:
    reach = w.nominal.reach
    w.sensor = lambda t, motion, rng: motion.position * (1.0 + 0.2 * a * (motion.position / reach - 0.5))


@form(UNKNOWN, source="Heydemann 1981 (interpolation error of an encoder)")
def sensor_interpolation_error(w: World, a: float) -> None:
    pitch, size = 0.27 * w.nominal.reach, 0.008 * a * w.nominal.reach
    w.sensor = lambda t, motion, rng: motion.position + size * np.sin(2 * np.pi * motion.position / pitch)


@form(UNKNOWN, source="Shannon 1949; Oppenheim and Schafer 1989 (aliased carrier that wanders)")
def sensor_alias(w: World, a: float) -> None:
    size, f = 0.008 * a * w.nominal.reach, 2 * np.pi / w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * np.sin(5.7 * f * t + 3.0 * np.sin(0.11 * f * t))


@form(UNKNOWN, source="Brokate and Sprekels 1996 (play in the sensor's linkage)")
def sensor_play(w: World, a: float) -> None:
    half = 0.02 * a * w.nominal.reach

    def sensor(t, motion, rng):
        shown = np.empty_like(motion.position)
        last = 0.0
        for i, x in enumerate(motion.position):
            last = min(max(last, x - half), x + half)
            shown[i] = last
        return shown

    w.sensor = sensor


@form(UNKNOWN, source="Hoffmann, Fischer, Allgaier and Gaul 2002 (spring that also presses)")
def load_from_spring(w: World, a: float) -> None:
    load, reach = w.normal_force, w.nominal.reach
    w.normal = lambda s: load * (1.0 + 0.35 * a * (s.x / reach - 0.5))


@form(UNKNOWN, source="Mathieu 1868; Nayfeh and Mook 1979 (parametric excitation)")
def stiffness_in_time(w: World, a: float) -> None:
    k, p = w.rig.stiffness, 0.93 * w.nominal.pulsation
    w.spring = lambda s: k * s.x * (1.0 + 0.10 * a * np.cos(p * s.t) * np.cos(0.013 * p * s.t))


@form(UNKNOWN, source="Kenjo 1984 (stepping drive that loses steps at random)")
def belt_stalls(w: World, a: float) -> None:
    speed, stall = w.belt_velocity, 0.3 * w.nominal.period
    times = arrivals(w.rng, w.duration, 0.18 / w.nominal.period)

    def velocity(t):
        stopped = np.zeros_like(t)
        for time in times:
            stopped = np.maximum(stopped, np.exp(-(((t - time) / (0.5 * stall)) ** 8)))
        return speed * (1.0 - 0.95 * a * stopped)

    w.set_belt(velocity)


@form(UNKNOWN, source="Zener 1948 (standard linear solid)")
def spring_relaxes(w: World, a: float) -> None:
    k, share, tau = w.rig.stiffness, 0.3 * a, 0.6 * w.nominal.period
    w.q0 = (0.0,)
    w.rates = lambda s: ((s.x - s.q[0]) / tau,)
    w.spring = lambda s: k * (s.x + share * (s.x - s.q[0]))


@form(UNKNOWN, source="Rothberg, Baker and Halliwell 1989 (dropouts that hold the last value)")
def sensor_drops_out(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        x = motion.position.copy()
        for time in arrivals(rng, w.duration, 0.6 / w.nominal.period) if a > 0.0 else ():
            i, j = np.searchsorted(t, [time, time + rng.uniform(0.03, 0.1) * a * w.nominal.period])
            x[i:j] = x[min(i, t.size - 1)]
        return x

    w.sensor = sensor


@form(UNKNOWN, source="Rubinstein, Cohen and Fineberg 2007 (precursors before each full slip)")
def precursors(w: World, a: float) -> None:
    """Two small slips, at nine tenths of the load, go before each large one."""
    rig, gap = w.rig, w.nominal.gap

    def small() -> bool:
        return w.memory.get("count", 0) % 3 != 0

    def turn(s) -> None:
        w.memory["count"] = w.memory.get("count", 0) + 1

    each_stick(w, turn)
    w.mu_s = lambda s: rig.mu_s - (0.25 * a * gap if small() else 0.0)
    w.mu_k = lambda s: rig.mu_k + (0.55 * a * gap if small() else 0.0)


@form(UNKNOWN, source="Paxson 1999 (packets that are written twice)")
def packets_repeated(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        apart = 7.5 * w.nominal.period  # one at some time in each stretch
        stretches = np.arange(int(np.ceil(w.duration / apart)))
        times = apart * (stretches + rng.uniform(0.0, 0.8, stretches.size))
        late = np.searchsorted(times, t) * 0.08 * a * w.nominal.period
        return np.interp(t - late, t, motion.position)

    w.sensor = sensor
