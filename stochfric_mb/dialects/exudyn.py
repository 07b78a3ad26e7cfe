"""Exudyn's CoordinateSpringDamperExt: a bristle with static and dynamic friction."""

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.dialects.contract import Array, Dialect
from stochfric_mb.dialects.curve import BRISTLE, Curve
from stochfric_mb.dialects.fitting import fit, half_way, viscous

STIFF = 1.0e-5
"""Deflection at break-away that is taken where the law has none [m]."""
ZETA = 0.3
"""Damping ratio that is taken then [-], at 1 kg."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class ExudynBristle(Dialect):
    """Spring and damper while stuck, an exponential fall while sliding."""

    fDynamicFriction: float  # noqa: N815  (Exudyn's names)
    """Dynamic friction force [N]."""
    fStaticFrictionOffset: float  # noqa: N815
    """Static minus dynamic friction force [N]."""
    stickingStiffness: float  # noqa: N815
    """Stiffness while stuck [N/m]."""
    stickingDamping: float  # noqa: N815
    """Damping while stuck [N s/m]."""
    exponentialDecayStatic: float  # noqa: N815
    """Velocity scale of the fall [m/s]."""
    fViscousFriction: float  # noqa: N815
    """Viscous part [N s/m]."""

    kind: ClassVar[str] = "exudyn"
    title: ClassVar[str] = "Exudyn, CoordinateSpringDamperExt with bristle"
    equation: ClassVar[str] = (
        "sliding: F = fDynamicFriction + fStaticFrictionOffset exp(-v/exponentialDecayStatic) + fViscousFriction v; "
        "stuck: stickingStiffness z + stickingDamping v"
    )
    source: ClassVar[str] = "Exudyn documentation, ObjectConnectorCoordinateSpringDamperExt"
    nearest: ClassVar[str] = "elastic_stick"
    holds: ClassVar[bool] = True
    memory: ClassVar[str] = BRISTLE

    def coefficient(self, speed: Array, normal_force: float) -> Array:
        """Return F/N."""
        falling = self.fStaticFrictionOffset * np.exp(-speed / max(self.exponentialDecayStatic, 1e-300))
        return (self.fDynamicFriction + falling + self.fViscousFriction * speed) / normal_force

    def break_away(self, normal_force: float) -> float:
        """Return (dynamic friction + static offset)/N."""
        return (self.fDynamicFriction + self.fStaticFrictionOffset) / normal_force

    @classmethod
    def fitted(cls, curve: Curve) -> Dialect:
        """Return the nearest parameters; stiffness and damping are the law's own where it has them."""
        n, last = curve.normal_force, float(curve.coefficient[-1])
        stiffness = curve.stiffness or curve.break_away * n / STIFF
        damping = curve.damping or 2.0 * ZETA * math.sqrt(stiffness)
        fall = half_way(curve.speed, curve.coefficient) / math.log(2.0)
        start = [last * n, max(curve.break_away - last, 1e-6) * n, fall, 1e-6 * n / curve.speed[-1]]

        def made(x: Array) -> ExudynBristle:
            return cls(
                fDynamicFriction=float(x[0]),
                fStaticFrictionOffset=float(x[1]),
                stickingStiffness=stiffness,
                stickingDamping=damping,
                exponentialDecayStatic=float(x[2]),
                fViscousFriction=viscous(x[3], curve.speed[-1], last * n),
            )

        def model(x: Array) -> tuple[Array, float]:
            trial = made(x)
            return trial.coefficient(curve.speed, n), trial.break_away(n)

        return made(fit(model, start, curve.coefficient, curve.break_away)[0])

    def lost(self, curve: Curve) -> list[str]:
        """Return what the bristle cannot say."""
        result = super().lost(curve)
        if not curve.holds:
            result.append("creep: the bristle holds a load below break-away")
        return result
