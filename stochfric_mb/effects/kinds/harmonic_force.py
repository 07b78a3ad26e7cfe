"""Harmonic force: a force on the body that nobody modelled."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import LOAD, TIME, Effect, JointSignature, Scan, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Slips, Wave, times
from stochfric_mb.effects.traits import COURSE_OF_RUN, FORCE_IN_TIME, WANDERS_ALIKE, WAVES

PERIODS = 3.0
"""Fewest periods in a record for a force to be called periodic."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class HarmonicForce(Effect):
    """Further force amplitude cos(2 pi frequency t + phase).

    Reference: J. P. Den Hartog, Mechanical Vibrations, 4th ed., McGraw-Hill 1956, section 2.9.
    """

    amplitude: float = parameter("N", "amplitude of the force", scale=0.3)
    """Amplitude of the force [N]."""
    frequency: float = parameter("Hz", "frequency", scale=5.0, low=0.0, strict=True)
    """Frequency [Hz]."""
    phase: float = parameter("rad", "phase at t = 0", scale=1.0, default=0.0)
    """Phase at t = 0 [rad]."""

    kind: ClassVar[str] = "harmonic_force"
    equation: ClassVar[str] = "further force amplitude cos(2 pi frequency t + phase)"
    source: ClassVar[str] = "Den Hartog 1956, chapter 2 (unbalance)"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({WAVES, FORCE_IN_TIME, COURSE_OF_RUN, WANDERS_ALIKE})
    separated_by: ClassVar[Mapping[str, str]] = {
        "nonlinear_stiffness": "a run at a second belt speed",
    }
    shows_on: ClassVar[str] = "time"
    shows: ClassVar[str] = "a periodic force acts, in stick and slip alike"

    def shortest_time(self, speed: float) -> float:
        """Return the period [s]."""
        return 1.0 / self.frequency

    @classmethod
    def at_joint(cls, span: JointSpan) -> JointSignature:
        """Return a force in time whose phase differs from run to run: slower than three periods a record it is a drift."""

        def begin(frequency: float, a: float, b: float) -> HarmonicForce:
            return cls(amplitude=math.hypot(a, b), frequency=frequency, phase=math.atan2(b, -a))

        highest = 0.5 / span.window if span.window > 0.0 else PERIODS / span.duration
        return JointSignature((), "time", 3, Scan("time", False, PERIODS / span.duration, highest, begin))

    @classmethod
    def wave(cls, slips: Slips) -> Wave:
        """Return a force that is added in time, the same in stick and slip."""
        places = times(slips)
        return Wave(places, np.broadcast_to(slips.direction.astype(np.float64)[:, None], places.shape), lambda f: f)


def surroundings(world, memory, rates, p):
    """Add the force."""
    world[LOAD] += p[0] * math.cos(2.0 * math.pi * p[1] * world[TIME] + p[2])
