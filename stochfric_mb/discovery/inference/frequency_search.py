"""Frequencies in long records: looked for in a shorter stretch first, then followed as the stretch grows to the whole record.

A record of length T resolves frequencies 1/T apart, and each costs all of its samples: T^2. A wave that shows in a stretch is
found there to 1/stretch; twice the stretch needs its neighbourhood alone. Slow waves wait for a stretch that holds some.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

FEWEST_WAVES = 10.0
"""Waves in a stretch below which a frequency waits for a longer one [-]."""
KEPT = 4
"""Best frequencies of a stretch that are followed."""
REACH = 4
"""Steps of the finer grid that are looked at on either side: the error of the coarser one, twice."""


def worth_a_look(
    gains: Callable[[Array, float], Array], whole: Array, *, duration: float, stretch: float, fineness: float
) -> Array:
    """Return the frequencies of a record at which a wave may stand out [Hz]: all of them where the record is short.

    Args:
        gains: frequencies [Hz] and length of a stretch [s] -> what waves would explain there, shape as the frequencies.
        whole: the record's own grid [Hz], shape (n,), rising.
        duration: length of the record [s].
        stretch: length of the first stretch [s].
        fineness: distance of frequencies in a stretch is 1/(fineness times its length) [-].
    """
    if duration <= stretch or not len(whole):
        return whole
    lowest = FEWEST_WAVES / stretch
    grid = np.arange(lowest, whole[-1], 1.0 / (fineness * stretch))
    best = _best(grid, gains(grid, stretch)) if len(grid) else grid
    while stretch < duration:
        stretch = min(2.0 * stretch, duration)
        slower = FEWEST_WAVES / stretch if stretch < duration else float(whole[0])
        step = 1.0 / (fineness * stretch)
        near = (best[:, None] + step * np.arange(-REACH, REACH + 1)).ravel()
        grid = np.unique(np.r_[np.arange(slower, lowest, step), near])
        best, lowest = _best(grid, gains(grid, stretch)), slower
    return np.sort(best)


def _best(grid: Array, gains: Array) -> Array:
    """Return the frequencies of the highest peaks, shape (KEPT,) or less."""
    peak = (gains >= np.r_[-np.inf, gains[:-1]]) & (gains >= np.r_[gains[1:], -np.inf])
    at = np.flatnonzero(peak)
    return grid[at[np.argsort(-gains[at], kind="stable")[:KEPT]]]
