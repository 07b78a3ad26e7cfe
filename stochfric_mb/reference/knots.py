"""The coefficients around the present state: linear between the knots of their path, in time or along the belt."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math

from stochfric_mb.coefficients.path import canonical_time, seek
from stochfric_mb.coefficients.processes import EVENT, POSITION, TIME
from stochfric_mb.compile import compiled
from stochfric_mb.reference.problem import EVENTS, HIGH, KNOT, LOW, MU_K, MU_S, ORIGIN, SLOPE_K, SLOPE_S


@compiled
def load_first_segment(q, run, t):
    """Find the knots around the start."""
    run.segment[EVENTS] = 0.0
    spacing = q.descriptor[3]
    if q.descriptor[1] == TIME:
        knot = float(math.floor(canonical_time(t, 0.0) / spacing))
        if (knot + 1.0) * spacing <= t + 1.0e-12:
            knot += 1.0
    elif q.descriptor[1] == POSITION:
        u = q.box.belt_velocity * t - run.y[0]
        knot = float(math.floor(u / spacing))
        if u < knot * spacing:
            knot -= 1.0
        elif u >= (knot + 1.0) * spacing:
            knot += 1.0
    else:
        knot = 0.0
    load_segment(q, run, knot)


@compiled
def load_segment(q, run, knot):
    """Take the coefficients from ``knot`` to the next one."""
    s = run.segment
    s[KNOT] = knot
    if q.descriptor[0] == 0.0:
        s[ORIGIN], s[LOW], s[HIGH] = 0.0, -math.inf, math.inf
        s[MU_S], s[SLOPE_S], s[MU_K], s[SLOPE_K] = q.descriptor[4], 0.0, q.descriptor[5], 0.0
        return
    spacing = q.descriptor[3]
    seek(q.descriptor, run.cursor, q.seed, q.sample, q.contact, int(knot))
    s[ORIGIN] = s[LOW] = knot * spacing
    s[HIGH] = (knot + 1.0) * spacing
    s[MU_S], s[MU_K] = run.cursor[2], run.cursor[3]
    s[SLOPE_S] = s[SLOPE_K] = 0.0
    if q.descriptor[2] == 1.0 and q.descriptor[1] != EVENT:
        s[SLOPE_S] = (run.cursor[4] - run.cursor[2]) / spacing
        s[SLOPE_K] = (run.cursor[5] - run.cursor[3]) / spacing


@compiled
def next_belt_segment(q, run, t):
    """Move to the neighbouring knots along the belt if u has left the present ones; return whether it has."""
    if q.descriptor[1] != POSITION:
        return False
    u = q.box.belt_velocity * t - run.y[0]
    if u < run.segment[LOW]:
        load_segment(q, run, run.segment[KNOT] - 1.0)
        return True
    if u > run.segment[HIGH]:
        load_segment(q, run, run.segment[KNOT] + 1.0)
        return True
    return False


@compiled
def since_knot(q, run, t, tau):
    """Return the time since the last knot [s] at t + tau (0 for paths that do not run along time)."""
    return (t - run.segment[ORIGIN]) + tau if q.descriptor[1] == TIME else 0.0


@compiled
def coefficients(q, run, since, u):
    """Return (mu_s, mu_k) [-], linear between the knots; ``since`` is the time since the last knot."""
    s = run.segment
    r = u - s[ORIGIN] if q.descriptor[1] == POSITION else since
    return s[MU_S] + s[SLOPE_S] * r, s[MU_K] + s[SLOPE_K] * r
