"""Position-dependent friction: coefficients that repeat along the belt or along the stroke."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import BELT_POSITION, MU_K, MU_S, POSITION, JointSignature, Scan, choice, parameter
from stochfric_mb.effects.joints import WAVES_ON_STROKE, JointSpan
from stochfric_mb.effects.marks import Array, Hypothesis, Slips, Wave, friction_at, times
from stochfric_mb.effects.shapes.course import CourseAlongStroke, courses_at_joint
from stochfric_mb.effects.shapes.splines import COURSE, along, returning_course
from stochfric_mb.effects.traits import ALONG_BELT, ANY_SHAPE, COURSE_OF_RUN, WANDERS_ALIKE, WAVES
from stochfric_mb.errors import InputError

MOST_AT_START = 0.9
"""Largest relative amplitude with which a fit begins [-]."""
STROKES = (0.5, 0.7, 1.0, 1.4, 2.0)
"""Wavelengths along the stroke that are looked for, over the length of the stroke [-]: a longer wave is a slope, which a
stiffness that is off leaves as well."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class PositionDependentFriction(CourseAlongStroke):
    """mu_s and mu_k times 1 + sum of a_h cos(2 pi h s/wavelength + phase_h) + course c((s - begin)/span), h = 1, 2, 3.

    s is the belt coordinate under the body, belt travel - x (axis "belt"), or x (axis "position"); c is a sum of cubic
    B-splines, so that friction may follow any smooth shape. With a wavelength the course comes back with each of them, as that
    of a belt does with each turn, and begins where the first harmonic has no phase: c(frac(s/wavelength + phase/(2 pi))).

    Reference: B. Armstrong-Helouvry, Control of Machines with Friction, Kluwer 1991 (friction against joint position).
    """

    amplitude: float = parameter("-", "relative amplitude of the first harmonic", scale=0.03, default=0.0, optional=True)
    """Relative amplitude of the first harmonic [-]."""
    wavelength: float = parameter(
        "m", "wavelength of the first harmonic", scale=0.01, low=0.0, strict=True, infinite=True, default=math.inf
    )
    """Wavelength of the first harmonic [m]."""
    phase: float = parameter("rad", "phase of the first harmonic at s = 0", scale=1.0, default=0.0)
    """Phase of the first harmonic at s = 0 [rad]."""
    axis: str = choice("along what friction varies", ("belt", "position"))
    """Along what friction varies: "belt" or "position"."""
    amplitude_2: float = parameter("-", "relative amplitude of the second harmonic", scale=0.01, default=0.0, optional=True)
    """Relative amplitude of the second harmonic [-]."""
    phase_2: float = parameter("rad", "phase of the second harmonic at s = 0", scale=1.0, default=0.0)
    """Phase of the second harmonic at s = 0 [rad]."""
    amplitude_3: float = parameter("-", "relative amplitude of the third harmonic", scale=0.01, default=0.0, optional=True)
    """Relative amplitude of the third harmonic [-]."""
    phase_3: float = parameter("rad", "phase of the third harmonic at s = 0", scale=1.0, default=0.0)
    """Phase of the third harmonic at s = 0 [rad]."""
    course: float = parameter("-", "relative size of a course of any shape", scale=0.03, default=0.0, optional=True)
    """Relative size of a course of any shape [-]."""

    course_end: ClassVar[str] = "span, or a wavelength with which it comes back"
    needs_one_of: ClassVar[tuple[str, ...]] = ("amplitude", "amplitude_2", "amplitude_3", "course")

    kind: ClassVar[str] = "position_dependent_friction"
    equation: ClassVar[str] = (
        "both mu times 1 + sum a_h cos(2 pi h s/wavelength + phase_h) + course c((s - begin)/span), "
        "s = belt travel - x, or x, c of splines, which comes back with each wavelength if there is one"
    )
    source: ClassVar[str] = "Armstrong-Helouvry 1991"
    group: ClassVar[str] = "friction varies"
    traits: ClassVar[frozenset[str]] = frozenset({ANY_SHAPE, WAVES, ALONG_BELT, COURSE_OF_RUN, WANDERS_ALIKE})
    answers_to: ClassVar[str] = "position"
    separated_by: ClassVar[Mapping[str, str]] = {
        "normal_load_ripple": "a run at a second belt speed (or a normal-force sensor)",
        "nonlinear_stiffness": "a quasi-static load test of the spring",
        "backlash": "a quasi-static load test of the spring",
        "harmonic_force": "a run at a second normal load",
    }
    shows_on: ClassVar[str] = "belt position"
    shows: ClassVar[str] = "friction varies with position"
    order: ClassVar[int] = 3

    def __post_init__(self) -> None:
        super().__post_init__()
        waves = any((self.amplitude, self.amplitude_2, self.amplitude_3))
        if math.isinf(self.wavelength) and (waves or not self.course):
            raise InputError(
                f"{self.kind} needs amplitude and wavelength of a wave, or course, span and {COURSE[0]} to {COURSE[-1]} of a "
                f"course; amplitude = {self.amplitude:g} has no wavelength"
            )
        if self.course and math.isfinite(self.wavelength):
            self.require_return()

    def appears(self) -> tuple[str, str]:
        """Return belt or stroke, whichever the friction varies along."""
        if self.axis == "position":
            return "position of the box", "friction varies along the stroke"
        return self.shows_on, "friction varies along the belt"

    @property
    def stretch(self) -> float:
        """Stretch over which the course runs [m]: a wavelength, if there is one."""
        return self.wavelength if math.isfinite(self.wavelength) else self.span

    @property
    def own_to_run(self) -> tuple[str, ...]:
        """The phases along the belt; the stroke is the same in all runs."""
        return super().own_to_run if self.axis == "belt" else ()

    def shortest_time(self, speed: float) -> float:
        """Return the time [s] in which the contact passes the shortest wavelength that acts."""
        harmonic = 3.0 if self.amplitude_3 != 0.0 else 2.0 if self.amplitude_2 != 0.0 else 1.0
        wave = self.wavelength / (harmonic * speed) if speed > 0.0 else math.inf
        return min(wave, super().shortest_time(speed))

    @classmethod
    def at_joint(cls, span: JointSpan) -> tuple[JointSignature, ...]:
        """Return waves along the stroke, and courses of any smooth shape."""
        parts = (2.0, 1.4, 1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.12, 0.08)
        starts = (cls(amplitude=0.05, wavelength=span.stroke * part, phase=0.7, axis="position") for part in parts)

        def begin(number: float, a: float, b: float) -> PositionDependentFriction:
            size = min(math.hypot(a, b) / span.friction, MOST_AT_START)
            return cls(amplitude=size, wavelength=1.0 / number, phase=math.atan2(-b, a), axis="position")

        low, high = (n / span.stroke for n in WAVES_ON_STROKE)
        flat = cls(axis="position", course=1.0, course_1=1.0, span=span.stroke, begin=span.lowest)
        return (
            JointSignature(tuple(starts), "position", 3, Scan("position", True, low, high, begin)),
            *courses_at_joint(flat, "position"),
        )

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return friction that is modulated along the stroke, by one harmonic or two."""
        place = slips.direction[:, None] * np.concatenate([slips.typical_onset[:, None], slips.typical_position], axis=1)
        force = friction_at(slips)
        length = float(np.ptp(np.abs(place)))

        def start(b: Array, wavelength: float) -> dict[str, float | str]:
            size, phase = np.hypot(b[0::2], b[1::2]), np.arctan2(-b[1::2], b[0::2])
            numbers: dict[str, float | str] = {"wavelength": wavelength, "axis": "position"}
            for h in range(len(size)):
                more = "" if h == 0 else f"_{h + 1}"
                numbers |= {f"amplitude{more}": float(size[h]), f"phase{more}": float(phase[h])}
            return numbers

        hypotheses: list[Hypothesis] = []
        for wavelength in (length * np.array(STROKES)).tolist():
            for harmonics, variant in ((1, "stroke"), (2, "stroke with an overtone")):
                waves = [
                    wave(2.0 * math.pi * (h + 1) / wavelength * place) for h in range(harmonics) for wave in (np.cos, np.sin)
                ]
                columns = [slips.column(force[:, 0] * w[:, 0], force[:, 1:] * w[:, 1:]) for w in waves]
                setting, begin = (wavelength, float(harmonics)), functools.partial(start, wavelength=wavelength)
                hypotheses.append(Hypothesis(cls.kind, columns, setting, begin, variant=variant))
        return hypotheses

    @classmethod
    def wave(cls, slips: Slips) -> Wave:
        """Return friction that is modulated along the belt, in stick and slip by the same share."""
        slowest = float(slips.belt_velocity.min())
        position = np.concatenate([slips.typical_onset[:, None], slips.typical_position], axis=1)
        typical = float(np.median([s.record.mechanism.belt_velocity for s in slips.slips]))
        place = (slips.belt_velocity[:, None] * times(slips) - position) / slowest
        return Wave(place, friction_at(slips), lambda f: slowest / f, typical / slowest, cls.returning, turned=True)

    @classmethod
    def returning(cls, weights: Array, pieces: int, wavelength: float) -> dict[str, float | str]:
        """Return the parameters of a course that comes back with each wavelength, its mean being 0; see `returning`."""
        return {"wavelength": wavelength, "axis": "belt"} | returning_course(weights, pieces)


def friction(world, memory, rates, p):
    """Multiply both coefficients by the pattern."""
    s = world[BELT_POSITION] if p[25] == 0.0 else world[POSITION]
    angle = 2.0 * math.pi * s / p[23]
    factor = 1.0 + p[22] * math.cos(angle + p[24])
    if p[26] != 0.0 or p[28] != 0.0:
        factor += p[26] * math.cos(2.0 * angle + p[27]) + p[28] * math.cos(3.0 * angle + p[29])
    if p[30] != 0.0:
        if math.isinf(p[23]):
            place = (s - p[20]) / p[19]
        else:
            turns = (s - p[20]) / p[23] + p[24] / (2.0 * math.pi)
            place = turns - math.floor(turns)
        factor += p[30] * (p[21] + along(p, place))
    world[MU_S] *= factor
    world[MU_K] *= factor
