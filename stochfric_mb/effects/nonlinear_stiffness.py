"""Nonlinear stiffness: a quadratic and a cubic part of the spring force."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

from stochfric_mb.effects.contract import LOAD, POSITION, Effect, parameter


@dataclasses.dataclass(frozen=True, kw_only=True)
class NonlinearStiffness(Effect):
    """Spring force k x + quadratic x abs(x) + cubic x^3.

    Reference: G. Duffing, Erzwungene Schwingungen bei veraenderlicher Eigenfrequenz, Vieweg 1918.
    """

    cubic: float = parameter("N/m^3", "spring force per cube of the deflection", scale=1.0e8)
    """Spring force per cube of the deflection [N/m^3]."""
    quadratic: float = parameter("N/m^2", "spring force per square of the deflection", scale=2.0e5, default=0.0)
    """Spring force per square of the deflection [N/m^2]."""

    kind: ClassVar[str] = "nonlinear_stiffness"
    equation: ClassVar[str] = "spring force k x + quadratic x abs(x) + cubic x^3"
    source: ClassVar[str] = "Duffing 1918"
    group: ClassVar[str] = "mechanism"


def surroundings(world, memory, rates, p):
    """Add the parts that are not linear."""
    x = world[POSITION]
    world[LOAD] -= (p[1] * abs(x) + p[0] * x * x) * x
