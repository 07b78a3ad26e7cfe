"""Friction that is drawn anew for each run: the scatter of runs beyond what the strokes within them explain.

Each run i has its own mu_k: delta_i from what the model leaves of it, the mean of both directions, so that a zero of the drive
cancels. The scatter of strokes gives it a variance v_i. Then delta_i ~ N(mean, sigma^2 + v_i), and sigma is asked for by
restricted likelihood.

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
from stochfric_mb.discovery.driven_joint.decision.stroke_scatter import CONFIDENCE, MATERIAL, NAMED, dependence, deviance_of
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel

Array = npt.NDArray[np.float64]

FEWEST = 5
"""Fewest runs from which a scatter between them is asked for: of fewer, any scatter fits."""
STROKES = 2
"""Fewest strokes of a run in a direction."""


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
    """Evidence: fall of the deviance from the scatter that was believed, less ln(runs)."""
    p_value: float
    """Chance of that fall without it."""
    gain: float
    """Part of the error (rms) that it is [-]."""
    runs: int
    """Number of runs."""
    believed: float
    """Standard deviation of mu_k from run to run that was believed already [-]."""

    @property
    def named(self) -> bool:
        """Whether it is a finding."""
        return self.score > NAMED and self.gain > MATERIAL

    @property
    def accounted(self) -> bool:
        """Whether the scatter is part of the model, found or believed."""
        return self.named or self.believed > 0.0

    @property
    def foreseen(self) -> float:
        """Return the standard deviation of a further run's mu_k: its own scatter, and that of the mean [-]."""
        return max(self.sigma, self.believed) * float(np.sqrt(1.0 + 1.0 / self.runs))


def run_scatter(
    model: JointModel, balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance], believed: float = 0.0
) -> RunScatter | None:
    """Return the scatter of mu_k over runs; None if these are too few, or slide too seldom in both directions.

    Args:
        model: what is known of the friction.
        balances: runs to learn from.
        nuisances: numbers of the mechanism.
        believed: standard deviation of mu_k from run to run that is believed already [-].
    """
    seen = [_of_run(model, balance, nuisances) for balance in balances]
    runs = [s for s in seen if s is not None]
    if len(runs) < FEWEST:
        return None
    delta = np.array([r.delta for r in runs])
    spread = np.concatenate([r.spread for r in runs])
    freedom = len(spread) - 2 * len(runs)
    variance = float(np.sum(spread**2)) / max(freedom, 1) / np.array([len(r.spread) for r in runs])
    groups = np.zeros(len(runs), dtype=np.int64)
    grid = np.r_[0.0, np.sqrt(np.median(variance)) * np.logspace(-2.0, 4.0, 300)]
    deviance = np.array([deviance_of(s, delta, variance, groups) for s in grid])
    best = int(np.argmin(deviance))
    sigma = float(grid[best])
    inside = grid[deviance < deviance[best] + CONFIDENCE]
    fall = deviance_of(believed, delta, variance, groups) - float(deviance[best]) if sigma > believed else 0.0
    force, left = sigma**2 * float(np.mean([r.force for r in runs])), float(np.mean([r.square for r in runs]))
    return RunScatter(
        sigma=sigma,
        low=float(inside[0]),
        high=float(inside[-1]),
        share=sigma / model.law.mu_k,
        score=fall - float(np.log(len(runs))),
        p_value=0.5 * float(chi2.sf(fall, 1)) if fall > 0.0 else 1.0,
        gain=1.0 - float(np.sqrt(max(1.0 - force / left, 0.0))),
        runs=len(runs),
        believed=believed,
    )


@dataclasses.dataclass(frozen=True)
class _Run:
    delta: float
    """Its mu_k less the model's [-]."""
    spread: Array
    """That of its strokes, less the mean of their direction [-]."""
    force: float
    """Mean square of friction's change with mu_k [N^2 or N^2 m^2]."""
    square: float
    """Mean square of what the model leaves [N^2 or N^2 m^2]."""


def _of_run(model: JointModel, balance: ForceBalance, nuisances: Sequence[Nuisance]) -> _Run | None:
    """Return what a run says of its mu_k; None if it hardly slides in one of the directions."""
    rest, along = model.remainder(balance, nuisances), dependence(model, balance)
    forward = balance.velocity[balance.window.centres] > 0.0
    edges = np.flatnonzero(np.diff(np.r_[0, balance.sliding.astype(np.int8), 0]))
    strokes: dict[bool, list[float]] = {True: [], False: []}
    for start, end in zip(edges[::2], edges[1::2], strict=True):
        f = along[start:end]
        if float(f @ f) > 0.0:
            strokes[bool(forward[start])].append(float(f @ rest[start:end]) / float(f @ f))
    if min(map(len, strokes.values())) < STROKES:
        return None
    means = {side: float(np.mean(values)) for side, values in strokes.items()}
    spread = np.concatenate([np.array(values) - means[side] for side, values in strokes.items()])
    sliding = balance.sliding
    return _Run(
        0.5 * (means[True] + means[False]), spread, float(np.mean(along[sliding] ** 2)), float(np.mean(rest[sliding] ** 2))
    )


@dataclasses.dataclass(frozen=True)
class Forecasts:
    """CRPS of forecasts of friction in held-out runs [N or N m]."""

    baseline: float
    """Of the model as believed."""
    recalibrated: float
    """Of the recalibrated one."""
    augmented: float
    """Of the one with what was found, which knows how far runs scatter."""
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
