"""Friction that is drawn anew for each run: the scatter of runs beyond what the strokes within them explain.

Each run i has its own mu_k: delta_i from what the model leaves of it, the mean of both directions, so that a zero of the drive
cancels; a run may be a single slide one way. What is left within strokes, and how strokes differ, give it a variance v_i. Then
delta_i ~ N(mean, sigma^2 + v_i), and sigma is estimated by REML (restricted maximum likelihood).

No model foretells such a run. Held-out runs are therefore scored by the CRPS of a forecast that knows how far runs scatter.

References: S. R. Searle, G. Casella, C. E. McCulloch, Variance Components, Wiley 1992, section 6.6; T. Gneiting, A. E. Raftery,
J. Am. Stat. Assoc. 102, 2007, 359-378, doi 10.1198/016214506000001437, eq. 21 (CRPS of a normal distribution).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy.stats import chi2, norm

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.scatter.stroke_coefficients import Stroke, dependence, strokes_of, variances
from stochfric_mb.discovery.driven_joint.scatter.stroke_scatter import CONFIDENCE, MATERIAL, NAMED, deviance_of

Array = npt.NDArray[np.float64]

FEWEST = 5
"""Fewest runs from which a scatter between them is asked for: of fewer, any scatter fits."""


@dataclasses.dataclass(frozen=True)
class RunScatter:
    """How mu_k differs from run to run."""

    sigma: float
    """Standard deviation of mu_k [-]."""
    low: float
    """Lower end of its 95 % interval [-]."""
    high: float
    """Upper end of its 95 % interval [-]."""
    share: float
    """The same over mu_k [-]."""
    score: float
    """Evidence: fall of the deviance from the stated scatter, less ln(runs)."""
    p_value: float
    """Chance of that fall without it."""
    gain: float
    """Part of the error of a run's mean (rms) that it is [-]."""
    runs: int
    """Number of runs."""
    believed: float
    """Stated standard deviation of mu_k from run to run [-]."""

    @property
    def named(self) -> bool:
        """Whether it is a finding."""
        return self.score > NAMED and self.gain > MATERIAL

    @property
    def accounted(self) -> bool:
        """Whether the scatter is part of the model, named or stated."""
        return self.named or self.believed > 0.0

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
    delta, spread = np.array([_mean(run) for run in runs]), _spread(runs)
    if spread > 0.0:
        parts = np.split(np.maximum(variances(strokes), spread), np.cumsum([len(run) for run in runs])[:-1])
    else:  # where no stroke repeats another, only the channels' noise says how well it is known
        parts = [np.array([_white(balances[i], along[i], s) for s in seen[i]]) for i in chosen]
    variance = np.array([float(np.mean(v)) / len(v) for v in parts])
    groups = np.zeros(len(runs), dtype=np.int64)
    grid = np.r_[0.0, np.sqrt(np.median(variance)) * np.logspace(-2.0, 4.0, 300)]
    deviance = np.array([deviance_of(s, delta, variance, groups) for s in grid])
    best = int(np.argmin(deviance))
    sigma = float(grid[best])
    inside = grid[deviance < deviance[best] + CONFIDENCE]
    fall = deviance_of(believed, delta, variance, groups) - float(deviance[best]) if sigma > believed else 0.0
    return RunScatter(
        sigma=sigma,
        low=float(inside[0]),
        high=float(inside[-1]),
        share=sigma / model.law.mu_k,
        score=fall - float(np.log(len(runs))),
        p_value=0.5 * float(chi2.sf(fall, 1)) if fall > 0.0 else 1.0,
        gain=1.0 - float(np.sqrt(np.mean(variance) / (sigma**2 + np.mean(variance)))),
        runs=len(runs),
        believed=believed,
    )


def _mean(run: list[Stroke]) -> float:
    """Return the mu_k of a run less the model's [-]: the mean over its directions, so that a zero of the drive cancels."""
    sides = [[s.delta for s in run if s.forward == side] for side in (True, False)]
    return float(np.mean([np.mean(side) for side in sides if side]))


def _white(balance: ForceBalance, along: Array, stroke: Stroke) -> float:
    own = slice(*stroke.at)
    return balance.white_variance(along[own], balance.window.centres[own])


def _spread(runs: list[list[Stroke]]) -> float:
    """Return the variance of strokes about the mean of their run and direction [-]; 0 where none repeats."""
    groups = [[s.delta for s in run if s.forward == side] for run in runs for side in (True, False)]
    freedom = sum(max(len(g) - 1, 0) for g in groups)
    return sum(float(np.sum((np.array(g) - np.mean(g)) ** 2)) for g in groups if g) / freedom if freedom else 0.0


@dataclasses.dataclass(frozen=True)
class Forecasts:
    """CRPS of forecasts of friction in held-out runs [N or N m]."""

    baseline: float
    """Of the model as stated."""
    recalibrated: float
    """Of the recalibrated one."""
    augmented: float
    """Of the augmented one, which knows how far runs scatter."""
    floor: float
    """Of the latter on data that it gives itself."""


def crps_of(
    model: JointModel, balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance], noise: float, sigma: float
) -> tuple[float, float]:
    """Return the mean CRPS of a model's forecasts of friction while it slides, and that of one that is right [N or N m].

    CRPS = s (z (2 Phi(z) - 1) + 2 phi(z) - 1/sqrt(pi)), z the error over the standard deviation s; s/sqrt(pi) on average for
    data from the forecast itself.

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
    z = error / wide
    score = wide * (z * (2.0 * norm.cdf(z) - 1.0) + 2.0 * norm.pdf(z) - 1.0 / np.sqrt(np.pi))
    return float(np.mean(score)), float(np.mean(wide) / np.sqrt(np.pi))
