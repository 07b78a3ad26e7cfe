"""Drive gain change: the force per command changes in time, with temperature or along the stroke."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import ClassVar

from stochfric_mb.effects.contract import DRIVE, LOAD, POSITION, TEMPERATURE, TIME, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.shapes.course import CourseAlongStroke, courses_at_joint
from stochfric_mb.effects.shapes.splines import along
from stochfric_mb.effects.traits import READS_DRIVE

SETTLED = (0.1, 0.2, 0.4, 0.8)
"""Shares of a record in which a gain may settle [-]; one that settles at once is no change, and imitates a payload."""
PITCHES = (2.0, 1.4, 1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.12)
"""Wavelengths from which fits begin, over the stroke [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class DriveGainChange(CourseAlongStroke):
    """Drive times 1 + grown, a change in time, with temperature and along the stroke.

    grown = rate tau (1 - exp(-t/tau)) + per_kelvin (T - reference_temperature) + ripple cos(2 pi x/pitch + phase) + change +
    slope x + curvature x^2 + course c((x - begin)/span), tau = time_constant, and rate t for an infinite one; c is a sum
    of cubic B-splines, so that the gain may follow any smooth shape along the stroke. Magnets weaken as they warm up, supplies
    sag, the phases of a motor are not equally strong, and a coil leaves its magnet to either end of the stroke. What it lacks
    on average then is the change at x = 0: without one mass and friction would have to take that up.

    References: T. Sebastian, IEEE Trans. Ind. Appl. 31, 1995, 353-357 (magnets); M. Gautier, S. Briot, J. Dyn. Sys., Meas.,
    Control 136, 2014, doi 10.1115/1.4027506 (drive gains of robots); R. Krishnan, Electric Motor Drives, Prentice Hall 2001,
    chapter 9 (torque per current along the turn); W. Klippel, J. Audio Eng. Soc. 54, 2006, 907-939 (force per current of a
    coil along its stroke, a polynomial).
    """

    rate: float = parameter("1/s", "relative rate of change at t = 0", scale=1.0e-2, default=0.0)
    """Relative rate of change at t = 0 [1/s]."""
    time_constant: float = parameter(
        "s", "time in which the change settles", scale=5.0, low=0.0, strict=True, infinite=True, default=math.inf
    )
    """Time in which the change settles [s]."""
    per_kelvin: float = parameter("1/K", "relative change per kelvin", scale=2.0e-3, default=0.0)
    """Relative change per kelvin [1/K]."""
    reference_temperature: float = parameter("degC", "temperature at which nothing changes", scale=10.0, default=20.0)
    """Temperature at which nothing changes [degC]."""
    ripple: float = parameter("-", "relative amplitude of a wave along the stroke", scale=0.02, default=0.0)
    """Relative amplitude of a wave along the stroke [-]."""
    pitch: float = parameter("m", "wavelength of that wave", scale=0.01, low=0.0, strict=True, default=1.0)
    """Wavelength of that wave [m]."""
    phase: float = parameter("rad", "phase of that wave at x = 0", scale=1.0, default=0.0)
    """Its phase at x = 0 [rad]."""
    change: float = parameter("-", "relative change at x = 0", scale=0.02, default=0.0)
    """Relative change at x = 0, waves apart [-]."""
    slope: float = parameter("1/m", "relative change along the stroke at x = 0", scale=1.0, default=0.0)
    """Relative change along the stroke at x = 0 [1/m]."""
    curvature: float = parameter("1/m^2", "relative change by the square of the position", scale=10.0, default=0.0)
    """Relative change by the square of the position [1/m^2]."""
    course: float = parameter("-", "relative size of a course of any shape", scale=0.02, default=0.0, optional=True)
    """Relative size of a course of any shape [-]."""

    kind: ClassVar[str] = "drive_gain_change"
    equation: ClassVar[str] = (
        "drive times 1 + rate tau (1 - exp(-t/tau)) + per_kelvin (T - reference_temperature) + "
        "ripple cos(2 pi x/pitch + phase) + change + slope x + curvature x^2 + "
        "course c((x - begin)/span), tau = time_constant, c of splines"
    )
    source: ClassVar[str] = "Sebastian 1995 (magnets); Gautier and Briot 2014"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({READS_DRIVE})
    separated_by: ClassVar[Mapping[str, str]] = {
        "friction_drift": "the same strokes with another payload or acceleration",
        "temperature_drift": "the same strokes with another payload or acceleration",
    }
    reads: ClassVar[tuple[str, ...]] = ("drive",)
    shows_on: ClassVar[str] = "drive"
    shows: ClassVar[str] = "the force per command changes"

    def kept_at_joints(self, contact: bool) -> tuple[str, ...]:
        """Return the time in which a gain settles, one of a few shares of the record, and where a course runs."""
        return *super().kept_at_joints(contact), "time_constant"

    @classmethod
    def at_joint(cls, span: JointSpan) -> tuple[JointSignature, ...]:
        """Return gains that change in time, along the stroke, and with temperature where one was measured."""
        if not span.drive or not span.both_ways:
            return ()
        fades = cls(rate=0.01 / span.duration)
        times = [part * span.duration for part in SETTLED]
        settles = tuple(cls(rate=size / time, time_constant=time) for time in times for size in (0.05, -0.05))
        waves = tuple(cls(ripple=0.05, pitch=part * span.stroke, phase=0.7) for part in PITCHES)
        curve = cls(change=-0.05, slope=0.1 / span.stroke, curvature=-0.2 / span.stroke**2)
        forms = [
            JointSignature((fades,), "time", 1),
            JointSignature(settles, "time", 1),
            JointSignature(waves, "position", 3),
            JointSignature((curve,), "position", 3),
            *courses_at_joint(cls(span=span.stroke, begin=span.lowest), "position", leveled=True),
        ]
        if span.temperature is not None:
            middle, width = span.temperature
            warm = cls(per_kelvin=0.01 / width, reference_temperature=middle)
            forms.append(JointSignature((warm,), "temperature", 1))
        return tuple(forms)


def surroundings(world, memory, rates, p):
    """Add what the drive gives beyond what is stated."""
    grown = p[22] * (world[TIME] if p[23] > 1.0e300 else -p[23] * math.expm1(-world[TIME] / p[23]))
    grown += p[24] * (world[TEMPERATURE] - p[25])
    grown += p[29] + (p[30] + p[31] * world[POSITION]) * world[POSITION]
    if p[26] != 0.0:
        grown += p[26] * math.cos(2.0 * math.pi * world[POSITION] / p[27] + p[28])
    if p[32] != 0.0:
        grown += p[32] * (p[21] + along(p, (world[POSITION] - p[20]) / p[19]))
    world[LOAD] += grown * world[DRIVE]
