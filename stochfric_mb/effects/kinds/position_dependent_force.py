"""Position-dependent force: a force that the place alone decides, whichever way the joint moves."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import ClassVar

from stochfric_mb.effects.contract import LOAD, POSITION, JointSignature, Scan, parameter
from stochfric_mb.effects.joints import WAVES_ON_STROKE, JointSpan
from stochfric_mb.effects.shapes.course import CourseAlongStroke, courses_at_joint
from stochfric_mb.effects.shapes.splines import along

WAVES_OF_STROKE = (4.0, 2.0, 1.4, 1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.12, 0.08)
"""Wavelengths from which fits begin, over the stroke [-]; the longest is an unbalance seen over a part of its turn."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class PositionDependentForce(CourseAlongStroke):
    """Further force amplitude cos(2 pi x/wavelength + phase) - stiffness d - cubic d^3 + course c, d = x - zero; an overtone.

    c is a sum of cubic B-splines of (x - begin)/span, so that the force may follow any smooth shape along the stroke.

    Cogging and unbalance are waves, cables and bellows springs. It is no friction: it does not turn with the direction.

    References: Z. Q. Zhu, D. Howe, IEEE Trans. Energy Convers. 15, 2000, 407-412 (cogging); J. P. Den Hartog, Mechanical
    Vibrations, 4th ed., McGraw-Hill 1956, sections 6.1 (unbalance) and 8.1 (springs that stiffen).
    """

    stiffness: float = parameter("N/m", "force per displacement", scale=10.0, default=0.0)
    """Force per displacement, towards ``zero`` [N/m]."""
    cubic: float = parameter("N/m^3", "force per displacement cubed", scale=1.0e3, default=0.0)
    """Force per displacement cubed [N/m^3]."""
    zero: float = parameter("m", "position at which the spring rests", scale=0.01, default=0.0)
    """Position at which the spring rests [m]."""
    amplitude: float = parameter("N", "amplitude of the wave", scale=0.3, default=0.0)
    """Amplitude of the wave [N]."""
    wavelength: float = parameter("m", "wavelength", scale=0.01, low=0.0, strict=True, default=1.0)
    """Its wavelength [m]."""
    phase: float = parameter("rad", "phase of the wave at x = 0", scale=1.0, default=0.0)
    """Its phase at x = 0 [rad]."""
    amplitude_2: float = parameter("N", "amplitude of the second harmonic", scale=0.1, default=0.0)
    """Amplitude of the second harmonic [N]."""
    phase_2: float = parameter("rad", "phase of the second harmonic at x = 0", scale=1.0, default=0.0)
    """Phase of the second harmonic at x = 0 [rad]."""
    course: float = parameter("N", "size of a course of any shape", scale=0.3, default=0.0, optional=True)
    """Size of a course of any shape [N]."""

    kind: ClassVar[str] = "position_dependent_force"
    equation: ClassVar[str] = (
        "further force amplitude cos(2 pi x/wavelength + phase) - stiffness (x - zero) - cubic (x - zero)^3 + "
        "course c((x - begin)/span), c of splines, and an overtone"
    )
    source: ClassVar[str] = "Zhu and Howe 2000 (cogging); Den Hartog 1956, sections 6.1 and 8.1 (unbalance, springs)"
    group: ClassVar[str] = "mechanism"
    answers_to: ClassVar[str] = "position"
    separated_by: ClassVar[Mapping[str, str]] = {
        "position_dependent_friction": "strokes both ways over the same place: friction turns with the direction",
    }
    shows_on: ClassVar[str] = "position"
    shows: ClassVar[str] = "a force depends on position, in both directions of motion alike"

    @property
    def own_to_run(self) -> tuple[str, ...]:
        """None: the stroke is the same in all runs."""
        return ()

    def shortest_time(self, speed: float) -> float:
        """Return the time [s] in which the contact passes the shorter wavelength that acts."""
        waves = 0.0 if self.amplitude == self.amplitude_2 == 0.0 else 2.0 if self.amplitude_2 != 0.0 else 1.0
        wave = self.wavelength / (waves * speed) if waves * speed > 0.0 else math.inf
        return min(wave, super().shortest_time(speed))

    @classmethod
    def at_joint(cls, span: JointSpan) -> tuple[JointSignature, ...]:
        """Return springs, waves and smooth courses along the stroke; both directions tell that they are no friction."""
        if not span.both_ways:
            return ()
        force, away = 0.1 * span.friction, 0.01 * span.stroke
        spring = cls(stiffness=force / span.stroke, zero=away)
        stiffening = cls(stiffness=force / span.stroke, cubic=force / span.stroke**3, zero=away)
        waves = tuple(cls(amplitude=force, wavelength=span.stroke * part, phase=0.7) for part in WAVES_OF_STROKE)
        twice = tuple(
            dataclasses.replace(w, amplitude_2=0.5 * force, phase_2=0.7)
            for w in waves
            if 0.2 < w.wavelength / span.stroke < 3.0
        )

        def begin(number: float, a: float, b: float) -> PositionDependentForce:
            return cls(amplitude=math.hypot(a, b), wavelength=1.0 / number, phase=math.atan2(b, -a))

        low, high = (n / span.stroke for n in WAVES_ON_STROKE)
        scan = Scan("position", False, low, high, begin)
        return (
            JointSignature((spring,), "position", 2),
            JointSignature((stiffening,), "position", 3),
            JointSignature(waves, "position", 3, scan),
            JointSignature(twice, "position", 5),
            *courses_at_joint(cls(span=span.stroke, begin=span.lowest), "position", leveled=True),
        )


def surroundings(world, memory, rates, p):
    """Add the force."""
    d = world[POSITION] - p[24]
    angle = 2.0 * math.pi * world[POSITION] / p[26]
    world[LOAD] += p[25] * math.cos(angle + p[27]) + p[28] * math.cos(2.0 * angle + p[29]) - p[22] * d - p[23] * d * d * d
    if p[30] != 0.0:
        world[LOAD] += p[30] * (p[21] + along(p, (world[POSITION] - p[20]) / p[19]))
