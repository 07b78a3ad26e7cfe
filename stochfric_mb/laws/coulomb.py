"""Coulomb friction with true stick: the force that holds the contact, up to mu_s N; mu_k N once it slides."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

from stochfric_mb.compile import compiled
from stochfric_mb.laws.contract import Law
from stochfric_mb.laws.plane import clipped, length, slip_direction

STICK = 0.0
SLIP = 1.0


@dataclasses.dataclass(frozen=True)
class Coulomb(Law):
    """Dry friction with true stick, a hybrid automaton of two modes.

    F = the holding force while stuck and abs(F) <= mu_s N; F = mu_k N v/abs(v) while sliding.

    Reference: C.-A. Coulomb, Theorie des machines simples, 1785; the limit of HAVSIN and of elastic stick.
    """

    kind: ClassVar[str] = "coulomb"
    rest: ClassVar[str] = "rigid"
    equation: ClassVar[str] = "stuck: F = holding force, abs(F) <= mu_s N; sliding: F = mu_k N v/abs(v)"
    source: ClassVar[str] = "Coulomb 1785"
    state_names: ClassVar[tuple[str, ...]] = ("mode", "dx", "dy")
    needs_holding_force: ClassVar[bool] = True
    exceptions: ClassVar[dict[str, str]] = {"continuous": "the force jumps from mu_s N to mu_k N at break-away"}


@compiled
def init(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state at the start: sliding if v is not zero, otherwise what the holding force allows."""
    speed = length(vx, vy)
    if speed > 0.0:
        return SLIP, vx / speed, vy / speed
    hold = length(hx, hy)
    if hold > mu_s * normal_force:
        return SLIP, hx / hold, hy / hold
    return STICK, 0.0, 0.0


@compiled
def force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the friction force [N]: the holding force within the cap while stuck, mu_k N along v while sliding."""
    if state[0] == STICK:
        return clipped(hx, hy, mu_s * normal_force)
    ex, ey = slip_direction(vx, vy, state[1], state[2])
    return mu_k * normal_force * ex, mu_k * normal_force * ey


@compiled
def commit(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state after an accepted step: break-away above mu_s N, stick when v turns over below it."""
    hold = length(hx, hy)
    if state[0] == STICK:
        if hold > mu_s * normal_force:
            return SLIP, hx / hold, hy / hold
        return STICK, 0.0, 0.0
    if vx * state[1] + vy * state[2] > 0.0:
        speed = length(vx, vy)
        return SLIP, vx / speed, vy / speed
    if hold > mu_s * normal_force:
        return SLIP, hx / hold, hy / hold
    return STICK, 0.0, 0.0


@compiled
def sliding_coefficient(speed, mu_s, mu_k, p):
    """Return mu_k [-], at any speed."""
    return mu_k


@compiled
def guards(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the distances to break-away (stuck) and to turning over (sliding)."""
    if state[0] == STICK:
        return mu_s * normal_force - length(hx, hy), 1.0, 1.0, 1.0, 1.0, 1.0
    return vx * state[1] + vy * state[2], 1.0, 1.0, 1.0, 1.0, 1.0
