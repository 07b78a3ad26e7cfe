"""A course of any smooth shape along time, distance, temperature or the stroke: a sum of cubic B-splines over a stretch of it.

A slow course differs from a random drift by its length scale: it bends over a part of the record that many slips fall into,
and it comes back in the next run. Reference: C. de Boor, A Practical Guide to Splines, Springer 1978, chapter IX.
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import functools
import math
from typing import Any, ClassVar, Self

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.effects.contract import Array, Effect, JointSignature, parameter
from stochfric_mb.effects.marks import COURSE_OF_ANY_SHAPE, Hypothesis, Slips, levels
from stochfric_mb.errors import InputError

PIECES = 16
"""Most pieces of a course between its beginning and its end."""
COURSE = tuple(f"course_{i}" for i in range(1, PIECES + 3))
"""Parameters that are its shape; a course begins at 0, so that the spline before them is left out."""
COARSER = (4, 8, PIECES)
"""Pieces of the courses that are looked for."""
RETURNING_PIECES = (8, PIECES)
"""Pieces of the courses that come back; with fewer they are sines."""
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
class Periodic(Shaped):
    """A wave in time that may have any smooth shape; ``amplitude`` and ``course`` have a unit of the effect's own."""

    course_size: ClassVar[str] = "course"
    course_end: ClassVar[str] = "frequency"
    needs_one_of: ClassVar[tuple[str, ...]] = ("amplitude", "course")

    at_begin: float = parameter(
        "-", "value of the course where it begins", scale=1.0, default=0.0, fit_prior=0.0, optional=True
    )
    """Value of the course where it begins and ends [-]."""
    amplitude: float = parameter("-", "amplitude of a cosine", scale=0.03, default=0.0, optional=True)
    """Amplitude of a cosine, in the unit of the effect."""
    frequency: float = parameter("Hz", "frequency", scale=5.0, low=0.0, strict=True)
    """Frequency [Hz]."""
    phase: float = parameter("rad", "phase at t = 0", scale=1.0, default=0.0)
    """Phase at t = 0 [rad]."""
    course: float = parameter("-", "size of a course of any shape", scale=0.03, default=0.0, optional=True)
    """Size of a course of any shape, in the unit of the effect."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.any_shape:
            self.require_return()

    @property
    def stretch(self) -> float:
        """Time after which the course comes back [s]."""
        return 1.0 / self.frequency

    @property
    def shaped_by(self) -> tuple[str, ...]:
        """Names of all numbers in which the shape is linear."""
        return *super().shaped_by, "at_begin"

    def columns(self, place: Array) -> Array:
        """Return the change of the shape with each of the numbers `shaped_by`, shape (..., n)."""
        return np.concatenate([super().columns(place), np.ones((*place.shape, 1))], axis=-1)

    def changed(self, **numbers: float) -> Self:
        """Return the effect with some of its numbers changed; a course still comes back, and its mean is still 0."""
        if not self.any_shape:
            return super().changed(**numbers)
        pieces = int(self.pieces)
        weights = [numbers.get(name, getattr(self, name)) for name in COURSE[: pieces - 1]]
        whole = np.array([*weights, 0.0, *weights[:2]])
        closed = dict(zip(COURSE, whole.tolist(), strict=False)) | {"at_begin": -float(np.mean(_turn(pieces)[1] @ whole))}
        return dataclasses.replace(self, **numbers | closed)

    def kept_at_joints(self, contact: bool) -> tuple[str, ...]:
        """Return the size of a course, and what hangs on the weights that are fitted since it comes back."""
        return "course", "at_begin", "pieces", *COURSE[int(self.pieces) - 1 :]

    def shortest_time(self, speed: float) -> float:
        """Return the period [s], or the time of two pieces of the course, in which it can rise and fall."""
        return (2.0 / self.pieces if self.any_shape else 1.0) / self.frequency

    def over_a_turn(self) -> Array:
        """Return cosine and course over a turn, as finely as a course's largest change is looked for."""
        cosine, course = _turn(int(self.pieces))
        weights = np.array([getattr(self, name) for name in self.weights])
        return self.amplitude * cosine + self.course * (self.at_begin + course @ weights)

    @classmethod
    def returning(cls, weights: Array, pieces: int, frequency: float) -> dict[str, float]:
        """Return the parameters of a course that comes back with each wave, its mean being 0; see `returning`."""
        return {"frequency": frequency} | returning_course(weights, pieces)


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


def splines(place: Array, pieces: int) -> Array:
    """Return the splines of a course with so many pieces, each less its value at the begin, shape (..., pieces + 2).

    Args:
        place: 0 at the begin of the course, 1 at its end.
        pieces: number of pieces.
    """
    value = _raw(place, pieces)
    return value - _raw(np.zeros(1), pieces)[0]


def _raw(place: Array, pieces: int) -> Array:
    node = np.arange(pieces + 2, dtype=np.float64)
    apart = np.abs(pieces * np.clip(place, 0.0, 1.0)[..., None] - node)
    near = 2.0 / 3.0 - apart**2 + apart**3 / 2.0
    return np.where(apart < 1.0, near, np.maximum(2.0 - apart, 0.0) ** 3 / 6.0)


@functools.cache
def _turn(pieces: int) -> tuple[Array, Array]:
    """Return a cosine, shape (n,), and the splines of a course, shape (n, pieces + 2), at places all over a turn."""
    turn = np.linspace(0.0, 1.0, 20 * PIECES, endpoint=False)
    return np.cos(2.0 * np.pi * turn), splines(turn, pieces)


