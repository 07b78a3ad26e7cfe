"""Whether held-out runs bear out what the fit runs suggest: an effect that worsens their forecasts is not kept."""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.paired import paired
from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import HeldOut, floor_of, scores
from stochfric_mb.discovery.stick_slip.simulation.model import Model


@dataclasses.dataclass(frozen=True)
class Comparison:
    """Forecasts of the same held-out windows by two models."""

    without: float
    """Mean error of the model without the effect [m]."""
    with_: float
    """Mean error of the model with it [m]."""
    deviation: float
    """Standard error of the difference [m]."""

    floor: float
    """What the model with it would leave of records that it had made itself [m]."""
    most_better: bool = False
    """Whether far more forecasts are better with it than worse."""

    @property
    def worse(self) -> bool:
        """Whether the effect makes the forecasts worse: far off, by more than chance, or where much could be gained.

        Where most are better, the mean may be far off for a slip that is missed: a forecast of a box on the verge of slipping
        says nothing of an effect.
        """
        if self.with_ <= self.without:
            return False
        chance = criteria.HELD_OUT_DOUBT * self.deviation
        to_gain = self.without - self.floor > criteria.LEAST_REDUCIBLE * self.without
        far_off = self.with_ > criteria.HELD_OUT_FAR_OFF * self.without and not self.most_better
        return far_off or self.with_ - self.without > chance or to_gain

    @property
    def better(self) -> bool:
        """Whether the effect makes the forecasts better, by more than chance."""
        return self.without - self.with_ > criteria.HELD_OUT_DOUBT * self.deviation

    @property
    def idle(self) -> bool:
        """Whether it takes away next to nothing of what they are off, however surely."""
        return self.without - self.with_ <= criteria.CLOSES_NOTHING * self.without


def compared(without: Model, with_: Model, runs: HeldOut) -> Comparison | None:
    """Return how two models, phases estimated already, forecast held-out runs; None where there are too few forecasts."""
    first, second = scores(without, runs), scores(with_, runs)
    if len(first) < 3:  # no standard error
        return None
    seen = paired(first, second)
    most_better = seen.better - seen.worse > criteria.HELD_OUT_MOST * np.sqrt(seen.better + seen.worse)
    return Comparison(seen.without, seen.with_, seen.deviation, floor_of(with_, runs), bool(most_better))
