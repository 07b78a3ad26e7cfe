"""Spread that a few wild values do not move."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

PER_MEDIAN = 1.482602218505602
"""Standard deviation of a normal law over the median of abs(x - centre) [-]: 1/quantile(3/4)."""


def deviation(values: npt.ArrayLike, *, about: float | None = None, axis: int | None = None) -> Any:
    """Return the standard deviation that normal values of this median distance from their centre would have.

    >>> deviation([1.0, 2.0, 3.0, 4.0, 1.0e9])
    1.482602218505602

    Args:
        values: numbers.
        about: their centre; their median if not given.
        axis: axis along which to take it; all values at once if not given.
    """
    x = np.asarray(values, dtype=np.float64)
    away = np.abs(x - (np.median(x, axis=axis, keepdims=True) if about is None else about))
    spread = PER_MEDIAN * np.median(away, axis=axis)
    return float(spread) if axis is None else spread
