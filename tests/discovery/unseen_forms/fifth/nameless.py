"""Forms that no effect of the vocabulary describes; a second name that stands with `unknown` would be defensible."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import median_filter
from scipy.signal import bilinear, lfilter

from tests.discovery.unseen_forms.forms import UNKNOWN, each_stick
from tests.discovery.unseen_forms.friction_forms import scaled
from tests.discovery.unseen_forms.motion import State, World

from .enter import form

SEVERAL = ("several",)


@form(UNKNOWN, source="Tobias and Fishwick 1958 (a force by where the body is, less where it was a while ago)")
def force_regenerates(w: World, a: float) -> None:
    k, half = 0.3 * a * w.rig.stiffness, 0.5 / w.nominal.pulsation
    w.q0 = (0.0, 0.0)
    w.rates = lambda s: ((s.x - s.q[0]) / half, (s.q[0] - s.q[1]) / half)
    w.load = lambda s: k * (s.q[1] - s.x)


@form(UNKNOWN, "velocity_weakening", source="van der Pol 1926; Den Hartog 1956, section 7.6 (a body that gallops in a wind)")
def body_gallops(w: World, a: float) -> None:
    force, top = 0.7 * a * w.nominal.gap * w.nominal.normal_force, w.nominal.peak_speed
    w.load = lambda s: force * (s.v / top) * (1.0 - (s.v / top) ** 2)


@form(UNKNOWN, "second_mode", source="Doebelin 2004 (a stylus that rings)")
def stylus_rings(w: World, a: float) -> None:
    p = 3.4 * w.nominal.pulsation

    def sensor(t, motion, rng):
        b, c = bilinear([p * p], [1.0, 0.1 * p, p * p], 1.0 / (t[1] - t[0]))
        start = motion.position[0]
        return motion.position + a * (lfilter(b, c, motion.position - start) + start - motion.position)

    w.sensor = sensor


@form(UNKNOWN, source="Burridge and Knopoff 1967 (a second block beside the first, on a spring)")
def block_beside(w: World, a: float) -> None:
    """The neighbour rubs on the belt, as Dahl 1976 has it, with an eighth of the load and of the mass."""
    if a <= 0.0:
        return
    mass, hold = 0.12 * a * w.rig.mass, 0.12 * a * w.rig.mu_k * w.normal_force
    k, length = 0.5 * w.rig.stiffness, 0.02 * w.nominal.slip_length

    def rates(s: State) -> tuple:
        rubs = s.w + s.v - s.q[1]
        return s.q[1], (hold * s.q[2] / length - k * (s.q[0] - s.x)) / mass, rubs - abs(rubs) * s.q[2] / length

    w.q0 = (0.0, 0.0, 0.0)
    w.rates = rates
    w.load = lambda s: k * (s.q[0] - s.x)


@form(
    UNKNOWN,
    also_one=("normal_load_ripple", "position_dependent_friction"),
    source="Schallamach 1971 (waves that cross the contact at a speed of their own)",
)
def waves_travel(w: World, a: float) -> None:
    """At one operating point a wave in time and one along the belt say nearly the same."""
    length, rate = 7.7 * w.nominal.slip_length, 0.37 / w.nominal.period
    scaled(w, lambda s: 1.0 + 0.07 * a * np.cos(2 * np.pi * ((s.travel - s.x) / length + rate * s.t)))


@form(UNKNOWN, source="Shepherd 1965 (a drive whose battery runs down)")
def belt_slows_down(w: World, a: float) -> None:
    speed, span = w.belt_velocity, 60.0 * w.nominal.period
    w.set_belt(lambda t: speed * (1.0 - 0.25 * a * np.minimum(t / span, 1.2)))


@form(UNKNOWN, source="Rawlings 1993 (a recorder's clockwork that runs down)")
def clock_runs_down(w: World, a: float) -> None:
    span = 60.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: np.interp(t * (1.0 - 0.06 * a * t / span), t, motion.position)


@form(UNKNOWN, source="Kuttruff 2009 (an ultrasonic gauge that hears an echo)")
def gauge_hears_an_echo(w: World, a: float) -> None:
    late = 0.3 * w.nominal.period

    def sensor(t, motion, rng):
        x = motion.position
        return x + 0.12 * a * (np.interp(t - late, t, x) - x)

    w.sensor = sensor


@form(UNKNOWN, "stale_samples", source="Bristol 1990; Miskowicz 2006 (an archive that keeps changes beyond a threshold)")
def archive_keeps_changes(w: World, a: float) -> None:
    threshold = 0.04 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        shown, last = np.empty_like(motion.position), motion.position[0]
        for i, x in enumerate(motion.position):
            last = x if abs(x - last) >= threshold else last
            shown[i] = last
        return shown

    w.sensor = sensor


@form(UNKNOWN, source="Tukey 1977 (a logger that takes a running median)")
def logger_takes_medians(w: World, a: float) -> None:
    def sensor(t, motion, rng):
        half = round(0.05 * a * w.nominal.period / (t[1] - t[0]))
        return median_filter(motion.position, 2 * half + 1, mode="nearest")

    w.sensor = sensor


@form(UNKNOWN, "random_coefficients", source="Omori 1894; Utsu 1961 (some slips have an aftershock)")
def aftershocks(w: World, a: float) -> None:
    rig, gap = w.rig, w.nominal.gap

    def turn(s: State | None) -> None:
        after = w.memory.get("after", 0.0)
        w.memory["after"] = 1.0 if s is not None and not after and w.rng.random() < 0.35 else 0.0

    each_stick(w, turn)
    w.mu_s = lambda s: rig.mu_s - 1.4 * a * gap * w.memory["after"]
    w.mu_k = lambda s: rig.mu_k - 0.7 * a * gap * w.memory["after"]


@form(UNKNOWN, "second_mode", source="Smith 2002 (an inerter that nobody entered)")
def inerter(w: World, a: float) -> None:
    mass = w.rig.mass
    w.mass = lambda t: mass * (1.0 + 0.3 * a)


@form(UNKNOWN, source="Wahl 1963 (one leaf of the spring breaks, at another time in each run)")
def leaf_breaks(w: World, a: float) -> None:
    k, at = w.rig.stiffness, w.rng.uniform(0.35, 0.65) * w.duration
    w.spring = lambda s: k * s.x * (1.0 - 0.12 * a * (s.t >= at))


@form(UNKNOWN, "random_coefficients", source="Morris 2001 (a gauge that is calibrated anew before each run)", designs=SEVERAL)
def calibrated_anew(w: World, a: float) -> None:
    gain = 1.0 + 0.12 * a * w.rng.uniform(-1.0, 1.0)
    w.sensor = lambda t, motion, rng: gain * motion.position


@form(UNKNOWN, source="Bagley and Torvik 1983 (a spring that remembers over decades of time)")
def spring_of_a_polymer(w: World, a: float) -> None:
    k, share = w.rig.stiffness, 0.1 * a
    times = np.array([0.05, 0.4, 3.0]) * w.nominal.period
    w.q0 = (0.0, 0.0, 0.0)
    w.rates = lambda s: tuple((s.x - q) / tau for q, tau in zip(s.q, times, strict=True))
    w.spring = lambda s: k * (s.x + share * sum(s.x - q for q in s.q))


@form(UNKNOWN, "dwell_ageing", source="Dieterich 1992 (a slip that needs a time to nucleate)", designs=SEVERAL)
def slip_nucleates(w: World, a: float) -> None:
    """The spring goes on being stretched meanwhile: more, the faster the belt."""
    rig, wait = w.rig, 0.08 * a * w.nominal.slip_length / w.nominal.belt_velocity
    more = rig.stiffness * wait * (abs(w.belt_velocity) - w.nominal.belt_velocity) / w.normal_force
    w.mu_s = lambda s: rig.mu_s + more


@form(UNKNOWN, source="Kester 2005 (a bit of the converter that is stuck)")
def bit_is_stuck(w: World, a: float) -> None:
    weight = 0.03 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        x = motion.position
        return x + weight * (np.floor(x / weight) % 2 == 0) if weight else x

    w.sensor = sensor


@form(
    UNKNOWN,
    source="Slocum 1992 (a guide that rubs on the box, whatever presses it onto the belt)",
    rig="brake",
    designs=SEVERAL,
)
def guide_rubs(w: World, a: float) -> None:
    force, slow = 0.15 * a * w.nominal.gap * w.nominal.normal_force, 0.2 * w.nominal.belt_velocity
    w.load = lambda s: -force * np.tanh(s.v / slow)
