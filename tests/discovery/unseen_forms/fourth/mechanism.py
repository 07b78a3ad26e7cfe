"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import drag, pulses
from tests.discovery.unseen_forms.motion import World
from tests.discovery.unseen_forms.third.mechanism import absorbers

from .enter import form


@form("normal_load_ripple", source="Rayleigh 1877 (two rollers of nearly one size: beats)")
def load_beats(w: World, a: float) -> None:
    load, turn = w.normal_force, 2 * np.pi / (3.3 * w.nominal.period)
    w.normal = lambda s: load * (1.0 + 0.06 * a * (np.cos(turn * s.t) + 0.7 * np.cos(1.13 * turn * s.t + 0.6)))


@form("normal_load_ripple", source="Manring and Zhang 2001 (pressure of a pump of three pistons)")
def load_of_a_pump(w: World, a: float) -> None:
    load, turn = w.normal_force, 2 * np.pi / (3.8 * w.nominal.period)

    def flow(u):
        return sum(np.maximum(np.sin(u + 2 * np.pi * i / 3), 0.0) for i in range(3))

    w.normal = lambda s: load * (1.0 + 0.9 * a * (flow(turn * s.t + 0.2) - 3.0 / np.pi))


@form("belt_speed_ripple", source="Randall 1982 (teeth of a wheel out of true: a line with side bands)")
def belt_of_modulated_teeth(w: World, a: float) -> None:
    speed, turn = w.belt_velocity, 2 * np.pi / (2.3 * w.nominal.period)
    w.set_belt(lambda t: speed * (1.0 + 0.25 * a * (1.0 + 0.6 * np.cos(turn * t)) * np.cos(5.0 * turn * t + 0.5)))


@form("belt_speed_ripple", source="Litvin and Fuentes 2004, chapter 12 (elliptical gears)")
def belt_of_elliptical_gears(w: World, a: float) -> None:
    speed, e, turn = w.belt_velocity, 0.25 * a, 2 * np.pi / (1.3 * w.nominal.period)
    w.set_belt(lambda t: speed * np.sqrt(1.0 - e * e) / (1.0 - e * np.cos(turn * t + 1.0)))


@form("nonlinear_stiffness", source="Carrella, Brennan and Waters 2007 (inclined springs)")
def stiffness_of_inclined_springs(w: World, a: float) -> None:
    k, d, share = w.rig.stiffness, 0.6 * w.nominal.reach, 0.35 * a
    middle = 1.0 / np.hypot(1.0, 0.7 / 0.6)
    w.spring = lambda s: k * s.x * (1.0 + share * (middle - 1.0 / np.hypot(1.0, s.x / d)))


@form("nonlinear_stiffness", source="Gent 1996 (rubber that locks)")
def stiffness_gent(w: World, a: float) -> None:
    k, longest, share = w.rig.stiffness, 2.0 * w.nominal.reach, 0.6 * a
    middle = 1.0 - 0.35**2
    w.spring = lambda s: k * s.x * (1.0 + share * (middle / (1.0 - (s.x / longest) ** 2) - 1.0))


@form("quadratic_damping", source="Abraham 1970 (a boundary layer on a blunt body)")
def drag_of_a_boundary_layer(w: World, a: float) -> None:
    drag(w, lambda u: np.sign(u) * (np.abs(u) + 0.4 * np.sqrt(np.abs(u))) ** 2 / 1.96, 0.45 * a)


@form("backlash", source="Comparin and Singh 1990 (a clutch of two stages)")
def backlash_of_a_clutch(w: World, a: float) -> None:
    k, gap, at = w.rig.stiffness, 0.07 * a * w.nominal.slip_length, w.nominal.reach - 0.7 * w.nominal.slip_length
    w.spring = lambda s: k * (s.x - 0.95 * np.clip(s.x - at, 0.0, gap) - 0.5 * np.clip(s.x - at - gap, 0.0, gap))


@form("second_mode", source="Ibrahim 2005 (a liquid that sloshes: slower than the rig)", rig="turntable")
def mode_that_sloshes(w: World, a: float) -> None:
    absorbers(w, ((0.18 * a, 0.6, 0.02, 0.0),))


@form("harmonic_force", source="Jaffrin and Shapiro 1971 (a peristaltic pump's hose)")
def force_of_a_peristaltic_pump(w: World, a: float) -> None:
    force, f = 0.3 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * 1.31 / w.nominal.period
    w.load = lambda s: force * (np.exp(3.0 * (np.cos(f * s.t + 0.8) - 1.0)) - 0.243)


@form("impacts", source="Hawkes 1971; Johnson 1985, chapter 11 (Hertzian blows in clusters)")
def impacts_in_clusters(w: World, a: float) -> None:
    first = arrivals(w.rng, w.duration, 0.3 / w.nominal.period)
    after = np.repeat(first, w.rng.poisson(1.5, first.size))
    times = np.concatenate([first, after + w.rng.exponential(0.5 * w.nominal.period, after.size)])
    sizes = 1.3 * a * w.nominal.gap * w.nominal.normal_force * w.rng.uniform(0.5, 1.5, times.size)
    pulses(w, lambda u: np.sin(np.pi * np.clip(u, 0.0, 1.0)) ** 1.5, 0.3 / w.nominal.pulsation, sizes, times)
