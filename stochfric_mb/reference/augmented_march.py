"""Marching the augmented belt-box: Dormand-Prince steps with dense output, and switches located within the step."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.effects import contract as e
from stochfric_mb.numerics.cubic import hermite, turning_point, value
from stochfric_mb.numerics.root import bracket, is_wide, narrowed, trial
from stochfric_mb.numerics.runge_kutta import DOPRI5, RK4, advance, interpolate, weighted
from stochfric_mb.reference import augmented_model as m
from stochfric_mb.reference.augmented_model import friction_force, hold, margin, motion, ride, rub, spring_constants, surround
from stochfric_mb.reference.events import BREAK_AWAY, STICK, note

OK, ENDLESS, NOT_FINITE, TOO_STIFF = 0.0, 1.0, 2.0, 3.0
RUN_AWAY = 1.0e12
"""Position over the error allowed at which a box has run away: a spring that softens without end throws it out at once."""
ENDLESS_SWITCHES = 5
"""Switches per output, on average, beyond which a contact chatters without end."""
MOST_STEPS = 500
"""Steps per output, on average, beyond which a motion is too stiff: the stiffest contact that a fit may reach, 1 um
at 8 N, swings through 1150 rad/s and takes 120 of them where outputs are 50 ms apart."""
APART = 1000.0
"""Draws at break-aways and re-sticks between those of two forecasts [-]: more than one forecast uses."""
MEMORY_TOLERANCE = 1.0e-7
"""Local error of an effect's memory, relative to its size."""
SHORTEST = 1.0e-12
"""Step [s] that is taken whatever its error: only a jump asks for it."""
RESOLUTION = 1.0e-13
"""Time [s] to which a switch is located."""
COLUMNS = 7
"""x, x', F, stick, N, and the path's mu_s, mu_k."""

A, C, DENSE = DOPRI5.a, DOPRI5.c, DOPRI5.dense
RK4_A, RK4_B, RK4_C = RK4.a, RK4.b, RK4.c
ERROR = DOPRI5.errors[0]


@compiled
def begin(r, d, t, position, velocity, stuck, dwell, slip, slip_time, draws, deflection):
    """Set up a run at time t [s]; the memories are in ``r.y`` already. A deflection that is not a number: at rest."""
    clock, y = r.clock, r.y
    clock[m.NOW], clock[m.DWELL], clock[m.DRAWS], clock[m.SWITCHES], clock[m.STATUS] = t, dwell, draws, 0.0, OK
    clock[m.SINCE] = t - dwell - (0.0 if stuck else slip_time)
    clock[m.STEP], clock[m.MARGIN] = r.constants[m.RESTART], math.nan
    y[0], y[1] = position, velocity
    surround(r, t, y, r.unused)
    travel, belt = r.world[e.BELT_TRAVEL], r.world[e.BELT_VELOCITY]
    if stuck and r.constants[m.LIMIT] == 0.0:
        _ride_from(r, position, travel)
        ride(r, t, y, r.unused)
    elif stuck:
        clock[m.MODE] = m.SPRING
        if math.isnan(deflection):
            deflection = hold(r, t) / spring_constants(r)[0]
        clock[m.ANCHOR] = travel - position - deflection
    else:
        side = 1.0 if belt > velocity or (belt == velocity and hold(r, t) >= 0.0) else -1.0
        _slide_from(r, side, travel - position, slip)
        clock[m.ARMED] = 1.0 if abs(belt - velocity) > r.constants[m.RESTICK] else 0.0
    _copy(r, y, r.probe)


@compiled
def _ride_from(r, position, travel):
    r.clock[m.MODE] = m.STUCK
    r.clock[m.X_STUCK], r.clock[m.TRAVEL_STUCK] = position, travel


@compiled
def _slide_from(r, side, u, slip):
    r.clock[m.MODE], r.clock[m.SIDE], r.clock[m.ARMED] = m.SLIDING, side, 0.0
    r.clock[m.BROKE_AT], r.clock[m.SLID] = u, slip


