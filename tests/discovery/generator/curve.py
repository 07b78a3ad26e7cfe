"""Tables over one variable: the shape of any effect, handed to the compiled simulator as numbers."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Curve(NamedTuple):
    """Values at equal spacing; linear between them; repeated if periodic, otherwise continued linearly beyond the ends."""

    origin: float
    spacing: float
    periodic: bool
    values: Array


def constant(value: float) -> Curve:
    """The same value everywhere."""
    return Curve(0.0, 1.0, False, np.full(2, float(value)))


def line(slope: float) -> Curve:
    """Slope times the variable."""
    return Curve(-1.0, 2.0, False, np.array([-slope, slope]))


def tabulate(function: Callable[[Array], Array], low: float, high: float, n: int = 4001) -> Curve:
    """The function at n points from low to high."""
    points = np.asarray(np.linspace(low, high, n), dtype=np.float64)
    return Curve(float(low), (high - low) / (n - 1), False, np.asarray(function(points), dtype=np.float64))


def tabulate_period(function: Callable[[Array], Array], length: float, n: int = 2000) -> Curve:
    """The function over one period of the given length, repeated for ever."""
    points = np.asarray(np.arange(n) * (length / n), dtype=np.float64)
    return Curve(0.0, length / n, True, np.ascontiguousarray(function(points), dtype=np.float64))


def slope(curve: Curve) -> float:
    """Slope of a straight curve."""
    return float((curve.values[-1] - curve.values[0]) / (curve.spacing * (curve.values.size - 1)))
