"""Sensor drift: a reading that runs away from the truth."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import Array, Effect, parameter
from stochfric_mb.effects.marks import Hypothesis, Slips
from stochfric_mb.effects.traits import COURSE_OF_RUN, CREEPING_ZERO, DRIFTS, MOVES_ZERO


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
    traits: ClassVar[frozenset[str]] = frozenset({COURSE_OF_RUN, DRIFTS, MOVES_ZERO})
    found_as: ClassVar[tuple[str, ...]] = (CREEPING_ZERO,)
    told_from: ClassVar[Mapping[str, str]] = {
        "friction_drift": "a force sensor, or a second position sensor",
    }
    shows_on: ClassVar[str] = "time, sensor"
    shows: ClassVar[str] = "the position drifts, in stick and slip alike"

    def measure(self, time: Array, position: Array, rng: np.random.Generator) -> Array:
        """Return what the sensor shows [m]; arguments as in `Effect.measure`."""
        return position + self.rate * time

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return k times a drift of the position, the same in stick and slip."""
        last = slips.duration
        side = slips.direction * slips.per_run(lambda s: s.record.mechanism.stiffness)

        def start(b: Array) -> dict[str, float]:
            return {"rate": float(b[0] / last)}

        shapes: list[Callable[[Array], Array]] = [lambda t: t / last, lambda t: np.sqrt(np.maximum(t, 0.0) / last)]
        return [
            Hypothesis(
                cls.kind,
                [slips.column(side * s(slips.onset_time), side * s(slips.mean_time))],
                (),
                start,
            )
            for s in shapes
        ]
