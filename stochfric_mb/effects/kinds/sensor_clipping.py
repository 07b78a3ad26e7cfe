"""Sensor clipping: a reading that ends at the limits of the range, at once or by and by."""

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import Array, parameter
from stochfric_mb.effects.shapes.course import CourseAlongStroke
from stochfric_mb.effects.traits import CLIPPED, OUTSIDE_FORECASTS
from stochfric_mb.errors import InputError


@dataclasses.dataclass(frozen=True, kw_only=True)
class SensorClipping(CourseAlongStroke):
    """Reading min(max(x + course c((x - begin)/span), low), high).

    c is a sum of cubic B-splines, by which the reading may bend over before it ends, as that of a core that saturates.

    Reference: J. Fraden, Handbook of Modern Sensors, 5th ed., Springer 2016, chapter 3.
    """

    high: float = parameter("m", "upper end of the range", scale=2.0e-3, infinite=True, default=math.inf)
    """Upper end of the range [m]."""
    low: float = parameter("m", "lower end of the range", scale=0.0, infinite=True, default=-math.inf)
    """Lower end of the range [m]."""
    course: float = parameter("m", "size of a course of any shape", scale=1.0e-4, default=0.0, optional=True)
    """Size of a course of any shape [m]."""

    needs_one_of: ClassVar[tuple[str, ...]] = ("high", "low", "course")

    kind: ClassVar[str] = "sensor_clipping"
    equation: ClassVar[str] = "reading min(max(x + course c((x - begin)/span), low), high), c of splines"
    source: ClassVar[str] = "Fraden 2016, chapter 3"
    group: ClassVar[str] = "sensor"
    traits: ClassVar[frozenset[str]] = frozenset({OUTSIDE_FORECASTS})
    signatures: ClassVar[tuple[str, ...]] = (CLIPPED,)
    shows_on: ClassVar[str] = "position, sensor"
    shows: ClassVar[str] = "the position reading ends at a limit of the sensor's range"

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.low < self.high:
            raise InputError(f"sensor_clipping.low = {self.low:g} m is not below high = {self.high:g} m; swap them")

    def appears(self) -> tuple[str, str]:
        """Return the axis and whether the reading ends at once or by and by."""
        return self.shows_on, f"{self.shows}, towards which it bends over" if self.any_shape else self.shows

    def shortest_time(self, speed: float) -> float:
        """Return infinity: a sensor moves nothing."""
        return math.inf

    def measure(self, time: Array, position: Array, rng: np.random.Generator) -> Array:
        """Return what the sensor shows [m]; arguments as in `Effect.measure`."""
        bent = self.course * self.shape((position - self.begin) / self.span) if self.any_shape else 0.0
        return np.clip(position + bent, self.low, self.high)
