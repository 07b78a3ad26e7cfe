"""Compiled collision callbacks: before each solve the law is asked, after it the impulses are read.

pymunk's step is: drift all positions with the velocities at hand, find contacts (*pre_solve*), kick all velocities with
forces and impulses, report the impulses (*post_solve*). So at pre_solve positions belong to time t, velocities to the
middle of the drift, t - dt/2, and a force written into the body acts in this very step. The velocity at t is the
velocity at hand plus half a step of acceleration, in which the friction force is solved for together with the law.
That is the leap-frog scheme, second order wherever the force is smooth.

Laws that need the holding force get it from pymunk's own contact solver, whose cap is set to the law's coefficient:
what the law would give against a boundless load (the static cap while stuck, the sliding coefficient while sliding).

Each contact (pair of shapes) has a slot: a row of `SLOT` doubles and a row of `PAIR` words.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportPrivateImportUsage=false
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import functools
import math
from typing import Any

import numba
from numba import types

from stochfric_mb.coefficients.path import CURSOR, canonical_time, evaluate
from stochfric_mb.compile import compiled, native
from stochfric_mb.laws.abi import MAX_STATE, call_law
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.pymunk.layout import NAMES
from stochfric_mb.pymunk.memory import (
    as_doubles,
    as_words,
    call_handler,
    get_byte,
    get_double,
    get_int,
    get_word,
    load_byte,
    load_double,
    load_int,
    load_word,
    store_double,
    store_word,
)

# One context for each handler: what was there before, and the address of the table.
OLD_DATA, OLD_BEGIN, OLD_BEFORE, OLD_AFTER, OLD_SEPARATE, TABLE_ADDRESS, CONTEXT = range(7)

# One table for each call of add_friction.
(
    USED, CAPACITY, PAIRS, SLOTS, CLOCK, BY_TYPE, TYPE_A, TYPE_B, INIT, FORCE_LAW, COMMIT, GUARD, PARAMETERS, DESCRIPTOR,
    DESCRIPTOR_SIZE, SEED, SAMPLE, HAS_MODE, PER_EVENT, HOLDING, STATEFUL, LAST_STAMP, PROBLEM, LAYOUT,
) = range(24)  # fmt: skip
TABLE = LAYOUT + len(NAMES)
OVERFLOW, NOT_FINITE = 1, 2
"""Values of the table's entry PROBLEM."""

SHAPE_A, SHAPE_B, CONTACT, STAMP, PAIR = range(5)

# A slot. RATE is the relative velocity over the last drift, VELOCITY the one at the time of the force. EXTRA_... are
# impulses that pymunk applies but does not count where the step size changes: it scales the last step's impulses by the
# ratio of the steps when it starts from them, not its record of them.
(
    DISPLACEMENT, RATE, FORCE, NORMAL, MU_S, MU_K, STICK, EVENTS, CAP, STEP, VELOCITY, EFFECTIVE_MASS, TIME, ORIGIN,
    EXTRA_NORMAL, EXTRA_TANGENT, PAST_DISPLACEMENT, PAST_VELOCITY, PAST_MU_S, PAST_MU_K,
    PAST_ACCELERATION,
) = range(21)  # fmt: skip
STATE = 24
CURSOR_AT = STATE + MAX_STATE
OUT = CURSOR_AT + CURSOR
SLOT = OUT + MAX_STATE

NOW, STICK_SPEED, CLOCK_SIZE = range(3)

