"""Random coefficients: mu_s and mu_k that are drawn anew."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import ClassVar

from stochfric_mb.coefficients import Knots, PerEvent, Process
from stochfric_mb.effects.contract import Effect, choice, parameter
from stochfric_mb.effects.traits import DRAWN_ANEW, SCATTER, WANDERS_ALIKE

FOREVER = 1.0e12
"""Distance between knots of which a run sees the first one alone [s]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class RandomCoefficients(Effect):
    """Normal pairs (mu_s, mu_k), one per knot in time, one per stick phase, or one per run, each independent of the others.

    The effect is the scenario's coefficient process; it is not evaluated with the other effects.

    Reference: W. S. Kang, C. K. Choi, H. H. Yoo, J. Mech. Sci. Tech. 29, 2015, 3645-3652,
    doi 10.1007/s12206-015-0808-4, section 2.2.
    """

    process: str = choice("when a new pair is drawn", ("knots", "per_event", "per_run"))
    """When a new pair is drawn: "knots" (every ``spacing`` seconds, linear between), "per_event" (every stick) or "per_run"."""
    sigma_s: float = parameter("-", "standard deviation of mu_s", scale=0.015, low=0.0)
    """Standard deviation of mu_s [-]."""
    sigma_k: float = parameter("-", "standard deviation of mu_k", scale=0.02, low=0.0)
    """Standard deviation of mu_k [-]."""
    spacing: float = parameter("s", "distance between knots", scale=0.01, low=0.0, strict=True, default=0.01, optional=True)
    """Distance between knots [s]; not used by the others."""
    cross_correlation: float = parameter(
        "-", "correlation of mu_s and mu_k", scale=0.5, low=-1.0, high=1.0, default=0.0, optional=True
    )
    """Correlation of mu_s and mu_k [-]: 1, both scatter together; 0, independently."""

    kind: ClassVar[str] = "random_coefficients"
    equation: ClassVar[str] = (
        "(mu_s, mu_k) normal, a new pair every `spacing` seconds (knots), stick (per_event) or run (per_run)"
    )
    source: ClassVar[str] = "Kang, Choi and Yoo 2015, section 2.2"
    group: ClassVar[str] = "randomness"
    traits: ClassVar[frozenset[str]] = frozenset({SCATTER, WANDERS_ALIKE})
    signatures: ClassVar[tuple[str, ...]] = (DRAWN_ANEW,)
    separated_by: ClassVar[Mapping[str, str]] = {
        "correlated_coefficients": "a longer record",
    }
    shows_on: ClassVar[str] = "scatter"
    shows: ClassVar[str] = "friction scatters from slip to slip with no memory"

    def lacks(self, name: str) -> bool:
        """Return whether a parameter belongs to a form of the effect that this one has not: only knots have a spacing."""
        return (name == "spacing" and self.process != "knots") or super().lacks(name)

    def coefficient_process(self) -> Process:
        """Return the coefficient process that the effect sets."""
        if self.process == "knots":
            return Knots(
                sigma_s=self.sigma_s, sigma_k=self.sigma_k, cross_correlation=self.cross_correlation, spacing=self.spacing
            )
        if self.process == "per_run":
            return Knots(sigma_s=self.sigma_s, sigma_k=self.sigma_k, cross_correlation=self.cross_correlation, spacing=FOREVER)
        return PerEvent(sigma_s=self.sigma_s, sigma_k=self.sigma_k, cross_correlation=self.cross_correlation)
