"""Readings that leave, a few in a row, the curve on which those before and after them lie, and what stands in their place."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline
from scipy.ndimage import binary_closing

from stochfric_mb.numerics.stretches import stretches

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

CURVE, REACH = 3, 1.5
"""Degree of the curve that replaces readings, and how far to both sides it is fitted, over the length of the gap [-]."""
LEAST = 8
"""Readings on each side at least."""
BURST = 12
"""Most readings in a row that a disturbance may reach, the two to either side that see it counted [-]: chosen, of clicks that
ring over four."""
SIDES = 3.0
"""Error of the curve through both sides, over the noise, beyond which it is the motion that is rough there [-]: chosen; noise
alone makes it about one."""


def in_a_row(values: Array, far: Mask, least: float, level: float) -> Mask:
    """Return which readings leave, a few in a row, one curve on which those before and after them lie.

    After a jump that stays, a kick or in an oscillation no curve goes through both sides, and none where so few samples come in
    a period of the motion that it is no cubic over both sides: there single readings alone are told.

    Args:
        values: the readings.
        far: those far off from their neighbours.
        least: such distances from the curve, over their noise, from which a reading is off [-].
        level: noise of these distances, in the unit of the readings.
    """
    joined: Mask = np.asarray(binary_closing(far, np.ones(3)), dtype=np.bool_)
    near = np.flatnonzero(~joined)
    off = np.zeros(len(values), dtype=np.bool_)
    for first, last in stretches(joined):
        at = int(np.searchsorted(near, first))
        around = near[max(at - LEAST, 0) : at + LEAST]
        if last - first > BURST or around[0] > first or around[-1] < last:
            continue
        curve = np.polynomial.Polynomial.fit(around.astype(np.float64), values[around], CURVE)
        if np.std(values[around] - curve(around.astype(np.float64))) < SIDES * level:
            off[first:last] = np.abs(values[first:last] - curve(np.arange(first, last, dtype=np.float64))) > least * level
    return off


def without(values: Array, held: Sequence[tuple[int, int]], off: Mask) -> Array:
    """Return the readings with what is repeated or far off replaced by a curve through those around it."""
    bad = off.copy()
    for start, end in held:
        bad[start:end] = True
    good, better = np.flatnonzero(~bad), values.copy()
    if len(good) < 0.5 * len(values):
        return CubicSpline(good, values[good])(np.arange(len(values)))
    for start, end in stretches(bad):
        at = int(np.searchsorted(good, start))
        reach = max(LEAST, round(REACH * (end - start)))
        known = good[max(at - reach, 0) : at + reach]
        gap = np.arange(start, end)
        curve = np.polynomial.Polynomial.fit(known.astype(np.float64), values[known], CURVE)
        better[start:end] = curve(gap.astype(np.float64))
    return better
