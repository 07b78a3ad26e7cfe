"""Normal-load ripple: a normal force that swings."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import ClassVar

from stochfric_mb.effects.contract import NORMAL_FORCE, TIME, parameter
from stochfric_mb.effects.marks import Slips, Wave, friction_at, times
from stochfric_mb.effects.shapes.periodic import Periodic, periodic
from stochfric_mb.effects.traits import COURSE_OF_RUN, WANDERS_ALIKE, WAVES
from stochfric_mb.errors import InputError


@dataclasses.dataclass(frozen=True, kw_only=True)
class NormalLoadRipple(Periodic):
    """N times 1 + amplitude cos(2 pi frequency t + phase) + course c(frac(frequency t + phase/(2 pi))).

    c is a sum of cubic B-splines, so that the normal force may have any smooth shape that comes back with each period.

    Reference: H. Jacobsson, Aspects of disc brake judder, Proc. IMechE Part D 217, 2003.
    """

    amplitude: float = parameter(
        "-", "relative amplitude of a cosine of the normal force", scale=0.03, low=-1.0, high=1.0, strict=True, default=0.0,
        optional=True,
    )  # fmt: skip
    """Relative amplitude of a cosine of the normal force [-]."""
    course: float = parameter(
        "-", "relative size of a course of any shape", scale=0.03, low=-1.0, high=1.0, strict=True, default=0.0, optional=True
    )
    """Relative size of a course of any shape [-]."""

    kind: ClassVar[str] = "normal_load_ripple"
    equation: ClassVar[str] = (
        "N times 1 + amplitude cos(2 pi frequency t + phase) + course c(frac(frequency t + phase/(2 pi))), c of splines"
    )
    source: ClassVar[str] = "disc thickness variation: Jacobsson 2003"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({WAVES, COURSE_OF_RUN, WANDERS_ALIKE})
    separated_by: ClassVar[Mapping[str, str]] = {
        "harmonic_force": "a run at a second normal load, or a normal-force sensor",
    }
    shows_on: ClassVar[str] = "time"
    shows: ClassVar[str] = "friction in stick and slip varies periodically in time by the same share"

    def __post_init__(self) -> None:
        super().__post_init__()
        lowest = 1.0 + float(self.over_a_turn().min()) if self.any_shape else 1.0
        if lowest < 0.0:
            raise InputError(
                f"{self.kind}: the normal force falls to {lowest:.2g} of what it is, and no contact pulls; "
                "give a smaller amplitude or course"
            )

    @classmethod
    def wave(cls, slips: Slips) -> Wave:
        """Return friction that is modulated in time, in stick and slip by the same share."""
        return Wave(times(slips), friction_at(slips), lambda f: f, returning=cls.returning)


def surroundings(world, memory, rates, p):
    """Multiply the normal force by the ripple."""
    world[NORMAL_FORCE] *= 1.0 + periodic(p, world[TIME])
