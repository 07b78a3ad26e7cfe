"""Effects of the mechanism that have a name, in further shapes."""

from __future__ import annotations

import numpy as np

from tests.discovery.unseen_forms.forms import arrivals
from tests.discovery.unseen_forms.mechanism_forms import drag, pulses
from tests.discovery.unseen_forms.motion import State, World

from .enter import form


@form("normal_load_ripple", source="Nayak 1972 (a roller with a flat)")
def load_of_a_flat(w: World, a: float) -> None:
    load, period = w.normal_force, 3.1 * w.nominal.period
    w.normal = lambda s: load * (1.0 - 0.16 * a * (np.exp(6.0 * (np.cos(2 * np.pi * s.t / period + 0.8) - 1.0)) - 0.167))


@form("normal_load_ripple", source="Rothbart 2004 (a cam that lifts slowly and drops fast)")
def load_of_a_cam(w: World, a: float) -> None:
    load, period = w.normal_force, 7.3 * w.nominal.period
    w.normal = lambda s: (
        load * (1.0 + 0.06 * a * np.interp(np.mod(s.t / period + 0.15, 1.0), [0.0, 0.75, 1.0], [-1.0, 1.0, -1.0]))
    )


@form("belt_speed_ripple", source="Acarnley 2002 (a stepping motor that rings after each step)")
def belt_rings_at_each_step(w: World, a: float) -> None:
    speed, period = w.belt_velocity, 0.6 * w.nominal.period

    def ring(u):
        return np.exp(-4.0 * u) * np.cos(4 * np.pi * u)

    mean = float(np.mean(ring(np.linspace(0.0, 1.0, 10001))))
    w.set_belt(lambda t: speed * (1.0 + 0.45 * a * (ring(np.mod(t / period + 0.2, 1.0)) - mean)))


@form("belt_speed_ripple", source="Johnson 1985, chapter 8 (two pulleys out of true, a turn and half a turn)")
def belt_of_two_pulleys(w: World, a: float) -> None:
    speed, turn = w.belt_velocity, 2 * np.pi / (1.7 * w.nominal.period)
    w.set_belt(lambda t: speed * (1.0 + 0.14 * a * np.cos(turn * t + 0.6) + 0.1 * a * np.cos(2.0 * turn * t - 1.0)))


@form("nonlinear_stiffness", source="Hertz 1882 (a mount that bears on a ball)")
def stiffness_hertz(w: World, a: float) -> None:
    k, reach, share = w.rig.stiffness, w.nominal.reach, 0.5 * a
    w.spring = lambda s: k * s.x * (1.0 - share + 1.25 * share * np.sqrt(np.abs(s.x) / reach))


@form("nonlinear_stiffness", source="Almen and Laszlo 1936 (disc spring)")
def stiffness_disc_spring(w: World, a: float) -> None:
    k, reach = w.rig.stiffness, w.nominal.reach

    def force(s: State):
        u = s.x / reach
        return k * s.x * (1.0 + a * (0.15 - 0.5 * np.abs(u) + 0.25 * u * u))

    w.spring = force


@form("backlash", source="Stepanenko and Sankar 1986 (two pins with clearance)")
def backlash_of_two_pins(w: World, a: float) -> None:
    k, reach, slip = w.rig.stiffness, w.nominal.reach, w.nominal.slip_length
    gap = 0.06 * a * slip

    def taken(x, share: float):
        return np.minimum(np.maximum(x - (reach - share * slip), 0.0), gap)

    w.spring = lambda s: k * (s.x - taken(s.x, 0.75) - taken(s.x, 0.35))


@form("backlash", source="Dubowsky and Freudenstein 1971 (a clearance that closes on round bodies)")
def backlash_on_round_bodies(w: World, a: float) -> None:
    k, gap, at = w.rig.stiffness, 0.12 * a * w.nominal.slip_length, w.nominal.reach - 0.6 * w.nominal.slip_length

    def taken(x):
        u = np.clip((x - at) / (1.6 * gap), 0.0, 1.0) if a > 0.0 else 0.0 * x
        return gap * (1.0 - (1.0 - u) ** 1.5)

    w.spring = lambda s: k * (s.x - taken(s.x))