@compiled
def march(r, d, step, count, rows, only_position):
    """Integrate from now to ``count`` outputs every ``step`` [s]; fill ``rows``; return the log of switches.

    ``rows`` is (count, COLUMNS), or (count, 1) where only positions are asked for. The number of switches is
    ``r.clock[SWITCHES]``.
    """
    clock = r.clock
    start = clock[m.NOW]
    last = start + step * count
    log = np.empty((64, 2))
    i, tried = 0, 0
    fresh = False
    while i < count and clock[m.STATUS] == OK:
        tried += 1
        if tried > MOST_STEPS * (count + 100):
            clock[m.STATUS] = TOO_STIFF
        t = clock[m.NOW]
        h, t_end = _length(r, t, last)
        free = not (clock[m.MODE] == m.STUCK and r.counts[2] == 0)
        error = _try_step(r, d, t, h, fresh) if free else 0.0
        fresh = free
        if not error <= 1.0 and h > SHORTEST:
            clock[m.STEP] = h * (max(0.2, 0.9 * error**-0.2) if error < math.inf else 0.1)
            continue
        part, ahead = _first_crossing(r, d, t, h)
        t_new = t_end if part >= 1.0 else t + part * h
        while i < count and start + step * (i + 1) <= t_new + 1.0e-12:
            at = start + step * (i + 1)
            _within(r, min((at - t) / h, 1.0), h)
            record(r, d, at, rows[i], only_position)
            i += 1
        if part >= 1.0:
            fresh = _accept(r, d, t_new, h, error, ahead) and fresh
            continue
        _within(r, part, h)
        _copy(r, r.probe, r.y)
        clock[m.NOW] = t_new
        log = _switch(r, d, log)
        fresh = False
        if clock[m.SWITCHES] > ENDLESS_SWITCHES * (count + 1000.0):
            clock[m.STATUS] = ENDLESS
    return log


@compiled
def _accept(r, d, t, h, error, ahead):
    """Take the step tried last, of h [s] up to t; return whether the rates at its end hold for the next one."""
    clock = r.clock
    clock[m.NOW], clock[m.MARGIN] = t, ahead
    _copy(r, r.end, r.y)
    clock[m.STEP] = h * min(5.0, 0.9 * error**-0.2) if error > 0.0 else 5.0 * h
    if clock[m.MODE] == m.STUCK:
        ride(r, t, r.y, r.unused)
    elif not math.isfinite(r.y[0] + r.y[1]) or abs(r.y[0]) > RUN_AWAY * r.constants[m.TOLERANCE] > 0.0:
        clock[m.STATUS] = NOT_FINITE
    for j in range(r.counts[2] + 2):
        r.stages[0, j] = r.stages[m.STAGES - 1, j]
    return _keep(r, d)


@compiled
def _length(r, t, last):
    """Return the next step [s] and where it ends: within the longest of the mode, not beyond a knot or the last output."""
    clock, c = r.clock, r.constants
    longest = c[m.LONGEST_SLIDE] if clock[m.MODE] != m.STUCK else c[m.LONGEST_STICK]
    h = min(clock[m.STEP] if clock[m.MODE] != m.STUCK or r.counts[2] > 0 else longest, longest)
    end = last
    if c[m.KNOTS] > 0.0:
        end = min(end, (math.floor(t / c[m.KNOTS] + 1.0e-9) + 1.0) * c[m.KNOTS])
    if end - t <= 1.0000001 * h:
        return end - t, end
    return h, t + h


@compiled
def _copy(r, source, target):
    for j in range(r.counts[2] + 2):
        target[j] = source[j]


@compiled
def _try_step(r, d, t, h, fresh):
    """Write the solution after a step h into ``r.end``; return its local error over the one allowed.

    ``fresh``: the first stage is known already.
    """
    n = r.counts[2] + 2
    k = r.stages
    if not fresh:
        _copy(r, r.y, r.probe)
        motion(r, d, t, r.probe, k[0])
    for i in range(1, m.STAGES):
        advance(A[i], i, h, r.y, k, 0, n, r.probe)
        if i == m.STAGES - 1:
            _copy(r, r.probe, r.end)
        motion(r, d, t + C[i] * h, r.probe, k[i])
    worst = 0.0
    c = r.constants
    for j in range(n):
        if j < 2 and r.clock[m.MODE] == m.STUCK:
            continue
        difference = weighted(ERROR, m.STAGES, k, j)
        scale = c[m.TOLERANCE]
        if j == 1:
            scale *= math.sqrt(c[m.K] / c[m.M])
        elif j >= 2:
            scale = MEMORY_TOLERANCE * (abs(r.y[j]) + abs(h * k[0, j])) + 1.0e-12
        worst = max(worst, abs(h * difference) / scale)
        if math.isnan(difference):
            return math.inf
    return worst


