"""Event-located adaptive integration of the belt-box with any law, compiled once for all laws.

Unknowns y = (x, x', z): position, velocity and, for laws with a ``flow``, the bristle deflection. The formula is
DOP853; it never steps across an output time, a coefficient knot, or a zero of one of the law's guards. A guard that
has been positive and turns negative is located on the step size, to the rounding of the time, on its negative side,
so that the law's own inequality in ``commit`` holds there. Commits happen once per accepted step, nowhere else.

Times are kept as the start of a *leg* (from one output time or knot to the next) and the time ``tau`` since then, so
that an event is located far below the rounding of the absolute time.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from stochfric_mb.coefficients.path import CURSOR, canonical_time, evaluate, seek
from stochfric_mb.coefficients.processes import EVENT, POSITION, TIME
from stochfric_mb.compile import compiled
from stochfric_mb.laws.abi import MAX_STATE, call_flow, call_law
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.reference.events import BREAK_AWAY, STICK, note
from stochfric_mb.reference.tableau import E3, E5, STAGES, A, B, C

OK, TOO_MANY_STEPS, NOT_FINITE = 0.0, 1.0, 2.0
MAX_STEPS_PER_LEG = 20_000_000
MAX_SETTLES = 20
"""Most commits at one instant: a new pair of coefficients at re-stick can break the contact away again."""
RESOLUTION = 1.0e-19
"""Time [s] to which an event is located within its step."""
CHECKS = 4
"""Even parts of a step at whose ends, at least, the guards are looked at."""
ALL_GUARDS = GUARDS + 4
"""The law's guards, two for the stick speed (laws without a mode) and two for knots along the belt."""
# Entries of Run.segment: the coefficients between the knots around the present state
ORIGIN, MU_S, SLOPE_S, MU_K, SLOPE_K, LOW, HIGH, KNOT, EVENTS = range(9)
# Entries of Run.clock
NOW, STEP, STUCK, N_STEPS, STATUS, N_EVENTS = range(6)


class Problem(NamedTuple):
    """What does not change during a run."""

    init: int
    """Address of the law's ``init``; likewise the next four."""
    force: int
    commit: int
    guards: int
    flow: int
    parameters: Any
    """The law's parameter vector."""
    moded: bool
    """Whether the law's first state entry is a mode, 0 being stick."""
    holding: bool
    """Whether the law holds a stuck contact still."""
    bristle: int
    """Index of the bristle deflection in the law's state; -1 for laws without ``flow``."""
    stick_speed: float
    """Speed [m/s] below which a contact without a mode counts as stuck."""
    mass: float
    """m [kg]; then c [N s/m], k [N/m], N [N], k u_0 [N], W [rad/s], v_b [m/s]."""
    damping: float
    stiffness: float
    normal_force: float
    drive: float
    frequency: float
    belt_velocity: float
    descriptor: Any
    """Descriptor of the coefficient path; then its address."""
    seed: int
    sample: int
    contact: int
    tolerance: float
    """Largest local error of a step, relative to ``scale``."""
    scale: Any
    """Scales of x [m], x' [m/s] and z [m], shape (3,)."""
    longest: float
    """Longest step [s]."""
    restart: float
    """First step after the start and after each event [s]."""
    shortest: float
    """Step [s] that is taken whatever its error: only a jump that no guard announces asks for it."""


