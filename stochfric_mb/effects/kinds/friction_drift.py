"""Friction drift: coefficients that change in the course of a record (temperature, wear, run-in)."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

from stochfric_mb.effects.contract import MU_K, MU_S, TIME, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Hypothesis, Slips, drifting
from stochfric_mb.effects.shapes.course import Course, courses_at_joint, friction_along
from stochfric_mb.effects.shapes.splines import along
from stochfric_mb.effects.traits import COURSE_OF_RUN, DRIFTS, WANDERS_ALIKE


@dataclasses.dataclass(frozen=True, kw_only=True)
class FrictionDrift(Course):
    """mu_k (and mu_s, by its share) times 1 + rate tau (1 - exp(-t/tau)) + change s(t/span), tau = time_constant.

    1 + rate t for an infinite time constant; s is a sum of cubic B-splines, so that the course may have any smooth shape.

    Reference: P. J. Blau, Tribology International 38, 2005, 1007-1012, doi 10.1016/j.triboint.2005.07.020.
    """

    rate: float = parameter("1/s", "relative rate of change at t = 0", scale=1.0e-3, default=0.0, optional=True)
    """Relative rate of change at t = 0 [1/s]."""
    time_constant: float = parameter(
        "s", "time in which the change settles", scale=30.0, low=0.0, strict=True, infinite=True, default=math.inf
    )
    """Time in which the change settles [s]."""
    static_share: float = parameter("-", "share of the change that mu_s takes", scale=1.0, default=1.0)
    """Share of the change that mu_s takes [-]: 1, both coefficients alike; 0, mu_k alone."""
    change: float = parameter("-", "relative size of a course of any shape", scale=0.03, default=0.0, optional=True)
    """Relative size of a course of any shape [-]."""

    kind: ClassVar[str] = "friction_drift"
    equation: ClassVar[str] = (
        "mu_k times 1 + rate tau (1 - exp(-t/tau)) + change s(t/span), tau = time_constant, s of splines; mu_s by its share"
    )
    source: ClassVar[str] = "Blau 2005 (running-in of frictional contacts)"
    group: ClassVar[str] = "friction varies"
    traits: ClassVar[frozenset[str]] = frozenset({COURSE_OF_RUN, WANDERS_ALIKE, DRIFTS})
    answers_to: ClassVar[str] = "time"
    shows_on: ClassVar[str] = "time"
    shows: ClassVar[str] = "friction drifts in the course of a run"
    order: ClassVar[int] = 3

    @classmethod
    def at_joint(cls, span: JointSpan) -> tuple[JointSignature, ...]:
        """Return a drift of a hundredth over the record, and courses of any smooth shape."""
        straight = JointSignature((cls(rate=0.01 / span.duration),), "time", 1)
        return straight, *courses_at_joint(cls(span=span.duration), "time")

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return friction that drifts in each run: linearly, towards a limit, or along a course of any smooth shape."""
        ways = drifting(cls.kind, slips.onset_time, slips.mean_time, slips.duration, slips, "time_constant")
        whole = slips.duration
        return ways + friction_along(cls.kind, slips.onset_time / whole, slips.node_time / whole, whole, slips)


def friction(world, memory, rates, p):
    """Multiply both coefficients by the drift."""
    span, rate, settled, share, change = p[19], p[20], p[21], p[22], p[23]
    grown = rate * (world[TIME] if settled > 1.0e300 else -settled * math.expm1(-world[TIME] / settled))
    if change != 0.0:
        grown += change * along(p, world[TIME] / span)
    world[MU_S] *= 1.0 + share * grown
    world[MU_K] *= 1.0 + grown
