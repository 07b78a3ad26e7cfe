"""Nonlinear stiffness: a cubic part of the spring force."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

from stochfric_mb.effects.contract import LOAD, POSITION, Effect, parameter


@dataclasses.dataclass(frozen=True, kw_only=True)
class NonlinearStiffness(Effect):
    """Spring force k x + cubic x^3.

    Reference: G. Duffing, Erzwungene Schwingungen bei veraenderlicher Eigenfrequenz, Vieweg 1918.
    """

    cubic: float = parameter("N/m^3", "spring force per cube of the deflection", scale=1.0e8)
    """Spring force per cube of the deflection [N/m^3]."""

    kind: ClassVar[str] = "nonlinear_stiffness"
    equation: ClassVar[str] = "spring force k x + cubic x^3"
    source: ClassVar[str] = "Duffing 1918"
    group: ClassVar[str] = "mechanism"


def surroundings(world, memory, rates, p):
    """Add the cubic part."""
    world[LOAD] -= p[0] * world[POSITION] ** 3
