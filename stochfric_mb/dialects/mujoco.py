"""MuJoCo's dry friction of a joint: frictionloss, with damping beside it."""

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.dialects.contract import Array, Dialect
from stochfric_mb.dialects.curve import Curve


@dataclasses.dataclass(frozen=True, kw_only=True)
class MujocoFrictionloss(Dialect):
    """One level of dry friction and a viscous part."""

    frictionloss: float
    """Dry friction [N]."""
    damping: float
    """Viscous coefficient [N s/m]."""

    kind: ClassVar[str] = "mujoco"
    title: ClassVar[str] = "MuJoCo, frictionloss and damping of a joint"
    equation: ClassVar[str] = "F = frictionloss + damping v, softened by the solver's regularisation"
    source: ClassVar[str] = "MuJoCo documentation, XML reference, joint"
    nearest: ClassVar[str] = "coulomb"
    holds: ClassVar[bool] = False

    def coefficient(self, speed: Array, normal_force: float) -> Array:
        """Return F/N."""
        return (self.frictionloss + self.damping * speed) / normal_force

    def break_away(self, normal_force: float) -> float:
        """Return frictionloss/N."""
        return self.frictionloss / normal_force

    @classmethod
    def fitted(cls, curve: Curve) -> Dialect:
        """Return the least-squares line over the speeds, neither part negative."""
        columns = np.stack([np.ones_like(curve.speed), curve.speed], axis=1)
        level, slope = np.linalg.lstsq(columns, curve.coefficient, rcond=None)[0]
        if slope < 0.0:
            level, slope = float(np.mean(curve.coefficient)), 0.0
        return cls(frictionloss=max(float(level), 0.0) * curve.normal_force, damping=float(slope) * curve.normal_force)

    def lost(self, curve: Curve) -> list[str]:
        """Return what one level cannot say."""
        result = super().lost(curve)
        if curve.break_away > self.break_away(curve.normal_force) * 1.01:
            result.append("the difference between static and kinetic friction: no stick-slip")
        return [*result, "the normal force: frictionloss is a force, so that it does not follow the load"]
