"""Forms that no effect of the vocabulary describes; a second name that stands with `unknown` would be defensible."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.forms import UNKNOWN, arrivals, steady_noise
from tests.discovery.unseen_forms.motion import State, World

from .enter import form


@form(UNKNOWN, source="Palmgren 1924; Miner 1945 (a spring that each slip cracks further)")
def spring_tires(w: World, a: float) -> None:
    k = w.rig.stiffness
    w.spring = lambda s: k * s.x * max(1.0 - 0.005 * a * s.count, 0.7)


@form(
    UNKNOWN,
    "second_mode",
    "impacts",
    source="Lieber and Jensen 1945; Masri and Caughey 1966 (a payload with play)",
    rig="turntable",
)
def payload_rattles(w: World, a: float) -> None:
    mass, p, half = 0.2 * a * w.rig.mass, 4.0 * w.nominal.pulsation, 0.1 * w.nominal.slip_length

    def pull(s: State):
        over = abs(s.q[0]) - half
        return 0.1 * p * s.q[1] + (p * p * over * np.sign(s.q[0]) + 0.2 * p * s.q[1] if over > 0.0 else 0.0)

    w.q0 = (0.0, 0.0)
    w.rates = lambda s: (s.q[1], -pull(s) - s.a)
    w.load = lambda s: mass * pull(s)


@form(UNKNOWN, "belt_speed_ripple", source="Frederick 1932; IEC 60386 (a recorder's flutter)")
def clock_flutters(w: World, a: float) -> None:
    turn = 2 * np.pi / (0.41 * w.nominal.period)
    w.sensor = lambda t, motion, rng: np.interp(t + 0.25 * a / turn * np.sin(turn * t), t, motion.position)


@form(UNKNOWN, source="OIML R 60 (creep of the sensing element)")
def sensor_creeps(w: World, a: float) -> None:
    tau = 0.35 * w.nominal.period

    def sensor(t, motion, rng):
        decay = np.exp(-(t[1] - t[0]) / tau)
        return motion.position + 0.15 * a * lfilter([1.0 - decay], [1.0, -decay], motion.position)

    w.sensor = sensor


@form(UNKNOWN, "friction_drift", source="Page 1955 (a weight that falls off, at another time in each run)")
def weight_falls_off(w: World, a: float) -> None:
    load, at = w.normal_force, w.rng.uniform(0.35, 0.65) * w.duration
    w.normal = lambda s: load * (1.0 - 0.08 * a * (s.t >= at))


@form(
    UNKNOWN,
    "friction_drift",
    "distance_drift",
    source="Jaeger 1942; Ettles 1986 (a contact that heats itself)",
    rig="turntable",
)
def contact_heats_itself(w: World, a: float) -> None:
    """Warmth is that of the power of friction in the last five cycles, one at the rig's own speed; each run starts cold."""
    rig, tau, speed = w.rig, 5.0 * w.nominal.period, w.nominal.belt_velocity
    w.q0 = (0.0,)
    w.rates = lambda s: ((abs(s.w) / speed - s.q[0]) / tau,)
    w.mu_s = lambda s: rig.mu_s * (1.0 - 0.08 * a * s.q[0])
    w.mu_k = lambda s: rig.mu_k * (1.0 - 0.08 * a * s.q[0])


@form(UNKNOWN, "correlated_coefficients", source="Ibrahim 1985 (a stiffness that wanders)")
def stiffness_wanders(w: World, a: float) -> None:
    k, z = w.rig.stiffness, steady_noise(w.rng, w.duration, 3.0 * w.nominal.period, order=2)
    w.spring = lambda s: k * s.x * (1.0 + 0.04 * a * z(s.t))


@form(
    UNKNOWN,
    "impacts",
    "random_coefficients",
    source="Cochard, Bureau and Baumberger 2003 (knocks in between let a loaded contact go)",
)
def frame_is_tapped(w: World, a: float) -> None:
    rig, width, size = w.rig, 0.01 * w.nominal.period, 0.35 * a * w.nominal.gap
    times = np.concatenate([arrivals(w.rng, w.duration, 1.5 / w.nominal.period), [-9.0 * width, w.duration + 9.0 * width]])
    grid = np.arange(0.0, w.duration + width, 0.2 * width)
    ends = np.sort(times)
    after = np.searchsorted(ends, grid)
    apart = np.minimum(grid - ends[after - 1], ends[after] - grid)
    dip = np.exp(-((apart / width) ** 2))
    w.mu_s = lambda s: rig.mu_s - size * np.interp(s.t, grid, dip)


@form(UNKNOWN, "position_dependent_force", "nonlinear_stiffness", source="Moon and Holmes 1979 (a magnet in the frame)")
def magnet_in_the_frame(w: World, a: float) -> None:
    middle, width = w.nominal.reach - 0.55 * w.nominal.slip_length, 0.15 * w.nominal.slip_length
    force = 0.7 * a * w.nominal.gap * w.nominal.normal_force

    def pull(s: State):
        u = (s.x - middle) / width
        return -force * u * np.exp(-u * u)

    w.load = pull


