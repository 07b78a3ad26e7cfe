"""Sensor drift: a reading that runs away from the truth."""

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import Array, Effect, parameter


@dataclasses.dataclass(frozen=True, kw_only=True)
class SensorDrift(Effect):
    """Reading x + rate t.

    Reference: J. Fraden, Handbook of Modern Sensors, 5th ed., Springer 2016, chapter 3.
    """

    rate: float = parameter("m/s", "rate of the drift", scale=1.0e-6)
    """Rate of the drift [m/s]."""

    kind: ClassVar[str] = "sensor_drift"
    equation: ClassVar[str] = "reading x + rate t"
    source: ClassVar[str] = "Fraden 2016, chapter 3"
    group: ClassVar[str] = "sensor"

    def measure(self, time: Array, position: Array, rng: np.random.Generator) -> Array:
        """Return what the sensor shows [m]; arguments as in `Effect.measure`."""
        return position + self.rate * time