_REAL = np.float64
RUN = np.dtype(
    [
        ("y", _REAL, 3),  # present (x, x', z)
        ("state", _REAL, MAX_STATE),  # the law's state
        ("segment", _REAL, 9),  # coefficients between the knots around the present state
        ("clock", _REAL, 6),  # time, step size, stick flag and counters
        ("armed", _REAL, ALL_GUARDS),  # 1 for a guard that has been positive since the last switch
        ("guards", _REAL, ALL_GUARDS),  # present values of the guards
        ("end", _REAL, 3),  # (x, x', z) at the end of the step tried last
        ("stages", _REAL, (STAGES + 1, 3)),  # rates of the step tried last
        ("probe", _REAL, 3),  # (x, x', z) of a stage or a check point
        ("checks", _REAL, 3 * CHECKS + 1),  # check points of a step, in parts of it
        ("table", _REAL, (3 * CHECKS + 1, ALL_GUARDS)),  # guards at the check points of a step
        ("out", _REAL, MAX_STATE + GUARDS),  # where a law's functions write
        ("cursor", _REAL, CURSOR),  # knots around the present state
        ("output_cursor", _REAL, CURSOR),  # knots around the last output
    ]
)
"""What changes during a run: a record, which compiled functions pass as one pointer and write in place."""


def new_run() -> Any:
    """Return the record of a run."""
    run = np.zeros(1, RUN).view(np.recarray)[0]
    run.guards[:] = 1.0
    run.table[:] = 1.0
    return run


@compiled
def start(q, run, t, given):
    """Set up a run at time t [s] from ``run.y``, the law's state being ``run.state`` if ``given``, else from ``init``."""
    clock = run.clock
    clock[NOW] = t
    clock[STEP] = q.restart
    _load_first_segment(q, run, t)
    tau = _along(q, run, t, 0.0)
    if not given:
        _call(q.init, q, run, t, tau, run.y)
        for i in range(MAX_STATE):
            run.state[i] = run.out[i]
    if q.bristle >= 0:
        run.y[2] = run.state[q.bristle]
    if _pinned(q, run):
        run.y[1] = q.belt_velocity
    _measure(q, run, t, tau, run.y, run.guards)
    for i in range(ALL_GUARDS):
        run.armed[i] = 1.0 if run.guards[i] > 0.0 or i >= GUARDS + 2 else 0.0
    clock[STUCK] = _sticks(q, run, run.y)


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
    force, _ = _friction(q, run, t, _along(q, run, t, 0.0), run.y)
    u = q.belt_velocity * t - x
    mu_s, mu_k = evaluate(
        q.descriptor, run.output_cursor, q.seed, q.sample, q.contact, t, u, run.segment[EVENTS]
    )  # fmt: skip
    row[0], row[1], row[2], row[3], row[4], row[5] = x, v, force, mu_s, mu_k, run.clock[STUCK]


# --- coefficients between knots ---------------------------------------------------------------------------------------


@compiled
def _load_first_segment(q, run, t):
    """Find the knots around the start."""
    run.segment[EVENTS] = 0.0
    spacing = q.descriptor[3]
    if q.descriptor[1] == TIME:
        knot = float(math.floor(canonical_time(t, 0.0) / spacing))
        if (knot + 1.0) * spacing <= t + 1.0e-12:
            knot += 1.0
    elif q.descriptor[1] == POSITION:
        u = q.belt_velocity * t - run.y[0]
        knot = float(math.floor(u / spacing))
        if u < knot * spacing:
            knot -= 1.0
        elif u >= (knot + 1.0) * spacing:
            knot += 1.0
    else:
        knot = 0.0
    _load_segment(q, run, knot)


@compiled
def _load_segment(q, run, knot):
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
def _along(q, run, t, tau):
    """Return the time since the last knot [s] at t + tau (0 for paths that do not run along time)."""
    return (t - run.segment[ORIGIN]) + tau if q.descriptor[1] == TIME else 0.0


@compiled
def _coefficients(q, run, since, u):
    """Return (mu_s, mu_k) [-], linear between the knots; ``since`` is the time since the last knot."""
    s = run.segment
    r = u - s[ORIGIN] if q.descriptor[1] == POSITION else since
    return s[MU_S] + s[SLOPE_S] * r, s[MU_K] + s[SLOPE_K] * r


# --- the contact ------------------------------------------------------------------------------------------------------


