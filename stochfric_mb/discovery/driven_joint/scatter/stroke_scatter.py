"""Friction that is drawn anew for each stroke: the scatter of strokes under the same conditions, beyond what windows explain.

Each stroke has its own mu_k, from what the model leaves of it, with the variance that the scatter within strokes gives it.
Strokes of one run in one direction share a mean (`between_groups`).
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance, Nuisance
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.scatter.between_groups import CoefficientScatter, Labels, estimated, means_of
from stochfric_mb.discovery.driven_joint.scatter.stroke_coefficients import Stroke, dependence, strokes_of, variances
from stochfric_mb.discovery.driven_joint.simulation.scores import APART, FLOOR, noise_floor
from stochfric_mb.numerics.stretches import stretches

Array = npt.NDArray[np.float64]

FEWEST = 8
"""Fewest strokes beyond one in each setting."""
REVERSAL = 10
"""Longest reversal across which noise is followed [windows that share no samples]."""
SIZES = np.logspace(-2.0, 2.5, 200)
"""Scatter that is tried, over the median deviation of a stroke [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class StrokeScatter(CoefficientScatter):
    """How mu_k differs from stroke to stroke."""

    correlation: float
    """Correlation of strokes that follow each other in one direction [-]."""
    across: float
    """Correlation of the force that is left just before a reversal with that just after it [-]."""
    strokes: int
    """Number of strokes."""
    level: float
    """Scatter of the friction force [N or N m]."""
    inside: float
    """What is left within strokes (rms), each with a mu_k of its own [N or N m]."""
    floor: float
    """Noise of the balance [N or N m]."""

    @property
    def all_of_it(self) -> bool:
        """Whether next to nothing but noise is left within strokes: what changes within them is not drawn anew for each."""
        return self.inside <= FLOOR * self.floor

    @property
    def remembers(self) -> bool:
        """Whether the stroke before says something of the next one, by two standard errors of a correlation of none."""
        return bool(self.correlation > 2.0 / np.sqrt(self.strokes))

    @property
    def wanders(self) -> bool:
        """Whether the stroke before says more than half of the next one, which is then not drawn anew."""
        return self.remembers and self.correlation**2 > criteria.EXPLAINED_HELD_OUT

    @property
    def slow_noise(self) -> bool:
        """Whether what is left goes on across reversals, where friction would turn: slow noise of the drive."""
        return self.across > 2.0 / np.sqrt(self.strokes)

    @property
    def named(self) -> bool:
        """Whether it is a finding."""
        return super().named and self.all_of_it and not self.wanders and not self.slow_noise


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
        reversals += _across(rest, stretches(balance.sliding))
        own = strokes_of(rest, dependence(model, balance), balance, 2 * APART)
        strokes += own
        settings += [2 * i + int(s.forward) for s in own]
    groups = np.unique(settings, return_inverse=True)[1] if settings else np.zeros(0, dtype=np.int64)
    if len(strokes) - (int(groups.max(initial=-1)) + 1) < FEWEST:
        return None
    delta, variance = np.array([s.delta for s in strokes]), variances(strokes)
    known = estimated(delta, variance, groups, SIZES, believed=believed, mu_k=model.law.mu_k)
    sigma = known["sigma"]
    force = sigma * float(np.sqrt(np.mean([s.slope for s in strokes])))
    left = max(1.0 - force**2 / float(np.mean([s.square for s in strokes])), 0.0)
    return StrokeScatter(
        **known,
        gain=1.0 - float(np.sqrt(left)),
        correlation=_following(delta, sigma**2 + variance, groups),
        across=_correlation(reversals),
        strokes=len(delta),
        level=force,
        inside=float(np.sqrt(np.average([s.inside for s in strokes], weights=[s.windows for s in strokes]))),
        floor=noise_floor(model, balances, nuisances),
    )


def _across(rest: Array, slid: Sequence[tuple[int, int]]) -> list[tuple[float, float]]:
    """Return what is left at the end of each stroke and at the start of the next one, where a stroke follows soon."""
    return [
        (float(rest[max(end - 2 * APART, 0) : end].mean()), float(rest[start : start + 2 * APART].mean()))
        for (_, end), (start, _) in itertools.pairwise(slid)
        if start - end <= REVERSAL * APART
    ]


def _correlation(pairs: Sequence[tuple[float, float]]) -> float:
    if len(pairs) < 4:
        return 0.0
    before, after = (np.array(x) for x in zip(*pairs, strict=True))
    return float(before @ after / max(float(np.sqrt((before @ before) * (after @ after))), 1.0e-300))


def _following(delta: Array, total: Array, groups: Labels) -> float:
    """Return the correlation of a stroke with the one after it in its setting [-]."""
    mean, _ = means_of(delta, total, groups)
    z = (delta - mean) / np.sqrt(total)
    products: list[float] = []
    for g in range(int(groups.max()) + 1):
        own = z[groups == g]
        products += list(own[1:] * own[:-1])
    # the mean of a setting takes part of each of its strokes: that alone gives -1/size
    size = len(delta) / (int(groups.max()) + 1)
    return float(np.mean(products) / max(float(np.mean(z**2)), 1.0e-300) + 1.0 / size) if products else 0.0
