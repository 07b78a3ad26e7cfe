"""Friction varies with the place on the belt, with the stroke, or with time."""

from collections.abc import Callable

import numpy as np

from tests.discovery.generator.curve import Array, Curve, tabulate, tabulate_period
from tests.discovery.generator.machine import KINETIC, STATIC, Machine
from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, either_sign, form


def _along_belt(parameters: dict[str, float], length: float, shape: Callable[[Array], Array]) -> Effect:
    """Factor 1 + shape(place/length), periodic along the belt; each run begins elsewhere on the belt."""
    curve = tabulate_period(lambda s: 1.0 + shape(s / length), length)

    def alter(machine: Machine, rng: Generator) -> Machine:
        return machine._replace(belt_surface=Curve(-length * rng.random(), curve.spacing, True, curve.values))

    return Effect(parameters | {"length": length}, alter)


@form("position_dependent_friction")
def sinusoidal(rng: Generator, strength: float, rig: Rig) -> Effect:
    amplitude, length = 0.07 * strength, rig.slip_length * rng.uniform(3.5, 12.0)
    return _along_belt({"amplitude": amplitude}, length, lambda r: amplitude * np.sin(2.0 * np.pi * r))


@form("position_dependent_friction")
def square(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Two strips of belt with different friction; the borders take 4 % of the length."""
    amplitude, length = 0.06 * strength, rig.slip_length * rng.uniform(5.0, 14.0)
    return _along_belt({"amplitude": amplitude}, length, lambda r: amplitude * np.tanh(np.sin(2.0 * np.pi * r) / 0.12))


@form("position_dependent_friction")
def seam(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A bump where the belt is joined."""
    height, width, length = 0.16 * strength, rng.uniform(0.06, 0.12), rig.slip_length * rng.uniform(6.0, 12.0)
    return _along_belt({"height": height, "width": width}, length, lambda r: height * np.exp(-0.5 * ((r - 0.5) / width) ** 2))


@form("position_dependent_friction", also=("nonlinear_stiffness",))
def worn_stroke(rng: Generator, strength: float, rig: Rig) -> Effect:
    """The middle of the stroke is polished."""
    depth = 0.25 * strength
    centre, width = rig.break_away * rng.uniform(0.5, 0.65), rig.slip_length * rng.uniform(0.1, 0.16)
    curve = tabulate(lambda x: 1.0 - depth * np.exp(-0.5 * ((np.abs(x) - centre) / width) ** 2), -0.01, 0.01)

    def alter(machine: Machine, rng: Generator) -> Machine:
        del rng
        return machine._replace(stroke=curve)

    return Effect({"depth": depth, "centre": centre, "width": width}, alter)


def _over_time(parameters: dict[str, float], factor: Callable[[Array], Array]) -> Effect:
    """Both coefficients times a factor over record time; before the record it stays at its first value."""

    def alter(machine: Machine, rng: Generator) -> Machine:
        del rng
        by_time = factor(np.maximum(machine.time, 0.0))
        return machine.scaled(STATIC, by_time).scaled(KINETIC, by_time)

    return Effect(parameters, alter)


@form("friction_drift")
def linear(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    rate = 0.12 / 60.0 * strength * either_sign(rng)
    return _over_time({"rate": rate}, lambda t: 1.0 + rate * t)


@form("friction_drift")
def warming(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Towards a steady temperature."""
    del rig
    share, time = 0.12 * strength * either_sign(rng), rng.uniform(8.0, 20.0)
    return _over_time({"share": share, "time": time}, lambda t: 1.0 - share * np.expm1(-t / time))


@form("friction_drift")
def running_in(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Towards a run-in surface, hyperbolically."""
    del rig
    share, time = -0.16 * strength, rng.uniform(10.0, 25.0)
    return _over_time({"share": share, "time": time}, lambda t: 1.0 + share * t / (t + time))
