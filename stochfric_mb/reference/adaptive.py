"""Event-located adaptive integration of the belt-box with any law, compiled once for all laws.

Unknowns y = (x, x', z): position, velocity and, for laws with a ``flow``, the bristle deflection. The formula is
DOP853; it never steps across an output time, a coefficient knot, or a zero of one of the law's guards. A guard that
has been positive and turns negative is located on the step size, to the rounding of the time, on its negative side,
so that the law's own inequality in ``commit`` holds there. Commits happen once per accepted step, nowhere else.

Times are kept as the start of a *leg* (from one output time or knot to the next) and the time ``tau`` since then, so
that an event is located far below the rounding of the absolute time.
"""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.coefficients.path import evaluate
from stochfric_mb.coefficients.processes import EVENT, TIME
from stochfric_mb.compile import compiled
from stochfric_mb.laws.abi import MAX_STATE
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.reference.events import BREAK_AWAY, STICK, note
from stochfric_mb.reference.knots import load_first_segment, load_segment, next_belt_segment, since_knot
from stochfric_mb.reference.law_calls import call, friction, measure_guards, pinned, sticks
from stochfric_mb.reference.location import first_crossing, locate
from stochfric_mb.reference.problem import ALL_GUARDS, EVENTS, HIGH, KNOT, N_EVENTS, N_STEPS, NOW, STATUS, STEP, STUCK
from stochfric_mb.reference.step import try_step

OK, TOO_MANY_STEPS, NOT_FINITE = 0.0, 1.0, 2.0
MAX_STEPS_PER_LEG = 20_000_000
MAX_SETTLES = 20
"""Most commits at one instant: a new pair of coefficients at re-stick can break the contact away again."""


@compiled
def start(q, run, t, given):
    """Set up a run at time t [s] from ``run.y``, the law's state being ``run.state`` if ``given``, else from ``init``."""
    clock = run.clock
    clock[NOW] = t
    clock[STEP] = q.restart
    load_first_segment(q, run, t)
    tau = since_knot(q, run, t, 0.0)
    if not given:
        call(q.init, q, run, t, tau, run.y)
        for i in range(MAX_STATE):
            run.state[i] = run.out[i]
    if q.bristle >= 0:
        run.y[2] = run.state[q.bristle]
    if pinned(q, run):
        run.y[1] = q.box.belt_velocity
    measure_guards(q, run, t, tau, run.y, run.guards)
    for i in range(ALL_GUARDS):
        run.armed[i] = 1.0 if run.guards[i] > 0.0 or i >= GUARDS + 2 else 0.0
    clock[STUCK] = sticks(q, run, run.y)


@compiled
def march(q, run, times, rows):
    """Integrate to each of ``times`` [s]; fill ``rows`` (n, 6): x, x', F, mu_s, mu_k, stick; return the log of new events.

    Their number is ``run.clock[N_EVENTS]``.
    """
    log = np.empty((64, 2))
    run.clock[N_EVENTS] = 0.0
    for i in range(len(times)):
        while run.clock[NOW] < times[i] and run.clock[STATUS] == OK:
            log = _leg(q, run, times[i], log)
        if run.clock[STATUS] != OK:
            break
        _record(q, run, rows[i])
    return log


@compiled
def _record(q, run, row):
    """Write one output row; the coefficients come from the path itself, at its own rounding."""
    t = run.clock[NOW]
    x, v = run.y[0], run.y[1]
    force, _ = friction(q, run, t, since_knot(q, run, t, 0.0), run.y)
    u = q.box.belt_velocity * t - x
    mu_s, mu_k = evaluate(
        q.descriptor, run.output_cursor, q.seed, q.sample, q.contact, t, u, run.segment[EVENTS]
    )  # fmt: skip
    row[0], row[1], row[2], row[3], row[4], row[5] = x, v, force, mu_s, mu_k, run.clock[STUCK]


