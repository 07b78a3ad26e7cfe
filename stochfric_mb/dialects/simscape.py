"""Simscape's Translational Friction block."""

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.dialects.contract import Array, Dialect
from stochfric_mb.dialects.curve import Curve
from stochfric_mb.dialects.fitting import fit, half_way, viscous


@dataclasses.dataclass(frozen=True, kw_only=True)
class Simscape(Dialect):
    """Stribeck, Coulomb and viscous friction, smooth through v = 0."""

    breakaway_friction_force: float
    """F_brk [N]."""
    breakaway_friction_velocity: float
    """v_brk [m/s]."""
    coulomb_friction_force: float
    """F_C [N]."""
    viscous_friction_coefficient: float
    """f [N s/m]."""

    kind: ClassVar[str] = "simscape"
    title: ClassVar[str] = "Simscape, Translational Friction block"
    equation: ClassVar[str] = (
        "F = sqrt(2 e) (F_brk - F_C) exp(-(v/v_St)^2) v/v_St + F_C tanh(v/v_Coul) + f v, "
        "v_St = sqrt(2) v_brk, v_Coul = v_brk/10"
    )
    source: ClassVar[str] = "MathWorks, Simscape documentation, Translational Friction"
    nearest: ClassVar[str] = "havsin"
    holds: ClassVar[bool] = False

    def coefficient(self, speed: Array, normal_force: float) -> Array:
        """Return F/N."""
        brk, coulomb = self.breakaway_friction_force, self.coulomb_friction_force
        r = speed / (math.sqrt(2.0) * self.breakaway_friction_velocity)
        stribeck = math.sqrt(2.0 * math.e) * (brk - coulomb) * np.exp(-r * r) * r
        sliding = coulomb * np.tanh(10.0 * speed / self.breakaway_friction_velocity)
        return (stribeck + sliding + self.viscous_friction_coefficient * speed) / normal_force

    def break_away(self, normal_force: float) -> float:
        """Return F_brk/N."""
        return self.breakaway_friction_force / normal_force

    @classmethod
    def fitted(cls, curve: Curve) -> Dialect:
        """Return the nearest parameters."""
        n = curve.normal_force
        last = float(curve.coefficient[-1])
        start = [curve.break_away * n, half_way(curve.speed, curve.coefficient) / 2.0, last * n, 1e-6 * n / curve.speed[-1]]

        def made(x: Array) -> Simscape:
            return cls(
                breakaway_friction_force=float(x[0]),
                breakaway_friction_velocity=float(x[1]),
                coulomb_friction_force=float(x[2]),
                viscous_friction_coefficient=viscous(x[3], curve.speed[-1], last * n),
            )

        def model(x: Array) -> tuple[Array, float]:
            return made(x).coefficient(curve.speed, n), float(x[0]) / n

        return made(fit(model, start, curve.coefficient, curve.break_away)[0])