_AT = {name: LAYOUT + i for i, name in enumerate(NAMES)}
M_INV, POSITION, SPEED, BODY_FORCE = _AT["body.m_inv"], _AT["body.p"], _AT["body.v"], _AT["body.f"]
I_INV, SPIN, TORQUE = _AT["body.i_inv"], _AT["body.w"], _AT["body.t"]
GRAVITY = _AT["space.gravity"]
FRICTION, SURFACE, CACHE = _AT["arbiter.u"], _AT["arbiter.surface_vr"], _AT["arbiter.data"]
ARBITER_A, ARBITER_B = _AT["arbiter.a"], _AT["arbiter.b"]
BODY_A, BODY_B, COUNT, POINTS = _AT["arbiter.body_a"], _AT["arbiter.body_b"], _AT["arbiter.count"], _AT["arbiter.contacts"]
AXIS, ARBITER_STATE, PROCESS = _AT["arbiter.n"], _AT["arbiter.state"], _AT["arbiter.processCollision"]
ARM_1, ARM_2, NORMAL_IMPULSE, TANGENT_IMPULSE = (_AT[f"contact.{n}"] for n in ("r1", "r2", "jnAcc", "jtAcc"))
POINT_SIZE, FIRST = _AT["contact.size"], _AT["arbiter.first"]
GET_STAMP, GET_STEP = _AT["cpSpaceGetTimestamp"], _AT["cpSpaceGetCurrentTimeStep"]
GET_TYPE, GET_SENSOR = _AT["cpShapeGetCollisionType"], _AT["cpShapeGetSensor"]

ENDLESS = 1.0e12
"""A load no friction can hold, in normal forces: it asks a law for its cap."""
ITERATIONS = 30
"""Most iterations for the velocity at the time of the force."""
SWITCHES = 4
"""Most switches located within a step."""
BISECTIONS = 40
"""Halvings of a step to locate a switch."""


@dataclasses.dataclass(frozen=True)
class Callbacks:
    """Addresses of the four callbacks."""

    begin: int
    """Address of the callback for a new contact."""
    before: int
    """Address of the callback before the solve."""
    after: int
    """Address of the callback after the solve."""
    separate: int
    """Address of the callback for a lost contact."""


_alive: list[Any] = []


@functools.cache
def callbacks() -> Callbacks:
    """Return the compiled callbacks, the same for all laws."""
    signature = types.void(types.intp, types.intp, types.intp)
    made = [native(f, signature) for f in (_begin, _before, _after, _separate)]
    _alive.extend(made)
    return Callbacks(*(f.address for f in made))


def _begin(arbiter, space, data):
    call_handler(load_word(data + 8 * OLD_BEGIN), arbiter, space, load_word(data + 8 * OLD_DATA))


def _separate(arbiter, space, data):
    call_handler(load_word(data + 8 * OLD_SEPARATE), arbiter, space, load_word(data + 8 * OLD_DATA))


def _before(arbiter, space, data):
    call_handler(load_word(data + 8 * OLD_BEFORE), arbiter, space, load_word(data + 8 * OLD_DATA))
    before_solve(arbiter, space, load_word(data + 8 * TABLE_ADDRESS))


def _after(arbiter, space, data):
    after_solve(arbiter, space, load_word(data + 8 * TABLE_ADDRESS))
    call_handler(load_word(data + 8 * OLD_AFTER), arbiter, space, load_word(data + 8 * OLD_DATA))


@compiled
def find_slot(table, arbiter):
    """Return the number of the slot of the arbiter's pair of shapes, -1 where it has none."""
    a = load_word(arbiter + table[ARBITER_A])
    b = load_word(arbiter + table[ARBITER_B])
    pairs = numba.carray(as_words(table[PAIRS]), (table[CAPACITY], PAIR))
    cached = load_word(arbiter + table[CACHE]) - 1
    if 0 <= cached < table[USED] and _is_pair(pairs[cached], a, b):
        return cached
    for i in range(table[USED]):
        if _is_pair(pairs[i], a, b):
            store_word(arbiter + table[CACHE], i + 1)
            return i
    return -1


@compiled
def _is_pair(pair, a, b):
    return (pair[SHAPE_A] == a and pair[SHAPE_B] == b) or (pair[SHAPE_A] == b and pair[SHAPE_B] == a)


@compiled
def new_slot(table, arbiter):
    """Return the number of a slot for a pair met for the first time, -1 where it is not ours or there is no room."""
    if table[BY_TYPE] == 0:
        return -1
    a = load_word(arbiter + table[ARBITER_A])
    b = load_word(arbiter + table[ARBITER_B])
    if get_byte(table[GET_SENSOR], a) != 0 or get_byte(table[GET_SENSOR], b) != 0:
        return -1
    if table[USED] >= table[CAPACITY]:
        table[PROBLEM] |= OVERFLOW
        return -1
    slot = table[USED]
    pairs = numba.carray(as_words(table[PAIRS]), (table[CAPACITY], PAIR))
    straight = get_word(table[GET_TYPE], a) == table[TYPE_A]
    pairs[slot, SHAPE_A] = a if straight else b
    pairs[slot, SHAPE_B] = b if straight else a
    pairs[slot, CONTACT] = slot
    table[USED] = slot + 1
    store_word(arbiter + table[CACHE], slot + 1)
    return slot


