"""Timing: whether the motion comes later in the record than the force that drives it; asked before friction is judged.

A delay looks like friction: m q''(t - T) has a part along q', and so has the rest of the balance. It is therefore judged
with a generous friction law in the balance, so that what is left for it is timing.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.joints.fitting import independent_count
from stochfric_mb.discovery.joints.sheet import Nuisance, Sheet

Array = npt.NDArray[np.float64]

LONGEST = 0.05
"""Longest delay that is looked for, either way [s]."""
GRID = 41
"""Delays on the first grid."""
LEAST_SAMPLES = 1.5
"""A delay of fewer samples is how signals are sampled and held, and is not called one."""
NAMED = 20.0
"""Score above which a delay is named."""
MATERIAL = 0.03
"""Least part of the error that a delay must take away."""


@dataclasses.dataclass(frozen=True)
class Timing:
    """By how much the position comes after the driving force in the record."""

    seconds: float
    """The delay [s]; negative: the force comes later."""
    low: float
    """Lower end of its 95 % interval [s]."""
    high: float
    """Upper end of its 95 % interval [s]."""
    score: float
    """Evidence: n ln(S_0/S) - ln n - 2 ln(grid size), n counting independent windows."""
    gain: float
    """Part of the error (rms) that it takes away [-]."""
    named: bool
    """Whether it is a finding, and compensated."""


def timing(make: Callable[[float], Sequence[Sheet]], nuisances: Sequence[Nuisance], interval: float) -> Timing:
    """Return the delay between drive and motion.

    Args:
        make: delay [s] -> the sheets to learn from, that delay compensated.
        nuisances: numbers of the mechanism with their priors; they are free here.
        interval: distance between samples [s].
    """
    span = min(LONGEST, 40.0 * interval)
    grid = np.linspace(-span, span, GRID)
    names = [n.name for n in nuisances]
    errors = np.array([_left(make(d), names)[0] for d in grid])
    best = int(np.argmin(errors))
    step = grid[1] - grid[0]
    fine = np.linspace(grid[best] - step, grid[best] + step, 9)
    finer = np.array([_left(make(d), names)[0] for d in fine])
    delay = float(fine[int(np.argmin(finer))])
    rest, n = _left(make(delay), names)
    still, _ = _left(make(0.0), names)
    score = n * np.log(still / rest) - np.log(n) - 2.0 * np.log(GRID)
    # S(T) = S (1 + (T - T0)^2 curvature): one standard deviation raises n S by S
    curvature = max((errors[best - 1 : best + 2].max() / rest - 1.0) / step**2, 1.0e-12) if 0 < best < GRID - 1 else 1.0e-12
    deviation = float(1.0 / np.sqrt(n * curvature))
    gain = 1.0 - float(np.sqrt(rest / still))
    inside = 0 < best < GRID - 1
    named = bool(inside and score > NAMED and gain > MATERIAL and abs(delay) > LEAST_SAMPLES * interval)
    return Timing(delay, delay - 1.96 * deviation, delay + 1.96 * deviation, float(score), gain, named)


def _left(sheets: Sequence[Sheet], names: Sequence[str]) -> tuple[float, float]:
    """Return the mean square that a generous friction law leaves, and the number of independent windows."""
    columns = np.concatenate([_generous(s, names)[s.sliding] for s in sheets])
    driven = np.concatenate([s.driven[s.sliding] for s in sheets])
    scaled = columns / np.maximum(np.linalg.norm(columns, axis=0), 1.0e-300)
    rest = driven - scaled @ np.linalg.lstsq(scaled, driven, rcond=1.0e-10)[0]
    ends = np.cumsum([int(s.sliding.sum()) for s in sheets])[:-1]
    return float(np.mean(rest**2)), max(sum(independent_count(r) for r in np.split(rest, ends)), 4.0)


def _generous(sheet: Sheet, names: Sequence[str]) -> Array:
    v, side = sheet.velocity, np.sign(sheet.velocity)
    top = max(float(np.quantile(np.abs(v), 0.95)), 1.0e-12)
    friction = (side, side * np.exp(-np.abs(v) / (0.1 * top)), v, v * np.abs(v), np.abs(v), side * sheet.load)
    known = [sheet.columns[n] for n in names if n in sheet.columns]
    one = np.ones(len(sheet.driven))
    return np.column_stack([one, *known, *(sheet.window.at_centres(x) for x in friction)])
