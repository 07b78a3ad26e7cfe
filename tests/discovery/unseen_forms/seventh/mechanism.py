"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import drag, pulses
from tests.discovery.unseen_forms.motion import State, World

from .enter import form


@form("normal_load_ripple", source="Norton 2009 (a cam: dwells, cycloids up and down, and a short dwell above)")
def load_of_a_dwelling_cam(w: World, a: float) -> None:
    u = np.linspace(0.0, 1.0, 2001)

    def cycloid(x):
        x = np.clip(x, 0.0, 1.0)
        return x - np.sin(2 * np.pi * x) / (2 * np.pi)

    lift = cycloid((u - 0.5) / 0.2) - cycloid((u - 0.78) / 0.22)
    lift = lift - np.trapezoid(lift, u)
    load, turn = w.normal_force, 4.3 * w.nominal.period
    w.normal = lambda s: load * (1.0 + 0.13 * a * np.interp(np.mod(s.t / turn + 0.2, 1.0), u, lift))


@form("belt_speed_ripple", source="Maxwell 1868 (a governor that cuts in and out: exponentials up and down)")
def belt_of_a_governor(w: World, a: float) -> None:
    """On for a third of the time; the mean speed is as stated."""
    u = np.linspace(0.0, 1.0, 2001)
    high = 0.25 * a  # the turning points are those of a first-order lag of 0.3 periods
    fall, rise = np.exp(-0.65 / 0.3), np.exp(-0.35 / 0.3)
    top = (1.0 - rise) / (1.0 - rise * fall)
    course = np.where(u < 0.35, 1.0 - (1.0 - top * fall) * np.exp(-u / 0.3), top * np.exp(-(u - 0.35) / 0.3))
    course = (course - np.trapezoid(course, u)) / np.ptp(course) * 2.0
    speed, turn = w.belt_velocity, 1.37 * w.nominal.period
    w.set_belt(lambda t: speed * (1.0 + high * np.interp(np.mod(t / turn + 0.1, 1.0), u, course)))


@form("nonlinear_stiffness", source="Bachrach and Rivin 1983 (an air spring: a polytrope)")
def stiffness_of_an_air_spring(w: World, a: float) -> None:
    """As stiff as believed at half the reach."""
    k, length, share = w.rig.stiffness, 3.0 * w.nominal.reach, 0.6 * a

    def push(x):
        return length / 1.3 * ((1.0 - x / length) ** -1.3 - 1.0)

    middle = 0.5 * w.nominal.reach / push(0.5 * w.nominal.reach)
    w.spring = lambda s: k * ((1.0 - share) * s.x + share * middle * push(s.x))


@form("quadratic_damping", source="Schiller and Naumann 1933 (a sphere up to a Reynolds number of a thousand)")
def drag_of_a_sphere(w: World, a: float) -> None:
    drag(w, lambda u: u * (1.0 + 17.0 * np.abs(u) ** 0.687) / 18.0, 0.45 * a)


@form("backlash", source="Kim, Rook and Singh 2003 (another of their smooth clearances: arc tangents)")
def backlash_between_arc_tangents(w: World, a: float) -> None:
    if a <= 0.0:
        return
    k, gap, at = w.rig.stiffness, 0.13 * a * w.nominal.slip_length, w.rig.reach - 0.6 * w.rig.slip_length
    soft = 0.12 * gap

    def ramp(u):
        return u * np.arctan(u / soft) - 0.5 * soft * np.log1p((u / soft) ** 2)

    lost = ramp(-at) - ramp(-at - gap)
    w.spring = lambda s: k * (s.x - 0.95 / np.pi * (ramp(s.x - at) - ramp(s.x - at - gap) - lost))


@form("second_mode", source="Sakai, Takaeda and Tamaki 1989 (a liquid column, damped by the square of its speed)")
def mode_of_a_liquid_column(w: World, a: float) -> None:
    mass, p, scale = 0.17 * a * w.rig.mass, 1.7 * w.nominal.pulsation, w.nominal.slip_length

    def pull(s: State):
        return p * p * s.q[0] + 0.5 * s.q[1] * np.abs(s.q[1]) / scale

    w.q0 = (0.0, 0.0)
    w.rates = lambda s: (s.q[1], -pull(s) - s.a)
    w.load = lambda s: mass * pull(s)


@form("harmonic_force", source="Winkler 1978 (the magnet of a vibratory conveyor: half a wave)")
def force_of_a_feeder(w: World, a: float) -> None:
    force, f = 0.3 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * 1.47 / w.nominal.period
    w.load = lambda s: force * (np.maximum(np.cos(f * s.t + 0.7), 0.0) - 1.0 / np.pi)


@form("impacts", source="Friedlander 1946 (blast waves: a push, then a weaker pull)")
def impacts_of_blasts(w: World, a: float) -> None:
    times = arrivals(w.rng, w.duration, 0.8 / w.nominal.period)
    sizes = 1.3 * a * w.nominal.gap * w.nominal.normal_force * w.rng.uniform(0.6, 1.4, times.size)
    sizes *= w.rng.choice([-1.0, 1.0], times.size)
    pulses(w, lambda u: (1.0 - u) * np.exp(-1.6 * u), 0.4 / w.nominal.pulsation, sizes, times)
