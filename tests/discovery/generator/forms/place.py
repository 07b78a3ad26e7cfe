"""Friction varies with the place on the belt, the stroke, or time."""

import numpy as np

from tests.discovery.generator.curve import Curve, tabulate_period
from tests.discovery.generator.machine import Machine
from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, form


def _along_belt(parameters: dict[str, float], length: float, shape) -> Effect:
    """Factor 1 + shape(place/length), periodic along the belt; each run begins elsewhere on the belt."""
    curve = tabulate_period(lambda s: 1.0 + shape(s / length), length)

    def alter(machine: Machine, rng: Generator) -> Machine:
        return machine._replace(belt_surface=Curve(-length * rng.random(), curve.spacing, True, curve.values))

    return Effect(parameters | {"length": length}, alter)


@form("position_dependent_friction")
def sinusoidal(rng: Generator, strength: float, rig: Rig) -> Effect:
    amplitude = 0.07 * strength
    return _along_belt(
        {"amplitude": amplitude}, rig.slip_length * rng.uniform(3.5, 12.0), lambda r: amplitude * np.sin(2.0 * np.pi * r)
    )


@form("position_dependent_friction")
def square(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Two strips of belt with different friction, their borders 4 % of the length wide."""
    amplitude = 0.06 * strength
    return _along_belt(
        {"amplitude": amplitude},
        rig.slip_length * rng.uniform(5.0, 14.0),
        lambda r: amplitude * np.tanh(np.sin(2.0 * np.pi * r) / 0.12),
    )


@form("position_dependent_friction")
def seam(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A bump where the belt is joined."""
    height, width = 0.16 * strength, rng.uniform(0.06, 0.12)
    return _along_belt(
        {"height": height, "width": width},
        rig.slip_length * rng.uniform(6.0, 12.0),
        lambda r: height * np.exp(-0.5 * ((r - 0.5) / width) ** 2),
    )
