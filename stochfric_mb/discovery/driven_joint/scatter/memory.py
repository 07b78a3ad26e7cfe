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
"""Correlations that are tried [-]: up to a memory of fifty strokes, which the mean of a setting takes with it."""
LEAST, MOST = -5.0, 5.0
"""Natural logarithms of the scatter that is tried, over that of the strokes [-]: a factor of 150 either way."""


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


UNKNOWN = Memory(0.0, 0.0, float(TRIED[-1]))
"""That of strokes that do not scatter beyond what is known of each."""


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
    lags = [np.abs(np.subtract.outer(m, m)) for m in rows]

    def least(correlation: float) -> float:
        alike = [correlation**lag for lag in lags]

        def deviance(log_size: float) -> float:
            square = (scale * float(np.exp(log_size))) ** 2
            return sum(_of_run(square * a, delta[m], variance[m], settings[m]) for a, m in zip(alike, rows, strict=True))

        found: Any = minimize_scalar(deviance, bounds=(LEAST, MOST), method="bounded")
        return float(found.fun)

    profile = np.array([least(float(rho)) for rho in TRIED])
    best, inside = int(np.argmin(profile)), TRIED[profile < profile.min() + CONFIDENCE]
    return Memory(float(TRIED[best]), float(inside[0]), float(inside[-1]))


def _of_run(process: Array, delta: Array, variance: Array, settings: Labels) -> float:
    """Return -2 log restricted likelihood of the strokes of one run with a covariance ``process``, up to a constant."""
    factor = cho_factor(process + np.diag(variance), lower=True)
    means = (settings[:, None] == np.unique(settings)).astype(np.float64)
    weighted = cho_solve(factor, means)
    precision = means.T @ weighted
    rest = delta - means @ np.linalg.solve(precision, weighted.T @ delta)
    determinant = 2.0 * float(np.sum(np.log(np.diag(factor[0]))))
    return determinant + float(np.linalg.slogdet(precision)[1]) + float(rest @ cho_solve(factor, rest))