@compiled
def _hold(q, t, y):
    """Return the friction force [N] that would make the relative acceleration zero."""
    return q.damping * y[1] + q.stiffness * y[0] - q.drive * math.cos(q.frequency * t)


@compiled
def _call(address, q, run, t, since, y):
    """Call one of the law's functions for (x, x') = y; the answer is in ``run.out``."""
    u = q.belt_velocity * t - y[0]
    mu_s, mu_k = _coefficients(q, run, since, u)
    call_law(  # pyright: ignore[reportCallIssue]
        address, t, u, 0.0, q.belt_velocity - y[1], 0.0, q.normal_force, mu_s, mu_k, q.mass, _hold(q, t, y), 0.0,
        run.state.ctypes.data, q.parameters.ctypes.data, run.out.ctypes.data,
    )  # fmt: skip


@compiled
def _friction(q, run, t, since, y):
    """Return the friction force [N] and the rate of the bristle [m/s]."""
    if q.bristle < 0:
        _call(q.force, q, run, t, since, y)
        return run.out[0], 0.0
    mu_s, mu_k = _coefficients(q, run, since, q.belt_velocity * t - y[0])
    call_flow(  # pyright: ignore[reportCallIssue]
        q.flow, q.belt_velocity - y[1], 0.0, q.normal_force, y[2], 0.0, mu_s, mu_k,
        q.parameters.ctypes.data, run.out.ctypes.data,
    )  # fmt: skip
    return run.out[0], run.out[2]


@compiled
def _pinned(q, run):
    """Return whether the contact moves with the belt."""
    return q.holding and run.state[0] == 0.0


@compiled
def _sticks(q, run, y):
    """Return 1.0 if the contact sticks, else 0.0."""
    if q.moded:
        return 1.0 if run.state[0] == 0.0 else 0.0
    return 1.0 if abs(q.belt_velocity - y[1]) <= q.stick_speed else 0.0


@compiled
def _measure(q, run, t, since, y, g):
    """Write all guards at y into ``g``."""
    _call(q.guards, q, run, t, since, y)
    for i in range(GUARDS):
        g[i] = run.out[i]
    if not q.moded:
        g[GUARDS] = abs(q.belt_velocity - y[1]) - q.stick_speed
        g[GUARDS + 1] = -g[GUARDS]
    if q.descriptor[1] == POSITION:
        u = q.belt_velocity * t - y[0]
        g[GUARDS + 2] = u - run.segment[LOW]
        g[GUARDS + 3] = run.segment[HIGH] - u


# --- one step ---------------------------------------------------------------------------------------------------------


@compiled
def _rates(q, run, t, since, y, dy):
    force, rate = _friction(q, run, t, since, y)
    dy[0] = y[1]
    dy[1] = (force - _hold(q, t, y)) / q.mass
    dy[2] = rate


@compiled
def _try_step(q, run, t_leg, tau, h):
    """Write the solution after a step h [s] into ``run.end``; return its local error relative to the scales."""
    stages = run.stages
    if _pinned(q, run):
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
        _rates(q, run, t_leg + part, _along(q, run, t_leg, part), run.probe, stages[i])
    for j in range(3):
        total = 0.0
        for k in range(STAGES):
            total += B[k] * stages[k, j]
        run.end[j] = run.y[j] + h * total
    _rates(q, run, t_leg + (tau + h), _along(q, run, t_leg, tau + h), run.end, stages[STAGES])
    return _error(q, run, h)


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
        error = _try_step(q, run, t_leg, tau, h)
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
        lowest, highest = _bracket(q, run, t_leg, tau, h)
        located = highest > 0.0
        if located:
            h = _locate(q, run, t_leg, tau, lowest, highest)
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
        _load_segment(q, run, run.segment[KNOT] + 1.0)
        if q.descriptor[2] == 0.0:
            log, _ = _settle(q, run, t_end, 0.0, False, log)
    return log


