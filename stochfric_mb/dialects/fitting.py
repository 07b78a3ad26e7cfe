"""Fitting one curve to another: positive parameters, on their logarithms, by a simplex search."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize

from stochfric_mb.errors import InputError

Array = npt.NDArray[np.float64]

REFUSED = 1.0e6
"""Misfit of parameters that cannot be."""
WEIGHT = 4.0
"""Weight of the coefficient at break-away against that of one speed: chosen, so that it is met where it can be."""


def fit(
    model: Callable[[Array], tuple[Array, float]], start: Sequence[float], target: Array, break_away: float
) -> tuple[Array, float]:
    """Return positive parameters whose curve comes nearest, and their root-mean-square misfit [-].

    Args:
        model: parameters -> (coefficient at the speeds [-], coefficient at break-away [-]); may raise `InputError`.
        start: where the search begins, each > 0.
        target: coefficients to meet [-], shape (n,).
        break_away: coefficient at break-away to meet [-].
    """

    def misfit(logarithms: Array) -> float:
        try:
            mu, peak = model(np.exp(logarithms))
        except (InputError, OverflowError, FloatingPointError):
            return REFUSED
        total = np.sum((mu - target) ** 2) + WEIGHT * (peak - break_away) ** 2
        return float(np.sqrt(total / (len(target) + WEIGHT))) if np.isfinite(total) else REFUSED

    x = np.log(np.maximum(np.asarray(start, dtype=np.float64), 1.0e-12))
    least = misfit(x)
    for _ in range(3):  # a simplex that has shrunk is spread out again
        minimum = minimize(misfit, x, method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 1e-12, "maxiter": 400 * len(x)})
        x, least = minimum.x, float(minimum.fun)
    return np.exp(x), least


def half_way(speed: Array, mu: Array) -> float:
    """Return the speed [m/s] at which the coefficient has fallen half way from its highest to its last value."""
    top = int(np.argmax(mu))
    below = np.flatnonzero(mu[top:] <= 0.5 * (mu[top] + mu[-1]))
    return float(speed[top + below[0]]) if len(below) else float(speed[-1])


def viscous(value: float, top_speed: float, force: float) -> float:
    """Return a viscous coefficient [N s/m], 0 where it makes less than a millionth of the force [N] at the highest speed."""
    return float(value) if value * top_speed > 1.0e-6 * force else 0.0
