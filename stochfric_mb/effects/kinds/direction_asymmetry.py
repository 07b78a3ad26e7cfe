"""Direction asymmetry: other coefficients in the negative direction."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import DIRECTION, MU_K, MU_S, VISCOUS_FORCE, Effect, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Hypothesis, Slips, apart
from stochfric_mb.effects.traits import BETWEEN_POINTS


@dataclasses.dataclass(frozen=True, kw_only=True)
class DirectionAsymmetry(Effect):
    """mu_k and viscous friction times 1 + asymmetry where v_rel (in stick: the force needed) is negative, mu_s by its share.

    Reference: B. Armstrong-Helouvry, Control of Machines with Friction, Kluwer 1991.
    """

    asymmetry: float = parameter("-", "relative change in the negative direction", scale=0.1, low=-1.0, strict=True)
    """Relative change in the negative direction [-]."""
    static_share: float = parameter("-", "share of the change that mu_s takes", scale=1.0, default=1.0)
    """Share of the change that mu_s takes [-]: 1, both coefficients alike; 0, mu_k alone."""

    kind: ClassVar[str] = "direction_asymmetry"
    equation: ClassVar[str] = (
        "mu_k and viscous friction times 1 + asymmetry, mu_s times 1 + static_share asymmetry, where v_rel < 0 (in stick: "
        "where the force needed is negative)"
    )
    source: ClassVar[str] = "Armstrong-Helouvry 1991 (robot joints)"
    group: ClassVar[str] = "friction law"
    traits: ClassVar[frozenset[str]] = frozenset({BETWEEN_POINTS})
    answers_to: ClassVar[str] = "direction"
    shows_on: ClassVar[str] = "direction"
    shows: ClassVar[str] = "friction differs between the two directions of sliding"
    order: ClassVar[int] = 3

    @classmethod
    def at_joint(cls, span: JointSpan) -> JointSignature | None:
        """Return a difference between both directions."""
        return JointSignature((cls(asymmetry=0.0),), "direction", 1) if span.both_ways else None

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return the share of the runs with a reversed belt."""
        if len(set(slips.direction)) < 2:
            return []
        back = (slips.direction < 0).astype(np.float64)
        return apart(cls.kind, slips.static * back, slips.kinetic * back, slips, "asymmetry", {})


def friction(world, memory, rates, p):
    """Multiply friction in the negative direction."""
    if world[DIRECTION] < 0.0:
        world[MU_S] *= 1.0 + p[0] * p[1]
        world[MU_K] *= 1.0 + p[0]
        world[VISCOUS_FORCE] *= 1.0 + p[0]
