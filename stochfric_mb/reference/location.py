"""Where within a step a guard of the law turns negative: seen on an interpolation, found on the step size itself."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math

from stochfric_mb.compile import compiled
from stochfric_mb.numerics.cubic import hermite, sign_change, turning_point, value
from stochfric_mb.numerics.root import bracket, is_wide, narrowed, trial
from stochfric_mb.reference.knots import since_knot
from stochfric_mb.reference.law_calls import measure_guards
from stochfric_mb.reference.problem import ALL_GUARDS, CHECKS, STAGES
from stochfric_mb.reference.step import try_step

RESOLUTION = 1.0e-19
"""Time [s] to which an event is located within its step."""
SMALLEST = 5.0e-324
"""What a guard of zero counts as: one has fired where it is negative."""


@compiled
def first_crossing(q, run, t_leg, tau, h):
    """Return (low, high) [s] within the step between which the first armed guard seems to turn negative, or (0, 0)."""
    g = run.table
    for i in range(ALL_GUARDS):
        g[0, i] = run.guards[i]
    n = _check_points(q, run, h)
    for c in range(1, n + 1):
        theta = run.checks[c]
        _measure_within(q, run, t_leg, tau, theta, h, g[c])
        dip = _dip(q, run, t_leg, tau, h, c - 1) if c > 1 else 0.0
        if dip > 0.0:
            return run.checks[c - 2] * h, dip * h
        for i in range(ALL_GUARDS):
            if g[c, i] < 0.0 and run.armed[i] == 1.0:
                return run.checks[c - 1] * h, theta * h
        if c < n:
            for i in range(ALL_GUARDS):
                if g[c, i] > 0.0:
                    run.armed[i] = 1.0
    return 0.0, 0.0


@compiled
def _along(run, h, j):
    """Return the cubic of unknown j through both ends of the step tried last."""
    return hermite(h, run.y[j], run.stages[0, j], run.end[j], run.stages[STAGES, j])


@compiled
def _check_points(q, run, h):
    """Write the parts of the step at which guards are looked at into ``run.checks``; return the index of the last.

    They are even parts, and on the cubic the zeros and extrema of v_rel: between them abs(v_rel) is monotone, so that
    no speed limit, however narrow, is stepped over.
    """
    v = _along(run, h, 1)
    v_rel = (q.box.belt_velocity - v[0], -v[1], -v[2], -v[3])
    slope = (v_rel[1], 2.0 * v_rel[2], 3.0 * v_rel[3], 0.0)
    n = 0
    run.checks[0] = 0.0
    for c in range(CHECKS):
        low, high = c / CHECKS, (c + 1) / CHECKS
        zero, turn = sign_change(v_rel, low, high), sign_change(slope, low, high)
        for theta in (min(zero, turn), max(zero, turn), high):
            if run.checks[n] < theta <= high:
                n += 1
                run.checks[n] = theta
    return n


@compiled
def _measure_within(q, run, t_leg, tau, theta, h, g):
    """Write the guards at the part theta of the step tried last into ``g``."""
    for j in range(3):
        run.probe[j] = run.end[j] if theta == 1.0 else value(_along(run, h, j), theta)
    part = tau + theta * h
    measure_guards(q, run, t_leg + part, since_knot(q, run, t_leg, part), run.probe, g)


@compiled
def _dip(q, run, t_leg, tau, h, c):
    """Return the part of the step at which an armed guard dips below zero around check point c, or 0."""
    g = run.table
    t0, t1, t2 = run.checks[c - 1], run.checks[c], run.checks[c + 1]
    first = 0.0
    for i in range(ALL_GUARDS):
        before, here, after = g[c - 1, i], g[c, i], g[c + 1, i]
        if not (run.armed[i] == 1.0 and 0.0 <= here <= before and here < after):
            continue
        theta, bottom = turning_point(t0, before, t1, here, t2, after)
        if bottom > 0.5 * here:
            continue
        _measure_within(q, run, t_leg, tau, theta, h, run.guards)
        if run.guards[i] < 0.0 and (first == 0.0 or theta < first):
            first = theta
    return first


@compiled
def locate(q, run, t_leg, tau, low, high):
    """Return the shortest step h [s] after which an armed guard is negative, down to rounding.

    The solution there is in ``run.end``. The bracket rests on an interpolation: if ``low`` is already beyond the
    event, the search starts from nothing; if nothing has crossed after ``high``, the step ``high`` is as good as any
    other and is returned.
    """
    at_low = _least(q, run, t_leg, tau, low) if low > 0.0 else math.inf
    if at_low < 0.0:
        low, high, at_low = 0.0, low, math.inf
    at_high = _least(q, run, t_leg, tau, high)
    if not at_high < 0.0:
        return high
    b = bracket(low, at_low, high, at_high)
    while is_wide(b, RESOLUTION):
        h = trial(b, RESOLUTION)
        at = _least(q, run, t_leg, tau, h)
        b = narrowed(b, h, at if at != 0.0 else SMALLEST)
    _least(q, run, t_leg, tau, b.negative)
    return b.negative


@compiled
def _least(q, run, t_leg, tau, h):
    """Return the least armed guard after a step h; the solution there is in ``run.end``."""
    try_step(q, run, t_leg, tau, h)
    part = tau + h
    measure_guards(q, run, t_leg + part, since_knot(q, run, t_leg, part), run.end, run.guards)
    least = math.inf
    for i in range(ALL_GUARDS):
        if run.armed[i] == 1.0:
            least = min(least, run.guards[i])
    return least
