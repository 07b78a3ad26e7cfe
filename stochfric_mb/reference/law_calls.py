"""The law at the contact of box and belt: its force, its guards, and whether it sticks."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math

from stochfric_mb.coefficients.processes import POSITION
from stochfric_mb.compile import compiled
from stochfric_mb.laws.abi import call_flow, call_law
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.reference.knots import coefficients
from stochfric_mb.reference.problem import HIGH, LOW


@compiled
def holding_force(q, t, y):
    """Return the friction force [N] that would make the relative acceleration zero."""
    return q.box.damping * y[1] + q.box.stiffness * y[0] - q.box.drive * math.cos(q.box.frequency * t)


@compiled
def call(address, q, run, t, since, y):
    """Call one of the law's functions for (x, x') = y; the answer is in ``run.out``."""
    u = q.box.belt_velocity * t - y[0]
    mu_s, mu_k = coefficients(q, run, since, u)
    call_law(
        address, t, u, 0.0, q.box.belt_velocity - y[1], 0.0, q.box.normal_force, mu_s, mu_k, q.box.mass,
        holding_force(q, t, y), 0.0, run.state.ctypes.data, q.parameters.ctypes.data, run.out.ctypes.data,
    )  # fmt: skip


@compiled
def friction(q, run, t, since, y):
    """Return the friction force [N] and the rate of the bristle [m/s]."""
    if q.bristle < 0:
        call(q.force, q, run, t, since, y)
        return run.out[0], 0.0
    mu_s, mu_k = coefficients(q, run, since, q.box.belt_velocity * t - y[0])
    call_flow(
        q.flow, q.box.belt_velocity - y[1], 0.0, q.box.normal_force, y[2], 0.0, mu_s, mu_k,
        q.parameters.ctypes.data, run.out.ctypes.data,
    )  # fmt: skip
    return run.out[0], run.out[2]


@compiled
def pinned(q, run):
    """Return whether the contact moves with the belt."""
    return q.holding and run.state[0] == 0.0


@compiled
def sticks(q, run, y):
    """Return 1.0 if the contact sticks, else 0.0."""
    if q.moded:
        return 1.0 if run.state[0] == 0.0 else 0.0
    return 1.0 if abs(q.box.belt_velocity - y[1]) <= q.stick_speed else 0.0


@compiled
def measure_guards(q, run, t, since, y, g):
    """Write all guards at y into ``g``."""
    call(q.guards, q, run, t, since, y)
    for i in range(GUARDS):
        g[i] = run.out[i]
    if not q.moded:
        g[GUARDS] = abs(q.box.belt_velocity - y[1]) - q.stick_speed
        g[GUARDS + 1] = -g[GUARDS]
    if q.descriptor[1] == POSITION:
        u = q.box.belt_velocity * t - y[0]
        g[GUARDS + 2] = u - run.segment[LOW]
        g[GUARDS + 3] = run.segment[HIGH] - u
