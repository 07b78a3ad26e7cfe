"""What discovery at joints hands on to reports and exports, beside the result itself."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.balance.timing import Timing
from stochfric_mb.discovery.driven_joint.decision.selection import Selected, Stage
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.scatter.run_scatter import RunScatter
from stochfric_mb.discovery.driven_joint.scatter.stroke_scatter import StrokeScatter
from stochfric_mb.discovery.driven_joint.simulation.pictures import Picture
from stochfric_mb.discovery.driven_joint.simulation.scores import FLOOR, Score, noise_floor
from stochfric_mb.discovery.outcome import Outcome
from stochfric_mb.discovery.result import Gap


@dataclasses.dataclass(frozen=True)
class PlaceOutcome:
    """The outcome at one joint."""

    place: str
    """Name of the joint; empty where there is one only."""
    selected: Selected
    """The selection, step by step."""
    nuisances: tuple[Nuisance, ...]
    """Numbers of the mechanism that were corrected."""
    stated: JointModel
    """The model as stated."""
    fit: tuple[ForceBalance, ...]
    """Fit runs."""
    test: tuple[ForceBalance, ...]
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
    forecasts: Gap | None = None
    """CRPS of forecasts that allow for that scatter; None where there is none."""
    undelayed: JointModel | None = None
    """The recalibrated model without the identified delay; None: there is none."""
    idle: str = ""
    """Why the selected effects are not named; empty: they are."""
    curve: tuple[str, ...] = ()
    """Effects that draw one curve along conditions that went together, and are not named for that."""
    unnamed: float | None = None
    """Evidence for a term without a name that carries over to held-out runs; it is the last effect of the final model."""
    timing: Timing | None = None
    """Delay between drive and motion; None where none could be looked for, or none shows."""
    mended: bool = False
    """Whether wrong readings were replaced by curves: of the noise of those the record then says nothing."""
    beside: tuple[Stage, ...] = ()
    """Steps of answers that were given up for this one, or that did not better it."""
    again: Callable[[frozenset[str]], PlaceOutcome] | None = dataclasses.field(default=None, compare=False, repr=False)
    """The answer without further kinds of effects and numbers of the mechanism."""

    @property
    def searched(self) -> tuple[Stage, ...]:
        """All steps of the search at this place."""
        return (*self.selected.stages, *self.beside)

    @property
    def drawn(self) -> bool:
        """Whether friction that is drawn anew, for each stroke or run, accounts for what scatters."""
        return any(seen is not None and seen.accounted for seen in (self.random, self.runs))

    @functools.cached_property
    def noise(self) -> float:
        """Noise of the balance on the fit runs, by what the final model leaves [N or N m]."""
        return noise_floor(self.selected.final.model, self.fit, self.nuisances)

    @property
    def leaves_noise(self) -> bool:
        """Whether the final model leaves no more than that of the fit runs."""
        return self.selected.final.rms < FLOOR * self.noise

    @property
    def late(self) -> float:
        """By how much positions come after the driving force, beyond the stated delay [s]."""
        return self.timing.seconds if self.timing is not None and self.timing.named else 0.0


@dataclasses.dataclass(frozen=True)
class JointOutcome(Outcome):
    """Everything about one dataset; `Outcome` has the result, the augmented scenario and the dataset."""

    places: tuple[PlaceOutcome, ...] = ()
    """The joints, those with effects first."""
    pictures: tuple[Picture, ...] = ()
    """Pictures for the report."""
