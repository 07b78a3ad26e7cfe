"""Levenberg's and Marquardt's least squares for many residuals and few numbers, with bounds.

The normal equations of a handful of scaled numbers are solved directly; that is all the algebra there is, so that a fit
costs little more than its evaluations.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

STEP = 1.0e-4
"""Step of the difference quotients [scales]."""
TRIES = 6
"""Times that damping is raised before a step is given up."""


def least_squares(
    errors: Callable[[Array], Array], low: Array, high: Array, *, evaluations: int, tolerance: float = 1.0e-7
) -> tuple[Array, Array]:
    """Return the steps from 0 that minimise the sum of squares, and the Jacobian there.

    Args:
        errors: steps, shape (k,) in natural scales -> residuals, shape (n,).
        low: smallest steps, shape (k,), <= 0.
        high: largest steps, shape (k,), >= 0.
        evaluations: most iterations.
        tolerance: relative fall of the sum of squares below which it ends.
    """
    x = np.zeros(len(low))
    rest = errors(x)
    jacobian = _jacobian(errors, x, rest, high)
    damping = 1.0e-4
    for _ in range(evaluations):
        cost = float(rest @ rest)
        gradient = jacobian.T @ rest
        free = ~(((x <= low) & (gradient > 0.0)) | ((x >= high) & (gradient < 0.0)))
        matrix = (jacobian.T @ jacobian)[np.ix_(free, free)]
        size = np.diag(matrix) + 1.0e-300
        for _ in range(TRIES):
            step = np.zeros(len(x))
            step[free] = -np.linalg.lstsq(matrix + np.diag(damping * size), gradient[free], rcond=1.0e-14)[0]
            trial = np.clip(x + step, low, high)
            new = errors(trial)
            if float(new @ new) < cost:
                break
            damping *= 10.0
        else:
            break
        x, rest = trial, new
        damping = max(damping / 10.0, 1.0e-9)
        jacobian = _jacobian(errors, x, rest, high)
        if cost - float(rest @ rest) < tolerance * cost:
            break
    return x, jacobian


def _jacobian(errors: Callable[[Array], Array], x: Array, rest: Array, high: Array) -> Array:
    columns: list[Array] = []
    for i in range(len(x)):
        h = STEP if x[i] + STEP <= high[i] else -STEP
        moved = x.copy()
        moved[i] += h
        columns.append((errors(moved) - rest) / h)
    return np.column_stack(columns)
