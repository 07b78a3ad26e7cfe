"""Sensor delay: a reading of the past."""

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import Array, Effect, parameter


@dataclasses.dataclass(frozen=True, kw_only=True)
class SensorDelay(Effect):
    """Reading x(t - delay), linear between samples; before the record begins, its first value.

    Reference: J. Fraden, Handbook of Modern Sensors, 5th ed., Springer 2016, chapter 3.
    """

    delay: float = parameter("s", "delay", scale=5.0e-3, low=0.0)
    """Delay [s]."""

    kind: ClassVar[str] = "sensor_delay"
    equation: ClassVar[str] = "reading x(t - delay)"
    source: ClassVar[str] = "Fraden 2016, chapter 3"
    group: ClassVar[str] = "sensor"

    def measure(self, time: Array, position: Array, rng: np.random.Generator) -> Array:
        """Return what the sensor shows [m]; arguments as in `Effect.measure`."""
        return np.interp(time - self.delay, time, position)
