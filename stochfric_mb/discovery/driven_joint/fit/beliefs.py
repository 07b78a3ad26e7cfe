"""What is believed of numbers of law and mechanism: how far a model has moved them, and what it is with a belief given up."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.force_balance import Nuisance
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.inference.free_parameter import LAW, MECHANISM

WIDE = 1.0e3
"""Factor on the standard deviation of a number whose belief is given up [-]: the data alone say what it is."""


@dataclasses.dataclass(frozen=True)
class Belief:
    """A number of law or mechanism as stated, and how firmly it is believed."""

    owner: int
    """`LAW` or `MECHANISM`."""
    name: str
    """Its name there."""
    value: float
    """What is stated."""
    deviation: float
    """Standard deviation of that, > 0 and finite."""
    stated: bool = True
    """Whether that is stated."""

    def in_model(self, model: JointModel) -> float:
        """Return the number as it is in a model, which has those that may be off; others are as stated."""
        return float(model.nuisances.get(self.name, self.value) if self.owner == MECHANISM else getattr(model.law, self.name))

    def off(self, model: JointModel) -> float:
        """Return by how many standard deviations it is off in a model [-]."""
        return (self.in_model(model) - self.value) / self.deviation

    def added_to(self, model: JointModel, nuisances: Sequence[Nuisance]) -> tuple[JointModel, list[Nuisance]]:
        """Return a model and the numbers of its mechanism with this one, which had no uncertainty."""
        numbers = {**model.nuisances, self.name: self.value}
        added = Nuisance(self.name, self.value, self.deviation, "-", 0.0)
        return dataclasses.replace(model, nuisances=numbers), [*nuisances, added]

    def given_up(self, model: JointModel, nuisances: Sequence[Nuisance]) -> tuple[JointModel, list[Nuisance]]:
        """Return a model and the numbers of its mechanism without this belief."""
        # a factor that nobody stated may be a gear that was left out
        return self._as_firm(model, nuisances, WIDE * (self.deviation if self.stated else abs(self.value)))

    def held(self, model: JointModel, nuisances: Sequence[Nuisance]) -> tuple[JointModel, list[Nuisance]]:
        """Return a model and the numbers of its mechanism with this belief, which had been given up."""
        return self._as_firm(model, nuisances, self.deviation)

    def _as_firm(self, model: JointModel, nuisances: Sequence[Nuisance], deviation: float) -> tuple[JointModel, list[Nuisance]]:
        if self.owner == LAW:
            return dataclasses.replace(model, level=(self.value, deviation)), list(nuisances)
        return model, [dataclasses.replace(n, deviation=deviation) if n.name == self.name else n for n in nuisances]


def beliefs(model: JointModel, nuisances: Sequence[Nuisance]) -> list[Belief]:
    """Return what is believed: mu_k, where its uncertainty is stated, and the numbers of the mechanism."""
    every = [Belief(LAW, "mu_k", *model.level), *(Belief(MECHANISM, n.name, n.value, n.deviation) for n in nuisances)]
    return [b for b in every if np.isfinite(b.deviation)]


def at_end(model: JointModel, believed: Sequence[Belief]) -> Belief | None:
    """Return a belief whose number a model needs as far off as beliefs give way; None: there is none."""
    return next((b for b in believed if abs(b.off(model)) > criteria.AT_BOUND * criteria.MOST_OFF), None)
