"""Bounded least squares by Levenberg and Marquardt, for many residuals and few numbers.

The normal equations of a handful of scaled numbers are solved directly, so that a fit costs little more than its evaluations.
Derivatives are differences of a stated size: simulated errors are too rough for the smallest ones.

Reference: J. J. More, in Numerical Analysis, Lecture Notes in Mathematics 630, Springer 1978, 105-116, doi 10.1007/BFb0067700.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.inference.threads import in_threads

Array = npt.NDArray[np.float64]

DAMPING, LEAST_DAMPING, CHANGE = 1.0e-4, 1.0e-9, 10.0
"""Damping at the start and at least, over the curvature, and the factor by which it falls after a step that
helped and rises after one that did not [-]."""
WIDEST = 1.0
"""Widest difference, in the numbers' own unit [-]."""
STRAIGHT = 1.0e-6
"""Fall of the cost over itself by a last step so short that the derivatives are as they were [-]."""


@dataclasses.dataclass(frozen=True)
class Minimum:
    """Where a fit ended."""

    x: Array
    """The numbers, shape (p,)."""
    jacobian: Array
    """Derivatives of the residuals there or, if the last step changed next to nothing, where it began, weighted as the loss
    weights them, shape (n, p)."""
    cost: float
    """Half the sum of squares, or of the loss."""


def minimised(
    errors: Callable[[Array], Array],
    first: Array,
    low: Array,
    high: Array,
    *,
    difference: float,
    evaluations: int,
    tolerance: float,
    outlying: float | Array = np.inf,
    stride: float | Array = np.inf,
    telling: float = 0.0,
    threads: bool = False,
) -> Minimum:
    """Return where the sum of squares is smallest; where it or its slopes are no numbers, the last point at which they were.

    Args:
        errors: from numbers, shape (p,), to residuals, shape (n,).
        first: where to begin, shape (p,); moved between the bounds.
        low: lower bounds, shape (p,).
        high: upper bounds, shape (p,).
        difference: step of the finite differences, in the numbers' own unit.
        evaluations: most iterations.
        tolerance: relative fall of the cost, seen or promised by the slopes, below which it ends [-].
        outlying: residuals beyond this, one for all or shape (n,), count by their size, not its square: the loss is
            C^2 (sqrt(1 + (r/C)^2) - 1).
        stride: largest change of a number in one iteration, one for all or shape (p,): a step that is longer is shortened.
        telling: change of the residuals that a difference has to make, to be told from their roughness; one that makes less is
            widened from one iteration to the next, up to `WIDEST`.
        threads: whether derivatives are taken in several threads, where compiled code makes the residuals: they stay the same.
    """
    anew = functools.partial(_slopes, errors, low=low, high=high, threads=threads)
    x = np.clip(first, low, high)
    rest = errors(x)
    cost = _cost(rest, outlying)
    slopes = anew(x, rest, np.full(len(x), difference))
    damping = DAMPING
    for _ in range(evaluations):
        if not (np.isfinite(cost) and np.isfinite(slopes).all()):
            break
        weighted, pull = _weighted(slopes, rest, outlying)
        gradient = weighted.T @ pull
        free = ~(((x <= low) & (gradient > 0.0)) | ((x >= high) & (gradient < 0.0)))
        matrix = (weighted.T @ weighted)[np.ix_(free, free)]
        size = np.diag(matrix) + 1.0e-300
        while True:
            step = np.zeros(len(x))
            step[free] = -np.linalg.lstsq(matrix + np.diag(damping * size), gradient[free], rcond=1.0e-14)[0]
            step /= max(1.0, float(np.max(np.abs(step) / stride, initial=0.0)))
            trial = np.clip(x + step, low, high)
            new = errors(trial)
            after = _cost(new, outlying)
            promised = -float(gradient[free] @ step[free] + 0.5 * step[free] @ matrix @ step[free])
            if after < cost or not promised > tolerance * cost:
                break
            damping *= CHANGE
        if not after < cost:
            break
        fall, x, rest, cost = cost - after, trial, new, after
        damping = max(damping / CHANGE, LEAST_DAMPING)
        done = fall < tolerance * (cost + fall)
        if not done or fall > STRAIGHT * (cost + fall):
            slopes = anew(x, rest, _told(slopes, telling, difference))
        if done:
            break
    return Minimum(x, _weighted(slopes, rest, outlying)[0], cost)


def _told(slopes: Array, telling: float, difference: float) -> Array:
    """Return the differences at which each number changes the residuals by ``telling``, shape (p,)."""
    size = np.linalg.norm(slopes, axis=0)
    return np.clip(telling / np.maximum(size, telling / WIDEST + 1.0e-300), difference, max(WIDEST, difference))


def _cost(rest: Array, outlying: float | Array) -> float:
    return float(np.sum(loss(rest, outlying)))


def loss(rest: Array, outlying: float | Array) -> Array:
    """Return the loss of residuals, half their squares or, of those beyond ``outlying``, about their size times that."""
    squares = rest**2
    # the same as C^2 (sqrt(1 + (r/C)^2) - 1), without the difference
    with np.errstate(invalid="ignore"):
        value = squares / (1.0 + np.sqrt(1.0 + squares / np.asarray(outlying) ** 2))
    return np.where(np.isposinf(squares), np.inf, value)


def _weighted(slopes: Array, rest: Array, outlying: float | Array) -> tuple[Array, Array]:
    """Return derivatives and residuals weighted such that Gauss and Newton's equations are those of the loss.

    Reference: B. Triggs, P. McLauchlan, R. Hartley, A. Fitzgibbon, Bundle adjustment, 2000, section 4.3.
    """
    z = 1.0 + np.where(np.isinf(outlying), 0.0, rest / np.minimum(outlying, np.finfo(float).max)) ** 2
    return slopes * z[:, None] ** -0.75, rest * z**0.25


def _slopes(
    errors: Callable[[Array], Array], at: Array, here: Array, differences: Array, *, low: Array, high: Array, threads: bool
) -> Array:
    def column(j: int) -> Array:
        moved = at.copy()
        moved[j] += differences[j] if at[j] + differences[j] <= high[j] else -differences[j]
        if moved[j] < low[j]:  # the bounds are closer together than the step, which is then what fits between them
            moved[j] = high[j] if high[j] - at[j] > at[j] - low[j] else low[j]
        with np.errstate(invalid="ignore"):  # errors that are infinite have no slopes
            return (errors(moved) - here) / (moved[j] - at[j])

    columns = in_threads(column, range(len(at))) if threads else [column(j) for j in range(len(at))]
    return np.stack(columns, axis=1) if columns else np.zeros((len(here), 0))
