"""Friction that is drawn anew for each stroke: the scatter of strokes under the same conditions, beyond what windows explain.

Each stroke k has its own mu_k: delta_k from what the model leaves of it, with the variance v_k that the scatter within strokes
gives it. Strokes of one run in one direction share a mean. Then delta_k ~ N(mean, sigma^2 + v_k), and sigma is asked for by
restricted likelihood.

Reference: S. R. Searle, G. Casella, C. E. McCulloch, Variance Components, Wiley 1992, section 6.6.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.stats import chi2

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.scatter.stroke_coefficients import Stroke, dependence, strokes_of, variances
from stochfric_mb.discovery.driven_joint.simulation.scores import APART, FLOOR, noise_floor

Array = npt.NDArray[np.float64]

NAMED = 20.0
"""Score above which the scatter is named."""
MATERIAL = 0.05
"""Least part of the error (rms) that the scatter is."""
FEWEST = 8
"""Fewest strokes beyond one in each setting."""
REVERSAL = 10
"""Longest reversal across which noise is followed [windows that share no samples]."""
CONFIDENCE = 3.84
"""Rise of the deviance at the ends of a 95 % interval."""


@dataclasses.dataclass(frozen=True)
class StrokeScatter:
    """How mu_k differs from stroke to stroke."""

    sigma: float
    """Standard deviation of mu_k [-]."""
    low: float
    """Lower end of its 95 % interval [-]."""
    high: float
    """Upper end of its 95 % interval [-]."""
    share: float
    """The same over mu_k [-]."""
    score: float
    """Evidence: fall of the deviance from the stated scatter, less ln(strokes)."""
    p_value: float
    """Chance of that fall without it."""
    gain: float
    """Part of the error (rms) that it is [-]."""
    correlation: float
    """Correlation of strokes that follow each other in one direction [-]."""
    across: float
    """Correlation of the force that is left just before a reversal with that just after it [-]."""
    strokes: int
    """Number of strokes."""
    level: float
    """Scatter of the friction force [N or N m]."""
    believed: float
    """Stated standard deviation of mu_k [-]."""
    inside: float
    """What is left within strokes (rms), each with a mu_k of its own [N or N m]."""
    floor: float
    """Noise of the balance [N or N m]."""

    @property
    def all_of_it(self) -> bool:
        """Whether next to nothing but noise is left within strokes: what changes within them is not drawn anew for each."""
        return self.inside <= FLOOR * self.floor

    @property
    def wanders(self) -> bool:
        """Whether strokes resemble those before them, so that they are not drawn anew."""
        return self.correlation > 2.0 / np.sqrt(self.strokes)

    @property
    def slow_noise(self) -> bool:
        """Whether what is left goes on across reversals, where friction would turn: slow noise of the drive."""
        return self.across > 2.0 / np.sqrt(self.strokes)

    @property
    def named(self) -> bool:
        """Whether it is a finding."""
        return self.score > NAMED and self.gain > MATERIAL and self.all_of_it and not self.wanders and not self.slow_noise

    @property
    def accounted(self) -> bool:
        """Whether the scatter is part of the model, named or stated, and so of the floor that no mean friction gets below."""
        return self.named or self.believed > 0.0


def stroke_scatter(
    model: JointModel, balances: Sequence[ForceBalance], nuisances: Sequence[Nuisance], believed: float = 0.0
) -> StrokeScatter | None:
    """Return the scatter of mu_k over the strokes of ``balances``; None if these are too few.

    Args:
        model: what is known of the friction.
        balances: fit runs.
        nuisances: numbers of the mechanism.
        believed: stated standard deviation of mu_k [-].
    """
    strokes: list[Stroke] = []
    settings: list[int] = []
    reversals: list[tuple[float, float]] = []
    for i, balance in enumerate(balances):
        rest = model.remainder(balance, nuisances)
        reversals += _across(rest, np.flatnonzero(np.diff(np.r_[0, balance.sliding.astype(np.int8), 0])))
        own = strokes_of(rest, dependence(model, balance), balance, 2 * APART)
        strokes += own
        settings += [2 * i + int(s.forward) for s in own]
    groups = np.unique(settings, return_inverse=True)[1] if settings else np.zeros(0, dtype=np.int64)
    if len(strokes) - (int(groups.max(initial=-1)) + 1) < FEWEST:
        return None
    delta, variance = np.array([s.delta for s in strokes]), variances(strokes)
    grid = np.r_[0.0, np.sqrt(np.median(variance)) * np.logspace(-2.0, 2.5, 200)]
    deviance = np.array([deviance_of(s, delta, variance, groups) for s in grid])
    best = int(np.argmin(deviance))
    sigma = float(grid[best])
    inside = grid[deviance < deviance[best] + CONFIDENCE]
    fall = deviance_of(believed, delta, variance, groups) - float(deviance[best]) if sigma > believed else 0.0
    force = sigma * float(np.sqrt(np.mean([s.slope for s in strokes])))
    left = max(1.0 - force**2 / float(np.mean([s.square for s in strokes])), 0.0)
    return StrokeScatter(
        sigma=sigma,
        low=float(inside[0]),
        high=float(inside[-1]),
        share=sigma / model.law.mu_k,
        score=fall - float(np.log(len(delta))),
        p_value=0.5 * float(chi2.sf(fall, 1)) if fall > 0.0 else 1.0,
        gain=1.0 - float(np.sqrt(left)),
        correlation=_following(delta, sigma**2 + variance, groups),
        across=_correlation(reversals),
        strokes=len(delta),
        level=force,
        believed=believed,
        inside=float(np.sqrt(np.average([s.inside for s in strokes], weights=[s.windows for s in strokes]))),
        floor=noise_floor(model, balances, nuisances),
    )


def _across(rest: Array, edges: npt.NDArray[np.int64]) -> list[tuple[float, float]]:
    """Return what is left at the end of each stroke and at the start of the next one, where a stroke follows soon."""
    items: list[tuple[float, float]] = []
    for end, start in zip(edges[1:-1:2], edges[2::2], strict=True):
        if start - end <= REVERSAL * APART:
            items.append((float(rest[max(end - 2 * APART, 0) : end].mean()), float(rest[start : start + 2 * APART].mean())))
    return items


def _correlation(pairs: Sequence[tuple[float, float]]) -> float:
    if len(pairs) < 4:
        return 0.0
    before, after = (np.array(x) for x in zip(*pairs, strict=True))
    return float(before @ after / max(float(np.sqrt((before @ before) * (after @ after))), 1.0e-300))


def _means(delta: Array, variance: Array, groups: npt.NDArray[np.int64]) -> tuple[Array, Array]:
    """Return the mean of each stroke's setting, weighted, shape (n,), and the weights of the settings."""
    weight: Any = np.bincount(groups, 1.0 / variance)
    return (np.bincount(groups, delta / variance) / weight)[groups], weight


def deviance_of(sigma: float, delta: Array, variance: Array, groups: npt.NDArray[np.int64]) -> float:
    """Return -2 log restricted likelihood of a scatter ``sigma``, up to a constant."""
    total = sigma**2 + variance
    mean, weight = _means(delta, total, groups)
    return float(np.sum(np.log(total) + (delta - mean) ** 2 / total) + np.sum(np.log(weight)))


def _following(delta: Array, total: Array, groups: npt.NDArray[np.int64]) -> float:
    """Return the correlation of a stroke with the one after it in its setting [-]."""
    mean, _ = _means(delta, total, groups)
    z = (delta - mean) / np.sqrt(total)
    products: list[float] = []
    for g in range(int(groups.max()) + 1):
        own = z[groups == g]
        products += list(own[1:] * own[:-1])
    # the mean of a setting takes part of each of its strokes: that alone gives -1/size
    size = len(delta) / (int(groups.max()) + 1)
    return float(np.mean(products) / max(float(np.mean(z**2)), 1.0e-300) + 1.0 / size) if products else 0.0
