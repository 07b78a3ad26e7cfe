"""Numbers that a fit may adjust, of law, mechanism, effect or a single run, each with its scale, bounds and prior."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

LAW, MECHANISM = -1, -2
"""Owners that are no effects."""
INSIDE = 1.0e-9
"""Distance beyond a bound at which the search ends [scales]: a start on a bound can be left; values are cut to the bounds."""


@dataclasses.dataclass(frozen=True)
class FreeParameter:
    """One number that a fit adjusts."""

    owner: int
    """Number of the effect that it belongs to, otherwise `LAW` or `MECHANISM`."""
    name: str
    """Its name there."""
    value: float
    """Where a fit starts."""
    scale: float
    """A natural step."""
    low: float
    """Smallest value allowed."""
    high: float
    """Largest value allowed."""
    unit: str = "-"
    """Unit."""
    nominal: float = 0.0
    """Prior mean, where `prior` is finite."""
    prior: float = np.inf
    """Standard deviation of the prior; inf where there is none."""
    run: str = ""
    """Run that it belongs to, empty for all."""
    stride: float = np.inf
    """Most natural steps in one iteration of a fit: beyond, derivatives say nothing."""

    def inside(self, value: float) -> float:
        """Return a value, moved between the bounds."""
        return float(min(max(value, self.low), self.high))


@dataclasses.dataclass(frozen=True)
class Steps:
    """Free parameters in their natural steps from where a fit starts: 0 is the start."""

    start: Array
    """Values at the start, shape (p,)."""
    scale: Array
    """Natural steps, shape (p,)."""
    low: Array
    """Smallest steps, shape (p,)."""
    high: Array
    """Largest steps, shape (p,)."""
    nominal: Array
    """Prior mean; the start where there is no prior, shape (p,)."""
    prior: Array
    """Standard deviations of that, shape (p,)."""
    stride: Array
    """Largest steps in one iteration, shape (p,)."""

    def values(self, step: Array) -> Array:
        """Return the values after a step, shape (p,)."""
        return self.start + self.scale * step

    def surprise(self, values: Array) -> Array:
        """Return by how many standard deviations values are off from the prior mean, shape (p,); 0 without a prior."""
        return (values - self.nominal) / self.prior


def steps_of(free: Sequence[FreeParameter], scale: Array | None = None) -> Steps:
    """Return the numbers in their natural steps, or in steps of ``scale``, shape (p,)."""
    start, low, high, prior = (np.array([getattr(k, n) for k in free]) for n in ("value", "low", "high", "prior"))
    scale = np.array([k.scale for k in free]) if scale is None else scale
    nominal = np.where(np.isfinite(prior), [k.nominal for k in free], start)
    stride = np.array([k.stride * k.scale for k in free]) / scale
    return Steps(start, scale, (low - start) / scale - INSIDE, (high - start) / scale + INSIDE, nominal, prior, stride)