@compiled
def advance_clock(table, clock, space):
    """Return the step [s] and the stamp of the space; the clock moves on once a step."""
    stamp = get_int(table[GET_STAMP], space)
    dt = get_double(table[GET_STEP], space)
    if stamp != table[LAST_STAMP]:
        clock[NOW] += (stamp - table[LAST_STAMP]) * dt
        table[LAST_STAMP] = stamp
    return dt, stamp


@compiled
def motion(table, arbiter, body_is_a):
    """Return the frame and the motion of a contact, relative quantities as counter-surface minus body.

    Returns:
        normal (2) from surface to body, tangent is (n_y, -n_x); arms (4) of shape a and b; tangential velocity
        [m/s], normal velocity (body minus surface) [m/s], inverse tangential and normal mass [1/kg].
    """
    side = -1.0 if body_is_a else 1.0
    nx = side * load_double(arbiter + table[AXIS])
    ny = side * load_double(arbiter + table[AXIS] + 8)
    count = load_int(arbiter + table[COUNT])
    point = load_word(arbiter + table[POINTS])
    ax, ay, bx, by = 0.0, 0.0, 0.0, 0.0
    for _ in range(count):
        ax += load_double(point + table[ARM_1]) / count
        ay += load_double(point + table[ARM_1] + 8) / count
        bx += load_double(point + table[ARM_2]) / count
        by += load_double(point + table[ARM_2] + 8) / count
        point += table[POINT_SIZE]
    a = load_word(arbiter + table[BODY_A])
    b = load_word(arbiter + table[BODY_B])
    wa, wb = load_double(a + table[SPIN]), load_double(b + table[SPIN])
    vx = load_double(b + table[SPEED]) - by * wb - load_double(a + table[SPEED]) + ay * wa
    vy = load_double(b + table[SPEED] + 8) + bx * wb - load_double(a + table[SPEED] + 8) - ax * wa
    v_normal = side * (vx * nx + vy * ny)
    vx += load_double(arbiter + table[SURFACE])
    vy += load_double(arbiter + table[SURFACE] + 8)
    v_rel = -side * (vx * ny - vy * nx)
    inverse_mass = load_double(a + table[M_INV]) + load_double(b + table[M_INV])
    turn_a, turn_b = ax * nx + ay * ny, bx * nx + by * ny
    inverse_tangential = (
        inverse_mass + load_double(a + table[I_INV]) * turn_a * turn_a + load_double(b + table[I_INV]) * turn_b * turn_b
    )
    return nx, ny, ax, ay, bx, by, v_rel, v_normal, inverse_tangential, inverse_mass


@compiled
def free_acceleration(table, space, arbiter, body_is_a):
    """Return the relative acceleration (counter-surface minus body) by gravity and applied forces, (x, y) [m/s^2]."""
    side = 1.0 if body_is_a else -1.0
    x, y = 0.0, 0.0
    for body, sign in ((load_word(arbiter + table[BODY_B]), side), (load_word(arbiter + table[BODY_A]), -side)):
        m_inv = load_double(body + table[M_INV])
        if m_inv > 0.0:
            x += sign * (load_double(space + table[GRAVITY]) + m_inv * load_double(body + table[BODY_FORCE]))
            y += sign * (load_double(space + table[GRAVITY] + 8) + m_inv * load_double(body + table[BODY_FORCE] + 8))
    return x, y


@compiled
def push(table, body, fx, fy, rx, ry):
    """Add a force at an arm to a dynamic body; it acts in this step."""
    if load_double(body + table[M_INV]) > 0.0:
        at = body + table[BODY_FORCE]
        store_double(at, load_double(at) + fx)
        store_double(at + 8, load_double(at + 8) + fy)
        at = body + table[TORQUE]
        store_double(at, load_double(at) + rx * fy - ry * fx)


