"""Memory of a coefficient that scatters: how far a stroke foretells the next one of its run (restricted likelihood).

What strokes of a run have beyond what is known of each is a stationary process of order one, there and back: strokes i and j
are correlated by rho^|i - j|. Strokes of one setting share a mean, as in `between_groups`: that a mean of few strokes takes
part of each of them, and most of what wanders slowly, is in the likelihood.

Reference: S. R. Searle, G. Casella, C. E. McCulloch, Variance Components, Wiley 1992, section 6.6.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize_scalar

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.scatter.between_groups import CONFIDENCE, Labels

Array = npt.NDArray[np.float64]

TRIED = np.linspace(0.0, 0.98, 25)
"""Correlations that are tried [-]."""
LEAST, MOST = -5.0, 5.0
"""Natural logarithms of the scatter that is tried, over the median deviation from the means [-]."""


@dataclasses.dataclass(frozen=True)
class Memory:
    """Correlation of a stroke with the next one."""

    correlation: float
    """Most likely value [-]."""
    low: float
    """Lower end of its 95 % interval [-]."""
    high: float
    """Upper end of its 95 % interval [-]."""

    @property
    def shown(self) -> bool:
        """Whether the strokes are not independent."""
        return self.low > 0.0


def foretells(correlation: float) -> bool:
    """Return whether with such a correlation [-] the stroke before says more than half of the next one."""
    return max(correlation, 0.0) ** 2 > criteria.EXPLAINED_HELD_OUT


def memory_of(delta: Array, variance: Array, settings: Labels, runs: Labels) -> Memory:
    """Return how strokes follow each other.

    Args:
        delta: mu_k of each stroke less the model's [-], in the order of time within each run, shape (n,).
        variance: how well each is known [-], shape (n,).
        settings: number of the setting of each stroke, none in two runs, shape (n,).
        runs: number of the run of each stroke, shape (n,).
    """
    rows = [np.flatnonzero(runs == r) for r in np.unique(runs)]
    scale = float(np.sqrt(np.median(variance) + np.var(delta)))

    def deviance(log_size: float, correlation: float) -> float:
        size = scale * float(np.exp(log_size))
        return sum(_of_run(size, correlation, delta[m], variance[m], settings[m]) for m in rows)

    def least(correlation: float) -> float:
        found: Any = minimize_scalar(deviance, bounds=(LEAST, MOST), args=(correlation,), method="bounded")
        return float(found.fun)

    profile = np.array([least(float(rho)) for rho in TRIED])
    best, inside = int(np.argmin(profile)), TRIED[profile < profile.min() + CONFIDENCE]
    return Memory(float(TRIED[best]), float(inside[0]), float(inside[-1]))


def _of_run(size: float, correlation: float, delta: Array, variance: Array, settings: Labels) -> float:
    """Return -2 log restricted likelihood of the strokes of one run, up to a constant."""
    lags = np.abs(np.subtract.outer(np.arange(len(delta)), np.arange(len(delta))))
    factor = cho_factor(size**2 * correlation**lags + np.diag(variance), lower=True)
    means = (settings[:, None] == np.unique(settings)).astype(np.float64)
    weighted = cho_solve(factor, means)
    precision = means.T @ weighted
    rest = delta - means @ np.linalg.solve(precision, weighted.T @ delta)
    determinant = 2.0 * float(np.sum(np.log(np.diag(factor[0]))))
    return determinant + float(np.linalg.slogdet(precision)[1]) + float(rest @ cho_solve(factor, rest))
