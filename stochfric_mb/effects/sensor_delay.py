"""Sensor delay: a reading of the past."""

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import Array, Effect, parameter
from stochfric_mb.effects.marks import Hypothesis, Slips


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
    shows_on: ClassVar[str] = "time, sensor"
    shows: ClassVar[str] = "the record lags behind the known excitation"

    def measure(self, time: Array, position: Array, rng: np.random.Generator) -> Array:
        """Return what the sensor shows [m]; arguments as in `Effect.measure`."""
        return np.interp(time - self.delay, time, position)

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return minus the rate of the known force, if any: a late record compares with a force that has moved on."""
        if not any(s.record.mechanism.excitation_amplitude for s in slips.slips):
            return []
        onset = np.zeros(len(slips.run))
        nodes = np.zeros_like(slips.node_time)
        for run, one in enumerate(slips.slips):
            mine = slips.run == run
            box = one.record.mechanism
            w = box.excitation_angular_frequency
            scale = box.stiffness * box.excitation_amplitude * w
            onset[mine] = scale * np.sin(w * slips.onset_time[mine])
            nodes[mine] = scale * np.sin(w * slips.node_time[mine])
        return [Hypothesis(cls.kind, [slips.column(onset, nodes)], (), lambda b: {"delay": float(b[0])})]
