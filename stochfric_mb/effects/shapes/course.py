"""A course of any smooth shape along time, distance, temperature or the stroke: a sum of cubic B-splines over a stretch of it.

A slow course differs from a random drift by its length scale: it bends over a part of the record that many slips fall into,
and it comes back in the next run.
"""

from __future__ import annotations

import dataclasses
import math
from typing import Any, ClassVar, Self

import numpy as np

from stochfric_mb.effects.contract import Array, Effect, JointSignature, parameter
from stochfric_mb.effects.marks import COURSE_OF_ANY_SHAPE, Hypothesis, Slips, levels
from stochfric_mb.effects.shapes.splines import COARSER, COURSE, PIECES, sized, splines
from stochfric_mb.errors import InputError

FLAT = 1.0e-3
"""Weights from which fits of a course begin [-]: friction is linear in them."""
RETURNS = 1.0e-9
"""Difference of weights over the largest one up to which a course returns to its begin [-]: rounding of written numbers."""
SHARES = (1.0, 0.0, 0.5, 2.0)
"""Shares of the change that mu_s takes, of courses of friction [-]."""


def _weight(number: int) -> Any:
    """Return the field of one number of a course's shape: no fit moves it, a fit moves the size."""
    return parameter(
        "-", f"weight of spline {number} of {PIECES + 2} in the course", scale=1.0, default=0.0, fit_prior=0.0, optional=True
    )


