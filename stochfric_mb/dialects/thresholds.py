"""Static and dynamic coefficients with threshold velocities: Adams (cubic steps) and RecurDyn (haversines)."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

import numpy as np

from stochfric_mb.dialects.contract import Array, Dialect
from stochfric_mb.dialects.curve import Curve
from stochfric_mb.dialects.fitting import fit, half_way
from stochfric_mb.errors import InputError


@dataclasses.dataclass(frozen=True, kw_only=True)
class _Thresholds(Dialect):
    static_coefficient: float
    """Coefficient at the static threshold [-]."""
    dynamic_coefficient: float
    """Coefficient from the dynamic threshold on [-]."""
    static_threshold_velocity: float
    """Velocity of the static coefficient [m/s]."""
    dynamic_threshold_velocity: float
    """Velocity of the dynamic coefficient [m/s], above the other."""

    nearest: ClassVar[str] = "havsin"
    holds: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if not 0.0 < self.static_threshold_velocity < self.dynamic_threshold_velocity:
            raise InputError(
                f"static_threshold_velocity = {self.static_threshold_velocity:g} m/s must be above 0 and below "
                f"dynamic_threshold_velocity = {self.dynamic_threshold_velocity:g} m/s"
            )

    @staticmethod
    def step(s: Array) -> Array:
        """Return the step from 0 at s = 0 to 1 at s = 1."""
        raise NotImplementedError

    def coefficient(self, speed: Array, normal_force: float) -> Array:
        """Return mu: from -mu_s at -v_s to mu_s at v_s, then to mu_d at v_d."""
        v_s, v_d = self.static_threshold_velocity, self.dynamic_threshold_velocity
        rising = self.static_coefficient * (2.0 * self.step(np.clip((speed + v_s) / (2.0 * v_s), 0.0, 1.0)) - 1.0)
        part = self.step(np.clip((speed - v_s) / (v_d - v_s), 0.0, 1.0))
        falling = self.static_coefficient + (self.dynamic_coefficient - self.static_coefficient) * part
        return np.where(speed <= v_s, rising, falling)

    def break_away(self, normal_force: float) -> float:
        """Return the static coefficient."""
        return self.static_coefficient

    @classmethod
    def fitted(cls, curve: Curve) -> Dialect:
        """Return the nearest thresholds; that of a law that sticks truly goes to a tenth of the lowest speed."""
        low = float(curve.speed[0])
        peak = float(curve.speed[np.argmax(curve.coefficient)])
        begin = 0.1 * low if curve.holds else min(peak, 0.5 * half_way(curve.speed, curve.coefficient))
        start = [curve.break_away, curve.coefficient[-1], begin, half_way(curve.speed, curve.coefficient)]

        def made(x: Array) -> Any:
            v_s = float(x[2]) + 0.1 * low  # what lies further below the lowest speed makes no difference
            return cls(
                static_coefficient=float(x[0]),
                dynamic_coefficient=float(x[1]),
                static_threshold_velocity=v_s,
                dynamic_threshold_velocity=v_s + float(x[3]),
            )

        def model(x: Array) -> tuple[Array, float]:
            return made(x).coefficient(curve.speed, curve.normal_force), float(x[0])

        result, _ = fit(model, start, curve.coefficient, curve.break_away)
        return made(result)


class Adams(_Thresholds):
    """Adams/View and Adams/Solver: friction of CONTACT statements."""

    kind: ClassVar[str] = "adams"
    title: ClassVar[str] = "Adams, CONTACT friction: mu_static, mu_dynamic, stiction and friction transition velocity"
    equation: ClassVar[str] = (
        "mu = STEP(v, -v_s, -mu_s, v_s, mu_s) to v_s, STEP(v, v_s, mu_s, v_d, mu_d) beyond; STEP: s^2 (3 - 2 s)"
    )
    source: ClassVar[str] = "Adams/Solver documentation, CONTACT statement, Coulomb friction"

    @staticmethod
    def step(s: Array) -> Array:
        """Return the cubic step."""
        return s * s * (3.0 - 2.0 * s)


class Recurdyn(_Thresholds):
    """RecurDyn: friction of contacts."""

    kind: ClassVar[str] = "recurdyn"
    title: ClassVar[str] = "RecurDyn, contact friction: static and dynamic coefficients and threshold velocities"
    equation: ClassVar[str] = "mu = HAVSIN(v, -v_s, -mu_s, v_s, mu_s) to v_s, HAVSIN(v, v_s, mu_s, v_d, mu_d) beyond"
    source: ClassVar[str] = "RecurDyn documentation, contact friction"

    @staticmethod
    def step(s: Array) -> Array:
        """Return the haversine step."""
        return 0.5 * (1.0 - np.cos(np.pi * s))
