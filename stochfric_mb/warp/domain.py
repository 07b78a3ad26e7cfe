"""Domain randomisation: what each world draws for itself when an episode begins."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
import warp as wp

from stochfric_mb.coefficients import Distribution, Normal
from stochfric_mb.coefficients.distributions import QUANTILES
from stochfric_mb.coefficients.processes import NORMAL, PerEvent
from stochfric_mb.errors import InputError, require_name, require_number
from stochfric_mb.laws import Law

PLACE = wp.constant(0)
CODE = wp.constant(1)
MEAN = wp.constant(2)
SIGMA = wp.constant(3)
LOW = wp.constant(4)
HIGH = wp.constant(5)
SPREAD = wp.constant(6)
"""Entries of a spread before its quantiles: place among the parameters, distribution, mean, deviation, bounds."""


@dataclasses.dataclass(frozen=True)
class Spread:
    """How a parameter scatters over worlds and episodes, around the law's own value."""

    sigma: float
    """Standard deviation, in the parameter's unit, >= 0."""
    distribution: Distribution = NORMAL
    """Its distribution; values that are not positive are drawn anew."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Domain:
    """What each world draws when an episode begins: its mean coefficients, always mu_s > mu_k >= 0, and further parameters.

    Draws are addressed by (seed, world, episode): they do not depend on which other worlds there are.
    """

    sigma_s: float = 0.0
    """Standard deviation of the mean mu_s [-], >= 0."""
    sigma_k: float = 0.0
    """Standard deviation of the mean mu_k [-], >= 0."""
    distribution_s: Distribution = dataclasses.field(default_factory=Normal)
    """Distribution of the mean mu_s."""
    distribution_k: Distribution = dataclasses.field(default_factory=Normal)
    """Distribution of the mean mu_k."""
    parameters: Mapping[str, Spread] = dataclasses.field(default_factory=dict[str, Spread])
    """Further parameters of the law -> how they scatter."""

    def means(self, law: Law) -> npt.NDArray[np.float64]:
        """Return the descriptor of the pairs (mu_s, mu_k), as `stochfric_mb.coefficients.path.independent_pair` reads it.

        Raises:
            InputError: a deviation out of range, or infeasible pairs beyond reason.
        """
        process = PerEvent(
            sigma_s=self.sigma_s, sigma_k=self.sigma_k, distribution_s=self.distribution_s, distribution_k=self.distribution_k
        )
        return process.descriptor(law)

    def spreads(self, law: Law) -> npt.NDArray[np.float64]:
        """Return a row for each further parameter, shape (n, SPREAD + QUANTILES).

        Raises:
            InputError: no parameter of the law, one that is no positive number, or a deviation out of range.
        """
        names = [field.name for field in dataclasses.fields(law)]
        rows = np.zeros((len(self.parameters), int(SPREAD) + QUANTILES))
        for row, (name, spread) in zip(rows, self.parameters.items(), strict=True):
            place = names.index(require_name(f"parameter of law {law.kind}", name, names))
            value: Any = getattr(law, name)
            if name in {"mu_s", "mu_k"} or isinstance(value, str):
                raise InputError(f"parameter {name!r} cannot scatter by itself; give sigma_s and sigma_k for mu_s and mu_k")
            require_number(f"{name} of law {law.kind}", value, above=0.0)
            require_number(f"sigma of {name}", spread.sigma, low=0.0)
            d = spread.distribution
            row[: int(SPREAD)] = place, d.code, value, spread.sigma, d.low, d.high
            table = d.quantile_table()
            row[int(SPREAD) : int(SPREAD) + len(table)] = table
        return rows
