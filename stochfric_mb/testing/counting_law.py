"""A law for the suite alone: its coefficient falls with every commit, so that the force tells how many there were."""

from __future__ import annotations

import dataclasses
from typing import ClassVar

from stochfric_mb.compile import compiled
from stochfric_mb.laws.contract import Law
from stochfric_mb.laws.plane import along

SHARE = 1.0e-4
"""Part of mu_k that each commit takes off [-]."""


@dataclasses.dataclass(frozen=True)
class Counting(Law):
    """F = mu_k (1 - 1e-4 n) N along v after n commits."""

    kind: ClassVar[str] = "counting"
    equation: ClassVar[str] = "F = mu_k (1 - 1e-4 n) N v/abs(v), n commits"
    source: ClassVar[str] = "this suite"
    state_names: ClassVar[tuple[str, ...]] = ("commits",)


@compiled
def init(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state at the start: no commit yet."""
    return (0.0,)


@compiled
def force(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the friction force [N]."""
    return along(mu_k * (1.0 - SHARE * state[0]) * normal_force, vx, vy)


@compiled
def commit(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state after one more commit."""
    return (state[0] + 1.0,)


@compiled
def guards(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return no guard."""
    return 1.0, 1.0, 1.0, 1.0, 1.0, 1.0
