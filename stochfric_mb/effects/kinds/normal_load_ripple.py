"""Normal-load ripple: a normal force that swings."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import ClassVar

from stochfric_mb.effects.contract import NORMAL_FORCE, TIME, Effect, parameter
from stochfric_mb.effects.marks import Slips, Wave, friction_at, times
from stochfric_mb.effects.traits import COURSE_OF_RUN, WANDERS_ALIKE, WAVES


@dataclasses.dataclass(frozen=True, kw_only=True)
class NormalLoadRipple(Effect):
    """N times 1 + amplitude cos(2 pi frequency t + phase).

    Reference: H. Jacobsson, Aspects of disc brake judder, Proc. IMechE Part D 217, 2003.
    """

    amplitude: float = parameter("-", "relative amplitude of the normal force", scale=0.03, low=-1.0, high=1.0, strict=True)
    """Relative amplitude of the normal force [-]."""
    frequency: float = parameter("Hz", "frequency", scale=5.0, low=0.0, strict=True)
    """Frequency [Hz]."""
    phase: float = parameter("rad", "phase at t = 0", scale=1.0, default=0.0)
    """Phase at t = 0 [rad]."""

    kind: ClassVar[str] = "normal_load_ripple"
    equation: ClassVar[str] = "N times 1 + amplitude cos(2 pi frequency t + phase)"
    source: ClassVar[str] = "disc thickness variation: Jacobsson 2003"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({WAVES, COURSE_OF_RUN, WANDERS_ALIKE})
    separated_by: ClassVar[Mapping[str, str]] = {
        "harmonic_force": "a run at a second normal load, or a normal-force sensor",
    }
    shows_on: ClassVar[str] = "time"
    shows: ClassVar[str] = "friction in stick and slip varies periodically in time by the same share"

    def shortest_time(self, speed: float) -> float:
        """Return the period [s]."""
        return 1.0 / self.frequency

    @classmethod
    def wave(cls, slips: Slips) -> Wave:
        """Return friction that is modulated in time, in stick and slip by the same share."""
        return Wave(times(slips), friction_at(slips), lambda f: f)


def surroundings(world, memory, rates, p):
    """Multiply the normal force by the ripple."""
    world[NORMAL_FORCE] *= 1.0 + p[0] * math.cos(2.0 * math.pi * p[1] * world[TIME] + p[2])
