"""Karnopp's law: a small velocity zone in which the contact counts as at rest and the holding force acts."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

from stochfric_mb.compile import compiled
from stochfric_mb.errors import require_number
from stochfric_mb.laws.contract import Law
from stochfric_mb.laws.plane import clipped, length, slip_direction

STICK = 0.0
ZONE = 1.0
"""Inside the zone, with a load above mu_s N."""
SLIP = 2.0


@dataclasses.dataclass(frozen=True)
class Karnopp(Law):
    """Stick-slip by a zone abs(v) <= v_s in which velocity is taken as zero.

    In the zone F = the holding force, up to mu_s N; outside F = mu_k N v/abs(v). A contact that enters the zone with
    a holding force below mu_s N is stopped: its velocity jumps by at most v_s.

    Reference: D. Karnopp, J. Dynamic Systems, Measurement and Control 107, 1985, 100-103, doi 10.1115/1.3140698.
    """

    v_s: float = 1.0e-4
    """Half width of the zone [m/s], > 0 (Karnopp's DV)."""

    kind: ClassVar[str] = "karnopp"
    rest: ClassVar[str] = "rigid"
    equation: ClassVar[str] = "abs(v) <= v_s: F = holding force, abs(F) <= mu_s N; otherwise F = mu_k N v/abs(v)"
    source: ClassVar[str] = "Karnopp 1985"
    state_names: ClassVar[tuple[str, ...]] = ("mode", "dx", "dy")
    needs_holding_force: ClassVar[bool] = True
    exceptions: ClassVar[dict[str, str]] = {"continuous": "the force jumps from mu_s N to mu_k N at v_s"}

    def __post_init__(self) -> None:
        super().__post_init__()
        require_number("v_s", self.v_s, above=0.0, unit="m/s")


@compiled
def init(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state at the start: sliding if abs(v) > v_s, otherwise what the holding force allows."""
    speed = length(vx, vy)
    if speed > p[2]:
        return SLIP, vx / speed, vy / speed
    hold = length(hx, hy)
    if hold > mu_s * normal_force:
        return ZONE, hx / hold, hy / hold
    return STICK, 0.0, 0.0


@compiled
def force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the friction force [N]: the holding force within mu_s N in the zone, mu_k N along v outside."""
    if state[0] < SLIP:
        return clipped(hx, hy, mu_s * normal_force)
    ex, ey = slip_direction(vx, vy, state[1], state[2])
    return mu_k * normal_force * ex, mu_k * normal_force * ey


@compiled
def commit(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state after an accepted step: by speed alone, and in the zone by the holding force."""
    speed = length(vx, vy)
    sliding = speed >= p[2] if state[0] == ZONE else speed > p[2]
    if state[0] != STICK and sliding:
        return SLIP, vx / speed, vy / speed
    hold = length(hx, hy)
    if hold > mu_s * normal_force:
        return ZONE, hx / hold, hy / hold
    return STICK, 0.0, 0.0


@compiled
def sliding_coefficient(speed, mu_s, mu_k, p):
    """Return the most that friction can be [-]: mu_s within the zone, mu_k outside."""
    return mu_s if speed <= p[2] else mu_k


@compiled
def guards(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the distances to break-away, to the edge of the zone, and back into it."""
    speed = length(vx, vy)
    slack = mu_s * normal_force - length(hx, hy)
    if state[0] == STICK:
        return slack, 1.0, 1.0, 1.0, 1.0, 1.0
    if state[0] == ZONE:
        return p[2] - speed, -slack, 1.0, 1.0, 1.0, 1.0
    # along the committed direction: a step may pass the whole zone
    return vx * state[1] + vy * state[2] - p[2], 1.0, 1.0, 1.0, 1.0, 1.0
