"""Effective area: the area on which a pressure acts changes along the stroke."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import ClassVar

from stochfric_mb.effects.contract import LOAD, POSITION, PRESSURE, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.shapes.course import CourseAlongStroke, courses_at_joint
from stochfric_mb.effects.shapes.splines import along
from stochfric_mb.effects.traits import OTHER_AREA


@dataclasses.dataclass(frozen=True, kw_only=True)
class EffectiveArea(CourseAlongStroke):
    """The pressure p pushes back with p (A + gradient (x - zero) + change tanh((x - place)/width)/2 + course c), A as stated.

    c is a sum of cubic B-splines of (x - begin)/span, so that the area may follow any smooth shape along the stroke.

    A bore that is not cylindrical, a lip that rolls or a bellows that swells; it does not turn with the direction.

    References: H. K. Mueller, B. S. Nau, Fluid Sealing Technology, Marcel Dekker 1998, chapter 8 (area of a lip in its bore);
    H. E. Merritt, Hydraulic Control Systems, Wiley 1967, chapter 6.
    """

    gradient: float = parameter("m", "area per position", scale=1.0e-4, default=0.0)
    """Area per position [m^2/m]."""
    zero: float = parameter("m", "position at which the stated area holds", scale=0.01, default=0.0)
    """Position at which the stated area holds [m]."""
    change: float = parameter("m^2", "how much larger the area is beyond a place", scale=1.0e-5, default=0.0)
    """How much larger the area is beyond ``place`` than before; midway it is as stated [m^2]."""
    place: float = parameter("m", "where the area changes", scale=0.01, default=0.0)
    """Where it changes [m]."""
    width: float = parameter("m", "width of that change", scale=1.0e-3, low=0.0, strict=True, default=1.0e-3)
    """Width of that change [m]."""
    course: float = parameter("m^2", "size of a course of any shape", scale=1.0e-5, default=0.0, optional=True)
    """Size of a course of any shape [m^2]."""

    kind: ClassVar[str] = "effective_area"
    equation: ClassVar[str] = (
        "further force -p (gradient (x - zero) + change tanh((x - place)/width)/2 + course c((x - begin)/span)), c of "
        "splines, p the measured pressure"
    )
    source: ClassVar[str] = "Merritt 1967, chapter 6; Mueller and Nau 1998, chapter 8"
    group: ClassVar[str] = "mechanism"
    signatures: ClassVar[tuple[str, ...]] = (OTHER_AREA,)
    answers_to: ClassVar[str] = "position"
    separated_by: ClassVar[Mapping[str, str]] = {
        "position_dependent_force": "strokes without pressure",
        "position_dependent_friction": "strokes both ways over the same place: friction turns with the direction",
    }
    reads: ClassVar[tuple[str, ...]] = ("pressure",)
    shows_on: ClassVar[str] = "pressure and position"
    shows: ClassVar[str] = "a force in proportion to the pressure depends on position"

    @classmethod
    def at_joint(cls, span: JointSpan) -> tuple[JointSignature, ...]:
        """Return an area that grows along the stroke, one that changes at a place, and courses of any smooth shape."""
        if span.pressure <= 0.0 or not span.both_ways:
            return ()
        area = 0.1 * span.friction / span.pressure
        grows = cls(gradient=area / span.stroke, zero=0.01 * span.stroke)
        steps = (cls(change=area, place=part * span.stroke, width=0.12 * span.stroke) for part in (-0.25, 0.01, 0.25))
        return (
            JointSignature((grows,), "position", 2),
            JointSignature(tuple(steps), "position", 3),
            *courses_at_joint(cls(span=span.stroke, begin=span.lowest), "position", leveled=True),
        )


def surroundings(world, memory, rates, p):
    """Take what the pressure pushes back with more."""
    area = p[22] * (world[POSITION] - p[23])
    if p[24] != 0.0:
        area += 0.5 * p[24] * math.tanh((world[POSITION] - p[25]) / p[26])
    if p[27] != 0.0:
        area += p[27] * (p[21] + along(p, (world[POSITION] - p[20]) / p[19]))
    world[LOAD] -= world[PRESSURE] * area