@form(UNKNOWN, "sensor_outliers", "stale_samples", source="Bennett, Partridge and Shectman 1999 (packets out of order)")
def packets_out_of_order(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        shown, n = motion.position.copy(), round(0.02 * a * w.nominal.period / (t[1] - t[0]))
        for time in arrivals(rng, w.duration, 0.5 / w.nominal.period) if n else ():
            i = np.searchsorted(t, time)
            if i + 2 * n <= t.size:
                shown[i : i + 2 * n] = np.roll(shown[i : i + 2 * n], n)
        return shown

    w.sensor = sensor


@form(UNKNOWN, source="Tomlinson 1929 (a row of junctions that all start in step)")
def slip_goes_in_jerks(w: World, a: float) -> None:
    rig, size, pitch = w.rig, 0.35 * a * w.nominal.gap, 0.22 * w.nominal.slip_length
    w.mu_k = lambda s: rig.mu_k + size * np.sin(2 * np.pi * s.slip / pitch)


@form(UNKNOWN, "second_mode", source="Crede and Ruzicka 1961 (a base that yields)", rig="turntable")
def base_moves(w: World, a: float) -> None:
    """The spring's foot is a mass of three times the box's on a spring; both in series are as stiff as believed."""
    if a <= 0.0:
        return
    k, give = w.rig.stiffness, 0.12 * a
    mass, first, second = 3.0 * w.rig.mass, k * (1.0 + give), k * (1.0 + give) / give
    damper = 0.04 * np.sqrt((first + second) * mass)
    w.q0 = (0.0, 0.0)
    w.rates = lambda s: (s.q[1], (first * (s.x - s.q[0]) - second * s.q[0] - damper * s.q[1]) / mass)
    w.spring = lambda s: first * (s.x - s.q[0])


@form(UNKNOWN, source="Bolot 1993 (blocks of samples that are lost, and nobody is told)", end=1.0)
def blocks_are_lost(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        apart = 7.0 * w.nominal.period  # one at some time in each stretch
        stretches = np.arange(int(np.ceil(w.duration / apart)))
        times = apart * (stretches + rng.uniform(0.0, 0.8, stretches.size))
        return np.interp(t + np.searchsorted(times, t) * 0.08 * a * w.nominal.period, t, motion.position)

    w.sensor = sensor


@form(UNKNOWN, source="Hoffmann and Gaul 2004 (a loader that follows the spring, late)", rig="turntable")
def loader_lags(w: World, a: float) -> None:
    load, reach, tau = w.normal_force, w.nominal.reach, 0.5 / w.nominal.pulsation
    middle = w.nominal.mu_k / w.nominal.mu_s
    w.q0 = (0.0,)
    w.rates = lambda s: ((s.x / reach - middle - s.q[0]) / tau,)
    w.normal = lambda s: load * (1.0 + 0.12 * a * s.q[0])


@form(UNKNOWN, "sensor_step", source="Hsu, Whittier and Mead 1970 (popcorn noise)")
def zero_pops(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        flips = arrivals(rng, w.duration, 0.5 / w.nominal.period)
        return motion.position + 0.01 * a * w.nominal.reach * np.mod(np.searchsorted(flips, t), 2)

    w.sensor = sensor


@form(
    UNKNOWN,
    "position_dependent_friction",
    "velocity_weakening",
    source="Armstrong-Helouvry 1991; Popp and Stelter 1990 (half of the belt is greased, and weakens with speed)",
)
def belt_of_two_halves(w: World, a: float) -> None:
    rig, size, slow = w.rig, 0.5 * a * w.nominal.gap, 0.25 * w.nominal.peak_speed
    length = 11.3 * w.nominal.slip_length

    def mu_k(s: State) -> float:
        greased = 0.5 + 0.5 * np.tanh(12.0 * np.sin(2 * np.pi * (s.travel - s.x) / length + 0.3))
        return rig.mu_k + size * greased * np.exp(-abs(s.w) / slow)

    w.mu_k = mu_k


@form(UNKNOWN, "harmonic_force", source="Lewis 1932 (a machine that runs up)")
def machine_runs_up(w: World, a: float) -> None:
    force, low, rise = 0.15 * a * w.nominal.gap * w.nominal.normal_force, 0.6 / w.nominal.period, 2.0 / w.nominal.period
    w.load = lambda s: force * np.cos(2 * np.pi * s.t * (low + 0.5 * rise * s.t / w.duration))


@form(UNKNOWN, "viscous_friction", source="Polycarpou and Soom 1995 (a film that forms within the slip)")
def film_forms(w: World, a: float) -> None:
    rig, size, top = w.rig, 0.5 * a * w.nominal.gap, w.nominal.peak_speed
    at, width = 0.4 * w.nominal.slip_length, 0.03 * w.nominal.slip_length
    w.mu_k = lambda s: rig.mu_k + size * abs(s.w) / top * 0.5 * (1.0 + np.tanh((s.slip - at) / width))
