"""Backlash: a gap in the spring's line of force."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

from stochfric_mb.effects.contract import LOAD, POSITION, STIFFNESS, Effect, parameter


@dataclasses.dataclass(frozen=True, kw_only=True)
class Backlash(Effect):
    """Spring force k x - k (min(max(x - position, 0), gap) - share_below gap): it stays the same while x passes the gap.

    Above the gap the spring is shifted by (1 - share_below) gap, below it by -share_below gap: where the spring counts
    as unloaded depends on the side on which the position was set to zero.

    Reference: M. Nordin, P.-O. Gutman, Automatica 38, 2002, 1633-1649, doi 10.1016/S0005-1098(02)00047-X.
    """

    gap: float = parameter("m", "width of the gap", scale=1.0e-4, low=0.0)
    """Width of the gap [m]."""
    position: float = parameter("m", "position at which the gap opens", scale=1.0e-3)
    """Position at which the gap opens [m]."""
    share_below: float = parameter("-", "share of the gap by which the spring is shifted below it", scale=0.5, default=0.0)
    """Share of the gap by which the spring is shifted below it [-]."""

    kind: ClassVar[str] = "backlash"
    equation: ClassVar[str] = "spring force k x - k (min(max(x - position, 0), gap) - share_below gap)"
    source: ClassVar[str] = "Nordin and Gutman 2002"
    group: ClassVar[str] = "mechanism"


def surroundings(world, memory, rates, p):
    """Take the force that the gap does not pass on."""
    world[LOAD] += world[STIFFNESS] * (min(max(world[POSITION] - p[1], 0.0), p[0]) - p[2] * p[0])
