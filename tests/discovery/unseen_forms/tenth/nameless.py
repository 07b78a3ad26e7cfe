"""Forms that no effect of the vocabulary describes; a second name that stands with `unknown` would be defensible.

Each says why no name can be defended, or what speaks for the names that stand beside `unknown`.
"""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.forms import UNKNOWN, warm
from tests.discovery.unseen_forms.motion import State, World

from .enter import form

SEVERAL = ("several",)


@form(UNKNOWN, "belt_speed_ripple", source="Fitzgerald, Kingsley and Umans 2003 (a motor whose speed droops under its load)")
def belt_droops_under_load(w: World, a: float) -> None:
    """The belt slows down as the box pulls: it varies once a cycle, though by the force and not by the clock."""
    if a <= 0.0:
        return
    v, rate = w.belt_velocity, 0.5 * a * w.nominal.belt_velocity / w.nominal.slip_length
    middle = w.rig.mu_k * w.normal_force / w.rig.stiffness
    since = {"time": 0.0, "travel": 0.0, "speed": v, "rate": 0.0}

    def travel(t):
        u = t - since["time"]
        if since["rate"] == 0.0:
            return since["travel"] + since["speed"] * u
        return since["travel"] - since["speed"] / since["rate"] * np.expm1(-since["rate"] * u)

    def belt(t):
        return since["speed"] * np.exp(-since["rate"] * (t - since["time"]))

    def stick(s: State) -> None:
        since.update(time=s.t, travel=travel(s.t), speed=v - rate * (s.x - middle), rate=rate)

    def slip(s: State) -> None:
        since.update(time=s.t, travel=travel(s.t), speed=v, rate=0.0)

    w.travel, w.belt = travel, belt
    w.belt_acceleration = lambda t: -since["rate"] * belt(t)
    w.on_stick, w.on_break = stick, slip


@form(UNKNOWN, "belt_speed_ripple", source="Merritt 1967 (a hydraulic drive that leaks more, the warmer its oil)")
def belt_follows_the_thermometer(w: World, a: float) -> None:
    """It is the belt's speed that differs, though by the recorded temperature and not in a period."""
    warm(w)
    celsius = vars(w)["temperature"]
    w.set_belt(lambda t: w.belt_velocity * (1.0 - 0.02 * a * (celsius(t) - 20.0)))


@form(UNKNOWN, source="Slocum 1992 (a pulley of another diameter: the belt runs faster than stated, always)")
def belt_runs_fast(w: World, a: float) -> None:
    """Nothing varies: no ripple. A gain or a clock that is off would change lengths or the rig's own period as well."""
    fast = w.belt_velocity * (1.0 + 0.08 * a)
    w.belt, w.travel = lambda t: fast + 0.0 * t, lambda t: fast * t


@form(UNKNOWN, "sensor_delay", source="ISO 230-2 2014 (a reversal error: the feeler leans with the sense of motion)")
def feeler_leans_with_the_motion(w: World, a: float) -> None:
    """Behind the box either way, as if late, though by the same way at any speed; what has play would need a way to turn."""
    lean, slow = 0.035 * a * w.nominal.slip_length, 0.5 * w.nominal.belt_velocity
    w.sensor = lambda t, motion, rng: motion.position - lean * np.tanh(motion.velocity / slow)


@form(UNKNOWN, source="Wedlock and Roberge 1969; Tektronix 1990 (a probe that is compensated by too much)")
def probe_is_overcompensated(w: World, a: float) -> None:
    """Fast motion is shown too large, and too early: the opposite of a delay; what rides on the belt is right."""

    def sensor(t, motion, rng):
        keep = np.exp(-(t[1] - t[0]) * w.nominal.pulsation / 1.3)
        x = motion.position
        slow = lfilter([1.0 - keep], [1.0, -keep], x, zi=[keep * x[0]])[0]
        return x + 0.12 * a * (x - slow)

    w.sensor = sensor


@form(
    UNKNOWN,
    "temperature_drift",
    "sensor_drift",
    source="Bryan 1990 (a frame that grows as it warms, and takes the spring's foot along)",
)
def frame_takes_the_foot_along(w: World, a: float) -> None:
    """A force by the recorded temperature. Friction, or the gauge's zero, would move places of break-away alike."""
    warm(w)
    celsius = vars(w)["temperature"]
    force = 0.016 * a * w.nominal.slip_length * w.nominal.stiffness
    w.foot = lambda t: force * (celsius(t) - 20.0)


