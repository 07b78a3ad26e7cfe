"""Friction drift: coefficients that change in the course of a record (temperature, wear, run-in)."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import MU_K, MU_S, TIME, Effect, parameter
from stochfric_mb.effects.joints import JointSignature, JointSpan
from stochfric_mb.effects.marks import Hypothesis, Slips, apart
from stochfric_mb.effects.traits import COURSE_OF_RUN, DRIFTS, SLOPE_IN_DISTANCE, WANDERS_ALIKE


@dataclasses.dataclass(frozen=True, kw_only=True)
class FrictionDrift(Effect):
    """mu_k (and mu_s, by its share) times 1 + rate tau (1 - exp(-t/tau)), tau = time_constant; 1 + rate t for an infinite one.

    Reference: P. J. Blau, Tribology International 38, 2005, 1007-1012, doi 10.1016/j.triboint.2005.07.020.
    """

    rate: float = parameter("1/s", "relative rate of change at t = 0", scale=1.0e-3)
    """Relative rate of change at t = 0 [1/s]."""
    time_constant: float = parameter(
        "s", "time in which the change settles", scale=30.0, low=0.0, strict=True, infinite=True, default=math.inf
    )
    """Time in which the change settles [s]."""
    static_share: float = parameter("-", "share of the change that mu_s takes", scale=1.0, default=1.0)
    """Share of the change that mu_s takes [-]: 1, both coefficients alike; 0, mu_k alone."""

    kind: ClassVar[str] = "friction_drift"
    equation: ClassVar[str] = (
        "mu_k times 1 + rate tau (1 - exp(-t/tau)), tau = time_constant; 1 + rate t where it is infinite; mu_s by its share"
    )
    source: ClassVar[str] = "Blau 2005 (running-in of frictional contacts)"
    group: ClassVar[str] = "friction varies"
    traits: ClassVar[frozenset[str]] = frozenset({COURSE_OF_RUN, WANDERS_ALIKE, DRIFTS})
    found_as: ClassVar[tuple[str, ...]] = (SLOPE_IN_DISTANCE,)
    answers_to: ClassVar[str] = "time"
    shows_on: ClassVar[str] = "time"
    shows: ClassVar[str] = "friction drifts in the course of a run"
    order: ClassVar[int] = 3

    @classmethod
    def at_joint(cls, span: JointSpan) -> JointSignature:
        """Return a drift of a hundredth over the record."""
        return JointSignature((cls(rate=0.01 / span.duration),), "time", 1)

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return friction that drifts in each run: linearly, or towards a limit."""
        last, middle = slips.duration, slips.mean_time
        found = apart(
            cls.kind, slips.static * slips.onset_time / last, slips.kinetic * middle / last, slips, "rate", {}, 1.0 / last
        )
        # neighbours differ by a fifth: a coarser grid would leave a clear record to what names no physics
        for share in np.geomspace(0.03, 1.0, 22):
            tau = float(share * last)
            static, kinetic = (
                level * -np.expm1(-t / tau) for level, t in ((slips.static, slips.onset_time), (slips.kinetic, middle))
            )
            found += apart(cls.kind, static, kinetic, slips, "rate", {"time_constant": tau}, 1.0 / tau)
        return found


def friction(world, memory, rates, p):
    """Multiply both coefficients by the drift."""
    grown = world[TIME] if p[1] > 1.0e300 else -p[1] * math.expm1(-world[TIME] / p[1])
    world[MU_S] *= 1.0 + p[0] * p[2] * grown
    world[MU_K] *= 1.0 + p[0] * grown
