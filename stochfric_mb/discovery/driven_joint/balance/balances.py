"""Where force balances come from: the base of what makes them, of a slide or hinge or of a user's own model."""

from __future__ import annotations

import abc
import dataclasses
from collections.abc import Mapping

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run

BESIDE = ("sensor", "randomness")
"""Groups of effects that are no part of the mean friction."""


@dataclasses.dataclass(frozen=True)
class Balances(abc.ABC):
    """The balances of a dataset, made when asked for: of its places, by role and delay."""

    dataset: Dataset
    """The dataset."""

    @property
    def stated_delay(self) -> float:
        """By how much the scenario says that positions are late [s]."""
        return sum(e.late for e in self.dataset.scenario.effects)

    @property
    @abc.abstractmethod
    def places(self) -> Mapping[str, float]:
        """Places in which friction is sought -> their stated loads [N or N m]; a single one needs no name."""

    @abc.abstractmethod
    def nuisances(self, place: str) -> list[Nuisance]:
        """Return what data may correct, with its priors."""

    def presses(self, place: str) -> bool:
        """Return whether the normal force of a place is known along the motion: of a pair of geoms, or measured at a slide."""
        return place in getattr(self.dataset.scenario.mechanism, "pairs", ())

    def stated(self, place: str) -> JointModel:
        """Return the model as stated at a place."""
        scenario = self.dataset.scenario
        acts_in = getattr(scenario.mechanism, "effects_in", ())
        own = () if acts_in and place not in acts_in else tuple(e for e in scenario.effects if e.group not in BESIDE)
        mu_k, spread = scenario.law.mu_k, scenario.uncertainty.get("mu_k", 0.0)
        return JointModel(
            scenario.law,
            own,
            {n.name: n.value for n in self.nuisances(place)},
            self.places[place],
            contact=self.presses(place),
            level=(mu_k, spread * mu_k if spread > 0.0 else float("inf")),
        )

    @abc.abstractmethod
    def rotates(self, place: str) -> bool:
        """Return whether friction in a place acts about an axis."""

    @abc.abstractmethod
    def balance(self, run: Run, place: str, delay: float, samples: int | None) -> ForceBalance:
        """Return a run as a balance of a place; arguments as of `balances`."""

    def balances(self, place: str, role: str, delay: float, samples: int | None = None) -> list[ForceBalance]:
        """Return the runs of a role as balances of a place.

        Args:
            place: its name.
            role: ``fit`` or ``test``.
            delay: by how much the position comes after the driving force in the record [s]; compensated here.
            samples: half width of the window [samples]; None: chosen from the noise.

        Raises:
            InputError: a channel is missing, or a run is too short.
        """
        runs = self.dataset.fit if role == "fit" else self.dataset.test
        return [self.balance(run, place, delay, samples) for run in runs]

    def coupled(self, place: str) -> bool:
        """Return whether friction elsewhere enters the balance of a place."""
        return False