@dataclasses.dataclass(frozen=True, kw_only=True)
class Shaped(Effect):
    """An effect that may have any smooth shape; the size of that is the effect's own."""

    course_size: ClassVar[str]
    """Name of the parameter that is the size of the course."""
    course_end: ClassVar[str]
    """What says where the course ends."""

    course_1: float = _weight(1)
    """Weight of the first spline in the course [-]."""
    course_2: float = _weight(2)
    """Weight of the second spline in the course [-]."""
    course_3: float = _weight(3)
    """Weight of the third spline in the course [-]."""
    course_4: float = _weight(4)
    """Weight of the 4th spline in the course [-]."""
    course_5: float = _weight(5)
    """Weight of the 5th spline in the course [-]."""
    course_6: float = _weight(6)
    """Weight of the 6th spline in the course [-]."""
    course_7: float = _weight(7)
    """Weight of the 7th spline in the course [-]."""
    course_8: float = _weight(8)
    """Weight of the 8th spline in the course [-]."""
    course_9: float = _weight(9)
    """Weight of the 9th spline in the course [-]."""
    course_10: float = _weight(10)
    """Weight of the 10th spline in the course [-]."""
    course_11: float = _weight(11)
    """Weight of the 11th spline in the course [-]."""
    course_12: float = _weight(12)
    """Weight of the 12th spline in the course [-]."""
    course_13: float = _weight(13)
    """Weight of the 13th spline in the course [-]."""
    course_14: float = _weight(14)
    """Weight of the 14th spline in the course [-]."""
    course_15: float = _weight(15)
    """Weight of the 15th spline in the course [-]."""
    course_16: float = _weight(16)
    """Weight of the 16th spline in the course [-]."""
    course_17: float = _weight(17)
    """Weight of the 17th spline in the course [-]."""
    course_18: float = _weight(18)
    """Weight of the 18th spline in the course [-]."""
    pieces: float = parameter(
        "-",
        "pieces of the course",
        scale=float(PIECES),
        low=1.0,
        high=float(PIECES),
        default=float(PIECES),
        fit_prior=0.0,
        optional=True,
    )
    """Pieces of the course between its beginning and its end, a whole number; of n pieces the first n + 2 splines count [-]."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.pieces != int(self.pieces):
            raise InputError(f"{self.kind}.pieces = {self.pieces:g} is no whole number; give one from 1 to {PIECES}")
        count = int(self.pieces) + 2
        idle = [name for name in COURSE[count:] if getattr(self, name)]
        if idle:
            raise InputError(
                f"{self.kind}.{idle[0]} = {getattr(self, idle[0]):g} counts for nothing in a course of {self.pieces:g} pieces; "
                f"give more pieces, or {COURSE[0]} to {COURSE[count - 1]} alone"
            )
        change = float(getattr(self, self.course_size, 0.0))
        if change == 0.0:
            return
        flat = not any(getattr(self, name) for name in self.shaped_by)
        if flat or math.isinf(self.stretch):
            lacking = f"no shape: give {COURSE[0]} to {self.weights[-1]}" if flat else f"no end: give {self.course_end}"
            name = self.course_size
            raise InputError(f"{self.kind}.{name} = {change:g}, but its course has {lacking}, or leave out {name}")

    @property
    def stretch(self) -> float:
        """Stretch over which the course runs; infinite where it has none."""
        raise NotImplementedError

    @property
    def any_shape(self) -> bool:
        """Whether it follows a course."""
        return bool(getattr(self, self.course_size))

    @property
    def weights(self) -> tuple[str, ...]:
        """Names of the weights that count."""
        return COURSE[: int(self.pieces) + 2]

    def require_return(self) -> None:
        """Raise an error unless the course goes on smoothly where it comes back.

        Raises:
            InputError: its end is not its begin.
        """
        n, weight = int(self.pieces), [0.0, *(getattr(self, name) for name in COURSE)]
        most = RETURNS * max(map(abs, weight))
        if any(abs(weight[n + k] - weight[k]) > most for k in range(3)):
            ends = ", ".join(f"course_{n + k} = {weight[n + k]:g}" for k in range(3))
            raise InputError(
                f"{self.kind}: its course comes back, but has a jump or a kink there: {ends}; of {n} pieces "
                f"give course_{n} = 0, course_{n + 1} = course_1 and course_{n + 2} = course_2"
            )

    def normalised(self) -> Self:
        """Return the same effect, its size being the largest change and its weights relative to that."""
        shape = self.shape(np.linspace(0.0, 1.0, 20 * PIECES + 1))
        largest = float(shape[np.argmax(np.abs(shape))])
        if largest in (0.0, 1.0):
            return self
        relative = {n: getattr(self, n) / largest for n in self.shaped_by}
        return dataclasses.replace(self, **relative, **{self.course_size: largest * getattr(self, self.course_size)})

    @property
    def shaped_by(self) -> tuple[str, ...]:
        """Names of all numbers in which the shape is linear."""
        return self.weights

    def columns(self, place: Array) -> Array:
        """Return the change of the shape with each of the numbers `shaped_by`, shape (..., n); 0 at its begin, 1 at its end."""
        return splines(place, int(self.pieces))

    def shape(self, place: Array) -> Array:
        """Return the course at places, shape as ``place``."""
        return self.columns(place) @ np.array([getattr(self, name) for name in self.shaped_by])


@dataclasses.dataclass(frozen=True, kw_only=True)
class Course(Shaped):
    """An effect that may follow a course of any smooth shape; ``change``, its size, is the effect's own."""

    course_size: ClassVar[str] = "change"
    course_end: ClassVar[str] = "span"

    span: float = parameter(
        "s", "time over which the course runs", scale=30.0, low=0.0, strict=True, infinite=True, default=math.inf,
        fit_prior=0.0, optional=True,
    )  # fmt: skip
    """Time over which the course runs [s]; nothing changes after it."""

    @property
    def stretch(self) -> float:
        """Stretch over which the course runs, in the unit of `span`."""
        return self.span

    def kept_at_joints(self, contact: bool) -> tuple[str, ...]:
        """Return where the course runs and its size: its weights are fitted."""
        return self.course_size, "span", "pieces"


