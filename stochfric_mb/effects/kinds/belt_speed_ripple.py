"""Belt-speed ripple: a belt that does not run evenly."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

from stochfric_mb.effects.contract import (
    BELT_ACCELERATION,
    BELT_TRAVEL,
    BELT_VELOCITY,
    MEAN_BELT_VELOCITY,
    TIME,
    Effect,
    parameter,
)
from stochfric_mb.effects.traits import BELT, BELT_RIPPLE


@dataclasses.dataclass(frozen=True, kw_only=True)
class BeltSpeedRipple(Effect):
    """v_b times 1 + amplitude cos(2 pi frequency t + phase); several ripples add.

    Reference: B. Armstrong-Helouvry, Control of Machines with Friction, Kluwer 1991.
    """

    amplitude: float = parameter("-", "relative amplitude of the belt speed", scale=0.03)
    """Relative amplitude of the belt speed [-]."""
    frequency: float = parameter("Hz", "frequency", scale=5.0, low=0.0, strict=True)
    """Frequency [Hz]."""
    phase: float = parameter("rad", "phase at t = 0", scale=1.0, default=0.0)
    """Phase at t = 0 [rad]."""

    kind: ClassVar[str] = "belt_speed_ripple"
    equation: ClassVar[str] = "v_b times 1 + amplitude cos(2 pi frequency t + phase)"
    source: ClassVar[str] = "eccentric pulleys and cogging of drives: Armstrong 1991"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({BELT})
    signatures: ClassVar[tuple[str, ...]] = (BELT_RIPPLE,)
    shows_on: ClassVar[str] = "time, in stick"
    shows: ClassVar[str] = "the belt's speed varies periodically"

    def shortest_time(self, speed: float) -> float:
        """Return the period [s]."""
        return 1.0 / self.frequency


def surroundings(world, memory, rates, p):
    """Add the ripple to velocity, acceleration and travel of the belt."""
    w = 2.0 * math.pi * p[1]
    size = p[0] * world[MEAN_BELT_VELOCITY]
    angle = w * world[TIME] + p[2]
    world[BELT_VELOCITY] += size * math.cos(angle)
    world[BELT_ACCELERATION] -= size * w * math.sin(angle)
    world[BELT_TRAVEL] += size / w * (math.sin(angle) - math.sin(p[2]))
