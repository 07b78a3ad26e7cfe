"""Sensor outliers: single readings that are far off."""

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import Array, Effect, parameter
from stochfric_mb.effects.traits import OUTSIDE_FORECASTS, RANDOM, STRAY


@dataclasses.dataclass(frozen=True, kw_only=True)
class SensorOutliers(Effect):
    """Reading x + size z, z standard normal, in a fraction of the samples, drawn independently; x in the others.

    Reference: J. W. Tukey, A survey of sampling from contaminated distributions, in: Contributions to
    Probability and Statistics, Stanford 1960, 448-485.
    """

    fraction: float = parameter("-", "share of the samples that are off", scale=0.01, low=0.0, high=1.0)
    """Share of the samples that are off [-]."""
    size: float = parameter("m", "standard deviation of their error", scale=2.0e-4, low=0.0)
    """Standard deviation of their error [m]."""

    kind: ClassVar[str] = "sensor_outliers"
    equation: ClassVar[str] = "reading x + size z, z normal, in a `fraction` of the samples"
    source: ClassVar[str] = "Tukey 1960 (contaminated normal)"
    group: ClassVar[str] = "sensor"
    traits: ClassVar[frozenset[str]] = frozenset({OUTSIDE_FORECASTS, RANDOM})
    signatures: ClassVar[tuple[str, ...]] = (STRAY,)
    shows_on: ClassVar[str] = "sensor"
    shows: ClassVar[str] = "single samples are outliers"

    def measure(self, time: Array, position: Array, rng: np.random.Generator) -> Array:
        """Return what the sensor shows [m]; arguments as in `Effect.measure`."""
        hit = rng.random(len(time)) < self.fraction
        return position + np.where(hit, self.size * rng.standard_normal(len(time)), 0.0)
