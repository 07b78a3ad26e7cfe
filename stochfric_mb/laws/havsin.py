"""HAVSIN, the modified Coulomb law: a haversine step up to mu_s at v_s, and another down to mu_k at v_d."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError, require_number
from stochfric_mb.laws.contract import Law
from stochfric_mb.laws.plane import along, length
from stochfric_mb.laws.stateless import commit, init

__all__ = ["Havsin", "coefficient", "commit", "force", "guards", "haversine_step", "init", "sliding_coefficient"]


@dataclasses.dataclass(frozen=True)
class Havsin(Law):
    """The modified Coulomb law: a smooth function of velocity alone.

    mu(v) = HAVSIN(v, 0, 0, v_s, mu_s) up to v_s, HAVSIN(v, v_s, mu_s, v_d, mu_k) beyond (constant above v_d), with
    HAVSIN(x, x0, h0, x1, h1) = (h0 + h1)/2 + (h1 - h0)/2 sin((x - x0)/(x1 - x0) pi - pi/2); odd in v.

    Reference: Kang, Choi and Yoo 2015, eqs. 1-2, doi 10.1007/s12206-015-0808-4. The paper gives v_r >= 0 only (odd
    extension here) and neither v_s nor v_d.
    """

    v_s: float = 1.0e-4
    """Velocity of the static peak [m/s], > 0."""
    v_d: float = 1.0e-3
    """Velocity above which mu = mu_k [m/s], > v_s."""

    kind: ClassVar[str] = "havsin"
    rest: ClassVar[str] = "creep"
    equation: ClassVar[str] = "mu = HAVSIN(v, 0, 0, v_s, mu_s), then HAVSIN(v, v_s, mu_s, v_d, mu_k); odd in v"
    source: ClassVar[str] = "Kang, Choi and Yoo 2015, eqs. 1-2"
    exceptions: ClassVar[dict[str, str]] = {
        "sticks": "creeps: any load is balanced at the velocity 0 < v < v_s where mu(v) N equals it"
    }
    step_limit_formula: ClassVar[str] = "4 v_s m_eff/(pi mu_s N)"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("v_s", self.v_s, above=0.0, unit="m/s")
        require_number("v_d", self.v_d, above=0.0, unit="m/s")
        if self.v_d <= self.v_s:
            raise InputError(f"v_d = {self.v_d:g} m/s must be above v_s = {self.v_s:g} m/s; raise v_d or lower v_s")

    @property
    def peak_speed(self) -> float:
        """Return v_s [m/s]."""
        return self.v_s

    def step_limit(self, normal_force: float, effective_mass: float) -> float:
        """Return 4 v_s m_eff/(pi mu_s N) [s]: the steepest slope of the rising branch is pi mu_s/(2 v_s)."""
        return 4.0 * self.v_s * effective_mass / (math.pi * self.mu_s * normal_force)


@compiled
def haversine_step(x, x0, h0, x1, h1):
    """Return HAVSIN(x, x0, h0, x1, h1), eq. 2: h0 below x0, h1 above x1, a haversine between."""
    if x <= x0:
        return h0
    if x >= x1:
        return h1
    return 0.5 * (h0 + h1) + 0.5 * (h1 - h0) * math.sin((x - x0) / (x1 - x0) * math.pi - 0.5 * math.pi)


@compiled
def coefficient(speed, mu_s, mu_k, v_s, v_d):
    """Return mu(speed) [-] for speed >= 0, eq. 1."""
    if speed <= v_s:
        return haversine_step(speed, 0.0, 0.0, v_s, mu_s)
    return haversine_step(speed, v_s, mu_s, v_d, mu_k)


@compiled
def force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the friction force [N], mu(abs(v)) N along v."""
    mu = coefficient(length(vx, vy), mu_s, mu_k, p[2], p[3])
    return along(mu * normal_force, vx, vy)


@compiled
def sliding_coefficient(speed, mu_s, mu_k, p):
    """Return mu(speed) [-]."""
    return coefficient(speed, mu_s, mu_k, p[2], p[3])


@compiled
def guards(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the kinks in curvature: v = 0, v_s and v_d, from both sides."""
    speed = length(vx, vy)
    return vx, -vx, speed - p[2], p[2] - speed, speed - p[3], p[3] - speed
