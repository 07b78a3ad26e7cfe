"""Stale samples: readings that are repeated while the body moves on."""

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import Array, Effect, parameter
from stochfric_mb.effects.traits import OUTSIDE_FORECASTS, RANDOM, REPEATED_READING


@dataclasses.dataclass(frozen=True, kw_only=True)
class StaleSamples(Effect):
    """Reading x(t_i) from t_i to t_i + duration, the moments t_i a Poisson process of a rate; x(t) otherwise.

    Reference: J. Nilsson, B. Bernhardsson, B. Wittenmark, Automatica 34, 1998, 57-64, doi 10.1016/S0005-1098(97)00170-2
    (samples lost on a bus).
    """

    rate: float = parameter("1/s", "how often readings stop", scale=3.0, low=0.0)
    """How often readings stop [1/s]."""
    duration: float = parameter("s", "how long they stop", scale=0.01, low=0.0)
    """How long they stop [s]."""

    kind: ClassVar[str] = "stale_samples"
    equation: ClassVar[str] = "reading x(t_i) from t_i to t_i + duration, at a mean `rate`"
    source: ClassVar[str] = "Nilsson, Bernhardsson and Wittenmark 1998"
    group: ClassVar[str] = "sensor"
    traits: ClassVar[frozenset[str]] = frozenset({OUTSIDE_FORECASTS, RANDOM})
    signatures: ClassVar[tuple[str, ...]] = (REPEATED_READING,)
    shows_on: ClassVar[str] = "sensor"
    shows: ClassVar[str] = "readings are repeated while the body moves on"

    def measure(self, time: Array, position: Array, rng: np.random.Generator) -> Array:
        """Return what the sensor shows [m]; arguments as in `Effect.measure`."""
        span = float(time[-1] - time[0]) if len(time) else 0.0
        begins = np.sort(time[0] + span * rng.random(rng.poisson(self.rate * span)))
        last = np.arange(len(time))
        for begin in begins:
            first, end = np.searchsorted(time, (begin, begin + self.duration))
            last[first:end] = np.minimum(last[first:end], min(first, len(time) - 1))
        return position[last]
