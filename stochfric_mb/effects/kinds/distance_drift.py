"""Distance drift: coefficients that change with the distance slid (wear, run-in)."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import BELT_VELOCITY, MU_K, MU_S, TRAVELLED, VELOCITY, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Hypothesis, Slips, drifting
from stochfric_mb.effects.shapes.course import Course, courses_at_joint, friction_along
from stochfric_mb.effects.shapes.splines import along
from stochfric_mb.effects.traits import COURSE_OF_RUN, DRIFTS, SLOPE_IN_DISTANCE, WANDERS_ALIKE

PACES_DIFFER = 1.1
"""Ratio of the distances slid in a time from which on they differ between runs [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class DistanceDrift(Course):
    """mu_k (and mu_s, by its share) times 1 + rate d (1 - exp(-s/d)) + change c(s/span), d = settling_distance.

    1 + rate s for an infinite settling distance; s is the distance slid since the record began, whichever way, c a sum of cubic
    B-splines, so that the course may have any smooth shape.

    Reference: P. J. Blau, Tribology International 38, 2005, 1007-1012, doi 10.1016/j.triboint.2005.07.020.
    """

    span: float = parameter(
        "m", "distance over which the course runs", scale=1.0, low=0.0, strict=True, infinite=True, default=math.inf,
        fit_prior=0.0, optional=True,
    )  # fmt: skip
    """Distance over which the course runs [m]; nothing changes after it."""
    rate: float = parameter("1/m", "relative change per distance slid, at first", scale=1.0e-2, default=0.0, optional=True)
    """Relative change per distance slid, at first [1/m]."""
    settling_distance: float = parameter(
        "m", "distance in which the change settles", scale=1.0, low=0.0, strict=True, infinite=True, default=math.inf
    )
    """Distance in which the change settles [m]."""
    static_share: float = parameter("-", "share of the change that mu_s takes", scale=1.0, default=1.0)
    """Share of the change that mu_s takes [-]: 1, both coefficients alike; 0, mu_k alone."""
    change: float = parameter("-", "relative size of a course of any shape", scale=0.03, default=0.0, optional=True)
    """Relative size of a course of any shape [-]."""

    kind: ClassVar[str] = "distance_drift"
    equation: ClassVar[str] = (
        "mu_k times 1 + rate d (1 - exp(-s/d)) + change c(s/span), s slid, d = settling_distance, c of splines; mu_s by share"
    )
    source: ClassVar[str] = "Blau 2005 (running-in of frictional contacts)"
    group: ClassVar[str] = "friction varies"
    traits: ClassVar[frozenset[str]] = frozenset({COURSE_OF_RUN, WANDERS_ALIKE, DRIFTS})
    signatures: ClassVar[tuple[str, ...]] = (SLOPE_IN_DISTANCE,)
    answers_to: ClassVar[str] = "distance"
    shows_on: ClassVar[str] = "slid distance"
    shows: ClassVar[str] = "friction drifts with the distance slid"
    order: ClassVar[int] = 3
    n_memory: ClassVar[int] = 1
    forgets: ClassVar[bool] = False
    separated_by: ClassVar[Mapping[str, str]] = {"friction_drift": "a run at another belt speed"}

    @classmethod
    def at_joint(cls, span: JointSpan) -> tuple[JointSignature, ...]:
        """Return a drift of a hundredth over the distance slid, and courses of any smooth shape."""
        straight = JointSignature((cls(rate=0.01 / span.distance),), "distance slid", 1)
        return straight, *courses_at_joint(cls(span=span.distance), "distance slid")

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return friction that drifts with the distance slid; none where it grows alike in all runs, as the time does."""
        before, nodes = slips.slid_before, slips.slid_before[:, None] + slips.slip_distance
        inside = nodes.mean(axis=1)
        ends = [int(np.flatnonzero(slips.run == run)[-1]) for run in range(slips.n_runs)]
        paces = inside[ends] / slips.mean_time[ends]
        if paces.max() < PACES_DIFFER * paces.min():
            return []
        last = float(inside.max())
        ways = drifting(cls.kind, before, inside, last, slips, "settling_distance")
        return ways + friction_along(cls.kind, before / last, nodes / last, last, slips)


def surroundings(world, memory, rates, p):
    """Keep the distance slid."""
    rates[0] = abs(world[BELT_VELOCITY] - world[VELOCITY])
    world[TRAVELLED] = memory[0]


def friction(world, memory, rates, p):
    """Multiply both coefficients by the drift."""
    slid, span, rate, settled, share, change = world[TRAVELLED], p[19], p[20], p[21], p[22], p[23]
    grown = rate * (slid if settled > 1.0e300 else -settled * math.expm1(-slid / settled))
    if change != 0.0:
        grown += change * along(p, slid / span)
    world[MU_S] *= 1.0 + share * grown
    world[MU_K] *= 1.0 + grown
