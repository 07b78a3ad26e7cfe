"""Piecewise-linear friction: up to mu_s at v_s, down to mu_k at v_d, constant beyond."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError, require_number
from stochfric_mb.laws.contract import Law
from stochfric_mb.laws.plane import along, length
from stochfric_mb.laws.stateless import commit, init

__all__ = ["PiecewiseLinear", "coefficient", "commit", "force", "guards", "init", "sliding_coefficient"]


@dataclasses.dataclass(frozen=True)
class PiecewiseLinear(Law):
    """The velocity-limited law of straight lines.

    mu(v) = mu_s v/v_s up to v_s; mu_s + (mu_k - mu_s)(v - v_s)/(v_d - v_s) up to v_d; mu_k beyond; odd in v.

    Reference: F. A. Tariku, R. J. Rogers, J. Tribology 123, 2001, 661-669, doi 10.1115/1.1331057, as the
    velocity-limited model that they compare with; cited as the piecewise-linear law by Kang, Choi and Yoo 2015.
    """

    v_s: float = 1.0e-4
    """Velocity of the static peak [m/s], > 0."""
    v_d: float = 1.0e-3
    """Velocity above which mu = mu_k [m/s], > v_s."""

    kind: ClassVar[str] = "piecewise_linear"
    rest: ClassVar[str] = "creep"
    equation: ClassVar[str] = "mu: lines through (0, 0), (v_s, mu_s), (v_d, mu_k), then constant; odd in v"
    source: ClassVar[str] = "Tariku and Rogers 2001"
    exceptions: ClassVar[dict[str, str]] = {
        "sticks": "creeps: any load is balanced at the velocity 0 < v < v_s where mu(v) N equals it"
    }
    step_limit_formula: ClassVar[str] = "2 v_s m_eff/(mu_s N)"

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
        """Return 2 v_s m_eff/(mu_s N) [s]: the rising branch is a damper of mu_s N/v_s."""
        return 2.0 * self.v_s * effective_mass / (self.mu_s * normal_force)


@compiled
def coefficient(speed, mu_s, mu_k, v_s, v_d):
    """Return mu(speed) [-] for speed >= 0."""
    if speed <= v_s:
        return mu_s * speed / v_s
    if speed <= v_d:
        return mu_s + (mu_k - mu_s) * (speed - v_s) / (v_d - v_s)
    return mu_k


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
    """Return the kinks at v_s and v_d, from both sides."""
    speed = length(vx, vy)
    return speed - p[2], p[2] - speed, speed - p[3], p[3] - speed, 1.0, 1.0
