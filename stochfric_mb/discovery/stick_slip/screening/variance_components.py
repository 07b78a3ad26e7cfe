"""Is friction random: variance components, their correlation in time, and whether stick and slip scatter together."""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.screening.regression import LOWEST, Baseline


@dataclasses.dataclass(frozen=True)
class Randomness:
    """What the scatter of the slips tells."""

    static: float
    """Likelihood ratio of scatter in the onset force: 2 delta log L [-]."""
    kinetic: float
    """The same of the mean force in slip."""
    within: float
    """The same of white scatter within the slip."""
    correlation: float
    """Correlation of the scatter from one slip to the next over its standard error [-]."""
    wander: float
    """Score of a slow wander of the forces [-]."""
    wander_share: float
    """Standard deviation of the wander over the mean friction [-]."""
    wander_time: float
    """Its correlation time [s]."""
    wander_of: str
    """What wanders, a key of `MODES`: "both" coefficients, "mu_s", "mu_k", or an "offset", the same force in stick and slip."""
    together: float
    """Correlation of the onset force with the mean force of the slip that follows [-]."""
    cross: float = 0.0
    """Correlation of the two coefficients: that of these forces less what noise makes of it [-]."""


def randomness(baseline: Baseline) -> Randomness:
    """Return what the scatter about a fitted model tells."""

    def ratio(component: int) -> float:
        without = baseline.solution.scatter.copy()
        without[component] = LOWEST
        return 2.0 * (baseline.regression.solve(baseline.terms, without).cost - baseline.solution.cost)

    rest = baseline.residuals()[:, :2]
    correlation = _correlation(baseline.pool, rest)
    nothing = (0.0, 0.0, 1.0, "both")
    wander, share, time, what = _wander(baseline, rest) if correlation > criteria.WANDER_WORTH_A_LOOK else nothing
    together, cross = _together(baseline.pool, rest), _cross(baseline, rest)
    return Randomness(ratio(0), ratio(1), ratio(2), correlation, wander, share, time, what, together, cross)


def _together(pool: Pool, rest: Array) -> float:
    """Return the correlation of the two forces of a slip, each less its mean over the run."""
    parts = [rest[rows] for rows in pool.rows]
    first, second = np.concatenate([p - p.mean(axis=0) for p in parts if len(p)]).T
    return float(first @ second / (np.sqrt((first @ first) * (second @ second)) or 1.0))


def _cross(baseline: Baseline, rest: Array) -> float:
    """Return the covariance of the two forces of a slip that noise does not make, over the scatter of the coefficients."""
    pool, (sigma_s, sigma_k) = baseline.pool, np.exp(baseline.solution.scatter[:2])
    shared = most = 0.0
    for run, rows in enumerate(pool.rows):
        if len(rows) < 2:
            continue
        load = pool.slips[run].record.mechanism.normal_force
        first, second = (rest[rows] - rest[rows].mean(axis=0)).T / load
        shared += float(first @ second) - (len(rows) - 1) * float(pool.calibrations[run].covariance[0, 1]) / load**2
        most += (len(rows) - 1) * sigma_s * sigma_k
    return float(np.clip(shared / (most or 1.0), -1.0, 1.0))


def _correlation(pool: Pool, rest: Array) -> float:
    total, weight = 0.0, 0
    for rows in pool.rows:
        mine = rest[rows].mean(axis=1)
        if len(mine) < 4:
            continue
        mine = mine - mine.mean()
        total += len(mine) * float(mine[1:] @ mine[:-1]) / (float(mine @ mine) or 1.0)
        weight += len(mine)
    return total / max(weight, 1) * np.sqrt(max(weight, 1))


MODES = ("both", "mu_s", "mu_k", "offset")
"""Wander of both coefficients together, of mu_s alone, of mu_k alone, and of a force that is the same in stick and slip."""
SHARES = (0.001, 0.003, 0.008, 0.02, 0.04, 0.08)
"""Strengths of wander that are tried, over the mean friction, that of an offset over the force at break-away [-]."""
TIMES = (0.7, 1.5, 3.0, 6.0, 15.0)
"""Correlation times that are tried, in cycles [-]."""
REMAINING = (1.0, 0.2, 0.02, 0.0)
"""Shares of the independent scatter that may remain [-]."""


def _wander(baseline: Baseline, rest: Array) -> tuple[float, float, float, str]:
    """Return (score, strength, correlation time, what wanders) of an Ornstein-Uhlenbeck process on the forces."""
    pool = baseline.pool
    static, kinetic = (baseline.regression.load * np.exp(baseline.solution.scatter[:2])) ** 2
    cycle = pool.cycle
    runs: list[tuple[Array, dict[str, Array], Array, Array]] = []
    for r, rows in enumerate(pool.rows):
        if len(rows) < 4:
            continue
        n = len(rows)
        covariance = pool.calibrations[r].covariance
        measured = np.r_[np.full(n, covariance[0, 0]), np.full(n, covariance[1, 1])]
        own = np.r_[np.full(n, static), np.full(n, kinetic)]
        time = np.r_[pool.onset_time[rows], pool.mean_time[rows]]
        value = np.r_[rest[rows, 0], rest[rows, 1]]
        apart = np.abs(time[:, None] - time[None])
        static_level, kinetic_level, none = pool.static[rows], pool.kinetic[rows], np.zeros(n)
        levels = {
            "both": np.r_[static_level, kinetic_level],
            "mu_s": np.r_[static_level, none],
            "mu_k": np.r_[none, kinetic_level],
            "offset": np.r_[static_level, static_level],
        }
        runs.append((np.stack([measured, own]), {m: v[:, None] * v[None] for m, v in levels.items()}, apart, value))

    def cost(remaining: float, share: float, duration: float, mode: str = "both") -> float:
        total = 0.0
        for diagonal, levels, apart, value in runs:
            matrix = np.diag(diagonal[0] + remaining * diagonal[1])
            if share > 0.0:
                matrix = matrix + share**2 * levels[mode] * np.exp(-apart / duration)
            factor = np.linalg.cholesky(matrix)
            white = np.linalg.solve(factor, value)
            total += 0.5 * float(white @ white) + float(np.log(np.diag(factor)).sum())
        return total

    plain = min(cost(a, 0.0, 1.0) for a in (1.3, 1.0, 0.7))
    best = (plain, 0.0, cycle, "both")
    for share in SHARES:
        for count in TIMES:
            for remaining in REMAINING:
                for mode in MODES:
                    trial = cost(remaining, share, count * cycle, mode)
                    if trial < best[0]:
                        best = (trial, share, count * cycle, mode)
    n = len(rest)
    return (
        2.0 * (plain - best[0]) - 2.0 * np.log(max(n, 2)) - 2.0 * np.log(len(SHARES) * len(TIMES) * len(MODES)),
        best[1],
        best[2],
        best[3],
    )
