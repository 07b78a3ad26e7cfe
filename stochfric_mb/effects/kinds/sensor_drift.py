"""Sensor drift: a reading that runs away from the truth."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import Array, parameter
from stochfric_mb.effects.marks import COURSE_OF_ANY_SHAPE, Hypothesis, Slips
from stochfric_mb.effects.shapes.course import Course
from stochfric_mb.effects.shapes.splines import COARSER, sized, splines
from stochfric_mb.effects.traits import COURSE_OF_RUN, CREEPING_ZERO, DRIFTS, MOVES_ZERO


@dataclasses.dataclass(frozen=True, kw_only=True)
class SensorDrift(Course):
    """Reading x + rate t + change s(t/span), s a sum of cubic B-splines, so that the zero may move along any smooth course.

    Reference: J. Fraden, Handbook of Modern Sensors, 5th ed., Springer 2016, chapter 3.
    """

    rate: float = parameter("m/s", "rate of the drift", scale=1.0e-6, default=0.0, optional=True)
    """Rate of the drift [m/s]."""
    change: float = parameter("m", "size of a course of any shape", scale=1.0e-5, default=0.0, optional=True)
    """Size of a course of any shape [m]."""

    kind: ClassVar[str] = "sensor_drift"
    equation: ClassVar[str] = "reading x + rate t + change s(t/span), s of splines"
    source: ClassVar[str] = "Fraden 2016, chapter 3"
    group: ClassVar[str] = "sensor"
    traits: ClassVar[frozenset[str]] = frozenset({COURSE_OF_RUN, DRIFTS, MOVES_ZERO})
    signatures: ClassVar[tuple[str, ...]] = (CREEPING_ZERO,)
    separated_by: ClassVar[Mapping[str, str]] = {
        "friction_drift": "a force sensor, or a second position sensor",
    }
    shows_on: ClassVar[str] = "time, sensor"
    shows: ClassVar[str] = "the zero of the position sensor drifts"

    def measure(self, time: Array, position: Array, rng: np.random.Generator) -> Array:
        """Return what the sensor shows [m]; arguments as in `Effect.measure`."""
        drifted = position + self.rate * time
        if self.change != 0.0:
            drifted = drifted + self.change * self.shape(time / self.span)
        return drifted

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return k times a drift of the position, the same in stick and slip."""
        last = slips.duration
        side = slips.direction * slips.per_run(lambda s: s.record.mechanism.stiffness)

        def start(b: Array) -> dict[str, float]:
            return {"rate": float(b[0] / last)}

        straight = slips.column(side * slips.onset_time / last, side * slips.mean_time / last)
        return [Hypothesis(cls.kind, [straight], (), start), *(_course(slips, side, pieces) for pieces in COARSER)]


def _course(slips: Slips, side: Array, pieces: int) -> Hypothesis:
    """Return k times a course of any smooth shape, the same in each run since its start."""
    at_onset, inside = (splines(t / slips.duration, pieces) for t in (slips.onset_time, slips.node_time))
    columns = [slips.column(side * at_onset[:, k], side[:, None] * inside[..., k]) for k in range(pieces + 2)]
    return Hypothesis(SensorDrift.kind, columns, (), lambda b: sized(b, pieces, slips.duration), COURSE_OF_ANY_SHAPE)
