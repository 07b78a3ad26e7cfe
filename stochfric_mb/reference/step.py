"""One step of DOP853 and its error."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import math

from stochfric_mb.compile import compiled
from stochfric_mb.reference.knots import since_knot
from stochfric_mb.reference.law_calls import friction, holding_force, pinned
from stochfric_mb.reference.tableau import E3, E5, STAGES, A, B, C


@compiled
def try_step(q, run, t_leg, tau, h):
    """Write the solution after a step h [s] into ``run.end``; return its local error relative to the scales."""
    stages = run.stages
    if pinned(q, run):
        for i in range(STAGES + 1):
            stages[i, 0], stages[i, 1], stages[i, 2] = q.belt_velocity, 0.0, 0.0
        run.end[0], run.end[1], run.end[2] = run.y[0] + q.belt_velocity * h, q.belt_velocity, run.y[2]
        return 0.0
    for i in range(STAGES):
        for j in range(3):
            total = 0.0
            for k in range(i):
                total += A[i, k] * stages[k, j]
            run.probe[j] = run.y[j] + h * total
        part = tau + C[i] * h
        _rates(q, run, t_leg + part, since_knot(q, run, t_leg, part), run.probe, stages[i])
    for j in range(3):
        total = 0.0
        for k in range(STAGES):
            total += B[k] * stages[k, j]
        run.end[j] = run.y[j] + h * total
    _rates(q, run, t_leg + (tau + h), since_knot(q, run, t_leg, tau + h), run.end, stages[STAGES])
    return _error(q, run, h)


@compiled
def _rates(q, run, t, since, y, dy):
    force, rate = friction(q, run, t, since, y)
    dy[0] = y[1]
    dy[1] = (force - holding_force(q, t, y)) / q.mass
    dy[2] = rate


@compiled
def _error(q, run, h):
    """Return the largest estimate of the local error over its scale, as in the code DOP853."""
    worst = 0.0
    for j in range(3):
        e5 = 0.0
        e3 = 0.0
        for k in range(STAGES + 1):
            e5 += E5[k] * run.stages[k, j]
            e3 += E3[k] * run.stages[k, j]
        size = math.sqrt(e5 * e5 + 0.01 * e3 * e3)
        if size > 0.0:
            worst = max(worst, h * e5 * e5 / size / q.scale[j])
        elif size != 0.0:  # not a number
            return math.inf
    return worst
