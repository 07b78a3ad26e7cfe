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
from stochfric_mb.discovery.driven_joint.scatter.between_groups import CoefficientScatter, estimated
from stochfric_mb.discovery.driven_joint.scatter.memory import UNKNOWN, Memory, foretells, memory_of
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

    memory: Memory
    """Correlation of strokes that follow each other."""
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
    def nearly_all_of_it(self) -> bool:
        """Whether what is left within strokes, noise apart, is no material part of the squared error."""
        more = max(self.inside**2 - self.floor**2, 0.0)
        return self.all_of_it or more < criteria.MATERIAL * (self.level**2 + more)

    @property
    def wanders(self) -> bool:
        """Whether the stroke before says more than half of the next one beyond doubt: that is then not drawn anew."""
        return foretells(self.memory.low)

    @property
    def may_wander(self) -> bool:
        """Whether the stroke before says something of the next one, or may as well say more than half of it."""
        return self.memory.shown or foretells(self.memory.high)

    @property
    def slow_noise(self) -> bool:
        """Whether what is left goes on across reversals, where friction would turn: slow noise of the drive."""
        return self.across > 2.0 / np.sqrt(self.strokes)

    @property
    def named(self) -> bool:
        """Whether it is a finding."""
        return super().named and self.nearly_all_of_it and not self.wanders and not self.slow_noise


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
    runs: list[int] = []
    reversals: list[tuple[float, float]] = []
    for i, balance in enumerate(balances):
        rest = model.remainder(balance, nuisances)
        reversals += _across(rest, stretches(balance.sliding))
        own = strokes_of(rest, dependence(model, balance), balance, 2 * APART)
        strokes += own
        settings += [2 * i + int(s.forward) for s in own]
        runs += [i] * len(own)
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
        memory=memory_of(delta, variance, groups, np.asarray(runs)) if known["low"] > 0.0 else UNKNOWN,
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
