"""init and commit of the laws that are functions of velocity alone."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

from stochfric_mb.compile import compiled


@compiled
def init(t, ux, uy, vx, vy, normal_force, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the state: none is needed (one unused entry)."""
    return (0.0,)


@compiled
def commit(t, ux, uy, vx, vy, normal_force, state, mu_s, mu_k, effective_mass, hx, hy, p):
    """Return the unchanged state."""
    return (0.0,)
