"""Hyperbolic-tangent friction, the smoothing used by the DADS code."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

from stochfric_mb.compile import compiled
from stochfric_mb.errors import require_number
from stochfric_mb.laws.contract import Law
from stochfric_mb.laws.plane import along, length
from stochfric_mb.laws.stateless import commit, init

__all__ = ["Tanh", "commit", "force", "guards", "init", "sliding_coefficient"]


@dataclasses.dataclass(frozen=True)
class Tanh(Law):
    """Kinetic friction smoothed by a hyperbolic tangent: mu(v) = mu_k tanh(v/v_s).

    It has one level, mu_k; mu_s is kept for the pair of coefficients that every law takes and does not enter.

    Reference: the smoothing of the DADS multibody code, as cited by Kang, Choi and Yoo 2015; see Andersson,
    Soderberg and Bjorklund, Tribology International 40, 2007, 580-587, doi 10.1016/j.triboint.2005.11.014.
    """

    v_s: float = 1.0e-4
    """Velocity scale [m/s], > 0: mu reaches 76 % of mu_k there."""

    kind: ClassVar[str] = "tanh"
    rest: ClassVar[str] = "creep"
    equation: ClassVar[str] = "mu = mu_k tanh(v/v_s)"
    source: ClassVar[str] = "DADS; Andersson et al. 2007"
    exceptions: ClassVar[dict[str, str]] = {
        "sticks": "creeps: any load is balanced at the velocity where mu_k tanh(v/v_s) N equals it; it has no mu_s"
    }
    step_limit_formula: ClassVar[str] = "2 v_s m_eff/(mu_k N)"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("v_s", self.v_s, above=0.0, unit="m/s")

    @property
    def peak_speed(self) -> float:
        """Return 20 v_s [m/s]: there mu is mu_k to rounding."""
        return 20.0 * self.v_s

    def step_limit(self, normal_force: float, effective_mass: float) -> float:
        """Return 2 v_s m_eff/(mu_k N) [s]: at rest the law is a damper of mu_k N/v_s."""
        return 2.0 * self.v_s * effective_mass / (self.mu_k * normal_force) if self.mu_k > 0.0 else math.inf


@compiled
def force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the friction force [N], mu_k tanh(abs(v)/v_s) N along v."""
    return along(mu_k * math.tanh(length(vx, vy) / p[2]) * normal_force, vx, vy)


@compiled
def sliding_coefficient(speed, mu_s, mu_k, p):
    """Return mu(speed) [-]."""
    return mu_k * math.tanh(speed / p[2])


@compiled
def guards(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return no guard: the law is smooth."""
    return 1.0, 1.0, 1.0, 1.0, 1.0, 1.0
