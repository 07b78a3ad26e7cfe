"""Modelica's friction tables: mu_pos = [v, mu; ...] with a peak factor at v = 0."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

import numpy as np

from stochfric_mb.dialects.contract import Array, Dialect
from stochfric_mb.dialects.curve import Curve
from stochfric_mb.errors import InputError

MOST_ROWS = 12
"""Most rows of a fitted table."""
CLOSE = 1.0e-3
"""Misfit at which no further row is added [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class ModelicaTable(Dialect):
    """A table of the coefficient over speed, linear between rows, and a peak factor for break-away."""

    speed: list[float]
    """Speeds of the rows [m/s], from 0, rising."""
    mu: list[float]
    """Coefficients of the rows [-]."""
    peak: float
    """Break-away coefficient over the table's first row [-], >= 1."""

    kind: ClassVar[str] = "modelica"
    title: ClassVar[str] = "Modelica Standard Library, mu_pos tables (Brake, Clutch; MassWithStopAndFriction with forces)"
    equation: ClassVar[str] = "sliding: mu interpolated in mu_pos; stuck: held up to peak*mu_pos[1, 2]"
    source: ClassVar[str] = "Modelica.Mechanics.Translational.Components.Brake, Modelica Standard Library 4"
    nearest: ClassVar[str] = "stribeck"
    holds: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if len(self.speed) != len(self.mu) or len(self.speed) < 2 or self.speed[0] != 0.0 or np.any(np.diff(self.speed) <= 0.0):
            raise InputError("speed and mu must be rows of the same length, two or more, with speeds that rise from 0")

    def coefficient(self, speed: Array, normal_force: float) -> Array:
        """Return mu between the rows."""
        return np.interp(speed, self.speed, self.mu)

    def break_away(self, normal_force: float) -> float:
        """Return peak times the first row."""
        return self.peak * self.mu[0]

    @classmethod
    def fitted(cls, curve: Curve) -> Dialect:
        """Return a table whose rows lie on the curve, each put where the ones before miss it most."""
        first = float(curve.coefficient[0])
        rows = {0.0: first, float(curve.speed[-1]): float(curve.coefficient[-1])}
        while len(rows) < MOST_ROWS:
            x = sorted(rows)
            missed = np.abs(np.interp(curve.speed, x, [rows[v] for v in x]) - curve.coefficient)
            worst = int(np.argmax(missed))
            if missed[worst] < CLOSE:
                break
            rows[float(curve.speed[worst])] = float(curve.coefficient[worst])
        x = sorted(rows)
        return cls(speed=x, mu=[rows[v] for v in x], peak=max(curve.break_away / first, 1.0))

    def lost(self, curve: Curve) -> list[str]:
        """Return what the table cannot say: friction that falls to zero with the speed becomes true stick."""
        result = super().lost(curve)
        if not curve.holds:
            result.append("creep: Modelica's contact sticks truly below its first row")
        return result

    def snippet(self) -> str:
        """Return the table as Modelica writes it."""
        return (
            "mu_pos = ["
            + "; ".join(f"{v:.6g}, {m:.6g}" for v, m in zip(self.speed, self.mu, strict=True))
            + f"], peak = {self.peak:.6g}"
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the parameters by name."""
        return {"speed": list(self.speed), "mu": list(self.mu), "peak": self.peak}
