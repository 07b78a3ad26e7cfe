"""What discovery at joints hands on to reports and exports, beside the result itself."""

from __future__ import annotations

import dataclasses

from stochfric_mb.discovery.joints.model import JointModel
from stochfric_mb.discovery.joints.pictures import Picture
from stochfric_mb.discovery.joints.randomness import StrokeScatter
from stochfric_mb.discovery.joints.run_scatter import Forecasts, RunScatter
from stochfric_mb.discovery.joints.scores import Score
from stochfric_mb.discovery.joints.selection import Selected
from stochfric_mb.discovery.joints.sheet import Nuisance, Sheet
from stochfric_mb.discovery.joints.timing import Timing
from stochfric_mb.discovery.workflow import Outcome


@dataclasses.dataclass(frozen=True)
class PlaceOutcome:
    """What was found at one joint."""

    place: str
    """Name of the joint; empty where there is one only."""
    selected: Selected
    """The selection, step by step."""
    nuisances: tuple[Nuisance, ...]
    """Numbers of the mechanism that were corrected."""
    believed: JointModel
    """The model as believed."""
    fit: tuple[Sheet, ...]
    """Runs that were learned from."""
    test: tuple[Sheet, ...]
    """Runs that were held out."""
    scores: dict[str, Score]
    """``baseline``, ``recalibrated``, ``augmented``, and ``with KIND`` after each effect -> errors on the held-out runs."""
    floor: float
    """Noise of the balance on the held-out runs [N or N m]."""
    thing: str = "joint"
    """What the place is: a joint, or a tendon."""
    random: StrokeScatter | None = None
    """Scatter of friction from stroke to stroke; None: too few strokes."""
    runs: RunScatter | None = None
    """Scatter of friction from run to run; None: too few runs."""
    forecasts: Forecasts | None = None
    """Errors of forecasts that allow for that scatter; None where there is none."""
    undelayed: JointModel | None = None
    """The recalibrated model without the delay that was found; None: none was."""


@dataclasses.dataclass(frozen=True)
class JointOutcome(Outcome):
    """Everything about one dataset; `Outcome` has the result, the augmented scenario and the dataset."""

    places: tuple[PlaceOutcome, ...] = ()
    """The joints, those with effects first."""
    timing: Timing | None = None
    """Delay between drive and motion; None where none could be looked for."""
    pictures: tuple[Picture, ...] = ()
    """Pictures for the report."""
