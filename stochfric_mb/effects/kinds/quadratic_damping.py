"""Quadratic damping: drag in proportion to the square of the body's velocity."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import LOAD, VELOCITY, Effect, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Hypothesis, Slips
from stochfric_mb.effects.traits import POSITIVE, SHAPES_SLIPS


@dataclasses.dataclass(frozen=True, kw_only=True)
class QuadraticDamping(Effect):
    """Further force -coefficient x' abs(x').

    Reference: J. R. Morison, J. W. Johnson, S. A. Schaaf, J. Petroleum Technology 2, 1950, 149-154, doi 10.2118/950149-G.
    """

    coefficient: float = parameter("N s^2/m^2", "drag per square of the velocity", scale=50.0, low=0.0)
    """Drag per square of the velocity [N s^2/m^2]."""

    kind: ClassVar[str] = "quadratic_damping"
    equation: ClassVar[str] = "further force -coefficient x' abs(x')"
    source: ClassVar[str] = "Newton's drag: Morison et al. 1950"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({SHAPES_SLIPS, POSITIVE})
    answers_to: ClassVar[str] = "speed"
    shows_on: ClassVar[str] = "velocity"
    shows: ClassVar[str] = "the damping force grows with the square of the velocity"

    @classmethod
    def at_joint(cls, span: JointSpan) -> JointSignature:
        """Return a force in proportion to the square of the speed."""
        return JointSignature((cls(coefficient=0.2 * span.friction / span.speed**2),), "speed", 1)

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return -x'|x'|."""
        velocity = slips.node_velocity
        columns = [slips.column(-(slips.belt_velocity**2), -velocity * np.abs(velocity))]
        return [Hypothesis(cls.kind, columns, (), lambda b: {"coefficient": float(b[0])})]


def surroundings(world, memory, rates, p):
    """Add the drag."""
    world[LOAD] -= p[0] * world[VELOCITY] * abs(world[VELOCITY])