@form(UNKNOWN, "random_coefficients", source="Wahl 1963 (springs of three batches, mixed up between runs)", designs=SEVERAL)
def springs_are_mixed_up(w: World, a: float) -> None:
    """Softer in one run and stiffer in another; coefficients drawn for each run move the places alike, but not the period."""
    k = w.rig.stiffness * (1.0 + 0.07 * a * w.rng.choice([-1.0, 0.0, 1.0]))
    w.spring = lambda s: k * s.x


@form(UNKNOWN, "second_mode", source="Wahl 1963, chapter 25; Lee and Thompson 2001 (a coil spring whose own mass surges)")
def spring_surges(w: World, a: float) -> None:
    """Waves along the spring: of all its modes the lowest may pass for a second mass; it hangs between box and foot, though."""
    if a <= 0.0:
        return
    coil, k = 0.3 * a * w.rig.mass, 4.0 * w.rig.stiffness
    part, mass, damping = coil / 4.0, w.rig.mass + coil / 8.0, 0.1 * w.nominal.pulsation

    def rates(s: State):
        x1, v1, x2, v2, x3, v3 = s.q
        return (
            v1,
            k / part * (x2 - 2.0 * x1) - damping * v1,
            v2,
            k / part * (x1 - 2.0 * x2 + x3) - damping * v2,
            v3,
            k / part * (x2 - 2.0 * x3 + s.x) - damping * v3,
        )

    w.q0, w.rates = (0.0,) * 6, rates
    w.mass = lambda t: mass
    w.spring = lambda s: k * (s.x - s.q[4])


@form(
    UNKNOWN,
    "velocity_weakening",
    "frictional_lag",
    source="Goldsby and Tullis 2002 (a gel that shear makes, and that sets again at rest alone)",
)
def gel_stays_weak(w: World, a: float) -> None:
    """Friction by the highest speed of the slip so far: as a curve of the speed up to there, and level from then on."""
    rig, scale = w.rig, 0.25 * w.nominal.peak_speed
    w.memory["highest"] = 0.0
    w.on_break = lambda s: w.memory.update(highest=0.0)

    def mu_k(s: State):
        w.memory["highest"] = max(w.memory["highest"], abs(float(s.w)))
        return rig.mu_k + 0.5 * a * w.nominal.gap * np.exp(-w.memory["highest"] / scale)

    w.mu_k = mu_k


@form(UNKNOWN, "sensor_step", source="Morris 2001 (somebody touches the amplifier's gain, once a run, at another time each)")
def gain_is_touched(w: World, a: float) -> None:
    """A jump of the reading, as if the zero had; yet it is by the place, and slips are shown longer from then on."""
    at = w.rng.uniform(0.3, 0.6) * w.duration
    w.sensor = lambda t, motion, rng: motion.position * (1.0 + 0.08 * a * (t >= at))


@form(
    UNKNOWN,
    "position_dependent_friction",
    source="Abbe 1890; Bryan 1979 (a box that tilts on a wavy belt, and a gauge that sits high above the contact)",
)
def box_tilts_on_a_wavy_belt(w: World, a: float) -> None:
    """A waviness by the place of the belt, as friction may have it, though of the reading: it stays while the box sticks."""
    size, turn = 0.06 * a * w.nominal.slip_length, 2 * np.pi / (6.3 * w.nominal.slip_length)
    w.sensor = lambda t, motion, rng: motion.position + size * np.sin(turn * (w.travel(t) - motion.position) + 0.7)


@form(
    UNKNOWN,
    "dwell_ageing",
    source="Merritt 1967 (a hydraulic loader that sags at each break-away, and is pumped up again)",
    designs=SEVERAL,
)
def loader_sags_at_each_slip(w: World, a: float) -> None:
    """What holds grows with the time of rest, as ageing does; it is the load, though, and slides with less as well."""
    load, tau = w.normal_force, 0.8 * w.nominal.period
    w.memory["broke"] = -1.0e3 * tau
    w.on_break = lambda s: w.memory.update(broke=s.t)
    w.normal = lambda s: load * (1.0 - 0.13 * a * np.exp(-(s.t - w.memory["broke"]) / tau))