@dataclasses.dataclass(frozen=True, kw_only=True)
class LeveledCourse(Course):
    """An effect that may follow a course from a place on, with a value of its own there; ``course`` is its size.

    The units of `span` and `begin`, and what they are places in, are the effect's own.
    """

    course_size: ClassVar[str] = "course"

    begin: float = parameter("-", "where the course begins", scale=1.0, default=0.0, fit_prior=0.0, optional=True)
    """Where the course begins, in the unit of `span`."""
    at_begin: float = parameter(
        "-", "value of the course where it begins", scale=1.0, default=0.0, fit_prior=0.0, optional=True
    )
    """Value of the course where it begins, and before [-]."""

    def kept_at_joints(self, contact: bool) -> tuple[str, ...]:
        """Return where the course runs and its size: its weights are fitted."""
        return *super().kept_at_joints(contact), "begin"

    @property
    def shaped_by(self) -> tuple[str, ...]:
        """Names of all numbers in which the shape is linear."""
        return *super().shaped_by, "at_begin"

    def columns(self, place: Array) -> Array:
        """Return the change of the shape with each of the numbers `shaped_by`, shape (..., n); 0 at its begin, 1 at its end."""
        return np.concatenate([super().columns(place), np.ones((*place.shape, 1))], axis=-1)


@dataclasses.dataclass(frozen=True, kw_only=True)
class CourseAlongStroke(LeveledCourse):
    """An effect that may follow a course of any smooth shape along the stroke; ``course``, its size, is the effect's own."""

    span: float = parameter(
        "m", "stretch of the stroke over which the course runs", scale=0.1, low=0.0, strict=True, infinite=True,
        default=math.inf, fit_prior=0.0, optional=True,
    )  # fmt: skip
    """Stretch of the stroke over which the course runs [m]; nothing changes before and after it."""
    begin: float = parameter("m", "position at which the course begins", scale=0.1, default=0.0, fit_prior=0.0, optional=True)
    """Position at which the course begins [m]."""

    def shortest_time(self, speed: float) -> float:
        """Return the time [s] in which the contact passes two pieces, in which a course can rise and fall."""
        return 2.0 * self.stretch / (self.pieces * speed) if self.any_shape and speed > 0.0 else math.inf


def courses_at_joint(flat: Course, axis: str, *, leveled: bool = False) -> tuple[JointSignature, ...]:
    """Return courses of any smooth shape at a joint, of few pieces and of many; their weights are fitted, the size stays 1.

    Args:
        flat: the effect with its ``span``, and whatever else says where its course runs.
        axis: axis along which it shows.
        leveled: whether a course has a level of its own where it begins, there being no other number that is one.
    """
    forms: list[JointSignature] = []
    for n in COARSER:
        begin = dataclasses.replace(flat, pieces=float(n), **{COURSE[0]: FLAT, flat.course_size: 1.0})
        fitted = begin.shaped_by if leveled else begin.weights
        forms.append(JointSignature((dataclasses.replace(begin, **dict.fromkeys(fitted, FLAT)),), axis, len(fitted)))
    return tuple(forms)


def friction_along(
    kind: str, at_onset: Array, in_slip: Array, span: float, slips: Slips, more: dict[str, float] | None = None
) -> list[Hypothesis]:
    """Return friction that follows a course of any smooth shape along a quantity.

    Args:
        kind: the effect, a `Course` whose ``change`` is relative to mu_k, and to mu_s by ``static_share``.
        at_onset: place in the course at the break-away, 0 at its begin and 1 at its end, shape (n,).
        in_slip: the same in the slip, shape (n, nodes).
        span: the stretch of the quantity that the course covers, in its unit.
        slips: the slips.
        more: further parameters of the effect.
    """
    static, kinetic = levels(slips)

    def way(pieces: int, share: float) -> Hypothesis:
        held, rubbing = splines(at_onset, pieces), splines(in_slip, pieces)
        columns = [slips.column(share * static * held[:, k], kinetic[:, None] * rubbing[..., k]) for k in range(pieces + 2)]

        def start(b: Array) -> dict[str, Any]:
            return sized(b, pieces, span) | {"static_share": share} | (more or {})

        return Hypothesis(kind, columns, (), start, COURSE_OF_ANY_SHAPE)

    return [way(pieces, share) for pieces in COARSER for share in SHARES]
