"""Sensor step: a reading that jumps once."""

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import Array, Effect, parameter
from stochfric_mb.effects.traits import JUMP, MOVES_ZERO, WANDERS_ALIKE


@dataclasses.dataclass(frozen=True, kw_only=True)
class SensorStep(Effect):
    """Reading x before time, x + size from then on.

    Reference: J. Fraden, Handbook of Modern Sensors, 5th ed., Springer 2016, chapter 3.
    """

    size: float = parameter("m", "size of the step", scale=5.0e-5)
    """Size of the step [m]."""
    time: float = parameter("s", "time of the step", scale=10.0)
    """Time of the step [s]."""

    kind: ClassVar[str] = "sensor_step"
    equation: ClassVar[str] = "reading x + size from `time` on"
    source: ClassVar[str] = "Fraden 2016, chapter 3"
    group: ClassVar[str] = "sensor"
    traits: ClassVar[frozenset[str]] = frozenset({WANDERS_ALIKE, MOVES_ZERO})
    signatures: ClassVar[tuple[str, ...]] = (JUMP,)
    shows_on: ClassVar[str] = "time, sensor"
    shows: ClassVar[str] = "the position reading jumps once and stays off"

    def measure(self, time: Array, position: Array, rng: np.random.Generator) -> Array:
        """Return what the sensor shows [m]; arguments as in `Effect.measure`."""
        return position + np.where(time >= self.time, self.size, 0.0)
