"""Effects of the mechanism that have a name, as laboratories meet them."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import attach, drag, pulses
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("normal_load_ripple", source="Jacobsson 2003 (the thickness of a disc varies: once a turn, and less twice a turn)")
def load_of_an_uneven_disc(w: World, a: float) -> None:
    """A wave of 4.7 cycles, and 0.4 as much of half its length."""
    load, f = w.normal_force, 2 * np.pi / (4.7 * w.nominal.period)
    w.normal = lambda s: load * (1.0 + 0.09 * a * (np.cos(f * s.t + 0.6) + 0.4 * np.cos(2.0 * f * s.t + 2.1)))


@form("belt_speed_ripple", source="Armstrong-Helouvry 1991 (a pulley that does not run true)")
def belt_on_an_untrue_pulley(w: World, a: float) -> None:
    """The speed follows the radius that drives: a cosine, one turn in 1.3 cycles; the mean speed is as stated."""
    speed, f = w.belt_velocity, 2 * np.pi / (1.3 * w.nominal.period)
    w.set_belt(lambda t: speed * (1.0 + 0.25 * a * np.cos(f * t + 1.1)))


@form("nonlinear_stiffness", source="Duffing 1918 (a spring that hardens: the cube)")
def stiffness_of_duffing(w: World, a: float) -> None:
    """As believed at rest; where friction breaks, the cube adds 0.3 of the straight part."""
    k, reach = w.rig.stiffness, w.nominal.reach
    w.spring = lambda s: k * s.x * (1.0 + 0.3 * a * (s.x / reach) ** 2)


@form(
    "quadratic_damping",
    source="Newton 1687; Morison, O'Brien, Johnson and Schaaf 1950 (a blunt body in still water)",
    rig="caisson",
)
def drag_of_still_water(w: World, a: float) -> None:
    """The square of the speed, against it; 0.45 of the fall of friction at the highest one."""
    drag(w, lambda u: u * np.abs(u), 0.45 * a)


@form("backlash", source="Nordin and Gutman 2002 (a dead zone)")
def backlash_of_a_worn_hole(w: World, a: float) -> None:
    """Slack over a tenth of a slip, where the force stays level; it begins amid a slip."""
    k, gap, at = w.rig.stiffness, 0.1 * a * w.nominal.slip_length, w.rig.reach - 0.55 * w.rig.slip_length
    w.spring = lambda s: k * (s.x - np.minimum(np.maximum(s.x - at, 0.0), gap))


@form("second_mode", source="Den Hartog 1956, chapter 3 (a part that swings on its own spring)")
def mode_of_a_loose_bracket(w: World, a: float) -> None:
    """An eighth of the box's mass, 2.4 times as fast as the rig, with 2 % of damping."""
    if a > 0.0:
        attach(w, ratio=0.125 * a, frequency=2.4 * w.nominal.pulsation / (2 * np.pi), damping_ratio=0.02)


@form("harmonic_force", source="Den Hartog 1956, chapter 2 (a fan whose rotor is out of balance)")
def force_of_an_unbalanced_fan(w: World, a: float) -> None:
    """One steady tone, somewhat above the second harmonic of the cycle."""
    force, f = 0.2 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * 2.23 / w.nominal.period
    w.load = lambda s: force * np.cos(f * s.t + 0.5)


@form("impacts", source="Harris and Piersol 2002 (shocks as haversines)")
def impacts_of_a_workshop(w: World, a: float) -> None:
    """Short pulses at random, either way, of normal size."""
    times = arrivals(w.rng, w.duration, 0.8 / w.nominal.period)
    sizes = 1.6 * a * w.nominal.gap * w.nominal.normal_force * w.rng.standard_normal(times.size)
    pulses(w, lambda u: np.where(u < 1.0, np.sin(np.pi * u) ** 2, 0.0), 0.5 / w.nominal.pulsation, sizes, times)
