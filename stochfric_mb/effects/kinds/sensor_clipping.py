"""Sensor clipping: a reading that ends at the limits of the range."""

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import Array, Effect, parameter
from stochfric_mb.effects.traits import CLIPPED, OUTSIDE_FORECASTS
from stochfric_mb.errors import InputError


@dataclasses.dataclass(frozen=True, kw_only=True)
class SensorClipping(Effect):
    """Reading min(max(x, low), high).

    Reference: J. Fraden, Handbook of Modern Sensors, 5th ed., Springer 2016, chapter 3.
    """

    high: float = parameter("m", "upper end of the range", scale=2.0e-3, infinite=True)
    """Upper end of the range [m]."""
    low: float = parameter("m", "lower end of the range", scale=0.0, infinite=True, default=-math.inf)
    """Lower end of the range [m]."""

    kind: ClassVar[str] = "sensor_clipping"
    equation: ClassVar[str] = "reading min(max(x, low), high)"
    source: ClassVar[str] = "Fraden 2016, chapter 3"
    group: ClassVar[str] = "sensor"
    traits: ClassVar[frozenset[str]] = frozenset({OUTSIDE_FORECASTS})
    signatures: ClassVar[tuple[str, ...]] = (CLIPPED,)
    shows_on: ClassVar[str] = "position, sensor"
    shows: ClassVar[str] = "the position reading is clipped at one value"

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.low < self.high:
            raise InputError(f"sensor_clipping.low = {self.low:g} m is not below high = {self.high:g} m; swap them")

    def measure(self, time: Array, position: Array, rng: np.random.Generator) -> Array:
        """Return what the sensor shows [m]; arguments as in `Effect.measure`."""
        return np.clip(position, self.low, self.high)