@compiled
def _within(r, part, h):
    """Write the unknowns at the given part of the step tried last into ``r.probe`` (not x, x' of a stuck box)."""
    interpolate(DENSE, part, h, r.y, r.stages, 2 if r.clock[m.MODE] == m.STUCK else 0, r.counts[2] + 2, r.probe)


@compiled
def _margin_within(r, d, t, part, h):
    _within(r, part, h)
    return margin(r, d, t + part * h, r.probe)


@compiled
def _first_crossing(r, d, t, h):
    """Return the part of the step at which the margin turns negative, 2 if it does not, and the margin at its end.

    It is looked at in the middle, at the end, and where a parabola through both and the start has its bottom.
    """
    first = r.clock[m.MARGIN]
    if math.isnan(first):
        _copy(r, r.y, r.probe)
        first = margin(r, d, t, r.probe)
    middle = _margin_within(r, d, t, 0.5, h)
    if middle < 0.0:
        return _crossing(r, d, t, h, 0.0, first, 0.5, middle), middle
    end = _margin_within(r, d, t, 1.0, h)
    bottom, predicted = turning_point(0.0, first, 0.5, middle, 1.0, end)
    if 0.0 < bottom < 1.0 and predicted < 0.1 * first:
        at_bottom = _margin_within(r, d, t, bottom, h)
        if at_bottom < 0.0:
            return _crossing(r, d, t, h, 0.0, first, bottom, at_bottom), middle
    if end < 0.0:
        return _crossing(r, d, t, h, 0.5, middle, 1.0, end), end
    return 2.0, end


@compiled
def _crossing(r, d, t, h, low, at_low, high, at_high):
    """Return the part of the step at which the margin has turned negative, to `RESOLUTION`."""
    b = bracket(low, at_low, high, at_high)
    while is_wide(b, RESOLUTION / h):
        part = trial(b, RESOLUTION / h)
        b = narrowed(b, part, _margin_within(r, d, t, part, h))
    return min(b.negative, 0.9999999999999999)


@compiled
def _switch(r, d, log):
    """Go to the next mode; return the log of switches."""
    clock, y, w = r.clock, r.y, r.world
    t = clock[m.NOW]
    clock[m.STEP], clock[m.MARGIN] = r.constants[m.RESTART], math.nan
    if clock[m.MODE] == m.SLIDING:
        return _come_to_rest(r, d, log)
    if clock[m.MODE] == m.STUCK:
        ride(r, t, y, r.unused)
        side = 1.0 if hold(r, t) >= 0.0 else -1.0
    else:
        surround(r, t, y, r.unused)
        side = 1.0 if w[e.BELT_TRAVEL] - y[0] > clock[m.ANCHOR] else -1.0
    clock[m.DWELL] = t - clock[m.SINCE]
    _slide_from(r, side, w[e.BELT_TRAVEL] - y[0], 0.0)
    clock[m.SWITCHES] += 1.0
    return note(log, int(clock[m.SWITCHES]) - 1, t, BREAK_AWAY)


@compiled
def _come_to_rest(r, d, log):
    """Stick where friction can hold the box, otherwise slide on to the side that the loads push it to."""
    clock, y, w = r.clock, r.y, r.world
    t = clock[m.NOW]
    surround(r, t, y, r.unused)
    travel = w[e.BELT_TRAVEL]
    if r.constants[m.LIMIT] > 0.0:
        rub(r, d, t, clock[m.SIDE], 0.0, 0.0, 0.0, 0.0)
        stiffness, damping = spring_constants(r)
        limit = w[e.MU_S] * w[e.NORMAL_FORCE] / stiffness
        z = clock[m.SIDE] * limit - damping * (w[e.BELT_VELOCITY] - y[1]) / stiffness
        clock[m.MODE] = m.SPRING
        clock[m.ANCHOR] = travel - y[0] - min(max(z, -limit), limit)
    else:
        y[1] = w[e.BELT_VELOCITY]
        surround(r, t, y, r.unused)
        needed = hold(r, t)
        side = 1.0 if needed >= 0.0 else -1.0
        rub(r, d, t, side, 0.0, 0.0, 0.0, 0.0)
        if abs(needed) > w[e.MU_S] * w[e.NORMAL_FORCE]:
            _slide_from(r, side, travel - y[0], clock[m.SLID] + abs(travel - y[0] - clock[m.BROKE_AT]))
            clock[m.SWITCHES] += 1.0
            return note(log, int(clock[m.SWITCHES]) - 1, t, BREAK_AWAY)
        _ride_from(r, y[0], travel)
    clock[m.SINCE] = t
    clock[m.DWELL] = 0.0
    clock[m.DRAWS] += 1.0
    clock[m.SWITCHES] += 1.0
    return note(log, int(clock[m.SWITCHES]) - 1, t, STICK)