@compiled
def before_solve(arbiter, space, table_address):
    """Apply the friction force of a contact, or set its cap; commits the state of the law once."""
    table = numba.carray(as_words(table_address), TABLE)
    if load_byte(arbiter + table[PROCESS]) == 0:
        return
    slot = find_slot(table, arbiter)
    if slot < 0:
        slot = new_slot(table, arbiter)
    if slot < 0:
        return
    pair = numba.carray(as_words(table[PAIRS]), (table[CAPACITY], PAIR))[slot]
    s = numba.carray(as_doubles(table[SLOTS]), (table[CAPACITY], SLOT))[slot]
    clock = numba.carray(as_doubles(table[CLOCK]), CLOCK_SIZE)
    dt, stamp = advance_clock(table, clock, space)
    s[TIME] = canonical_time(clock[NOW], 0.5 * dt)
    pair[STAMP] = stamp
    body_is_a = pair[SHAPE_A] == load_word(arbiter + table[ARBITER_A])
    nx, ny, ax, ay, bx, by, rate, v_normal, inverse_mass, inverse_normal = motion(table, arbiter, body_is_a)
    first = load_int(arbiter + table[ARBITER_STATE]) == table[FIRST]
    if first:
        gx, gy = free_acceleration(table, space, arbiter, body_is_a)
        s[NORMAL] = max(0.0, (gx * nx + gy * ny - v_normal / dt) / inverse_normal) if inverse_normal > 0.0 else 0.0
        acceleration = gx * ny - gy * nx
        s[DISPLACEMENT] = s[ORIGIN]
        s[FORCE] = 0.0
        s[CAP] = 0.0
        s[EXTRA_NORMAL], s[EXTRA_TANGENT] = 0.0, 0.0
    else:
        normal, tangent = impulses(table, arbiter)
        s[EXTRA_NORMAL], s[EXTRA_TANGENT] = normal * (dt / s[STEP] - 1.0), tangent * (dt / s[STEP] - 1.0)
        acceleration = (rate - s[RATE]) / s[STEP] + inverse_mass * s[FORCE]
        s[DISPLACEMENT] += rate * dt
    s[EFFECTIVE_MASS] = 1.0 / inverse_mass if inverse_mass > 0.0 else math.inf
    s[RATE] = rate
    s[STEP] = dt
    if table[HOLDING] == 1:
        set_cap(table, clock, s, pair[CONTACT], first, rate, acceleration, inverse_mass, dt)
        store_double(arbiter + table[FRICTION], s[CAP])
        return
    step = 0.0 if first else dt
    force = settle(table, clock, s, pair[CONTACT], first, rate + 0.5 * step * acceleration, 0.5 * step * inverse_mass)
    if not math.isfinite(force):
        table[PROBLEM] |= NOT_FINITE
        force = 0.0
    s[FORCE] = force
    store_double(arbiter + table[FRICTION], 0.0)
    sign = 1.0 if body_is_a else -1.0
    push(table, load_word(arbiter + table[BODY_A]), sign * force * ny, -sign * force * nx, ax, ay)
    push(table, load_word(arbiter + table[BODY_B]), -sign * force * ny, sign * force * nx, bx, by)


@compiled
def after_solve(arbiter, space, table_address):
    """Read the normal force, and where pymunk's solver made it the friction force, of the step just taken."""
    table = numba.carray(as_words(table_address), TABLE)
    slot = find_slot(table, arbiter)
    if slot < 0:
        return
    s = numba.carray(as_doubles(table[SLOTS]), (table[CAPACITY], SLOT))[slot]
    normal, tangent = impulses(table, arbiter)
    s[NORMAL] = (normal + s[EXTRA_NORMAL]) / s[STEP]
    if table[HOLDING] == 1:
        s[FORCE] = -(tangent + s[EXTRA_TANGENT]) / s[STEP]


@compiled
def impulses(table, arbiter):
    """Return the sums of the contact's recorded normal and tangential impulses [N s]."""
    normal, tangent = 0.0, 0.0
    point = load_word(arbiter + table[POINTS])
    for _ in range(load_int(arbiter + table[COUNT])):
        normal += load_double(point + table[NORMAL_IMPULSE])
        tangent += load_double(point + table[TANGENT_IMPULSE])
        point += table[POINT_SIZE]
    return normal, tangent


