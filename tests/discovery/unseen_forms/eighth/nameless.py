"""Forms that no effect of the vocabulary describes; a second name that stands with `unknown` would be defensible.

Each says why no name can be defended, or what speaks for the names that stand beside `unknown`.
"""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.forms import UNKNOWN, each_stick
from tests.discovery.unseen_forms.motion import State, World

from .enter import form

SEVERAL = ("several",)


@form(UNKNOWN, source="Doebelin 2004 (a gauge that was calibrated with another amplifier: its gain is off)")
def gain_is_off(w: World, a: float) -> None:
    """The box seems to ride faster than the belt, always; no name lets a constant gain differ."""
    w.sensor = lambda t, motion, rng: motion.position * (1.0 + 0.06 * a)


@form(UNKNOWN, source="Ott 2009 (mains hum on the gauge's cable, with its third harmonic)")
def cable_hums(w: World, a: float) -> None:
    """A tone on the reading alone, as large where the box sticks as where it slips: no force moves a box that sticks."""
    size, f = 0.035 * a * w.nominal.slip_length, 4.3 * w.nominal.pulsation
    w.sensor = lambda t, motion, rng: motion.position + size * (np.sin(f * t + 0.3) + 0.4 * np.sin(3.0 * f * t))


@form(UNKNOWN, source="Irschik and Holl 2004 (goods that are taken off and put on: another mass at each stick)")
def another_mass_each_time(w: World, a: float) -> None:
    """Slips last longer or shorter and are as long; coefficients that scatter would change lengths, not durations."""
    mass = w.rig.mass
    each_stick(w, lambda s: w.memory.update(mass=mass * (1.0 + 0.5 * a * w.rng.uniform(-1.0, 1.0))))
    w.mass = lambda t: w.memory["mass"]


@form(
    UNKNOWN, source="Dweib and D'Souza 1990 (a box that hops as it breaks away: its load rings, and is calm before the stick)"
)
def box_hops_as_it_starts(w: World, a: float) -> None:
    """The swing of the load begins anew with each slip; a ripple would go on, a lag would not swing, a mode would not end."""
    load, tau, f = w.normal_force, 0.6 / w.nominal.pulsation, 6.0 * w.nominal.pulsation
    w.memory["broke"] = -1e3 * tau
    w.on_break = lambda s: w.memory.update(broke=s.t)

    def normal(s: State):
        since = s.t - w.memory["broke"]
        return load * (1.0 - 0.45 * a * np.exp(-since / tau) * np.sin(f * since))

    w.normal = normal


@form(UNKNOWN, source="Kenjo 1984 (a drive that falls behind for a spell, under another machine's load)")
def belt_is_slow_for_a_spell(w: World, a: float) -> None:
    """Once, for twelve cycles: no ripple, which repeats itself; what rides on the belt shows its speed."""
    speed, period = w.belt_velocity, w.nominal.period

    def pace(t):
        spell = 0.5 * (np.tanh((t / period - 6.0) / 0.3) - np.tanh((t / period - 18.0) / 0.3))
        return speed * (1.0 - 0.09 * a * spell)

    w.set_belt(pace)


@form(UNKNOWN, source="Oliver 1948 (a recorder whose gain falls after each loud passage, and recovers)")
def recorder_turns_itself_down(w: World, a: float) -> None:
    """The gain depends on what went before; a delay or a clipped range would leave what rides on the belt alone."""

    def sensor(t, motion, rng):
        keep = np.exp(-(t[1] - t[0]) / (0.25 * w.nominal.period))
        loud = lfilter([1.0 - keep], [1.0, -keep], np.abs(motion.velocity))
        return motion.position * (1.0 - 0.08 * a * loud / (0.1 * w.nominal.peak_speed))

    w.sensor = sensor


@form(UNKNOWN, "dwell_ageing", source="Johannes, Green and Brockley 1973 (break-away by the rate of loading)", designs=SEVERAL)
def break_away_by_the_rate_of_loading(w: World, a: float) -> None:
    """A faster belt leaves less time, so that ageing goes the same way; it differs where the load changes the time alone."""
    base, rate = w.rig.mu_s, abs(w.belt_velocity) / w.nominal.belt_velocity
    w.mu_s = lambda s: base - 0.3 * a * w.nominal.gap * np.log(rate)


@form(
    UNKNOWN,
    "viscous_friction",
    "quadratic_damping",
    source="Wouterse 1991 (an eddy-current brake: its drag falls beyond a speed)",
)
def brake_of_eddy_currents(w: World, a: float) -> None:
    """Drag of the body's own speed with a greatest value; drag that levels off, or that grows, is next to it."""
    critical, force = 0.35 * w.nominal.peak_speed, 0.24 * a * w.nominal.gap * w.nominal.normal_force
    w.load = lambda s: -2.0 * force * (s.v / critical) / (1.0 + (s.v / critical) ** 2)