# --- events -----------------------------------------------------------------------------------------------------------


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
def _bracket(q, run, t_leg, tau, h):
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
def _measure_within(q, run, t_leg, tau, theta, h, g):
    """Write the guards at the part theta of the step tried last into ``g``."""
    if theta == 1.0:
        for j in range(3):
            run.probe[j] = run.end[j]
    else:
        _interpolate(run, theta, h)
    part = tau + theta * h
    _measure(q, run, t_leg + part, _along(q, run, t_leg, part), run.probe, g)


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
def _crossed(q, run, t_leg, tau, h):
    """Return whether an armed guard is negative after a step h; the solution there is in ``run.end``."""
    _try_step(q, run, t_leg, tau, h)
    part = tau + h
    _measure(q, run, t_leg + part, _along(q, run, t_leg, part), run.end, run.guards)
    for i in range(ALL_GUARDS):  # noqa: SIM110  (numba knows no generators)
        if run.armed[i] == 1.0 and run.guards[i] < 0.0:
            return True
    return False


@compiled
def _locate(q, run, t_leg, tau, low, high):
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
def _settle(q, run, t_leg, tau, located, log):
    """Commit an accepted step: the law's state, belt knots, stick flag, events; return (log, whether the mode changed).

    A guard that has fired without a change of mode is armed again one step later at the earliest: commit may have put
    the contact exactly on it (the clipped deflection of an elastic stick).
    """
    t = t_leg + tau
    switched = False
    for _ in range(MAX_SETTLES):
        mode = run.state[0]
        since = _along(q, run, t_leg, tau)
        if q.bristle >= 0:
            run.state[q.bristle] = run.y[2]
        else:
            _call(q.commit, q, run, t, since, run.y)
            for i in range(MAX_STATE):
                run.state[i] = run.out[i]
        if _pinned(q, run):
            run.y[1] = q.belt_velocity
        switched = switched or (q.moded and run.state[0] != mode)
        log, entered = _note(q, run, t, log)
        moved = _next_belt_segment(q, run, t)
        if entered and q.descriptor[1] == EVENT:
            _load_segment(q, run, run.segment[EVENTS])
        elif not (moved and q.descriptor[2] == 0.0):
            break
    for i in range(ALL_GUARDS):
        fired = located and not switched and run.armed[i] == 1.0 and run.guards[i] < 0.0
        run.table[0, i] = 1.0 if fired else 0.0
        if fired or switched:
            run.armed[i] = 0.0
    _measure(q, run, t, _along(q, run, t_leg, tau), run.y, run.guards)
    for i in range(ALL_GUARDS):
        g = run.guards[i]
        positive = g > 0.0 and run.table[0, i] == 0.0
        still = g == 0.0 and run.armed[i] == 1.0
        run.armed[i] = 1.0 if positive or still or i >= GUARDS + 2 else 0.0
    return log, switched


@compiled
def _note(q, run, t, log):
    """Update the stick flag; log a change of it; return (log, whether the contact has just entered stick)."""
    now = _sticks(q, run, run.y)
    clock = run.clock
    if now == clock[STUCK]:
        return log, False
    clock[STUCK] = now
    log = note(log, int(clock[N_EVENTS]), t, STICK if now == 1.0 else BREAK_AWAY)
    clock[N_EVENTS] += 1.0
    if now == 1.0:
        run.segment[EVENTS] += 1.0
    return log, now == 1.0


@compiled
def _next_belt_segment(q, run, t):
    """Move to the neighbouring knots along the belt if u has left the present ones; return whether it has."""
    if q.descriptor[1] != POSITION:
        return False
    u = q.belt_velocity * t - run.y[0]
    if u < run.segment[LOW]:
        _load_segment(q, run, run.segment[KNOT] - 1.0)
        return True
    if u > run.segment[HIGH]:
        _load_segment(q, run, run.segment[KNOT] + 1.0)
        return True
    return False
