"""Correlated coefficients: mu_s and mu_k that wander slowly."""

from __future__ import annotations

import dataclasses
from typing import ClassVar

from stochfric_mb.coefficients import OrnsteinUhlenbeck, Process
from stochfric_mb.effects.contract import Effect, parameter
from stochfric_mb.effects.traits import SCATTER, WANDER, WANDERS_ALIKE


@dataclasses.dataclass(frozen=True, kw_only=True)
class CorrelatedCoefficients(Effect):
    """Stationary Ornstein-Uhlenbeck processes around mu_s and mu_k, independent of one another or not.

    The effect is the scenario's coefficient process; it is not evaluated with the other effects.

    Reference: G. E. Uhlenbeck, L. S. Ornstein, Phys. Rev. 36, 1930, 823-841, doi 10.1103/PhysRev.36.823.
    """

    sigma_s: float = parameter("-", "standard deviation of mu_s", scale=0.015, low=0.0)
    """Standard deviation of mu_s [-]."""
    sigma_k: float = parameter("-", "standard deviation of mu_k", scale=0.02, low=0.0)
    """Standard deviation of mu_k [-]."""
    correlation_time: float = parameter("s", "time in which the correlation falls to 1/e", scale=3.0, low=0.0, strict=True)
    """Time in which the correlation falls to 1/e [s]."""
    cross_correlation: float = parameter(
        "-", "correlation of mu_s and mu_k", scale=0.5, low=-1.0, high=1.0, default=0.0, optional=True
    )
    """Correlation of mu_s and mu_k [-]: 1, both scatter together; 0, independently."""

    kind: ClassVar[str] = "correlated_coefficients"
    equation: ClassVar[str] = "mu_s, mu_k with correlation exp(-abs(dt)/correlation_time)"
    source: ClassVar[str] = "Uhlenbeck and Ornstein 1930"
    group: ClassVar[str] = "randomness"
    traits: ClassVar[frozenset[str]] = frozenset({SCATTER, WANDERS_ALIKE})
    signatures: ClassVar[tuple[str, ...]] = (WANDER,)
    shows_on: ClassVar[str] = "scatter, time"
    shows: ClassVar[str] = "friction drifts slowly and at random"

    def draws(self, duration: float, slips: int) -> float:
        """Return T/(2 tau), which is what a mean over T knows of an exponential memory, at most one draw a slip."""
        return min(float(slips), max(duration / (2.0 * self.correlation_time), 1.0))

    def coefficient_process(self) -> Process:
        """Return the coefficient process that the effect sets."""
        return OrnsteinUhlenbeck(
            sigma_s=self.sigma_s,
            sigma_k=self.sigma_k,
            cross_correlation=self.cross_correlation,
            correlation_time=self.correlation_time,
        )
