"""Position-dependent friction: coefficients that repeat along the belt or along the stroke."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import BELT_POSITION, MU_K, MU_S, POSITION, Effect, choice, parameter
from stochfric_mb.effects.marks import Slips, Wave, friction_at, times


@dataclasses.dataclass(frozen=True, kw_only=True)
class PositionDependentFriction(Effect):
    """mu_s and mu_k times 1 + sum of a_h cos(2 pi h s/wavelength + phase_h), h = 1, 2, 3.

    s is the belt coordinate under the body, belt travel - x (axis "belt"), or x (axis "position").

    Reference: B. Armstrong-Helouvry, Control of Machines with Friction, Kluwer 1991 (friction against joint position).
    """

    amplitude: float = parameter("-", "relative amplitude of the first harmonic", scale=0.03)
    """Relative amplitude of the first harmonic [-]."""
    wavelength: float = parameter("m", "wavelength of the first harmonic", scale=0.01, low=0.0, strict=True)
    """Wavelength of the first harmonic [m]."""
    phase: float = parameter("rad", "phase of the first harmonic at s = 0", scale=1.0, default=0.0)
    """Phase of the first harmonic at s = 0 [rad]."""
    axis: str = choice("along what friction varies", ("belt", "position"))
    """Along what friction varies: "belt" or "position"."""
    amplitude_2: float = parameter("-", "relative amplitude of the second harmonic", scale=0.01, default=0.0)
    """Relative amplitude of the second harmonic [-]."""
    phase_2: float = parameter("rad", "phase of the second harmonic at s = 0", scale=1.0, default=0.0)
    """Phase of the second harmonic at s = 0 [rad]."""
    amplitude_3: float = parameter("-", "relative amplitude of the third harmonic", scale=0.01, default=0.0)
    """Relative amplitude of the third harmonic [-]."""
    phase_3: float = parameter("rad", "phase of the third harmonic at s = 0", scale=1.0, default=0.0)
    """Phase of the third harmonic at s = 0 [rad]."""

    kind: ClassVar[str] = "position_dependent_friction"
    equation: ClassVar[str] = "both mu times 1 + sum a_h cos(2 pi h s/wavelength + phase_h), s = belt travel - x, or x"
    source: ClassVar[str] = "Armstrong-Helouvry 1991"
    group: ClassVar[str] = "friction varies"
    shows_on: ClassVar[str] = "belt position"
    shows: ClassVar[str] = "friction varies along the belt"
    order: ClassVar[int] = 3

    def shortest_time(self, speed: float) -> float:
        """Return the time [s] in which the contact passes the shortest wavelength that acts."""
        harmonic = 3.0 if self.amplitude_3 != 0.0 else 2.0 if self.amplitude_2 != 0.0 else 1.0
        return self.wavelength / (harmonic * speed) if speed > 0.0 else math.inf

    @classmethod
    def wave(cls, slips: Slips) -> Wave:
        """Return friction that is modulated along the belt, in stick and slip by the same share."""
        slowest = float(slips.belt_velocity.min())
        position = np.concatenate([slips.typical_onset[:, None], slips.typical_position], axis=1)
        typical = float(np.median([s.record.mechanism.belt_velocity for s in slips.slips]))
        place = (slips.belt_velocity[:, None] * times(slips) - position) / slowest
        return Wave(place, friction_at(slips), lambda f: slowest / f, typical / slowest)


def friction(world, memory, rates, p):
    """Multiply both coefficients by the pattern."""
    s = world[BELT_POSITION] if p[3] == 0.0 else world[POSITION]
    angle = 2.0 * math.pi * s / p[1]
    factor = 1.0 + p[0] * math.cos(angle + p[2])
    if p[4] != 0.0 or p[6] != 0.0:
        factor += p[4] * math.cos(2.0 * angle + p[5]) + p[6] * math.cos(3.0 * angle + p[7])
    world[MU_S] *= factor
    world[MU_K] *= factor
