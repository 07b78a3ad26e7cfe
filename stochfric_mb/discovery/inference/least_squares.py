"""Bounded least squares with differences of a stated size: simulated errors are too rough for the smallest ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from stochfric_mb.discovery.stick_slip.records.record import Array


def minimised(
    errors: Callable[[Array], Array], first: Array, low: Array, high: Array, *, difference: float, **options: Any
) -> Any:
    """Return SciPy's result of least squares.

    Args:
        errors: from numbers, shape (p,), to residuals, shape (n,).
        first: where to begin, shape (p,); moved between the bounds.
        low: lower bounds, shape (p,).
        high: upper bounds, shape (p,).
        difference: step by which the derivatives are found, in the numbers' own unit.
        options: further arguments of `scipy.optimize.least_squares`.
    """
    last: list[tuple[Array, Array]] = []

    def values(at: Array) -> Array:
        found = errors(at)
        last[:] = [(at.copy(), found)]
        return found

    def slopes(at: Array) -> Array:
        here = last[0][1] if last and np.array_equal(last[0][0], at) else errors(at)
        columns: list[Array] = []
        for j in range(len(at)):
            step = difference if at[j] + difference <= high[j] else -difference
            # where the bounds are closer together than the step, the step is what fits between them
            moved = at.copy()
            moved[j] = min(max(at[j] + step, low[j]), high[j])
            columns.append((errors(moved) - here) / (moved[j] - at[j]))
        return np.stack(columns, axis=1)

    more: dict[str, Any] = {"jac": slopes, "bounds": (low, high), **options}
    return least_squares(values, np.clip(first, low, high), **more)