def returning(turns: Array, pieces: int) -> Array:
    """Return the splines of a course that comes back with each turn, shape (..., pieces - 1).

    The last one is left out: all of them together are a constant.

    Args:
        turns: turns from the begin of the course; whole numbers are its begin and its end.
        pieces: number of pieces in a turn, 4 or more.
    """
    raw = _raw(turns - np.floor(turns), pieces)
    once = raw[..., : pieces - 1].copy()
    once[..., :2] += raw[..., pieces:]
    return once


def returning_course(weights: Array, pieces: int) -> dict[str, float]:
    """Return the parameters of a course from the weights of `returning`: its size, and a shape of mean 0 and largest change 1.

    Args:
        weights: shape (pieces - 1,).
        pieces: as of `returning`.
    """
    course = returning(np.linspace(0.0, 1.0, 20 * PIECES, endpoint=False), pieces) @ weights
    course, begin = course - course.mean(), float(course[0] - course.mean())
    size = float(course[np.argmax(np.abs(course))]) or 1.0
    whole = np.concatenate([weights, [0.0], weights[:2]]) / size
    shape = {name: float(w) for name, w in zip(COURSE, whole, strict=False)}
    return {"course": size, "at_begin": begin / size, "pieces": float(pieces)} | shape


@compiled
def along(p, place):
    """Return the course at a place, 0 at its begin and 1 at its end, from an effect's parameters."""
    where = p[18] * min(max(place, 0.0), 1.0)
    value = -(2.0 / 3.0 * p[0] + p[1] / 6.0)  # less what the splines are at the begin
    for k in range(max(int(where) - 1, 0), min(int(where) + 3, int(p[18]) + 2)):
        away = abs(where - k)
        if away < 1.0:
            value += p[k] * (2.0 / 3.0 - away * away * (1.0 - away / 2.0))
        elif away < 2.0:
            value += p[k] * (2.0 - away) * (2.0 - away) * (2.0 - away) / 6.0
    return value


@compiled
def periodic(p, time):
    """Return what a `Periodic` effect adds at a time [s], from its parameters, those of its own being p[19] to p[23]."""
    value = p[20] * math.cos(2.0 * math.pi * p[21] * time + p[22])
    if p[23] != 0.0:
        turns = p[21] * time + p[22] / (2.0 * math.pi)
        value += p[23] * (p[19] + along(p, turns - math.floor(turns)))
    return value


@compiled
def periodic_slope(p, time):
    """Return the rate at which `periodic` changes at a time [s], per second."""
    pace = 2.0 * math.pi * p[21]
    value = -p[20] * pace * math.sin(pace * time + p[22])
    if p[23] != 0.0:
        turns = p[21] * time + p[22] / (2.0 * math.pi)
        value += p[23] * p[21] * _along_slope(p, turns - math.floor(turns))
    return value


@compiled
def periodic_integral(p, time):
    """Return the integral of `periodic` from 0 to a time [s], in seconds."""
    pace = 2.0 * math.pi * p[21]
    value = p[20] / pace * (math.sin(pace * time + p[22]) - math.sin(p[22]))
    if p[23] != 0.0:
        begin = p[22] / (2.0 * math.pi)
        turns = p[21] * time + begin
        whole = math.floor(turns) - math.floor(begin)
        course = whole * _along_integral(p, 1.0)
        course += _along_integral(p, turns - math.floor(turns)) - _along_integral(p, begin - math.floor(begin))
        value += p[23] / p[21] * (course + p[19] * (turns - begin))
    return value


@compiled
def _along_slope(p, place):
    """Return the slope of `along` between its begin, at 0, and its end, at 1."""
    where, value = p[18] * place, 0.0
    for k in range(int(p[18]) + 2):
        away, side = abs(where - k), math.copysign(1.0, where - k)
        if away < 1.0:
            value += side * p[k] * away * (1.5 * away - 2.0)
        elif away < 2.0:
            value -= side * p[k] * (2.0 - away) * (2.0 - away) / 2.0
    return p[18] * value


@compiled
def _along_integral(p, place):
    """Return the integral of `along` from its begin, at 0, to a place up to its end, at 1."""
    value = -p[18] * place * (2.0 / 3.0 * p[0] + p[1] / 6.0)
    for k in range(int(p[18]) + 2):
        value += p[k] * (_half_of_spline(p[18] * place - k) - _half_of_spline(-1.0 * k))
    return value / p[18]


@compiled
def _half_of_spline(away):
    """Return the integral of a cubic B-spline from its middle, at 0, to a distance from that in pieces, of either sign."""
    far = min(abs(away), 2.0)
    if far < 1.0:
        half = far * (2.0 / 3.0 - far * far * (1.0 / 3.0 - far / 8.0))
    else:
        half = 0.5 - (2.0 - far) * (2.0 - far) * (2.0 - far) * (2.0 - far) / 24.0
    return math.copysign(half, away)


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


def sized(weights: Array, pieces: int, span: float) -> dict[str, float]:
    """Return the parameters of a course: its size, its shape with a largest change of 1, its pieces and its span."""
    course = splines(np.linspace(0.0, 1.0, 20 * PIECES + 1), pieces) @ weights
    size = float(course[np.argmax(np.abs(course))]) or 1.0
    shape = {name: float(w / size) for name, w in zip(COURSE, weights, strict=False)}
    return {"change": size, "span": span, "pieces": float(pieces)} | shape
