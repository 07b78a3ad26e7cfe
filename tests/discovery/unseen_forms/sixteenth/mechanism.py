"""Effects of the mechanism that have a name, in shapes that laboratories meet."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import attach, drag, pulses
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("normal_load_ripple", source="Jacobsson 2003 (a runout, once a turn)")
def load_of_an_eccentric_roller(w: World, a: float) -> None:
    """A sine, once in 3.7 cycles."""
    load, turn = w.normal_force, 3.7 * w.nominal.period
    w.normal = lambda s: load * (1.0 + 0.09 * a * np.sin(2 * np.pi * s.t / turn + 1.3))


@form("belt_speed_ripple", source="Jahns and Soong 1996 (cogging of a motor with permanent magnets)")
def belt_of_a_cogging_motor(w: World, a: float) -> None:
    """A sine and an overtone of a third of it, 1.4 cycles long; the mean speed is as stated."""
    speed, f = w.belt_velocity, 2 * np.pi / (1.4 * w.nominal.period)
    w.set_belt(lambda t: speed * (1.0 + 0.35 * a * (np.sin(f * t + 0.6) + np.sin(2.0 * f * t - 0.9) / 3.0)))


@form("nonlinear_stiffness", source="Duffing 1918; Woinowsky-Krieger 1950 (a strip clamped at both ends is stretched: a cube)")
def stiffness_of_a_clamped_strip(w: World, a: float) -> None:
    """As stiff as believed at rest; at the reach the force is half as much again."""
    k, reach = w.rig.stiffness, w.nominal.reach
    w.spring = lambda s: k * s.x * (1.0 + 0.5 * a * (s.x / reach) ** 2)


@form("quadratic_damping", source="Merritt 1967 (oil through an orifice with sharp edges: the square of the speed)")
def drag_of_an_orifice(w: World, a: float) -> None:
    """The square of the speed, both ways."""
    drag(w, lambda u: u * np.abs(u), 0.5 * a)


@form("backlash", source="Nordin and Gutman 2002 (a dead zone; a weight preloads the joint)")
def backlash_of_a_clevis(w: World, a: float) -> None:
    """The force stands still over 0.12 of a slip, in the middle of the slips, where spring and weight are in balance."""
    k, gap, at = w.rig.stiffness, 0.12 * a * w.nominal.slip_length, w.rig.reach - 0.5 * w.rig.slip_length
    w.spring = lambda s: k * (s.x - np.minimum(np.maximum(s.x - at, 0.0), gap))


@form("second_mode", source="Den Hartog 1956, chapter 3 (a lightly damped mass on a spring)")
def mode_of_a_bracket(w: World, a: float) -> None:
    """A bracket of a fifth of the box's mass, 2.1 times as fast as the rig."""
    if a > 0.0:
        attach(w, ratio=0.2 * a, frequency=2.1 * w.nominal.pulsation / (2 * np.pi), damping_ratio=0.015)


@form("harmonic_force", source="Piotrowski 2006 (a shaft out of line: once and twice a turn)")
def force_of_a_misaligned_shaft(w: World, a: float) -> None:
    """The two tones are about alike, the lower one at 0.4 of the rig's frequency."""
    force, f = 0.14 * a * w.nominal.gap * w.nominal.normal_force, 0.4 * w.nominal.pulsation
    w.load = lambda s: force * (np.cos(f * s.t + 0.5) + 0.9 * np.cos(2.0 * f * s.t + 1.9))


@form("impacts", source="Richart, Hall and Woods 1970 (a drop hammer next door: the floor rings and dies away)")
def impacts_of_a_drop_hammer(w: World, a: float) -> None:
    """Blows at random, one in two cycles; each is a decaying sine, four times as fast as the rig."""
    times = arrivals(w.rng, w.duration, 0.5 / w.nominal.period)
    sizes = 0.9 * a * w.nominal.gap * w.nominal.normal_force * w.rng.uniform(0.5, 1.5, times.size)
    pulses(w, lambda u: np.exp(-0.9 * u) * np.sin(2 * np.pi * u), 0.5 * np.pi / w.nominal.pulsation, sizes, times)
