"""One step of DOP853 and its error."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math

from stochfric_mb.compile import compiled
from stochfric_mb.numerics.runge_kutta import DOP853, advance, weighted
from stochfric_mb.reference.knots import since_knot
from stochfric_mb.reference.law_calls import friction, holding_force, pinned
from stochfric_mb.reference.problem import STAGES

A, B, C = DOP853.a, DOP853.b, DOP853.c
E5, E3 = DOP853.errors


@compiled
def try_step(q, run, t_leg, tau, h):
    """Write the solution after a step h [s] into ``run.end``; return its local error relative to the scales."""
    stages = run.stages
    if pinned(q, run):
        for i in range(STAGES + 1):
            stages[i, 0], stages[i, 1], stages[i, 2] = q.box.belt_velocity, 0.0, 0.0
        run.end[0], run.end[1], run.end[2] = run.y[0] + q.box.belt_velocity * h, q.box.belt_velocity, run.y[2]
        return 0.0
    for i in range(STAGES):
        advance(A[i], i, h, run.y, stages, 0, 3, run.probe)
        part = tau + C[i] * h
        _rates(q, run, t_leg + part, since_knot(q, run, t_leg, part), run.probe, stages[i])
    advance(B, STAGES, h, run.y, stages, 0, 3, run.end)
    _rates(q, run, t_leg + (tau + h), since_knot(q, run, t_leg, tau + h), run.end, stages[STAGES])
    return _error(q, run, h)


@compiled
def _rates(q, run, t, since, y, dy):
    force, rate = friction(q, run, t, since, y)
    dy[0] = y[1]
    dy[1] = (force - holding_force(q, t, y)) / q.box.mass
    dy[2] = rate


@compiled
def _error(q, run, h):
    """Return the largest estimate of the local error over its scale, as in the code DOP853."""
    worst = 0.0
    for j in range(3):
        e5, e3 = weighted(E5, STAGES + 1, run.stages, j), weighted(E3, STAGES + 1, run.stages, j)
        size = math.sqrt(e5 * e5 + 0.01 * e3 * e3)
        if size > 0.0:
            worst = max(worst, h * e5 * e5 / size / q.scale[j])
        elif size != 0.0:  # not a number
            return math.inf
    return worst
