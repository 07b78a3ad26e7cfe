"""Friction that is drawn anew for each run: the scatter of runs beyond what the strokes within them explain.

Each run has its own mu_k, from what the model leaves of it: the mean of both directions, so that a zero of the drive cancels;
a run may be a single slide one way. What is left within strokes, and how strokes differ, give it a variance (`between_groups`).

No model foretells such a run: where a condition of the runs does, their speed for instance, it is no chance. Held-out runs are
therefore scored by the CRPS of a forecast that knows how far runs scatter.

Reference: T. Gneiting, A. E. Raftery, J. Am. Stat. Assoc. 102, 2007, 359-378, doi 10.1198/016214506000001437, eq. 21 (CRPS of a
normal distribution).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy.stats import pearsonr

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.scatter.between_groups import CoefficientScatter, estimated
from stochfric_mb.discovery.driven_joint.scatter.stroke_coefficients import Stroke, dependence, strokes_of, variances
from stochfric_mb.statistics import crps_normal

Array = npt.NDArray[np.float64]

FEWEST = 5
"""Fewest runs from which a scatter between them is asked for: of fewer, any scatter fits."""
RUN_BY_RUN = ("time", "distance")
"""Clocks that begin with a run."""
SIZES = np.logspace(-2.0, 4.0, 300)
"""Scatter that is tried, over the median deviation of a run [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class RunScatter(CoefficientScatter):
    """How mu_k differs from run to run; ``gain`` is the part of the error of a run's mean."""

    runs: int
    """Number of runs."""
    told_by: str = ""
    """The condition of the runs that says more of their friction than it leaves; empty: none does."""

    @property
    def named(self) -> bool:
        """Whether it is a finding."""
        return super().named and not self.told_by

    @property
    def foretold(self) -> bool:
        """Whether runs differ as a condition of theirs does, and that has no name."""
        return super().named and bool(self.told_by)

    @property
    def foreseen(self) -> float:
        """Return the standard deviation of a further run's mu_k: its own scatter, and that of the mean [-]."""
        return max(self.sigma, self.believed) * float(np.sqrt(1.0 + 1.0 / self.runs))


def run_scatter(
    model: JointModel, balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance], believed: float = 0.0
) -> RunScatter | None:
    """Return the scatter of mu_k over runs; None if these are too few.

    Args:
        model: what is known of the friction.
        balances: fit runs.
        nuisances: numbers of the mechanism.
        believed: stated standard deviation of mu_k from run to run [-].
    """
    along = [dependence(model, s) for s in balances]
    seen = [strokes_of(model.remainder(s, nuisances), f, s, 1) for s, f in zip(balances, along, strict=True)]
    slid = [i for i, strokes in enumerate(seen) if strokes]
    both = [i for i in slid if len({s.forward for s in seen[i]}) == 2]
    chosen = both if len(both) >= FEWEST else slid
    if len(chosen) < FEWEST:
        return None
    runs = [seen[i] for i in chosen]
    strokes = [s for run in runs for s in run]
    sides = [_sides(run) for run in runs]
    # the mean over directions: a zero of the drive cancels
    delta = np.array([float(np.mean([way.mean() for way in run])) for run in sides])
    spread = _spread([way for run in sides for way in run])
    if spread > 0.0:
        parts = np.split(np.maximum(variances(strokes), spread), np.cumsum([len(run) for run in runs])[:-1])
    else:  # where no stroke repeats another, only the channels' noise says how well it is known
        parts = [np.array([_white(balances[i], along[i], s) for s in seen[i]]) for i in chosen]
    variance = np.array([float(np.mean(v)) / len(v) for v in parts])
    alike = np.zeros(len(runs), dtype=np.int64)
    known = estimated(delta, variance, alike, SIZES, believed=believed, mu_k=model.law.mu_k)
    left = float(np.mean(variance))
    told_by = _condition_of(delta, [balances[i] for i in chosen])
    return RunScatter(**known, gain=1.0 - float(np.sqrt(left / (known["sigma"] ** 2 + left))), runs=len(runs), told_by=told_by)


def _condition_of(delta: Array, balances: Sequence[ForceBalance]) -> str:
    """Return the condition of the runs that says more of their mu_k than it leaves, and not by chance; empty: none does.

    How long a run slides, and how far, friction itself makes where nothing drives: clocks that begin with it are not asked.
    """
    names = [n for n in balances[0].factors if n not in RUN_BY_RUN and all(n in s.factors for s in balances)]
    conditions = {n: np.array([_condition(s, n) for s in balances]) for n in names}
    asked = {n: x for n, x in conditions.items() if min(np.ptp(x), np.ptp(delta)) > 0.0}
    told: dict[str, float] = {}
    for name, values in asked.items():
        correlation, chance = np.asarray(pearsonr(values, delta), dtype=np.float64).tolist()
        if correlation**2 > criteria.EXPLAINED_HELD_OUT and chance * len(asked) < criteria.FAMILY_WISE:
            told[name] = correlation**2
    return max(told, key=lambda n: told[n], default="")


def _condition(balance: ForceBalance, name: str) -> float:
    """Return a condition of a run: its mean, or how it begins where nothing drives and friction makes what comes after."""
    values = balance.factors[name][balance.sliding]
    return float(values.mean() if balance.drive is not None and np.any(balance.drive) else values[0])


def _sides(run: Sequence[Stroke]) -> list[Array]:
    """Return mu_k of the strokes of a run less the model's [-], direction by direction."""
    return [np.array(side) for way in (True, False) if (side := [s.delta for s in run if s.forward == way])]


def _white(balance: ForceBalance, along: Array, stroke: Stroke) -> float:
    own = slice(*stroke.at)
    return balance.white_variance(along[own], balance.window.centres[own])


def _spread(groups: Sequence[Array]) -> float:
    """Return the variance of strokes about the mean of their run and direction [-]; 0 where none repeats."""
    freedom = sum(len(g) - 1 for g in groups)
    return sum(float(np.sum((g - g.mean()) ** 2)) for g in groups) / freedom if freedom else 0.0


def crps_of(
    model: JointModel, balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance], noise: float, sigma: float
) -> tuple[float, float]:
    """Return the mean CRPS of a model's forecasts of friction while it slides, and that of one that is right [N or N m].

    Args:
        model: the model.
        balances: held-out runs.
        nuisances: numbers of the mechanism.
        noise: standard deviation of the balance [N or N m].
        sigma: standard deviation of mu_k that the forecast allows for [-].
    """
    error = np.concatenate([model.remainder(s, nuisances)[s.sliding] for s in balances])
    along = np.concatenate([dependence(model, s)[s.sliding] for s in balances])
    wide = np.hypot(noise, sigma * along)
    return float(np.mean(crps_normal(error, wide))), float(np.mean(wide) / np.sqrt(np.pi))
