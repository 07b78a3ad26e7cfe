"""A smooth law for contact simulation: an arctangent step that falls from mu_s towards mu_k."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.errors import require_number
from stochfric_mb.laws.contract import Law
from stochfric_mb.laws.plane import along, length
from stochfric_mb.laws.stateless import commit, init

__all__ = ["Smooth", "coefficient", "commit", "force", "guards", "init", "sliding_coefficient"]


@dataclasses.dataclass(frozen=True)
class Smooth(Law):
    """An infinitely smooth law: mu(v) = 2/pi arctan(v/v_s) [mu_k + (mu_s - mu_k)/(1 + (v/v_d)^2)].

    Reference: P. Song, P. Kraus, V. Kumar, P. Dupont, J. Applied Mechanics 68, 2001, 118-128,
    doi 10.1115/1.1331060, who smooth the sign function so that contact problems have one solution. Their article was
    not at hand: the arctangent step is the usual form of such a law, and the fall to mu_k is ours, so that the law
    takes both coefficients.
    """

    v_s: float = 1.0e-5
    """Width of the step at v = 0 [m/s], > 0."""
    v_d: float = 1.0e-3
    """Velocity at which half of mu_s - mu_k is gone [m/s], > 0."""

    kind: ClassVar[str] = "smooth"
    rest: ClassVar[str] = "creep"
    equation: ClassVar[str] = "mu = 2/pi arctan(v/v_s) (mu_k + (mu_s - mu_k)/(1 + (v/v_d)^2))"
    source: ClassVar[str] = "after Song, Kraus, Kumar and Dupont 2001"
    exceptions: ClassVar[dict[str, str]] = {"sticks": "creeps: any load is balanced at the velocity where mu(v) N equals it"}
    step_limit_formula: ClassVar[str] = "pi v_s m_eff/(mu_s N)"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("v_s", self.v_s, above=0.0, unit="m/s")
        require_number("v_d", self.v_d, above=0.0, unit="m/s")

    @property
    def peak_speed(self) -> float:
        """Return the speed [m/s] at which mu is largest, to 0.1 % of mu (of 1e4 v_s at most: mu_s = mu_k has no peak)."""
        speeds = self.v_s * np.logspace(0.0, 4.0, 2001)
        fall = speeds / self.v_d
        mu = np.arctan(speeds / self.v_s) * (self.mu_k + (self.mu_s - self.mu_k) / (1.0 + fall * fall))
        return float(speeds[np.argmax(mu)])

    def step_limit(self, normal_force: float, effective_mass: float) -> float:
        """Return pi v_s m_eff/(mu_s N) [s]: at rest the law is a damper of 2 mu_s N/(pi v_s)."""
        return math.pi * self.v_s * effective_mass / (self.mu_s * normal_force)


@compiled
def coefficient(speed, mu_s, mu_k, v_s, v_d):
    """Return mu(speed) [-] for speed >= 0."""
    fall = speed / v_d
    return 2.0 / math.pi * math.atan(speed / v_s) * (mu_k + (mu_s - mu_k) / (1.0 + fall * fall))


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
    """Return no guard: the law is smooth."""
    return 1.0, 1.0, 1.0, 1.0, 1.0, 1.0
