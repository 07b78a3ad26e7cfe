"""Direction asymmetry: other coefficients in the negative direction."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import DIRECTION, MU_K, MU_S, SPEED, VISCOUS_FORCE, Effect, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Hypothesis, Slips, apart
from stochfric_mb.effects.traits import BETWEEN_POINTS


@dataclasses.dataclass(frozen=True, kw_only=True)
class DirectionAsymmetry(Effect):
    """mu_k and viscous friction times 1 + asymmetry where v_rel (in stick: the force needed) is negative, mu_s by its share.

    Beside it viscous friction may differ alone: viscous_difference/2 abs(v_rel) more where v_rel < 0, as much less else.

    References: B. Armstrong-Helouvry, Control of Machines with Friction, Kluwer 1991, chapter 4; A. Janot, M. Gautier,
    M. Brunot, Data Set and Reference Models of EMPS, Nonlinear System Identification Benchmarks 2019 (both parts differ).
    """

    asymmetry: float = parameter(
        "-", "relative change in the negative direction", scale=0.1, low=-1.0, strict=True, default=0.0
    )
    """Relative change in the negative direction [-]."""
    static_share: float = parameter("-", "share of the change that mu_s takes", scale=1.0, default=1.0)
    """Share of the change that mu_s takes [-]: 1, both coefficients alike; 0, mu_k alone."""

    viscous_difference: float = parameter("N s/m", "further force per speed, negative less positive", scale=3.0, default=0.0)
    """Further force per speed where v_rel < 0 less that where v_rel > 0 [N s/m]."""

    kind: ClassVar[str] = "direction_asymmetry"
    equation: ClassVar[str] = (
        "mu_k and viscous friction times 1 + asymmetry, mu_s times 1 + static_share asymmetry, where v_rel < 0 (in stick: "
        "where the force needed is negative); further friction viscous_difference/2 abs(v_rel), against the motion where v_rel "
        "< 0, along it where v_rel > 0"
    )
    source: ClassVar[str] = "Armstrong-Helouvry 1991 (robot joints)"
    group: ClassVar[str] = "friction law"
    traits: ClassVar[frozenset[str]] = frozenset({BETWEEN_POINTS})
    answers_to: ClassVar[str] = "direction"
    shows_on: ClassVar[str] = "direction"
    shows: ClassVar[str] = "friction differs between the two directions of sliding"
    order: ClassVar[int] = 3

    @classmethod
    def at_joint(cls, span: JointSpan) -> tuple[JointSignature, ...]:
        """Return a difference between both directions: of all friction, of what is viscous alone, or of each by itself."""
        if not span.both_ways:
            return ()
        all_of_it, viscous = cls(asymmetry=0.01), cls(viscous_difference=0.2 * span.friction / span.speed)
        both = dataclasses.replace(viscous, asymmetry=0.01)
        forms = (all_of_it, "direction", 1), (viscous, "speed and direction", 1), (both, "speed and direction", 2)
        return tuple(JointSignature((start,), axis, numbers) for start, axis, numbers in forms)

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return the share of the runs with a reversed belt."""
        if len(set(slips.direction)) < 2:
            return []
        back = (slips.direction < 0).astype(np.float64)
        return apart(cls.kind, slips.static * back, slips.kinetic * back, slips, "asymmetry", {})


def friction(world, memory, rates, p):
    """Multiply friction in the negative direction; add half the difference there, take it in the other."""
    if world[DIRECTION] < 0.0:
        world[MU_S] *= 1.0 + p[0] * p[1]
        world[MU_K] *= 1.0 + p[0]
        world[VISCOUS_FORCE] *= 1.0 + p[0]
    world[VISCOUS_FORCE] += (0.5 if world[DIRECTION] < 0.0 else -0.5) * p[2] * world[SPEED]
