"""Marginal distributions of a coefficient, each a function of a standard normal (so that any process can use it)."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError, require_number

QUANTILES = 257
"""Number of equally spaced quantiles that stand for an empirical distribution."""


@dataclasses.dataclass(frozen=True)
class Distribution:
    """A marginal distribution; mean and standard deviation come from the law and the process."""

    kind: ClassVar[str]
    """Name in scenario files."""
    code: ClassVar[float]
    """Number of the distribution in compiled code."""
    equation: ClassVar[str]
    """The distribution in one line, z standard normal."""

    @property
    def low(self) -> float:
        """Lower bound [-]; draws below it are not accepted."""
        return -math.inf

    @property
    def high(self) -> float:
        """Upper bound [-]; draws above it are not accepted."""
        return math.inf

    def quantile_table(self) -> npt.NDArray[np.float64]:
        """Return the quantiles that compiled code interpolates, shape (0,) or (QUANTILES,)."""
        return np.empty(0)


@dataclasses.dataclass(frozen=True)
class Normal(Distribution):
    """The paper's choice: mu = mean + sigma z."""

    kind: ClassVar[str] = "normal"
    code: ClassVar[float] = 0.0
    equation: ClassVar[str] = "mean + sigma z"


@dataclasses.dataclass(frozen=True)
class TruncatedNormal(Distribution):
    """A normal within bounds; ``mean`` and ``sigma`` are those of the normal before it is truncated.

    Independent draws are redrawn outside; correlated processes take the quantile function at Phi(z). Both have the truncated
    normal's distribution.
    """

    lower: float = 0.0
    """Lower bound [-]."""
    upper: float = math.inf
    """Upper bound [-], > lower."""

    kind: ClassVar[str] = "truncated_normal"
    code: ClassVar[float] = 0.0
    equation: ClassVar[str] = "mean + sigma z given lower <= mu <= upper"

    def __post_init__(self) -> None:
        if not self.lower < self.upper:
            raise InputError(f"bounds {self.lower:g} .. {self.upper:g} are empty; lower must be below upper")

    @property
    def low(self) -> float:
        """Lower bound [-]."""
        return self.lower

    @property
    def high(self) -> float:
        """Upper bound [-]."""
        return self.upper


@dataclasses.dataclass(frozen=True)
class Lognormal(Distribution):
    """A lognormal of the given mean and standard deviation."""

    kind: ClassVar[str] = "lognormal"
    code: ClassVar[float] = 1.0
    equation: ClassVar[str] = "exp(ln mean - s^2/2 + s z), s^2 = ln(1 + sigma^2/mean^2)"


@dataclasses.dataclass(frozen=True)
class Uniform(Distribution):
    """A uniform distribution of the given mean and standard deviation."""

    kind: ClassVar[str] = "uniform"
    code: ClassVar[float] = 2.0
    equation: ClassVar[str] = "mean + sqrt(3) sigma (2 Phi(z) - 1)"


@dataclasses.dataclass(frozen=True)
class Empirical(Distribution):
    """The distribution of measured coefficients; the law's mean and the process's sigma do not enter."""

    values: tuple[float, ...]
    """Measured coefficients [-], at least 10 of them."""

    kind: ClassVar[str] = "empirical"
    code: ClassVar[float] = 3.0
    equation: ClassVar[str] = "quantile function of the data at Phi(z)"

    def __post_init__(self) -> None:
        if len(self.values) < 10:
            raise InputError(f"{len(self.values)} values are too few for an empirical distribution; give at least 10")
        for i, value in enumerate(self.values):
            require_number(f"value {i} of an empirical distribution", value, low=0.0)

    def quantile_table(self) -> npt.NDArray[np.float64]:
        """Return the QUANTILES equally spaced quantiles of the data."""
        return np.quantile(np.array(self.values), np.linspace(0.0, 1.0, QUANTILES))


DISTRIBUTIONS: dict[str, type[Distribution]] = {d.kind: d for d in (Normal, TruncatedNormal, Lognormal, Uniform, Empirical)}
"""Kind of a distribution -> its class."""


@compiled
def transform(z, code, mean, sigma, table, start, count):
    """Return the coefficient [-] that belongs to the standard normal z.

    Args:
        z: standard normal.
        code: number of the distribution.
        mean: mean [-].
        sigma: standard deviation [-].
        table: array that holds the quantiles of an empirical distribution.
        start: index of the first quantile.
        count: number of quantiles.
    """
    if code == 0.0:
        return mean + sigma * z
    if code == 1.0:
        s2 = math.log(1.0 + (sigma / mean) ** 2)
        return math.exp(math.log(mean) - 0.5 * s2 + math.sqrt(s2) * z)
    phi = 0.5 * math.erfc(-z / 1.4142135623730951)
    if code == 2.0:
        return mean + 1.7320508075688772 * sigma * (2.0 * phi - 1.0)
    r = phi * (count - 1)
    i = min(int(r), count - 2)
    return table[start + i] + (r - i) * (table[start + i + 1] - table[start + i])


@compiled
def truncated(z, mean, sigma, low, high):
    """Return the value [-] of a normal truncated to [low, high] that belongs to the standard normal z: F^-1(Phi(z)).

    Tails are summed from the side on which they are small, so that bounds far from the mean lose no digits.

    Args:
        z: standard normal.
        mean: mean [-] of the normal before it is truncated.
        sigma: its standard deviation [-].
        low: lower bound [-], or minus infinity.
        high: upper bound [-], or infinity.
    """
    if sigma <= 0.0:
        return min(max(mean, low), high)
    a, b = (low - mean) / sigma, (high - mean) / sigma
    before, after = lower_tail(z), lower_tail(-z)
    p = lower_tail(a) * after + lower_tail(b) * before
    q = lower_tail(-a) * after + lower_tail(-b) * before
    x = tail_quantile(p) if p < q else -tail_quantile(q)
    return min(max(mean + sigma * x, low), high)


@compiled
def lower_tail(x):
    """Return Phi(x), the probability of a standard normal below x."""
    return 0.5 * math.erfc(-x / 1.4142135623730951)


@compiled
def tail_quantile(p):
    """Return the x <= 0 with Phi(x) = p, p <= 1/2: a rational first guess, and three of Halley's steps (rounding remains).

    Reference: Abramowitz and Stegun 1964, 26.2.23 (error below 4.5e-4).
    """
    if p <= 1.0e-300:
        return -37.0
    t = math.sqrt(-2.0 * math.log(p))
    x = (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t
    for _ in range(3):
        u = (lower_tail(x) - p) * 2.5066282746310002 * math.exp(0.5 * x * x)
        x -= u / (1.0 + 0.5 * x * u)
    return x
