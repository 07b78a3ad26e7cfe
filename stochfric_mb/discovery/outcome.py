"""What discovery hands on: the result, with what reports and exports need beside it."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from stochfric_mb.discovery.result import Result
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.scenario import Scenario

if TYPE_CHECKING:
    from stochfric_mb.discovery.stick_slip.decision.decision import Decision
    from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import HeldOut
    from stochfric_mb.discovery.stick_slip.simulation.model import Model
    from stochfric_mb.discovery.stick_slip.study import Study


@dataclasses.dataclass(frozen=True)
class Outcome:
    """A result with what a report and an export need beside it."""

    result: Result
    """What is said."""
    scenario: Scenario
    """The augmented scenario: what ``augmented.toml`` holds."""
    dataset: Dataset
    """What was studied."""
    study: Study | None = None
    """What the fit runs showed; None where they had too few slips."""
    decision: Decision | None = None
    """The decision on them."""
    models: tuple[Model, Model, Model] | None = None
    """Stated, recalibrated and augmented model."""
    runs: HeldOut | None = None
    """The held-out runs."""
