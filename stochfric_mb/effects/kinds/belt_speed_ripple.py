"""Belt-speed ripple: a belt that does not run evenly."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

from stochfric_mb.effects.contract import (
    BELT_ACCELERATION,
    BELT_TRAVEL,
    BELT_VELOCITY,
    MEAN_BELT_VELOCITY,
    TIME,
)
from stochfric_mb.effects.shapes.periodic import Periodic, periodic, periodic_integral, periodic_slope
from stochfric_mb.effects.traits import BELT, BELT_RIPPLE


@dataclasses.dataclass(frozen=True, kw_only=True)
class BeltSpeedRipple(Periodic):
    """v_b times 1 + amplitude cos(2 pi frequency t + phase) + course c(frac(frequency t + phase/(2 pi))).

    c is a sum of cubic B-splines, so that the speed may vary in any smooth way that comes back with each period; several
    ripples add.

    Reference: B. Armstrong-Helouvry, Control of Machines with Friction, Kluwer 1991.
    """

    kind: ClassVar[str] = "belt_speed_ripple"
    equation: ClassVar[str] = (
        "v_b times 1 + amplitude cos(2 pi frequency t + phase) + course c(frac(frequency t + phase/(2 pi))), c of splines"
    )
    source: ClassVar[str] = "eccentric pulleys and cogging of drives: Armstrong 1991"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({BELT})
    signatures: ClassVar[tuple[str, ...]] = (BELT_RIPPLE,)
    shows_on: ClassVar[str] = "time, in stick"
    shows: ClassVar[str] = "the belt's speed varies periodically"


def surroundings(world, memory, rates, p):
    """Add the ripple to velocity, acceleration and travel of the belt."""
    world[BELT_VELOCITY] += world[MEAN_BELT_VELOCITY] * periodic(p, world[TIME])
    world[BELT_ACCELERATION] += world[MEAN_BELT_VELOCITY] * periodic_slope(p, world[TIME])
    world[BELT_TRAVEL] += world[MEAN_BELT_VELOCITY] * periodic_integral(p, world[TIME])