@compiled
def set_cap(table, clock, s, contact, first, rate, acceleration, inverse_mass, dt):
    """Set the cap [-] of pymunk's own friction: the law's answer to an endless load.

    ``acceleration`` is the one of the last step without friction; while the contact is held it is carried on to this
    step along a line, so that break-away falls on the step nearest to it.
    """
    held = not first and abs(s[FORCE]) < s[CAP] * s[NORMAL] * (1.0 - 1.0e-9)
    now = acceleration
    if held:
        v = 0.0
        now += acceleration - s[PAST_ACCELERATION]
    elif first:
        v = rate
    else:
        v = rate + 0.5 * dt * (acceleration - inverse_mass * s[FORCE])
    s[PAST_ACCELERATION] = acceleration
    load = now / inverse_mass if inverse_mass > 0.0 else 0.0
    coefficients(table, s, contact)
    remember(table, clock, s, contact, first, s[TIME], s[DISPLACEMENT], v, s[MU_S], s[MU_K], load)
    s[VELOCITY] = v
    normal = s[NORMAL] if s[NORMAL] > 0.0 else 1.0
    s[CAP] = abs(law_force(table, s, v, normal, math.copysign(ENDLESS * normal, load))) / normal
    if not math.isfinite(s[CAP]):
        table[PROBLEM] |= NOT_FINITE
        s[CAP] = 0.0


@compiled
def settle(table, clock, s, contact, first, v_free, compliance):
    """Return the friction force [N] at the velocity v that it leads to, v = v_free - compliance F(v); commits at v."""
    s[PAST_MU_S], s[PAST_MU_K] = s[MU_S], s[MU_K]
    coefficients(table, s, contact)
    if first:
        v = v_free
    else:
        v = meet(table, s, v_free, compliance)
        if table[STATEFUL] == 1:
            locate(table, clock, s, contact, v)
    changed = remember(table, clock, s, contact, first, s[TIME], s[DISPLACEMENT], v, s[MU_S], s[MU_K], 0.0)
    if changed and not first:
        v = meet(table, s, v_free, compliance)
    s[VELOCITY] = v
    s[PAST_VELOCITY], s[PAST_DISPLACEMENT] = v, s[DISPLACEMENT]
    return law_force(table, s, v, s[NORMAL], 0.0)


@compiled
def locate(table, clock, s, contact, v):
    """Commit at each point within the last step where the law switches, found on its guards by bisection.

    Between its ends the step is a cubic in displacement and linear in velocity and coefficients. Without this, a
    switch would be late by up to a step, and what the law remembers of it (such as where a contact stuck) first order.
    """
    out = s[OUT : OUT + GUARDS]
    low = 0.0
    for _ in range(SWITCHES):
        guards_at(table, s, v, low)
        before = (out[0], out[1], out[2], out[3], out[4], out[5])
        guards_at(table, s, v, 1.0)
        after = (out[0], out[1], out[2], out[3], out[4], out[5])
        theta = 2.0
        for i in range(GUARDS):
            if before[i] > 0.0 >= after[i]:
                theta = min(theta, crossing(table, s, v, i, low))
        if theta >= 1.0:
            return
        u, w, mu_s, mu_k = between(s, v, theta)
        remember(table, clock, s, contact, False, s[TIME] - (1.0 - theta) * s[STEP], u, w, mu_s, mu_k, 0.0)
        low = theta


@compiled
def crossing(table, s, v, i, low):
    """Return the fraction of the step at which guard ``i`` is no longer positive, after ``low``."""
    out = s[OUT : OUT + GUARDS]
    high = 1.0
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        guards_at(table, s, v, middle)
        if out[i] > 0.0:
            low = middle
        else:
            high = middle
    return high


@compiled
def between(s, v, theta):
    """Return displacement, velocity, mu_s and mu_k at a fraction of the last step."""
    u0, u1 = s[PAST_DISPLACEMENT], s[DISPLACEMENT]
    v0, h = s[PAST_VELOCITY], s[STEP]
    rest = 1.0 - theta
    u = rest * rest * (u0 * (1.0 + 2.0 * theta) + theta * h * v0) + theta * theta * (u1 * (3.0 - 2.0 * theta) - rest * h * v)
    mu_s = rest * s[PAST_MU_S] + theta * s[MU_S]
    mu_k = rest * s[PAST_MU_K] + theta * s[MU_K]
    return u, rest * v0 + theta * v, mu_s, mu_k


