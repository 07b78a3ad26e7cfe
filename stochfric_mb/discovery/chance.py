"""Random friction and random kicks: looked for last, in what all other effects leave."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery.calibration import robust_deviation
from stochfric_mb.discovery.choice import NAME
from stochfric_mb.discovery.randomness import Randomness
from stochfric_mb.discovery.regression import Solution
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.study import Study

CERTAIN = 30.0
"""Likelihood ratio at which friction scatters beyond doubt [-]."""
MEMORY = 3.0
"""Correlation from slip to slip over its standard error at which the scatter has a memory [-]."""
REMAINING_SCATTER = 0.1
"""Share of the believed model's scatter that must remain with the effects in for it to be called random [-]."""
EARLY = 0.03
"""Share of slips that break away far too early at which kicks are looked at [-]."""


@dataclasses.dataclass(frozen=True)
class Chance:
    """A random effect."""

    kind: str
    """Its name."""
    score: float
    """Evidence [-]."""
    values: dict[str, float | str]
    """Its parameters."""


def early(study: Study) -> tuple[float, float, float]:
    """Return the share of slips that break away far too early, that of far too late ones, and how early [N]."""
    pool = study.pool
    centred = np.concatenate(
        [pool.features[pool.run == r, 0] - np.median(pool.features[pool.run == r, 0]) for r in range(pool.n_runs)]
    )
    limit = max(5.0 * robust_deviation(centred), 0.04 * float(np.median(pool.static)))
    low = centred < -limit
    return float(low.mean()), float((centred > limit).mean()), float(-np.median(centred[low])) if low.any() else 0.0


def kicks(study: Study) -> Chance | None:
    """Return impacts if a few slips, and only a few, break away far too early."""
    share, late, force = early(study)
    if share < EARLY or share > 0.45 or late > 0.3 * share:
        return None
    pool = study.pool
    cycles = float(np.median([np.median(np.diff(s.onset_time)) for s in pool.slips]))
    # a kick that lasts 2 ms adds its mean force to the spring's; one in about three is strong enough to be seen
    impulse = 1.5 * force * 2.0e-3
    return Chance("impacts", 400.0 * share, {"rate": 3.0 * share / cycles, "impulse": impulse})


def chance(study: Study, scatter: Randomness, solution: Solution, named: Sequence[str]) -> Chance | Where | None:
    """Return random friction, or where a scatter of no known kind lives, or None."""
    strongest = max(scatter.static, scatter.kinetic)
    if strongest <= CERTAIN and scatter.wander <= NAME:
        return None
    remaining = np.exp(2.0 * solution.scatter[:2]).sum() / np.exp(2.0 * study.solution.scatter[:2]).sum()
    if named and remaining < REMAINING_SCATTER:
        return None
    if scatter.two_levels > NAME:
        return Where("scatter", "friction switches at random between two levels")
    load = float(np.median(study.pool.normal_force))
    if scatter.wander > NAME and scatter.correlation > MEMORY:
        share = max(scatter.wander_share, 1.0e-3)
        mu_s, mu_k = study.solution.coefficients[:2]
        return Chance(
            "correlated_coefficients",
            scatter.wander,
            {"sigma_s": float(share * mu_s), "sigma_k": float(share * mu_k), "correlation_time": float(scatter.wander_time)},
        )
    if scatter.correlation > 2.0 * MEMORY:
        return Where("scatter, time", "friction varies from slip to slip with a memory that no known random process has")
    if study.model.process is not None:
        return None
    sigma_s, sigma_k, _ = np.exp(solution.scatter) / load
    within = scatter.within > CERTAIN and scatter.within > 0.05 * strongest
    values: dict[str, float | str] = {
        "process": "knots" if within else "per_event", "sigma_s": float(sigma_s), "sigma_k": float(sigma_k)
    }  # fmt: skip
    return Chance("random_coefficients", strongest, values)
