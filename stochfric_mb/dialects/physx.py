"""PhysX materials: a static and a dynamic coefficient."""

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.dialects.contract import Array, Dialect
from stochfric_mb.dialects.curve import Curve


@dataclasses.dataclass(frozen=True, kw_only=True)
class Physx(Dialect):
    """Coulomb's two levels."""

    staticFriction: float  # noqa: N815  (PhysX's names)
    """Static coefficient [-]."""
    dynamicFriction: float  # noqa: N815
    """Dynamic coefficient [-]."""

    kind: ClassVar[str] = "physx"
    title: ClassVar[str] = "PhysX (Isaac, Omniverse), material of a shape"
    equation: ClassVar[str] = "stuck: up to staticFriction N; sliding: dynamicFriction N"
    source: ClassVar[str] = "PhysX 5 documentation, PxMaterial"
    nearest: ClassVar[str] = "coulomb"
    holds: ClassVar[bool] = True

    def coefficient(self, speed: Array, normal_force: float) -> Array:
        """Return the dynamic coefficient."""
        return np.full_like(speed, self.dynamicFriction)

    def break_away(self, normal_force: float) -> float:
        """Return the static coefficient."""
        return self.staticFriction

    @classmethod
    def fitted(cls, curve: Curve) -> Dialect:
        """Return the break-away coefficient and the mean over the speeds."""
        return cls(staticFriction=curve.break_away, dynamicFriction=float(np.mean(curve.coefficient)))

    def lost(self, curve: Curve) -> list[str]:
        """Return what two levels cannot say."""
        result = super().lost(curve)
        if np.ptp(curve.coefficient) > 0.01 * curve.break_away:
            result.append("how the coefficient changes with speed")
        if not curve.holds:
            result.append("creep: the contact sticks")
        return result
