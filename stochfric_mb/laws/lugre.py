"""LuGre friction: a bristle with damping and a Stribeck curve."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

from stochfric_mb.compile import compiled
from stochfric_mb.errors import require_number
from stochfric_mb.laws.contract import Law
from stochfric_mb.laws.plane import length


@dataclasses.dataclass(frozen=True)
class Lugre(Law):
    """The bristle model of Lund and Grenoble, normalised by the normal force.

    F = (sigma_0 z + sigma_1 dz/dt + sigma_2 v) N, dz/dt = v - sigma_0 abs(v) z/g(v),
    g(v) = mu_k + (mu_s - mu_k) exp(-(v/stribeck_velocity)^2).

    Between commits z is advanced along the path with g at the mean velocity since the last commit (second order). A contact
    born faster than the Stribeck velocity starts with the z of steady sliding.

    Reference: C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky, IEEE Trans. Automatic Control 40, 1995,
    419-425, doi 10.1109/9.376053, eqs. 3-6; normalised as in Canudas de Wit and Tsiotras 1999.
    """

    stribeck_velocity: float = 1.0e-3
    """Velocity scale of the Stribeck curve [m/s], > 0."""
    sigma_0: float = 8.0e4
    """Bristle stiffness over normal force [1/m], > 0."""
    sigma_1: float = 100.0
    """Bristle damping over normal force [s/m], >= 0."""
    sigma_2: float = 0.0
    """Viscous coefficient over normal force [s/m], >= 0."""

    kind: ClassVar[str] = "lugre"
    equation: ClassVar[str] = "F = (sigma_0 z + sigma_1 dz/dt + sigma_2 v) N, dz/dt = v - sigma_0 abs(v) z/g(v)"
    source: ClassVar[str] = "Canudas de Wit, Olsson, Astrom and Lischinsky 1995"
    state_names: ClassVar[tuple[str, ...]] = ("t", "ux", "uy", "zx", "zy")
    has_flow: ClassVar[bool] = True
    exceptions: ClassVar[dict[str, str]] = {
        "bounded": "sigma_1 dz/dt and sigma_2 v come on top of sigma_0 z, which alone stays within mu_s",
        "sticks": "drifts: a load that oscillates below mu_s N moves the bristle a little further each cycle",
    }
    step_limit_formula: ClassVar[str] = (
        "2 (sqrt(1 + zeta^2) - zeta)/omega, omega^2 = sigma_0 N/m_eff, zeta = sigma_1 N/(2 m_eff omega)"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("mu_k", self.mu_k, above=0.0)
        require_number("stribeck_velocity", self.stribeck_velocity, above=0.0, unit="m/s")
        require_number("sigma_0", self.sigma_0, above=0.0, unit="1/m")
        require_number("sigma_1", self.sigma_1, low=0.0, unit="s/m")
        require_number("sigma_2", self.sigma_2, low=0.0, unit="s/m")

    def step_limit(self, normal_force: float, effective_mass: float) -> float:
        """Return 2 (sqrt(1 + zeta^2) - zeta)/omega [s] of the linear bristle."""
        omega = math.sqrt(self.sigma_0 * normal_force / effective_mass)
        zeta = (self.sigma_1 + self.sigma_2) * normal_force / (2.0 * effective_mass * omega)
        return 2.0 * (math.sqrt(1.0 + zeta**2) - zeta) / omega


@compiled
def steady_coefficient(speed, mu_s, mu_k, stribeck_velocity):
    """Return g(v) [-], the coefficient of steady sliding without sigma_2."""
    r = speed / stribeck_velocity
    return mu_k + (mu_s - mu_k) * math.exp(-r * r)


@compiled
def flow(vx, vy, normal_force, zx, zy, mu_s, mu_k, p):
    """Return the force [N] and the rate of the bristle deflection [m/s]."""
    speed = length(vx, vy)
    fade = p[3] * speed / steady_coefficient(speed, mu_s, mu_k, p[2])
    wx = vx - fade * zx
    wy = vy - fade * zy
    fx = (p[3] * zx + p[4] * wx + p[5] * vx) * normal_force
    fy = (p[3] * zy + p[4] * wy + p[5] * vy) * normal_force
    return fx, fy, wx, wy


@compiled
def deflection(t, ux, uy, state, mu_s, mu_k, p):
    """Return the bristle deflection [m] after the straight path since the last commit, g at the mean velocity."""
    dx = ux - state[1]
    dy = uy - state[2]
    path = length(dx, dy)
    if path <= 0.0 or t <= state[0]:
        return state[3], state[4]
    full = steady_coefficient(path / (t - state[0]), mu_s, mu_k, p[2]) / p[3]
    keep = math.exp(-path / full)
    ex = full * (dx / path)
    ey = full * (dy / path)
    return ex + (state[3] - ex) * keep, ey + (state[4] - ey) * keep


@compiled
def init(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state at the start: at rest up to the Stribeck velocity, beyond it the deflection of steady sliding.

    From a bristle at rest a contact born in motion would feel sigma_1 v N, far above mu_s N, for the g/(sigma_0 v) that the
    bristle takes to turn over: 4 us at 1 m/s, which few steps can follow.
    """
    speed = length(vx, vy)
    if speed <= p[2]:
        return t, ux, uy, 0.0, 0.0
    full = steady_coefficient(speed, mu_s, mu_k, p[2]) / p[3]
    return t, ux, uy, full * (vx / speed), full * (vy / speed)


@compiled
def force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the friction force [N], (sigma_0 z + sigma_1 dz/dt + sigma_2 v) N."""
    zx, zy = deflection(t, ux, uy, state, mu_s, mu_k, p)
    fx, fy, _, _ = flow(vx, vy, normal_force, zx, zy, mu_s, mu_k, p)
    return fx, fy


@compiled
def commit(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state after an accepted step: the deflection reached."""
    zx, zy = deflection(t, ux, uy, state, mu_s, mu_k, p)
    return t, ux, uy, zx, zy


@compiled
def guards(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the turning points of v."""
    return vx, -vx, 1.0, 1.0, 1.0, 1.0