@compiled
def guards_at(table, s, v, theta):
    """Write the law's guards at a fraction of the last step into the slot's scratch space."""
    u, w, mu_s, mu_k = between(s, v, theta)
    call_law(
        table[GUARD], s[TIME] - (1.0 - theta) * s[STEP], u, 0.0, w, 0.0, s[NORMAL], mu_s, mu_k, s[EFFECTIVE_MASS], 0.0, 0.0,
        s[STATE : STATE + MAX_STATE].ctypes.data, table[PARAMETERS], s[OUT : OUT + MAX_STATE].ctypes.data,
    )  # fmt: skip


@compiled
def meet(table, s, v_free, compliance):
    """Return the root v [m/s] of v - v_free + compliance F(v), by a safeguarded secant iteration."""
    v0 = v_free
    g0 = compliance * law_force(table, s, v0, s[NORMAL], 0.0)
    v1 = v0 - g0
    if g0 == 0.0:
        return v0
    g1 = v1 - v_free + compliance * law_force(table, s, v1, s[NORMAL], 0.0)
    for _ in range(ITERATIONS):
        if abs(g1) <= 1.0e-13 * abs(v1) + 1.0e-18 or g1 == g0:
            break
        v2 = v1 - g1 * (v1 - v0) / (g1 - g0)
        g2 = v2 - v_free + compliance * law_force(table, s, v2, s[NORMAL], 0.0)
        if g2 * g1 < 0.0:
            v0, g0 = v1, g1
        elif g1 * g0 < 0.0:
            g0 *= 0.5
        else:
            v0, g0 = v1, g1
        v1, g1 = v2, g2
    return v1


@compiled
def remember(table, clock, s, contact, first, time, u, v, mu_s, mu_k, load):
    """Commit (or, at first contact, start) the state of the law; count stick phases; return whether anything changed."""
    was_stuck = s[STICK]
    state = s[STATE : STATE + MAX_STATE]
    out = s[OUT : OUT + MAX_STATE]
    call_law(
        table[INIT] if first else table[COMMIT], time, u, 0.0, v, 0.0, s[NORMAL], mu_s, mu_k, s[EFFECTIVE_MASS], load, 0.0,
        state.ctypes.data, table[PARAMETERS], out.ctypes.data,
    )  # fmt: skip
    changed = False
    for i in range(MAX_STATE):
        changed = changed or state[i] != out[i]
        state[i] = out[i]
    stuck = state[0] == 0.0 if table[HAS_MODE] == 1 else abs(v) <= clock[STICK_SPEED]
    s[STICK] = 1.0 if stuck else 0.0
    if stuck and was_stuck == 0.0 and not first:
        s[EVENTS] += 1.0
        if table[PER_EVENT] == 1:
            coefficients(table, s, contact)
            changed = True
    return changed


@compiled
def coefficients(table, s, contact):
    """Evaluate mu_s and mu_k of the contact at its time, displacement and number of stick phases."""
    s[MU_S], s[MU_K] = evaluate(
        numba.carray(as_doubles(table[DESCRIPTOR]), table[DESCRIPTOR_SIZE]), s[CURSOR_AT : CURSOR_AT + CURSOR],
        table[SEED], table[SAMPLE], contact, s[TIME], s[DISPLACEMENT], s[EVENTS],
    )  # fmt: skip


@compiled
def law_force(table, s, v, normal_force, load):
    """Return the friction force [N] of the law at velocity v [m/s] and load [N]."""
    out = s[OUT : OUT + MAX_STATE]
    call_law(
        table[FORCE_LAW], s[TIME], s[DISPLACEMENT], 0.0, v, 0.0, normal_force, s[MU_S], s[MU_K], s[EFFECTIVE_MASS],
        load, 0.0, s[STATE : STATE + MAX_STATE].ctypes.data, table[PARAMETERS], out.ctypes.data,
    )  # fmt: skip
    return out[0]
