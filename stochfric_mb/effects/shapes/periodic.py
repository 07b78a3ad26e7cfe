"""A wave in time of any smooth shape: a cosine, and a course that comes back with each turn."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import functools
import math
from typing import ClassVar, Self

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.effects.contract import Array, parameter
from stochfric_mb.effects.shapes.course import Shaped
from stochfric_mb.effects.shapes.splines import COURSE, PIECES, along, along_integral, along_slope, returning_course, splines


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


@functools.cache
def _turn(pieces: int) -> tuple[Array, Array]:
    """Return a cosine, shape (n,), and the splines of a course, shape (n, pieces + 2), at places all over a turn."""
    turn = np.linspace(0.0, 1.0, 20 * PIECES, endpoint=False)
    return np.cos(2.0 * np.pi * turn), splines(turn, pieces)


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
        value += p[23] * p[21] * along_slope(p, turns - math.floor(turns))
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
        course = whole * along_integral(p, 1.0)
        course += along_integral(p, turns - math.floor(turns)) - along_integral(p, begin - math.floor(begin))
        value += p[23] / p[21] * (course + p[19] * (turns - begin))
    return value
