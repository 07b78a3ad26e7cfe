"""Where within a step a guard of the law turns negative: seen on an interpolation, found on the step size itself."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import math

from stochfric_mb.compile import compiled
from stochfric_mb.reference.knots import since_knot
from stochfric_mb.reference.law_calls import measure_guards
from stochfric_mb.reference.problem import ALL_GUARDS, CHECKS
from stochfric_mb.reference.step import try_step
from stochfric_mb.reference.tableau import STAGES

RESOLUTION = 1.0e-19
"""Time [s] to which an event is located within its step."""


@compiled
def bracket(q, run, t_leg, tau, h):
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
def _interpolate(run, theta, h):
    """Write the cubic through both ends of the step tried last into ``run.probe``, at the part theta."""
    for j in range(3):
        a = h * run.stages[0, j]
        b = h * run.stages[STAGES, j]
        d = run.end[j] - run.y[j]
        run.probe[j] = run.y[j] + theta * (a + theta * ((3.0 * d - 2.0 * a - b) + theta * (a + b - 2.0 * d)))


@compiled
def _check_points(q, run, h):
    """Write the parts of the step at which guards are looked at into ``run.checks``; return the index of the last.

    They are even parts, and on the cubic the zeros and extrema of v_rel: between them abs(v_rel) is monotone, so that
    no speed limit, however narrow, is stepped over.
    """
    a = h * run.stages[0, 1]
    b = h * run.stages[STAGES, 1]
    d = run.end[1] - run.y[1]
    w, c1, c2, c3 = q.belt_velocity - run.y[1], -a, -(3.0 * d - 2.0 * a - b), -(a + b - 2.0 * d)
    n = 0
    run.checks[0] = 0.0
    for c in range(CHECKS):
        low, high = c / CHECKS, (c + 1) / CHECKS
        zero = _cubic_zero(w, c1, c2, c3, low, high)
        turn = _cubic_zero(c1, 2.0 * c2, 3.0 * c3, 0.0, low, high)
        for theta in (min(zero, turn), max(zero, turn), high):
            if run.checks[n] < theta <= high:
                n += 1
                run.checks[n] = theta
    return n


@compiled
def _cubic_zero(c0, c1, c2, c3, low, high):
    """Return where c0 + c1 s + c2 s^2 + c3 s^3 changes sign between low and high, infinity if it does not."""
    positive = c0 + low * (c1 + low * (c2 + low * c3)) > 0.0
    if positive == (c0 + high * (c1 + high * (c2 + high * c3)) > 0.0):
        return math.inf
    for _ in range(50):
        middle = 0.5 * (low + high)
        if (c0 + middle * (c1 + middle * (c2 + middle * c3)) > 0.0) == positive:
            low = middle
        else:
            high = middle
    return high


@compiled
def _measure_within(q, run, t_leg, tau, theta, h, g):
    """Write the guards at the part theta of the step tried last into ``g``."""
    if theta == 1.0:
        for j in range(3):
            run.probe[j] = run.end[j]
    else:
        _interpolate(run, theta, h)
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
        falling = (here - before) / (t1 - t0)
        curvature = ((after - here) / (t2 - t1) - falling) / (t2 - t0)
        theta = 0.5 * (t0 + t1 - falling / curvature)
        if here - curvature * (theta - t1) ** 2 > 0.5 * here:
            continue
        _measure_within(q, run, t_leg, tau, theta, h, run.guards)
        if run.guards[i] < 0.0 and (first == 0.0 or theta < first):
            first = theta
    return first


@compiled
def locate(q, run, t_leg, tau, low, high):
    """Return the shortest step h [s] after which an armed guard is negative, by bisection down to rounding.

    The solution there is in ``run.end``. The bracket rests on an interpolation: if ``low`` is already beyond the
    event, the search starts from nothing; if nothing has crossed after ``high``, the step ``high`` is as good as any
    other and is returned.
    """
    if low > 0.0 and _crossed(q, run, t_leg, tau, low):
        low, high = 0.0, low
    if not _crossed(q, run, t_leg, tau, high):
        return high
    while True:
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high or high - low < RESOLUTION:
            break
        if _crossed(q, run, t_leg, tau, middle):
            high = middle
        else:
            low = middle
    _crossed(q, run, t_leg, tau, high)
    return high


@compiled
def _crossed(q, run, t_leg, tau, h):
    """Return whether an armed guard is negative after a step h; the solution there is in ``run.end``."""
    try_step(q, run, t_leg, tau, h)
    part = tau + h
    measure_guards(q, run, t_leg + part, since_knot(q, run, t_leg, part), run.end, run.guards)
    for i in range(ALL_GUARDS):  # noqa: SIM110  (numba knows no generators)
        if run.armed[i] == 1.0 and run.guards[i] < 0.0:
            return True
    return False
