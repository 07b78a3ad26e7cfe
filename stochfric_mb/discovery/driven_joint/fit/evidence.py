"""Evidence of what models leave, where the settings of an experiment are fewer than its samples.

What stays the same in all strokes of a run in one direction (the zero of a sensor, the warmth of a seal, the mounting of a
day) errs in all of them alike. A smooth dependence on load or speed that takes four values in four runs is supported by four
numbers, not by four thousand windows. So what is left has two variances: within a setting, and from setting to setting.

Between effects the two are those about the best fit: physics may be asked what it explains. A smooth dependence without a
name has to do better than runs that differ for no known reason, so there each side has the variances that suit it best.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.discovery.driven_joint.fit.fitting import JointFit

Array = npt.NDArray[np.float64]
Labels = npt.NDArray[np.int64]

RATIOS = np.r_[0.0, np.logspace(-3.0, 4.0, 57)]
"""Variances between settings that are tried, over the variance of one independent window [-]."""
FEWEST = 2
"""Runs from which there is something to say about the scatter between them."""


@dataclasses.dataclass(frozen=True)
class Scatter:
    """What a model leaves, as two variances."""

    deviance: float
    """-2 log likelihood, up to a constant."""
    ratio: float
    """Variance between settings over that of an independent window [-]."""
    between: float
    """Standard deviation from setting to setting [N or N m]."""
    within: float
    """Standard deviation of a window within its setting [N or N m]."""


def settings_of(balances: Sequence[ForceBalance]) -> Labels:
    """Return the setting of each window of sliding, a number for each run and direction, shape (n,)."""
    parts = [2 * i + (s.velocity[s.window.centres][s.sliding] > 0.0).astype(np.int64) for i, s in enumerate(balances)]
    return np.concatenate(parts) if len(balances) >= FEWEST else np.zeros(sum(map(len, parts)), dtype=np.int64)


def scatter(rest: Array, settings: Labels, independent: float, ratios: Array = RATIOS) -> Scatter:
    """Return the likelihood of ``rest`` with the variance between settings that makes it the largest.

    D = sum ln(1 + r m_g) + n ln((S_w + sum m_g mean_g^2/(1 + r m_g))/n), r the ratio of the variances, m_g the independent
    windows of setting g and S_w their sum of squares about the means: one-way random effects, in closed form but for r.
    With a single setting it is n ln(mean square).

    Args:
        rest: what a model leaves of the windows of sliding [N or N m], shape (n_windows,).
        settings: the setting of each, shape (n_windows,).
        independent: number n of independent windows.
        ratios: ratios of the variances that are tried.

    Reference: S. R. Searle, G. Casella, C. E. McCulloch, Variance Components, Wiley 1992, section 3.7.
    """
    weight = independent / len(rest)
    index = np.unique(settings, return_inverse=True)[1]
    count = weight * np.bincount(index)
    means = weight * np.bincount(index, rest) / count
    inside = weight * float(np.sum((rest - means[index]) ** 2))
    ratios = ratios if len(count) > 1 else RATIOS[:1]
    shrunk = 1.0 + np.outer(ratios, count)
    variance = (inside + np.sum(count * means**2 / shrunk, axis=1)) / independent + 1.0e-300
    deviance = np.sum(np.log(shrunk), axis=1) + independent * np.log(variance)
    best = int(np.argmin(deviance))
    return Scatter(
        float(deviance[best]),
        float(ratios[best]),
        float(np.sqrt(ratios[best] * variance[best])),
        float(np.sqrt(variance[best])),
    )


def whitened(columns: Array, settings: Labels, independent: float, ratio: float) -> Array:
    """Return columns, shape (n_windows, k), with the means over settings shrunk: least squares of these is generalised.

    Args:
        columns: signals at the windows of sliding.
        settings: the setting of each window, shape (n_windows,).
        independent: number of independent windows.
        ratio: variance between settings over that of an independent window [-].
    """
    index = np.unique(settings, return_inverse=True)[1]
    size = np.bincount(index)
    kept = 1.0 / np.sqrt(1.0 + ratio * size * independent / len(columns))
    means: Array = np.stack([np.bincount(index, c) / size for c in columns.T], axis=1)
    shrunk: Array = ((1.0 - kept)[:, None] * means)[index]
    return columns - shrunk


def evidence(plain: JointFit, richer: JointFit, best: JointFit, settings: Labels) -> float:
    """Return 2 delta log L of two fits, beliefs included, settings scattering as they do about the best fit there is.

    Args:
        plain: the fit that is compared with.
        richer: the other one.
        best: the best fit there is, by which independent windows are counted.
        settings: the setting of each window of sliding, shape (n_windows,).
    """
    n = best.n
    ratio = scatter(np.concatenate(best.remainders), settings, n).ratio
    before, after = (scatter(np.concatenate(f.remainders), settings, n, ratios=np.array([ratio])) for f in (plain, richer))
    return before.deviance + plain.strain - after.deviance - richer.strain
