"""Quadratic damping: drag in proportion to the square of the body's velocity."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

from stochfric_mb.effects.contract import LOAD, VELOCITY, Effect, parameter


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


def surroundings(world, memory, rates, p):
    """Add the drag."""
    world[LOAD] -= p[0] * world[VELOCITY] * abs(world[VELOCITY])
