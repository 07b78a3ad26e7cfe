"""The servo friction models M1 to M6 of Rhoban's bam."""

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.dialects.contract import Array, Dialect
from stochfric_mb.dialects.curve import Curve
from stochfric_mb.dialects.fitting import fit, half_way, viscous
from stochfric_mb.errors import require_name

MODELS = ("m1", "m2", "m3", "m4", "m5", "m6")


@dataclasses.dataclass(frozen=True, kw_only=True)
class Bam(Dialect):
    """Base, Stribeck, viscous and load-dependent friction; forces where bam has torques.

    The load terms are read at a given load of motor and outside. M1: base and viscous; M2: with Stribeck; M3: M1 with load;
    M4: M2 with load; M5: with a direction of the load; M6: with its square.
    """

    model: str = "m2"
    """One of m1 to m6."""
    friction_base: float
    """Friction that is always there [N]."""
    friction_viscous: float
    """Viscous coefficient [N s/m]."""
    friction_stribeck: float = 0.0
    """Friction that is added at rest [N]."""
    dtheta_stribeck: float = 1.0
    """Stribeck velocity [m/s]."""
    alpha: float = 1.0
    """Its exponent [-]."""
    load_friction_base: float = 0.0
    """Share of the load (m3, m4) [-]."""
    load_friction_stribeck: float = 0.0
    """The same at rest (m4) [-]."""
    load_friction_motor: float = 0.0
    """Share of the motor's force (m5, m6) [-]."""
    load_friction_external: float = 0.0
    """Share of the outside force (m5, m6) [-]."""
    load_friction_motor_stribeck: float = 0.0
    """The same at rest [-]."""
    load_friction_external_stribeck: float = 0.0
    """The same at rest [-]."""
    load_friction_motor_quad: float = 0.0
    """Square of the motor's force (m6) [1/N]."""
    load_friction_external_quad: float = 0.0
    """Square of the outside force (m6) [1/N]."""
    motor_force: float = 0.0
    """Force of the motor at which the load terms are read [N]."""
    external_force: float = 0.0
    """Outside force at which they are read [N]."""

    kind: ClassVar[str] = "bam"
    title: ClassVar[str] = "Rhoban bam, models M1 to M6"
    equation: ClassVar[str] = (
        "F = friction_base + load + s(v) (friction_stribeck + load at rest) + friction_viscous v, "
        "s = exp(-(v/dtheta_stribeck)^alpha)"
    )
    source: ClassVar[str] = (
        "Duclusaud, Passault, Padois, Ly 2025, Extended friction models for servo actuators; github.com/Rhoban/bam"
    )
    nearest: ClassVar[str] = "stribeck"
    holds: ClassVar[bool] = True

    def __post_init__(self) -> None:
        require_name("model of bam", self.model, MODELS)

    def _levels(self) -> tuple[float, float]:
        """Return what is always there and what is added at rest [N], load included."""
        motor, outside = self.motor_force, self.external_force
        base, rest = self.friction_base, self.friction_stribeck if self.model in ("m2", "m4", "m5", "m6") else 0.0
        if self.model in ("m3", "m4"):
            base += self.load_friction_base * abs(outside - motor)
        if self.model == "m4":
            rest += self.load_friction_stribeck * abs(outside - motor)
        if self.model in ("m5", "m6"):
            base += abs(outside * self.load_friction_external - motor * self.load_friction_motor)
            rest += abs(outside * self.load_friction_external_stribeck - motor * self.load_friction_motor_stribeck)
        if self.model == "m6" and np.sign(motor) != np.sign(outside):
            stronger_motor = abs(motor) > abs(outside)
            rest += (
                self.load_friction_external_quad * outside**2 if stronger_motor else self.load_friction_motor_quad * motor**2
            )
        return base, rest

    def coefficient(self, speed: Array, normal_force: float) -> Array:
        """Return F/N."""
        base, rest = self._levels()
        power = np.minimum(self.alpha * np.log(speed / self.dtheta_stribeck), 700.0)  # beyond, nothing is left of it
        falling = rest * np.exp(-np.exp(power))
        return (base + falling + self.friction_viscous * speed) / normal_force

    def break_away(self, normal_force: float) -> float:
        """Return the friction at rest over N."""
        return sum(self._levels()) / normal_force

    @classmethod
    def fitted(cls, curve: Curve) -> Dialect:
        """Return the nearest M2: a law under one normal force has no load terms."""
        n, last = curve.normal_force, float(curve.coefficient[-1])
        fall = half_way(curve.speed, curve.coefficient) / np.log(2.0)
        start = [last * n, max(curve.break_away - last, 1e-6) * n, fall, 1.0, 1e-6 * n / curve.speed[-1]]

        def made(x: Array) -> Bam:
            return cls(
                model="m2",
                friction_base=float(x[0]),
                friction_stribeck=float(x[1]),
                dtheta_stribeck=float(x[2]),
                alpha=float(x[3]),
                friction_viscous=viscous(x[4], curve.speed[-1], last * n),
            )

        def model(x: Array) -> tuple[Array, float]:
            trial = made(x)
            return trial.coefficient(curve.speed, n), trial.break_away(n)

        return made(fit(model, start, curve.coefficient, curve.break_away)[0])

    def lost(self, curve: Curve) -> list[str]:
        """Return what bam's models cannot say."""
        result = super().lost(curve)
        if not curve.holds:
            result.append("creep: the budget of friction holds a load below it")
        return [
            *result,
            "the normal force: bam's load terms follow the forces of motor and outside, not a contact's normal force",
        ]
