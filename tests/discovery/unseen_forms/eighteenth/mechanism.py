"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import attach, drag, pulses
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("normal_load_ripple", source="Jacobsson 2003 (a disc that runs out of true: a sine over its turn)")
def load_of_a_runout(w: World, a: float) -> None:
    """Eight per cent up and down, over four cycles and two thirds."""
    load, turn = w.normal_force, 4.7 * w.nominal.period
    w.normal = lambda s: load * (1.0 + 0.08 * a * np.sin(2 * np.pi * s.t / turn + 0.5))


@form("belt_speed_ripple", source="Gerbert 1999 (a pulley whose bore is off its middle: the radius at which the belt leaves)")
def belt_of_an_eccentric_bore(w: World, a: float) -> None:
    """The bore is a quarter of the radius off; the mean speed is as stated."""
    speed, turn, off = w.belt_velocity, 2.3 * w.nominal.period, 0.25 * a
    angle = 2 * np.pi * np.arange(720) / 720

    def radius(u):
        return off * np.cos(u) + np.sqrt(1.0 - (off * np.sin(u)) ** 2)

    mean = radius(angle).mean()
    w.set_belt(lambda t: speed * radius(2 * np.pi * t / turn + 0.9) / mean)


@form("nonlinear_stiffness", source="Wahl 1963 (a helical spring whose coils close, the narrow ones first)")
def stiffness_of_closing_coils(w: World, a: float) -> None:
    """Straight up to two fifths of the reach; then coils close evenly, and those that are open share what is left."""
    k, begins = w.rig.stiffness, 0.4 * w.nominal.reach
    closed = 0.8 * a / w.nominal.reach  # share of the coils by metre

    def spring(s):
        gone = np.minimum(closed * np.maximum(np.abs(s.x) - begins, 0.0), 0.8)
        more = -np.log1p(-gone) / closed - gone / closed if a > 0.0 else 0.0
        return k * (s.x + np.sign(s.x) * more)

    w.spring = spring


@form("quadratic_damping", source="Rayleigh 1876 (a plate that is moved broadside through a fluid: the square of the speed)")
def drag_of_a_plate(w: World, a: float) -> None:
    """Against the motion either way; two fifths of the fall of friction at the highest speed."""
    drag(w, lambda u: u * np.abs(u), 0.4 * a)


@form("backlash", source="Tao and Kokotovic 1996 (a nut with play on its screw: a dead zone)")
def backlash_of_a_loose_nut(w: World, a: float) -> None:
    """The spring's force stays level over a tenth of a slip, amid the slips."""
    k, gap, at = w.rig.stiffness, 0.1 * a * w.nominal.slip_length, w.rig.reach - 0.5 * w.rig.slip_length
    w.spring = lambda s: k * (s.x - np.minimum(np.maximum(s.x - at, 0.0), gap))


@form("second_mode", source="Frahm 1909; Ormondroyd and Den Hartog 1928 (a mass on a spring, on the box)")
def mode_of_a_sprung_mass(w: World, a: float) -> None:
    """An eighth of the box's mass at 1.8 times its frequency, lightly damped."""
    attach(w, ratio=0.125 * a, frequency=1.8 * w.nominal.pulsation / (2 * np.pi), damping_ratio=0.02)


@form("harmonic_force", source="Den Hartog 1956, chapter 2 (the unbalance of a motor at an even speed)")
def force_of_an_unbalanced_motor(w: World, a: float) -> None:
    """A sine at 0.57 of the natural frequency: a fifth of the fall of friction."""
    force, f = 0.2 * a * w.nominal.gap * w.nominal.normal_force, 0.57 * w.nominal.pulsation
    w.load = lambda s: force * np.sin(f * s.t + 0.6)


@form("impacts", source="Harris and Crede 1961; Cox and Isham 1980 (doors that slam: half-sine shocks, a Poisson process)")
def impacts_of_slammed_doors(w: World, a: float) -> None:
    """Two in three cycles, pushing either way, of exponential sizes."""
    times = arrivals(w.rng, w.duration, 0.67 / w.nominal.period)
    signs = w.rng.choice([-1.0, 1.0], times.size)
    sizes = a * w.nominal.gap * w.nominal.normal_force * signs * (0.4 + 0.6 * w.rng.exponential(1.0, times.size))
    pulses(w, lambda u: np.where(u < 1.0, np.sin(np.pi * u), 0.0), 0.5 / w.nominal.pulsation, sizes, times)