@form("quadratic_damping", source="Forchheimer 1901 (through a porous plug)")
def drag_through_a_plug(w: World, a: float) -> None:
    drag(w, lambda u: 0.8 * u * np.abs(u) + 0.2 * u, 0.45 * a)


@form("quadratic_damping", source="Reynolds 1883 (laminar, then turbulent)")
def drag_becomes_turbulent(w: World, a: float) -> None:
    drag(w, lambda u: u * np.maximum(np.abs(u), 0.3), 0.45 * a)


def absorbers(world: World, parts: tuple[tuple[float, float, float, float], ...]) -> None:
    """Put masses on the box: mass over the box's, frequency over the rig's, damping ratio, dry friction over k slip length."""
    pulsation, scale = world.nominal.pulsation, world.nominal.slip_length
    parts = tuple((ratio * world.rig.mass, f * pulsation, zeta, dry) for ratio, f, zeta, dry in parts)

    def pull(s: State, i: int):
        _, p, zeta, dry = parts[i]
        q, rate = s.q[2 * i], s.q[2 * i + 1]
        return p * p * q + 2.0 * zeta * p * rate + dry * p * p * scale * np.tanh(rate / (0.01 * p * scale))

    world.q0 = (0.0,) * (2 * len(parts))
    world.rates = lambda s: tuple(x for i in range(len(parts)) for x in (s.q[2 * i + 1], -pull(s, i) - s.a))
    world.load = lambda s: sum(parts[i][0] * pull(s, i) for i in range(len(parts)))


@form("second_mode", source="Hunt 1979 (two absorbers)")
def mode_and_a_third(w: World, a: float) -> None:
    absorbers(w, ((0.10 * a, 2.4, 0.01, 0.0), (0.06 * a, 4.3, 0.01, 0.0)))


@form("second_mode", source="Ricciardelli and Vickery 1999 (an absorber that rubs)")
def mode_that_rubs(w: World, a: float) -> None:
    absorbers(w, ((0.18 * a, 2.1, 0.003, 0.01),))


@form("harmonic_force", source="Den Hartog 1956, chapter 5 (orders of an engine)")
def force_of_an_engine(w: World, a: float) -> None:
    force, f = 0.12 * a * w.nominal.gap * w.nominal.normal_force, 2 * np.pi * 1.19 / w.nominal.period
    w.load = lambda s: force * (np.cos(f * s.t) + 0.5 * np.cos(2 * f * s.t + 0.7) + 0.3 * np.cos(3 * f * s.t - 1.2))


@form("harmonic_force", source="Fitzgerald, Kingsley and Umans 2003 (a solenoid: the square of the current)")
def force_of_a_solenoid(w: World, a: float) -> None:
    force, f = 0.25 * a * w.nominal.gap * w.nominal.normal_force, np.pi * 0.37 / w.nominal.period
    w.load = lambda s: force * (np.abs(np.cos(f * s.t + 0.3)) - 2.0 / np.pi)


@form("impacts", source="Goldsmith 1960; Limpert, Stahel and Abbt 2001 (saw-toothed blows, lognormal sizes)")
def impacts_saw_toothed(w: World, a: float) -> None:
    times = arrivals(w.rng, w.duration, 0.8 / w.nominal.period)
    sizes = -1.3 * a * w.nominal.gap * w.nominal.normal_force * np.exp(0.5 * w.rng.standard_normal(times.size))
    pulses(w, lambda u: np.where(u < 1.0, 1.0 - u, 0.0), 0.4 / w.nominal.pulsation, sizes, times)


@form("impacts", source="Jacobsen and Ayre 1958 (rounded rectangles of both signs)")
def impacts_rectangular(w: World, a: float) -> None:
    times = arrivals(w.rng, w.duration, 0.6 / w.nominal.period)
    sizes = 0.9 * a * w.nominal.gap * w.nominal.normal_force * w.rng.choice([-1.0, 1.0], times.size)
    sizes *= w.rng.uniform(0.6, 1.2, times.size)
    pulses(
        w, lambda u: 0.5 * (np.tanh(12.0 * (u - 0.15)) - np.tanh(12.0 * (u - 1.0))), 0.35 / w.nominal.pulsation, sizes, times
    )
