"""Friction that switches: it stays at a level, jumps, and stays again. No effect of the vocabulary does that at random.

Independent draws, a random drift, a drift and a ripple all change from every slip to the next, each in its way; a friction
that is at rest between jumps is distinguished from them by the slips alone, without a model. Two signs of it are looked for, in
the onset force and in the mean force in slip:

- two levels: the slips of each run fall into two groups, which lie further apart than any even distribution puts them;
- jumps: most slips repeat the one before, and some differ from it by far more than that.

Steps of a sensor jump once or twice, and a square ripple at regular intervals of time or belt travel; both have names.
"""

from __future__ import annotations

import dataclasses

import numpy as np
from scipy.special import gammaln

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline
from stochfric_mb.numerics.robust import deviation

PHASES, DUTIES = 24, (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
"""Phases and shares of the upper level of the alternations that are tried."""
SWITCHES = Where("scatter, time", "friction switches between two levels, at no regular intervals")
"""Where friction with two levels disagrees."""
JUMPS = Where("scatter, time", "friction stays at one level for some slips, jumps, and stays at another")
"""Where friction that is at rest between jumps disagrees."""


@dataclasses.dataclass(frozen=True)
class Switching:
    """What the slips tell of levels and jumps; the larger of onset force and mean force in slip."""

    separation: float
    """Distance of two levels over their width [-]."""
    changes: float
    """Changes of level a run [-]."""
    regular: bool
    """Whether the levels alternate regularly in time or along the belt."""
    rarer: int
    """Slips at the rarer level of their run."""
    jumps: int
    """Changes from one slip to the next that are far larger than most."""
    still: float
    """Share of the changes that are none [-]."""

    @property
    def two_levels(self) -> bool:
        """Whether friction switches at random between two levels."""
        apart = self.separation > criteria.LEVELS_APART and self.rarer >= criteria.FEWEST_ALIKE
        return apart and self.changes > criteria.STEPS_OF_A_SENSOR and not self.regular

    @property
    def at_rest_between_jumps(self) -> bool:
        """Whether friction stays where it is most of the time, and jumps."""
        return self.jumps >= criteria.FEWEST_JUMPS and self.still >= 1.0 - criteria.MOST_JUMPS

    @property
    def where(self) -> Where | None:
        """Where a friction that switches at random disagrees with any that does not; None where it does not switch so."""
        if self.two_levels:
            return SWITCHES
        return JUMPS if self.at_rest_between_jumps and not self.regular else None


def switching(pool: Pool, residuals: Array) -> Switching:
    """Return what residuals of the features [N], shape (n, N_FEATURES), tell of levels and jumps."""
    finest = _finest(pool)
    levels = [_levels(pool, residuals[:, c], finest[:, c]) for c in (0, 1)]
    separation, column = max((levels[c][0], c) for c in (0, 1))
    upper = levels[column][1]
    changes = float(np.mean([np.count_nonzero(np.diff(upper[m])) for m in pool.rows]))
    regular = separation > criteria.LEVELS_APART and _regular(pool, upper)
    rarer = sum(min(int(upper[m].sum()), int((~upper[m]).sum())) for m in pool.rows)
    jumps, still = max((_jumps(pool, residuals[:, c], finest[:, c]) for c in (0, 1)), key=lambda j: j[0])
    return Switching(separation, changes, regular, rarer, jumps, still)


def levels_score(baseline: Baseline, jumps: bool = False) -> float:
    """Return the evidence for levels of friction between which slips change without a rule [-].

    Which slip is at which level costs the logarithm of the number of ways in which as many changes may fall.

    Args:
        baseline: what is known of the slips.
        jumps: False: two levels, each run's own; True: after each jump another one.
    """
    pool, residuals = baseline.pool, baseline.residuals()
    finest = _finest(pool)
    values: list[float] = []
    for column in (0, 1):
        upper = _levels(pool, residuals[:, column], finest[:, column])[1]
        columns, cost = list[Array](), 0.0
        for run, rows in enumerate(pool.rows):
            if not len(rows):  # none of its slips counts
                continue
            changed = _jumped(residuals[rows, column], finest[run, column]) if jumps else np.diff(upper[rows])
            after = np.r_[0, np.cumsum(changed)]
            levels = [after == k for k in range(1, int(after[-1]) + 1)] if jumps else [upper[rows]]
            for there in levels:
                mine = np.zeros(len(residuals))
                mine[rows[there]] = 1.0
                columns += [pool.column(pool.static * mine, None), pool.column(None, pool.kinetic * mine)]
            n, changes = len(rows), int(np.count_nonzero(changed))
            cost += 2.0 * len(levels) * baseline.price + 2.0 * float(gammaln(n) - gammaln(changes + 1) - gammaln(n - changes))
        values.append(2.0 * (baseline.solution.cost - baseline.fitted(columns).cost) - cost)
    return max(values)


def _finest(pool: Pool) -> Array:
    """Return what the extraction itself scatters of onset force and mean force in slip [N], shape (runs, 2): no change."""
    return np.stack([np.sqrt(np.diag(c.covariance)[:2]) for c in pool.calibrations])


def _levels(pool: Pool, values: Array, finest: Array) -> tuple[float, np.ndarray]:
    """Return the distance of two levels over their width in a typical run, and which slips are at the upper one."""
    upper = np.zeros(len(values), dtype=bool)
    distances, weights = list[float](), list[int]()
    for run, rows in enumerate(pool.rows):
        if len(rows) < 4:
            continue
        mine = values[rows]
        low, high = _halves(np.sort(mine))
        upper[rows] = np.abs(mine - np.median(high)) < np.abs(mine - np.median(low))
        away = np.concatenate([np.abs(part - np.median(part)) for part in (low, high)])
        width = deviation(np.maximum(away, 0.67 * finest[run]), about=0.0)
        # run by run: in a run whose slips are locked to a ripple all are alike, which tells nothing of the others
        distances.append(float(np.median(high) - np.median(low)) / width)
        weights.append(len(rows))
    if sum(weights) < criteria.LEVELS_FEWEST:
        return 0.0, upper
    return float(np.median(distances)), upper


def _halves(values: Array) -> tuple[Array, Array]:
    """Return sorted values cut in two where that leaves the least variance within the parts."""
    n = len(values)
    count = np.arange(1, n)
    sums = np.cumsum(values)[:-1]
    explained = sums**2 / count + (values.sum() - sums) ** 2 / (n - count)
    cut = int(np.argmax(explained)) + 1
    return values[:cut], values[cut:]


def _jumps(pool: Pool, values: Array, finest: Array) -> tuple[int, float]:
    """Return the number of jumps, and the share of changes that are none; runs are in units of their own small changes."""
    changes = [_jumped(values[rows], finest[run]) for run, rows in enumerate(pool.rows) if len(rows) >= 4]
    if sum(map(len, changes)) < criteria.LEVELS_FEWEST:
        return 0, 1.0
    jumped = np.concatenate(changes)
    return int(np.count_nonzero(jumped)), float(1.0 - jumped.mean())


def _jumped(values: Array, finest: float) -> np.ndarray:
    """Return which changes between the slips of a run are jumps, shape (n - 1,)."""
    if len(values) < 4:
        return np.zeros(max(len(values) - 1, 0), dtype=bool)
    steps = np.abs(np.diff(values))
    jumps = steps > criteria.LEVEL_JUMP * max(deviation(steps, about=0.0), np.sqrt(2.0) * finest)
    # a single slip that stands out is an accident: after it friction is where it was
    back = jumps[1:] & jumps[:-1] & (np.abs(values[2:] - values[:-2]) < np.minimum(steps[1:], steps[:-1]) / 2.0)
    return np.asarray(jumps & ~(np.r_[back, False] | np.r_[False, back]))


def _regular(pool: Pool, upper: np.ndarray) -> bool:
    """Return whether the levels alternate at regular intervals of time or of belt travel."""
    rate = max(1.0 / s.cycle for s in pool.slips)
    # short of every other slip: that is no ripple
    grid = np.arange(2.0 / pool.duration, 0.45 * rate, 0.1 / pool.duration)
    belt = float(pool.belt_velocity.min())
    travel = (pool.belt_velocity * pool.onset_time - pool.typical_onset) / belt
    rows = pool.rows
    rarer = sum(min(int(upper[m].sum()), int((~upper[m]).sum())) for m in rows)
    for place in (pool.onset_time, travel):
        missed = np.zeros((len(DUTIES), len(grid)))
        for m in rows:
            missed += _out_of_step(grid, place[m], upper[m])
        if missed.size and missed.min() <= criteria.OUT_OF_STEP * rarer:
            return True
    return False


def _out_of_step(grid: Array, place: Array, upper: np.ndarray) -> Array:
    """Return how many slips of a run are at another level than the best phase has it, shape (duties, frequencies)."""
    least = np.full((len(DUTIES), len(grid)), len(place))
    for phase in np.arange(PHASES) / PHASES:
        cycles = (grid[:, None] * place + phase) % 1.0
        for i, duty in enumerate(DUTIES):
            np.minimum(least[i], np.count_nonzero((cycles < duty) != upper, axis=1), out=least[i])
    return least