@compiled
def _keep(r, d):
    """Update what changes within a mode after an accepted step; return whether the rates at its end still hold."""
    clock, y = r.clock, r.y
    if clock[m.MODE] == m.SLIDING and clock[m.ARMED] == 0.0 and r.constants[m.RESTICK] > 0.0:
        surround(r, clock[m.NOW], y, r.unused)
        if clock[m.SIDE] * (r.world[e.BELT_VELOCITY] - y[1]) > r.constants[m.RESTICK]:
            clock[m.ARMED], clock[m.MARGIN] = 1.0, math.nan
    elif clock[m.MODE] == m.SPRING:
        _, z, limit = m.spring(r, d, clock[m.NOW], y, r.unused)
        if abs(z) > limit:
            clock[m.ANCHOR] += z - math.copysign(limit, z)
            clock[m.MARGIN] = math.nan
            return False
    return True


@compiled
def record(r, d, t, row, only_position):
    """Fill an output row from the unknowns in ``r.probe``."""
    if only_position:
        if r.clock[m.MODE] == m.STUCK:
            ride(r, t, r.probe, r.unused)
        row[0] = r.probe[0]
        return
    row[2] = friction_force(r, d, t, r.probe)
    row[0], row[1] = r.probe[0], r.probe[1]
    row[3] = 1.0 if r.clock[m.MODE] != m.SLIDING else 0.0
    row[4] = r.world[e.NORMAL_FORCE]
    c = r.constants
    row[5], row[6] = m.evaluate(
        d, r.cursor, int(c[m.SEED]), int(c[m.SAMPLE]), int(c[m.CONTACT]), t, r.world[e.BELT_POSITION], r.clock[m.DRAWS]
    )  # fmt: skip


@compiled
def recall(r, time, position, velocity, memory, out):
    """Fill ``out`` (n, n_memory) with the memories while the body moves as given, on cubics between the samples.

    The classical Runge-Kutta formula, one step a sample.
    """
    n = r.counts[2]
    k = r.stages
    for j in range(n):
        r.y[2 + j] = memory[j]
        out[0, j] = memory[j]
    for i in range(len(time) - 1):
        h = time[i + 1] - time[i]
        path = hermite(h, position[i], velocity[i], position[i + 1], velocity[i + 1])
        for s in range(len(RK4_B)):
            part = RK4_C[s]
            advance(RK4_A[s], s, h, r.y, k, 2, 2 + n, r.probe)
            r.probe[0], r.probe[1] = value(path, part), (1.0 - part) * velocity[i] + part * velocity[i + 1]
            surround(r, time[i] + part * h, r.probe, k[s])
        advance(RK4_B, len(RK4_B), h, r.y, k, 2, 2 + n, r.y)
        for j in range(n):
            out[i + 1, j] = r.y[2 + j]


@compiled
def forecasts(r, d, starts, memories, step, count, out):
    """Fill ``out`` (k, count) with positions from each start, each with draws of its own; return the worst status."""
    worst = OK
    row = np.empty((count, 1))
    for k in range(len(starts)):
        for j in range(r.counts[2]):
            r.y[2 + j] = memories[k, j]
        s = starts[k]
        begin(r, d, s[0], s[1], s[2], s[3] != 0.0, s[4], s[5], 0.0, APART * k, math.nan)
        march(r, d, step, count, row, True)
        worst = max(worst, r.clock[m.STATUS])
        if worst == TOO_STIFF:
            return worst
        for i in range(count):
            out[k, i] = row[i, 0]
    return worst
