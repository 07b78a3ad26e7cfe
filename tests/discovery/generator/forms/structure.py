"""The mechanism differs: spring, damping, play, a second body."""

from collections.abc import Callable

import numpy as np

from tests.discovery.generator.curve import Array, line, slope, tabulate
from tests.discovery.generator.machine import Machine
from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, form

_REACH = 0.02  # m, far beyond the rig's motion


def _spring(parameters: dict[str, float], law: Callable[[Array], Array], rig: Rig) -> Effect:
    """Spring force k x_b law(x/x_b), x_b the break-away position."""
    unit = rig.break_away

    def alter(machine: Machine, rng: Generator) -> Machine:
        del rng
        stiffness = slope(machine.spring)
        return machine._replace(spring=tabulate(lambda x: stiffness * unit * law(x / unit), -_REACH, _REACH, 40001))

    return Effect(parameters, alter)


@form("nonlinear_stiffness")
def cubic(rng: Generator, strength: float, rig: Rig) -> Effect:
    share = strength * rng.uniform(0.25, 0.4)
    return _spring({"share": share}, lambda u: u * (1.0 + share * (u**2 - 0.4)), rig)


@form("nonlinear_stiffness")
def quintic(rng: Generator, strength: float, rig: Rig) -> Effect:
    share = strength * rng.uniform(0.25, 0.4)
    return _spring({"share": share}, lambda u: u * (1.0 + share * (np.minimum(np.abs(u), 2.0) ** 4 - 0.3)), rig)


@form("nonlinear_stiffness")
def exponential(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Hardens like rubber."""
    rate = strength * rng.uniform(0.7, 1.0)
    level = rate * (1.0 + 0.35 * rate)
    return _spring({"rate": rate}, lambda u: np.sign(u) * np.expm1(rate * np.minimum(np.abs(u), 3.0)) / level, rig)


@form("nonlinear_stiffness")
def yielding(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Softens with stroke."""
    rate = strength * rng.uniform(0.8, 1.1)
    return _spring({"rate": rate}, lambda u: np.tanh(rate * u) / rate * (1.0 + 0.2 * rate**2), rig)


def _damper(parameters: dict[str, float], exponent: float, share: float, rig: Rig) -> Effect:
    """A further force, `share` of the sliding friction at the rig's slip speed."""
    force = share * rig.mu_k * rig.normal_force

    def alter(machine: Machine, rng: Generator) -> Machine:
        del rng
        damping = slope(machine.damper)
        curve = tabulate(lambda v: damping * v + force * np.sign(v) * np.abs(v / rig.slip_speed) ** exponent, -1.0, 1.0, 40001)
        return machine._replace(damper=curve)

    return Effect(parameters | {"force_at_slip_speed": force, "exponent": exponent}, alter)


@form("quadratic_damping")
def drag(rng: Generator, strength: float, rig: Rig) -> Effect:
    return _damper({}, 2.0, strength * rng.uniform(0.5, 0.65), rig)


@form("quadratic_damping")
def steeper(rng: Generator, strength: float, rig: Rig) -> Effect:
    """An orifice with a little more than the square."""
    return _damper({}, rng.uniform(2.2, 2.6), 0.6 * strength, rig)


_DEEP = 0.32
"""mu_k at which the slip carries the spring through zero, where play lives."""


@form("backlash", mu_k=_DEEP)
def dead_zone(rng: Generator, strength: float, rig: Rig) -> Effect:
    gap = 0.08 * strength * rng.uniform(0.8, 1.2)
    return _spring({"gap": gap}, lambda u: np.sign(u) * np.maximum(np.abs(u) - gap, 0.0), rig)


@form("backlash", mu_k=_DEEP)
def soft_landing(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Play that closes gradually."""
    gap = 0.12 * strength * rng.uniform(0.8, 1.2)
    return _spring({"gap": gap}, lambda u: np.sign(u) * (np.sqrt(u**2 + gap**2) - gap), rig)


@form("backlash", mu_k=_DEEP)
def one_sided(rng: Generator, strength: float, rig: Rig) -> Effect:
    """All the play on one side of zero."""
    gap = 0.14 * strength * rng.uniform(0.8, 1.2)
    return _spring({"gap": gap}, lambda u: np.maximum(u, 0.0) + np.minimum(u + gap, 0.0), rig)


def _second_body(parameters: dict[str, float], change: Callable[[Machine], Machine]) -> Effect:
    def alter(machine: Machine, rng: Generator) -> Machine:
        del rng
        return change(machine)

    return Effect(parameters, alter)


@form("second_mode")
def attached(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A part of the mass hangs on a spring."""
    mass = rig.mass * 0.16 * strength
    omega = 2.0 * np.pi * rng.uniform(6.0, 13.0)
    damping = 2.0 * 0.02 * omega * mass

    def change(machine: Machine) -> Machine:
        return machine._replace(
            mass=machine.mass - mass, second_mass=mass, link_stiffness=mass * omega**2, link_damping=float(damping)
        )

    return _second_body({"mass": mass, "angular_frequency": float(omega)}, change)


@form("second_mode")
def heavy_spring(rng: Generator, strength: float, rig: Rig) -> Effect:
    """The spring has a mass, in its middle."""
    mass = rig.mass * strength * rng.uniform(0.2, 0.35)

    def change(machine: Machine) -> Machine:
        half = 2.0 * slope(machine.spring)
        damping = 0.04 * np.sqrt(2.0 * half * mass)
        return machine._replace(
            spring=line(0.0),
            second_mass=mass,
            link_stiffness=half,
            ground_stiffness=half,
            link_damping=0.0,
            ground_damping=float(damping),
        )

    return _second_body({"mass": mass}, change)
