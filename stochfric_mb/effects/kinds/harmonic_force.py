"""Harmonic force: a force on the body that nobody modelled."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import LOAD, TIME, Array, JointSignature, Scan, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Slips, Wave, times
from stochfric_mb.effects.shapes.periodic import Periodic, periodic
from stochfric_mb.effects.shapes.splines import RETURNING_PIECES
from stochfric_mb.effects.traits import COURSE_OF_RUN, FORCE_IN_TIME, WANDERS_ALIKE, WAVES

PERIODS = 3.0
"""Fewest periods in a record for a force to be called periodic."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class HarmonicForce(Periodic):
    """Further force amplitude cos(2 pi frequency t + phase) + course c(frac(frequency t + phase/(2 pi))).

    c is a sum of cubic B-splines, so that the force may have any smooth shape that comes back with each period.

    Reference: J. P. Den Hartog, Mechanical Vibrations, 4th ed., McGraw-Hill 1956, section 2.9.
    """

    amplitude: float = parameter("N", "amplitude of a cosine", scale=0.3, default=0.0, optional=True)
    """Amplitude of a cosine [N]."""
    course: float = parameter("N", "size of a course of any shape", scale=0.3, default=0.0, optional=True)
    """Size of a course of any shape [N]."""

    kind: ClassVar[str] = "harmonic_force"
    equation: ClassVar[str] = (
        "further force amplitude cos(2 pi frequency t + phase) + course c(frac(frequency t + phase/(2 pi))), c of splines"
    )
    source: ClassVar[str] = "Den Hartog 1956, chapter 2 (unbalance)"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({WAVES, FORCE_IN_TIME, COURSE_OF_RUN, WANDERS_ALIKE})
    separated_by: ClassVar[Mapping[str, str]] = {
        "nonlinear_stiffness": "a run at a second belt speed",
    }
    shows_on: ClassVar[str] = "time"
    shows: ClassVar[str] = "a periodic force acts, at rest and in sliding alike"

    @classmethod
    def at_joint(cls, span: JointSpan) -> tuple[JointSignature, ...]:
        """Return forces in time whose phase differs from run to run: slower than three periods a record they are drifts."""

        def begin(frequency: float, a: float, b: float) -> HarmonicForce:
            return cls(amplitude=math.hypot(a, b), frequency=frequency, phase=math.atan2(b, -a))

        def scan(pieces: int) -> Scan:
            def shaped(frequency: float, weights: Array) -> HarmonicForce:
                return cls(**cls.returning(-weights, pieces, frequency))

            return Scan("time", False, PERIODS / span.duration, highest, begin, pieces, shaped if pieces else None)

        highest = 0.5 / span.window if span.window > 0.0 else PERIODS / span.duration
        # weights but one, frequency and phase
        shapes = (JointSignature((), "time", pieces + 1, scan(pieces)) for pieces in RETURNING_PIECES)
        return JointSignature((), "time", 3, scan(0)), *shapes

    @classmethod
    def wave(cls, slips: Slips) -> Wave:
        """Return a force that is added in time, the same in stick and slip."""
        places = times(slips)
        weight = np.broadcast_to(slips.direction.astype(np.float64)[:, None], places.shape)
        return Wave(places, weight, lambda f: f, returning=cls.returning)


def surroundings(world, memory, rates, p):
    """Add the force."""
    world[LOAD] += periodic(p, world[TIME])
