"""Distance drift: coefficients that change with the distance slid (wear, run-in)."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import BELT_VELOCITY, MU_K, MU_S, TRAVELLED, VELOCITY, Effect, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Hypothesis, Slips, drifting
from stochfric_mb.effects.traits import COURSE_OF_RUN, DRIFTS, SLOPE_IN_DISTANCE, WANDERS_ALIKE

PACES_DIFFER = 1.1
"""Ratio of the distances slid in a time from which on they differ between runs [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class DistanceDrift(Effect):
    """mu_k (and mu_s, by its share) times 1 + rate d (1 - exp(-s/d)), d = settling_distance; 1 + rate s for an infinite one.

    s is the distance slid since the record began, whichever way.

    Reference: P. J. Blau, Tribology International 38, 2005, 1007-1012, doi 10.1016/j.triboint.2005.07.020.
    """

    rate: float = parameter("1/m", "relative change per distance slid, at first", scale=1.0e-2)
    """Relative change per distance slid, at first [1/m]."""
    settling_distance: float = parameter(
        "m", "distance in which the change settles", scale=1.0, low=0.0, strict=True, infinite=True, default=math.inf
    )
    """Distance in which the change settles [m]."""
    static_share: float = parameter("-", "share of the change that mu_s takes", scale=1.0, default=1.0)
    """Share of the change that mu_s takes [-]: 1, both coefficients alike; 0, mu_k alone."""

    kind: ClassVar[str] = "distance_drift"
    equation: ClassVar[str] = (
        "mu_k times 1 + rate d (1 - exp(-s/d)), s slid, d = settling_distance; 1 + rate s if it is infinite; mu_s by its share"
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
    def at_joint(cls, span: JointSpan) -> JointSignature:
        """Return a drift of a hundredth over the distance slid."""
        return JointSignature((cls(rate=0.01 / span.distance),), "distance slid", 1)

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return friction that drifts with the distance slid; none where it grows alike in all runs, as the time does."""
        before, inside = slips.slid_before, slips.slid_before + slips.slip_distance.mean(axis=1)
        ends = [int(np.flatnonzero(slips.run == run)[-1]) for run in range(slips.n_runs)]
        paces = inside[ends] / slips.mean_time[ends]
        if paces.max() < PACES_DIFFER * paces.min():
            return []
        return drifting(cls.kind, before, inside, float(inside.max()), slips, "settling_distance")


def surroundings(world, memory, rates, p):
    """Keep the distance slid."""
    rates[0] = abs(world[BELT_VELOCITY] - world[VELOCITY])
    world[TRAVELLED] = memory[0]


def friction(world, memory, rates, p):
    """Multiply both coefficients by the drift."""
    grown = world[TRAVELLED] if p[1] > 1.0e300 else -p[1] * math.expm1(-world[TRAVELLED] / p[1])
    world[MU_S] *= 1.0 + p[0] * p[2] * grown
    world[MU_K] *= 1.0 + p[0] * grown