@form(
    UNKNOWN,
    "impacts",
    "frictional_lag",
    source="Moon and Stiefel 2006 (an escapement: a push at each break-away, always alike)",
)
def escapement_pushes(w: World, a: float) -> None:
    """Knocks, though not by chance; a force that hangs on the time since break-away, though along the slip."""
    force, length = 0.5 * a * w.nominal.gap * w.nominal.normal_force, 0.7 / w.nominal.pulsation
    w.memory["broke"] = -1e3 * length
    w.on_break = lambda s: w.memory.update(broke=s.t)
    w.load = lambda s: -force * np.sin(np.pi * np.clip((s.t - w.memory["broke"]) / length, 0.0, 1.0)) ** 2


@form(
    UNKNOWN, "stale_samples", "sensor_delay", source="Brown 1959; Welch and Bishop 1995 (a tracker that guesses between frames)"
)
def tracker_guesses(w: World, a: float) -> None:
    """Between frames the last step goes on; it is right in stick, and overshoots where slips begin and end."""

    def sensor(t, motion, rng):
        n = 1 + round(0.9 * a / w.nominal.pulsation / (t[1] - t[0]))
        index = np.arange(t.size)
        frame = index // n * n
        x = motion.position
        return x[frame] + (index - frame) / n * (x[frame] - x[np.maximum(frame - n, 0)]) if n > 1 else x

    w.sensor = sensor


@form(UNKNOWN, "sensor_delay", source="Casiez, Roussel and Vogel 2012 (a filter that opens as the signal quickens)")
def filter_opens_with_speed(w: World, a: float) -> None:
    """Late by much in stick and by little in slip; one delay cannot be both."""

    def sensor(t, motion, rng):
        if a <= 0.0:
            return motion.position
        h, p, top = t[1] - t[0], w.nominal.pulsation, w.nominal.peak_speed
        corner = (p / (0.6 * a)) * (1.0 + 6.0 * np.abs(motion.velocity) / top)
        keep = np.exp(-h * corner)
        shown, last = np.empty(t.size), motion.position[0]
        for i, (x, held) in enumerate(zip(motion.position, keep, strict=True)):
            last = x + held * (last - x)
            shown[i] = last
        return shown

    w.sensor = sensor


@form(UNKNOWN, "sensor_drift", source="Randolph and Gourvenec 2011 (an anchor that each pull drags a little further)")
def anchor_drags(w: World, a: float) -> None:
    """The spring's foot follows whenever its force is great; to a gauge it looks like a zero that runs away."""
    k, slip, hold = w.rig.stiffness, w.nominal.slip_length, 0.8 * w.nominal.mu_s * w.nominal.normal_force
    rate = 0.35 * a * slip * w.nominal.belt_velocity / w.nominal.reach
    w.q0 = (0.0,)
    w.spring = lambda s: k * (s.x - s.q[0])
    w.rates = lambda s: (rate * max(k * (s.x - s.q[0]) / hold - 1.0, 0.0),)


@form(
    UNKNOWN,
    "position_dependent_friction",
    source="Zhu and Howe 2000 (magnets in the belt that pull the box on and back, load or no load)",
)
def belt_has_magnets(w: World, a: float) -> None:
    """A force by the belt's place that adds as much to what slides as to what holds; friction that varies would add less."""
    force, pitch = 0.15 * a * w.nominal.gap * w.nominal.normal_force, 5.9 * w.nominal.slip_length
    w.load = lambda s: force * np.sin(2 * np.pi * (s.travel - s.x) / pitch + 0.4)


@form(
    UNKNOWN,
    "nonlinear_stiffness",
    "backlash",
    source="Timoshenko and Gere 1961 (a panel in the frame that clicks in, and later out)",
)
def panel_clicks(w: World, a: float) -> None:
    """A loop in the spring's curve; each of its two branches alone would be a curved spring, or a gap."""
    k, force = w.rig.stiffness, 0.14 * a * w.nominal.gap * w.nominal.normal_force
    reach, slip = w.rig.reach, w.rig.slip_length
    into, out, soft, slow = reach - 0.25 * slip, reach - 0.6 * slip, 0.02 * slip, 0.01 * w.nominal.peak_speed

    def clicked(s: State):
        place = np.where(np.abs(s.w) > slow, out, into)
        return 0.5 + 0.5 * np.tanh((s.x - place) / soft)

    w.spring = lambda s: k * s.x - force * clicked(s)
