"""Second mode: an oscillator hung on the body."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import LOAD, MASS, POSITION, VELOCITY, Array, Effect, parameter


@dataclasses.dataclass(frozen=True, kw_only=True)
class SecondMode(Effect):
    """r'' + 2 damping_ratio w r' + w^2 r = -x'', w = 2 pi frequency.

    The force on the body is mass_ratio m (w^2 r + 2 damping_ratio w r'). r is the oscillator's position relative to the
    body; memory = (q, q') with q = x + r, so that no acceleration is needed.

    Reference: J. P. Den Hartog, Mechanical Vibrations, 4th ed., McGraw-Hill 1956, section 3.2.
    """

    mass_ratio: float = parameter("-", "mass of the oscillator over that of the body", scale=0.05, low=0.0, high=1.0)
    """Mass of the oscillator over that of the body [-]."""
    frequency: float = parameter("Hz", "its frequency with the body held", scale=20.0, low=0.0, strict=True)
    """Its frequency with the body held [Hz]."""
    damping_ratio: float = parameter("-", "its damping ratio", scale=0.01, low=0.0, high=1.0, default=0.01)
    """Its damping ratio [-]."""

    kind: ClassVar[str] = "second_mode"
    equation: ClassVar[str] = (
        "r'' + 2 damping_ratio w r' + w^2 r = -x'', w = 2 pi frequency; force mass_ratio m (w^2 r + 2 damping_ratio w r')"
    )
    source: ClassVar[str] = "Den Hartog 1956, chapter 3 (the dynamic absorber)"
    group: ClassVar[str] = "mechanism"
    n_memory: ClassVar[int] = 2

    def shortest_time(self, speed: float) -> float:
        """Return the period [s]."""
        return 1.0 / self.frequency

    def rest(self, position: Array, velocity: Array) -> Array:
        """Return (q, q') of an oscillator that moves along with the body, shape (n, 2)."""
        return np.stack([position, velocity], axis=1)


def surroundings(world, memory, rates, p):
    """Add the oscillator's force; write its motion."""
    w = 2.0 * math.pi * p[1]
    pull = w * w * (memory[0] - world[POSITION]) + 2.0 * p[2] * w * (memory[1] - world[VELOCITY])
    rates[0] = memory[1]
    rates[1] = -pull
    world[LOAD] += p[0] * world[MASS] * pull
