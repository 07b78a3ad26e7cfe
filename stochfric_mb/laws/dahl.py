"""Dahl friction: a bristle whose force approaches mu_k N along the path, whatever the speed."""

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

AT_REST = 1.0e-4
"""Speed up to which a contact is born at rest [m/s], that of `Law.stick_speed`."""


@dataclasses.dataclass(frozen=True)
class Dahl(Law):
    """Rate-independent presliding friction: F = sigma_0 z N, dz/dt = v - sigma_0 abs(v) z/mu_k.

    Between commits the equation is solved exactly along a straight path: z moves towards (mu_k/sigma_0) v/abs(v) by
    exp(-sigma_0 abs(du)/mu_k). It has one level, mu_k; mu_s does not enter.

    Reference: P. R. Dahl, A solid friction model, Aerospace Corporation TOR-0158(3107-18)-1, 1968 (exponent 1).
    """

    sigma_0: float = 8.0e4
    """Bristle stiffness over normal force [1/m], > 0."""

    kind: ClassVar[str] = "dahl"
    equation: ClassVar[str] = "F = sigma_0 z N, dz/dt = v - sigma_0 abs(v) z/mu_k"
    source: ClassVar[str] = "Dahl 1968"
    state_names: ClassVar[tuple[str, ...]] = ("ux", "uy", "zx", "zy")
    has_flow: ClassVar[bool] = True
    exceptions: ClassVar[dict[str, str]] = {
        "sticks": "drifts under a load that oscillates, and has no mu_s: it lets go at mu_k N",
        "passive": "a bristle without damping is pumped by a normal force that changes at its own frequency",
    }
    step_limit_formula: ClassVar[str] = "2/omega, omega^2 = sigma_0 N/m_eff"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("mu_k", self.mu_k, above=0.0)
        require_number("sigma_0", self.sigma_0, above=0.0, unit="1/m")

    def step_limit(self, normal_force: float, effective_mass: float) -> float:
        """Return 2/omega [s] with omega^2 = sigma_0 N/m_eff."""
        return 2.0 / math.sqrt(self.sigma_0 * normal_force / effective_mass)


@compiled
def flow(vx, vy, normal_force, zx, zy, mu_s, mu_k, p):
    """Return the force [N] and the rate of the bristle deflection [m/s]."""
    fade = p[2] * length(vx, vy) / mu_k
    return p[2] * zx * normal_force, p[2] * zy * normal_force, vx - fade * zx, vy - fade * zy


@compiled
def deflection(ux, uy, state, mu_k, p):
    """Return the bristle deflection [m] after the straight path since the last commit."""
    dx = ux - state[0]
    dy = uy - state[1]
    path = length(dx, dy)
    if path <= 0.0:
        return state[2], state[3]
    full = mu_k / p[2]
    keep = math.exp(-path / full)
    ex = full * (dx / path)
    ey = full * (dy / path)
    return ex + (state[2] - ex) * keep, ey + (state[3] - ey) * keep


@compiled
def init(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state at the start: at rest up to `AT_REST`, beyond it the deflection of steady sliding.

    It takes mu_k/sigma_0 to turn the bristle over, some micrometres: a contact born in motion is through with them at once.
    """
    speed = length(vx, vy)
    if speed <= AT_REST:
        return ux, uy, 0.0, 0.0
    full = mu_k / p[2]
    return ux, uy, full * (vx / speed), full * (vy / speed)


@compiled
def force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the friction force [N], sigma_0 z N."""
    zx, zy = deflection(ux, uy, state, mu_k, p)
    fx, fy, _, _ = flow(vx, vy, normal_force, zx, zy, mu_s, mu_k, p)
    return fx, fy


@compiled
def commit(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state after an accepted step: the deflection reached."""
    zx, zy = deflection(ux, uy, state, mu_k, p)
    return ux, uy, zx, zy


@compiled
def guards(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the turning points of v."""
    return vx, -vx, 1.0, 1.0, 1.0, 1.0
