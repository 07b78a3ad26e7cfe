"""Sensor delay: a reading of the past."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

import numpy as np

from stochfric_mb.effects.contract import Array, Effect, parameter
from stochfric_mb.effects.marks import Hypothesis, Slips
from stochfric_mb.effects.traits import LATE, POSITIVE, SHAPED_IF_FORCED

PHASES = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2)
"""Angles by which the known force may have moved on [rad]; 0: by so little that its rate tells."""


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
    traits: ClassVar[frozenset[str]] = frozenset({SHAPED_IF_FORCED, POSITIVE})
    signatures: ClassVar[tuple[str, ...]] = (LATE,)
    answers_to: ClassVar[str] = "known force"
    shows_on: ClassVar[str] = "time, sensor"
    shows: ClassVar[str] = "the position comes late in the record"

    def measure(self, time: Array, position: Array, rng: np.random.Generator) -> Array:
        """Return what the sensor shows [m]; arguments as in `Effect.measure`."""
        return np.interp(time - self.delay, time, position)

    @property
    def late(self) -> float:
        """The delay [s]."""
        return self.delay

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return what the known force, if any, has moved on by, over the delay: a late record is compared with it."""
        if not any(s.record.mechanism.excitation_amplitude for s in slips.slips):
            return []
        items: list[Hypothesis] = []
        for phase in PHASES:
            onset, nodes = np.zeros(len(slips.run)), np.zeros_like(slips.node_time)
            for run, one in enumerate(slips.slips):
                mine = slips.run == run
                for values, time in ((onset, slips.onset_time), (nodes, slips.node_time)):
                    values[mine] = _moved_on(one.record.mechanism, time[mine], phase)
            items.append(Hypothesis(cls.kind, [slips.column(onset, nodes)], (phase,), lambda b: {"delay": float(b[0])}))
        return items


def _moved_on(box: Any, time: Array, phase: float) -> Array:
    """Return k u_0 (cos(W t - phase) - cos W t) over the delay phase/W [N/s]."""
    force, w = box.stiffness * box.excitation_amplitude, box.excitation_angular_frequency
    if phase == 0.0:
        return force * w * np.sin(w * time)
    return force * w / phase * (np.cos(w * time - phase) - np.cos(w * time))