@compiled
def _leg(q, run, t_end, log):
    """Integrate from now to ``t_end`` or the next knot in time, whichever is first."""
    clock = run.clock
    t_leg = clock[NOW]
    at_knot = False
    if q.descriptor[1] == TIME and run.segment[HIGH] <= t_end + 1.0e-12:
        at_knot = True
        if run.segment[HIGH] < t_end - 1.0e-12:
            t_end = run.segment[HIGH]
    length = t_end - t_leg
    tau = 0.0
    steps = 0
    while tau < length:
        steps += 1
        rest = length - tau
        last = rest <= 1.0000001 * clock[STEP]
        h = rest if last else clock[STEP]
        error = try_step(q, run, t_leg, tau, h)
        if not error <= q.tolerance and h > q.shortest:
            clock[STEP] = h * max(0.2, 0.9 * (q.tolerance / error) ** 0.125) if error < math.inf else 0.1 * h
            continue
        if not (math.isfinite(run.end[0]) and math.isfinite(run.end[1]) and math.isfinite(run.end[2])):
            clock[STATUS] = NOT_FINITE
            break
        if steps > MAX_STEPS_PER_LEG:
            clock[STATUS] = TOO_MANY_STEPS
            break
        clock[N_STEPS] += 1.0
        lowest, highest = first_crossing(q, run, t_leg, tau, h)
        located = highest > 0.0
        if located:
            h = locate(q, run, t_leg, tau, lowest, highest)
            last = last and h == rest
        for j in range(3):
            run.y[j] = run.end[j]
        tau = length if last else tau + h
        log, switched = _settle(q, run, t_leg, tau, located, log)
        if located or switched:
            clock[STEP] = q.restart
        else:
            grown = h * (6.0 if error == 0.0 else min(6.0, 0.9 * (q.tolerance / error) ** 0.125))
            clock[STEP] = min(q.longest, max(grown, clock[STEP]) if last else max(grown, 0.3 * h))
    clock[NOW] = t_end if clock[STATUS] == OK else t_leg + tau
    if at_knot and clock[STATUS] == OK:
        load_segment(q, run, run.segment[KNOT] + 1.0)
        if q.descriptor[2] == 0.0:
            log, _ = _settle(q, run, t_end, 0.0, False, log)
    return log


@compiled
def _settle(q, run, t_leg, tau, located, log):
    """Commit an accepted step: the law's state, belt knots, stick flag, events; return (log, whether the mode changed).

    A guard that has fired without a change of mode is armed again one step later at the earliest: commit may have put
    the contact exactly on it (the clipped deflection of an elastic stick).
    """
    t = t_leg + tau
    switched = False
    for _ in range(MAX_SETTLES):
        mode = run.state[0]
        since = since_knot(q, run, t_leg, tau)
        if q.bristle >= 0:
            run.state[q.bristle] = run.y[2]
        else:
            call(q.commit, q, run, t, since, run.y)
            for i in range(MAX_STATE):
                run.state[i] = run.out[i]
        if pinned(q, run):
            run.y[1] = q.box.belt_velocity
        switched = switched or (q.moded and run.state[0] != mode)
        log, entered = _note(q, run, t, log)
        moved = next_belt_segment(q, run, t)
        if entered and q.descriptor[1] == EVENT:
            load_segment(q, run, run.segment[EVENTS])
        elif not (moved and q.descriptor[2] == 0.0):
            break
    for i in range(ALL_GUARDS):
        fired = located and not switched and run.armed[i] == 1.0 and run.guards[i] < 0.0
        run.table[0, i] = 1.0 if fired else 0.0
        if fired or switched:
            run.armed[i] = 0.0
    measure_guards(q, run, t, since_knot(q, run, t_leg, tau), run.y, run.guards)
    for i in range(ALL_GUARDS):
        g = run.guards[i]
        positive = g > 0.0 and run.table[0, i] == 0.0
        still = g == 0.0 and run.armed[i] == 1.0
        run.armed[i] = 1.0 if positive or still or i >= GUARDS + 2 else 0.0
    return log, switched


@compiled
def _note(q, run, t, log):
    """Update the stick flag; log a change of it; return (log, whether the contact has just entered stick)."""
    now = sticks(q, run, run.y)
    clock = run.clock
    if now == clock[STUCK]:
        return log, False
    clock[STUCK] = now
    log = note(log, int(clock[N_EVENTS]), t, STICK if now == 1.0 else BREAK_AWAY)
    clock[N_EVENTS] += 1.0
    if now == 1.0:
        run.segment[EVENTS] += 1.0
    return log, now == 1.0
