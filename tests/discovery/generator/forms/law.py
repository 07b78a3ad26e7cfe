"""The friction law differs: speed, dwell, memory, direction, load, compliance."""

import numpy as np

from tests.discovery.generator.curve import tabulate
from tests.discovery.generator.machine import Machine
from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, form

_FASTEST = 1.0  # m/s, far above any slip of the rig


def _weakening(name: str, excess: float, scale: float, shape) -> Effect:
    """mu_k (1 + excess shape(v/scale) - mean), with shape(0) = 1: the level at the scale speed stays where it is believed."""
    level = 1.0 + excess * float(shape(np.array(1.0)))
    curve = tabulate(lambda v: (1.0 + excess * shape(np.maximum(v, 0.0) / scale)) / level, 0.0, _FASTEST, 20001)

    def alter(machine: Machine, rng: Generator) -> Machine:
        del rng
        return machine._replace(sliding=curve)

    return Effect({name: excess, "speed_scale": scale}, alter)


@form("velocity_weakening")
def exponential(rng: Generator, strength: float, rig: Rig) -> Effect:
    return _weakening("excess", 0.5 * strength, rig.slip_speed * rng.uniform(0.2, 0.5), lambda r: np.exp(-r))


@form("velocity_weakening")
def rational(rng: Generator, strength: float, rig: Rig) -> Effect:
    return _weakening("excess", 0.6 * strength, rig.slip_speed * rng.uniform(0.15, 0.4), lambda r: 1.0 / (1.0 + r))


@form("velocity_weakening")
def power(rng: Generator, strength: float, rig: Rig) -> Effect:
    exponent = rng.uniform(0.4, 0.8)
    return _weakening("excess", 0.6 * strength, rig.slip_speed * rng.uniform(0.1, 0.3), lambda r: (1.0 + r) ** -exponent)


@form("velocity_weakening")
def logarithmic(rng: Generator, strength: float, rig: Rig) -> Effect:
    return _weakening("excess", 0.4 * strength, rig.slip_speed * rng.uniform(0.15, 0.3), lambda r: 1.0 - 0.35 * np.log1p(r))
