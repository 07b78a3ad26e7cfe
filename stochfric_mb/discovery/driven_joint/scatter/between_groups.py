"""Scatter of a friction coefficient from group to group, beyond what is known of each group: restricted likelihood (REML).

Group i has delta_i, its mu_k less the model's, known to a variance v_i. Groups of one setting share a mean. Then
delta_i ~ N(mean, sigma^2 + v_i), and sigma is where the restricted likelihood is largest.

Reference: S. R. Searle, G. Casella, C. E. McCulloch, Variance Components, Wiley 1992, section 6.6.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.stats import chi2

Array = npt.NDArray[np.float64]
Labels = npt.NDArray[np.int64]

NAMED = 20.0
"""Score above which the scatter is named."""
MATERIAL = 0.05
"""Least part of the error (rms) that the scatter is."""
CONFIDENCE = 3.84
"""Rise of the deviance at the ends of a 95 % interval."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class CoefficientScatter:
    """How mu_k differs from group to group."""

    sigma: float
    """Standard deviation of mu_k [-]."""
    low: float
    """Lower end of its 95 % interval [-]."""
    high: float
    """Upper end of its 95 % interval [-]."""
    share: float
    """The same over mu_k [-]."""
    score: float
    """Evidence: fall of the deviance from the stated scatter, less ln(groups)."""
    p_value: float
    """Chance of that fall without it."""
    believed: float
    """Stated standard deviation of mu_k [-]."""
    gain: float
    """Part of the error (rms) that it is [-]."""

    @property
    def named(self) -> bool:
        """Whether it is a finding."""
        return self.score > NAMED and self.gain > MATERIAL

    @property
    def accounted(self) -> bool:
        """Whether the scatter is part of the model, named or stated, and so of the floor that no mean friction gets below."""
        return self.named or self.believed > 0.0


def estimated(
    delta: Array, variance: Array, settings: Labels, tried: Array, *, believed: float, mu_k: float
) -> dict[str, float]:
    """Return what the likelihood says of the scatter: the fields of `CoefficientScatter` but ``gain``.

    Args:
        delta: mu_k of each group less the model's [-], shape (n,).
        variance: how well each is known [-], shape (n,).
        settings: number of the setting of each group, from 0, shape (n,).
        tried: sizes of the scatter that are tried beside none, over the median deviation of a group [-], rising.
        believed: stated standard deviation of mu_k [-].
        mu_k: mu_k of the model [-].
    """
    grid = np.r_[0.0, np.sqrt(np.median(variance)) * tried]
    deviance = np.array([_deviance(s, delta, variance, settings) for s in grid])
    best = int(np.argmin(deviance))
    sigma, inside = float(grid[best]), grid[deviance < deviance[best] + CONFIDENCE]
    fall = _deviance(believed, delta, variance, settings) - float(deviance[best]) if sigma > believed else 0.0
    return {
        "sigma": sigma,
        "low": float(inside[0]),
        "high": float(inside[-1]),
        "share": sigma / mu_k,
        "score": fall - float(np.log(len(delta))),
        "p_value": 0.5 * float(chi2.sf(fall, 1)) if fall > 0.0 else 1.0,
        "believed": believed,
    }


def means_of(delta: Array, variance: Array, settings: Labels) -> tuple[Array, Array]:
    """Return the weighted mean of each group's setting, shape (n,), and the weights of the settings."""
    weight: Any = np.bincount(settings, 1.0 / variance)
    return (np.bincount(settings, delta / variance) / weight)[settings], weight


def _deviance(sigma: float, delta: Array, variance: Array, settings: Labels) -> float:
    """Return -2 log restricted likelihood of a scatter ``sigma``, up to a constant."""
    total = sigma**2 + variance
    mean, weight = means_of(delta, total, settings)
    return float(np.sum(np.log(total) + (delta - mean) ** 2 / total) + np.sum(np.log(weight)))
