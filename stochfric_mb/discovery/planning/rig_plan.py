"""What planned runs of any rig have in common: a run as it would be measured, and what a plan knows of its rig."""

from __future__ import annotations

import abc
import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

from stochfric_mb.discovery.driven_joint.decision.estimates import unit_at
from stochfric_mb.discovery.planning.planned_run import PlannedRun
from stochfric_mb.discovery.planning.signature import Signature, separation
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run
from stochfric_mb.scenario import Scenario

Further = tuple[str, Mapping[str, Any]]
"""A further run in words, and what of it differs from the first planned one."""


@dataclasses.dataclass(frozen=True)
class Part:
    """One planned run."""

    run: PlannedRun
    """The run, its noise stated."""
    measured: Run
    """What would be measured with the stated model."""


@dataclasses.dataclass(frozen=True)
class RigPlan(abc.ABC):
    """Planned runs of a rig."""

    scenario: Scenario[Any]
    """The stated model."""

    shown: ClassVar[tuple[str, ...]] = ()
    """Numbers of a planned run that are said beside those of any rig."""

    def facts(self, part: Any) -> dict[str, Any]:
        """Return what there is to say of a planned run."""
        run = part.run
        about = {"name": run.name, "seconds": run.duration, "sample_rate": run.sample_rate, "noise": run.noise}
        return about | {key: getattr(run, key) for key in self.shown} | {"set": dict(run.settings)}

    @property
    def rotational(self) -> bool:
        """Whether friction acts about an axis."""
        return False

    @property
    def notes(self) -> Sequence[str]:
        """What a reader should know of this mechanism."""
        return ()

    @property
    def no_limit(self) -> tuple[str, ...]:
        """The effects that discovery looks for here; those without a signature have no limit."""
        return ()

    def records(self, *runs: Run) -> Dataset:
        """Return runs as a dataset."""
        return Dataset(title="", scenario_path=None, scenario=self.scenario, runs=runs)

    @abc.abstractmethod
    def part(self, run: PlannedRun, seed: int) -> Any:
        """Return a planned run, simulated.

        Raises:
            InputError: discovery would refuse it; says what would do.
        """

    @abc.abstractmethod
    def signatures(self, parts: Sequence[Any]) -> tuple[Sequence[Signature], Mapping[str, str]]:
        """Return what effects would leave in some runs, and effect -> what would show it, for those that leave nothing."""

    @abc.abstractmethod
    def further(self, first: PlannedRun) -> list[Further]:
        """Return runs that may be added, beside the first planned one again."""

    def extra_runs(self, first: PlannedRun) -> list[tuple[str, PlannedRun]]:
        """Return runs that may be added, each with its words."""
        again: Further = f"another {first.duration:g} s as in {first.name}", {}
        return [
            (text, dataclasses.replace(first, name="extra run", **change)) for text, change in (again, *self.further(first))
        ]

    def apart(self, true: Any, other: Sequence[Any]) -> float:
        """Return the size over its limit from which on an effect is distinguished from another one; inf: at no size."""
        return separation(true, other)

    def unit(self, straight: str) -> str:
        """Return the unit of a parameter at this rig, its unit along a line given."""
        return unit_at(straight, "N m" if self.rotational else "N")
