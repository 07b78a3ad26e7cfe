"""Compiled collision callbacks: before each solve the law is asked, after it the impulses are read.

pymunk's step is: drift all positions with the velocities at hand, find contacts (*pre_solve*), kick all velocities with
forces and impulses, report the impulses (*post_solve*). So at pre_solve positions belong to time t, velocities to the
middle of the drift, t - dt/2, and what is set there acts in this very step.

The friction force reaches the bodies in one of two ways. While a contact slides too fast to stop within the step, and
where bodies have just met, the law's coefficient F/N goes to pymunk's own friction solver as its cap, so that friction
follows the normal force of the step itself, impacts included. Otherwise (stick, and sliding about to end) the force is
written into the bodies. Laws that need the holding force always get it from pymunk's solver, whose cap is what the law
would give against a boundless load (the static cap while stuck, the sliding coefficient while sliding).

The callbacks are those of the space's one handler for all collisions, which pymunk calls after all others.
"""

from __future__ import annotations

import dataclasses
import functools
import math
from typing import Any

from numba import types

from stochfric_mb.compile import compiled, compiled_inline, native
from stochfric_mb.numerics.memory import as_doubles, as_words, carray, load_byte, load_double, load_int, load_word, store_double
from stochfric_mb.pymunk import records as r
from stochfric_mb.pymunk.kinematics import advance_clock, free_acceleration, impulses, motion, push
from stochfric_mb.pymunk.matching import find_slot, slot_for
from stochfric_mb.pymunk.memory import call_handler
from stochfric_mb.pymunk.response import law_force, set_cap, settle

FAST = 4.0
"""Velocity beyond which a contact cannot stop within a step, in changes of velocity by friction in one step."""
SLOW = 10.0
"""Velocity up to which a contact's law is stiff, in stick speeds."""
JUMP = 0.1
"""Change of the force in one step, in mu_s N, beyond which a contact's law is stiff."""
PATIENCE = 10.0
"""Stiff steps beyond the stability limit after which it counts as broken; an impact lasts one."""
RELIEF = 0.5
"""What any other step takes off their count: an unstable contact is stiff in most steps, a sound one in few."""


@dataclasses.dataclass(frozen=True)
class Callbacks:
    """Addresses of the four callbacks."""

    begin: int
    """Address of the callback for a new contact."""
    pre_solve: int
    """Address of the callback before the solve."""
    post_solve: int
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
    call_handler(load_word(data + 8 * r.OLD_BEGIN), arbiter, space, load_word(data + 8 * r.OLD_DATA))


def _separate(arbiter, space, data):
    call_handler(load_word(data + 8 * r.OLD_SEPARATE), arbiter, space, load_word(data + 8 * r.OLD_DATA))


def _before(arbiter, space, data):
    call_handler(load_word(data + 8 * r.OLD_BEFORE), arbiter, space, load_word(data + 8 * r.OLD_DATA))
    for i in range(load_word(data + 8 * r.N_TABLES)):
        table = carray(as_words(load_word(data + 8 * (r.TABLES + i))), r.TABLE)
        if before_solve(table, arbiter, space, data):
            return


def _after(arbiter, space, data):
    for i in range(load_word(data + 8 * r.N_TABLES)):
        table = carray(as_words(load_word(data + 8 * (r.TABLES + i))), r.TABLE)
        if after_solve(table, arbiter):
            break
    call_handler(load_word(data + 8 * r.OLD_AFTER), arbiter, space, load_word(data + 8 * r.OLD_DATA))


@compiled
def before_solve(table, arbiter, space, data):
    """Answer for a contact if it is ours, and return whether it is; commits the state of the law once."""
    if load_byte(arbiter + table[r.PROCESS]) == 0:
        return False
    clock = carray(as_doubles(table[r.CLOCK]), r.CLOCK_SIZE)
    dt, stamp = advance_clock(table, clock, space)
    problem = table[r.PROBLEM]
    slot, made = slot_for(table, arbiter, stamp)
    if slot >= 0:
        pair = carray(as_words(table[r.PAIRS]), (table[r.CAPACITY], r.PAIR))[slot]
        s = carray(as_doubles(table[r.SLOTS]), (table[r.CAPACITY], r.SLOT))[slot]
        if made:
            s[:] = 0.0
        pair[r.STAMP] = stamp
        if clock[r.CHECKED_STEP] != dt:
            call_handler(load_word(data + 8 * r.ALARM), arbiter, space, load_word(data + 8 * r.ALARM_DATA))
        respond(table, clock, s, pair, arbiter, space, dt)
    if table[r.PROBLEM] != problem:
        call_handler(load_word(data + 8 * r.ALARM), arbiter, space, load_word(data + 8 * r.ALARM_DATA))
    return slot >= 0


@compiled_inline
def respond(table, clock, s, pair, arbiter, space, dt):
    """Apply the friction force of a contact, or set its cap."""
    s[r.TIME] = clock[r.STEP_TIME]
    a, b = load_word(arbiter + table[r.BODY_A]), load_word(arbiter + table[r.BODY_B])
    body_is_a = pair[r.NUMBER_A] == load_word(load_word(arbiter + table[r.ARBITER_A]) + table[r.SHAPE_NUMBER])
    sign = 1.0 if body_is_a else -1.0
    if s[r.PENDING] == 1.0:
        take_back(table, s, a, b, sign == s[r.ORDER])
    s[r.ORDER] = sign
    first = s[r.KNOWN] == 0.0 or load_int(arbiter + table[r.ARBITER_STATE]) == table[r.FIRST]
    nx, ny, ax, ay, bx, by, rate, v_normal, inverse_mass, inverse_normal = motion(table, arbiter, body_is_a, first)
    if not math.isfinite(rate) or not math.isfinite(v_normal):
        table[r.PROBLEM] |= r.NOT_FINITE
        return
    if inverse_normal == 0.0:
        return
    s[r.KNOWN] = 1.0
    s[r.NORMAL_X], s[r.NORMAL_Y] = nx, ny
    a_x, a_y = free_acceleration(table, space, a, ax, ay)
    b_x, b_y = free_acceleration(table, space, b, bx, by)
    gx, gy = sign * (b_x - a_x), sign * (b_y - a_y)
    expect_normal(table, s, arbiter, first, gx * nx + gy * ny, v_normal, inverse_normal, dt)
    s[r.EFFECTIVE_MASS] = 1.0 / inverse_mass
    acceleration = gx * ny - gy * nx
    if first:
        begin_contact(clock, s)
    else:
        acceleration = move_on(table, s, arbiter, rate, dt)
    turned = rate * s[r.RATE] < 0.0
    s[r.RATE], s[r.STEP], s[r.PUSH] = rate, dt, 0.0
    beyond = s[r.NORMAL] > clock[r.LARGEST_LOAD] * s[r.EFFECTIVE_MASS]
    s[r.CAPPED] = 1.0 if table[r.HOLDING] == 1 or (beyond and table[r.CAP_WHEN_STIFF] == 1) else 0.0
    if s[r.CAPPED] == 1.0:
        set_cap(table, clock, s, pair[r.CONTACT], first, rate, acceleration, inverse_mass, dt)
        store_double(arbiter + table[r.FRICTION], s[r.CAP])
        return
    before, step = s[r.FORCE], 0.0 if first else dt
    force = settle(table, clock, s, pair[r.CONTACT], first, rate + 0.5 * step * acceleration, 0.5 * step * inverse_mass)
    if not math.isfinite(force):
        table[r.PROBLEM] |= r.NOT_FINITE
        force = 0.0
    slow = abs(rate) <= SLOW * clock[r.STICK_SPEED]
    fast = abs(s[r.VELOCITY]) > FAST * dt * inverse_mass * abs(force)
    if (first or fast) and force * rate >= 0.0:
        s[r.CAP] = abs(force) / s[r.NORMAL] if s[r.NORMAL] > 0.0 else abs(law_force(table, s, s[r.VELOCITY], 1.0, 0.0))
        store_double(arbiter + table[r.FRICTION], s[r.CAP])
        watch_step(table, clock, s, beyond and slow)
        return
    stiff = slow or turned or abs(force - before) > JUMP * s[r.MU_S] * s[r.NORMAL]
    watch_step(table, clock, s, beyond and stiff)
    store_double(arbiter + table[r.FRICTION], 0.0)
    apply(table, s, a, b, sign * force * ny, -sign * force * nx, ax, ay, bx, by)
    s[r.PUSH] = force


@compiled_inline
def apply(table, s, a, b, fx, fy, ax, ay, bx, by):
    """Write a force into body ``a`` and its opposite into ``b``; it acts in this step."""
    s[r.PUSH_X], s[r.PUSH_Y] = fx, fy
    s[r.TORQUE_A], s[r.TORQUE_B] = ax * fy - ay * fx, bx * fy - by * fx
    s[r.PENDING] = 1.0
    push(table, a, fx, fy, s[r.TORQUE_A])
    push(table, b, -fx, -fy, -s[r.TORQUE_B])


@compiled
def take_back(table, s, a, b, ordered):
    """Take the force of the step in which the bodies fell asleep out of them: that step was never solved."""
    s[r.PENDING] = 0.0
    if not ordered:
        a, b = b, a
    push(table, a, -s[r.PUSH_X], -s[r.PUSH_Y], -s[r.TORQUE_A])
    push(table, b, s[r.PUSH_X], s[r.PUSH_Y], s[r.TORQUE_B])


@compiled
def begin_contact(clock, s):
    """Reset what belongs to a contact's life."""
    s[r.DISPLACEMENT] = clock[r.START]
    s[r.FORCE], s[r.CAP], s[r.OVER], s[r.GUARDS_KNOWN] = 0.0, 0.0, 0.0, 0.0
    s[r.EXTRA_NORMAL], s[r.EXTRA_TANGENT] = 0.0, 0.0


@compiled_inline
def move_on(table, s, arbiter, rate, dt):
    """Bring a contact to this step; return the relative acceleration [m/s^2] of the last one without friction."""
    normal, tangent = impulses(table, arbiter)
    s[r.EXTRA_NORMAL] = normal * (dt / s[r.STEP] - 1.0)
    s[r.EXTRA_TANGENT] = tangent * (dt / s[r.STEP] - 1.0)
    s[r.DISPLACEMENT] += rate * dt
    return (rate - s[r.RATE]) / s[r.STEP] + s[r.FORCE] / s[r.EFFECTIVE_MASS]


@compiled_inline
def expect_normal(table, s, arbiter, first, acceleration, v_normal, inverse_normal, dt):
    """Set the normal force [N] to expect of this step: what the pair alone would need, and what was amiss last time.

    Alone, the impulse stops the approach (times 1 + restitution) and holds against ``acceleration``, the free one of
    the surface towards the body; other contacts and joints add what they added in the last step.
    """
    s[r.PAST_NORMAL] = s[r.NORMAL]
    bounce = 1.0 + load_double(arbiter + table[r.RESTITUTION])
    alone = max(0.0, (acceleration - bounce * v_normal / dt) / inverse_normal)
    s[r.NORMAL] = alone if first else max(0.0, alone + s[r.NORMAL] - s[r.ISOLATED])
    s[r.ISOLATED] = alone


@compiled_inline
def watch_step(table, clock, s, stiff):
    """Count a step that is ``stiff`` beyond the stability limit: slow, turned round, or with a force that jumped.

    An unstable contact is fast, since instability makes it so: its speed alone says nothing. Steady sliding has no limit.
    """
    if not stiff:
        s[r.OVER] = max(0.0, s[r.OVER] - RELIEF)
        return
    s[r.OVER] += 1.0
    if s[r.OVER] >= PATIENCE:
        clock[r.WORST_LOAD] = max(clock[r.WORST_LOAD], s[r.NORMAL] / s[r.EFFECTIVE_MASS])
        table[r.PROBLEM] |= r.UNSTABLE


@compiled
def after_solve(table, arbiter):
    """Read the normal and the friction force of the step just taken, if the contact is ours; return whether it is."""
    slot = find_slot(table, arbiter)
    if slot < 0:
        return False
    pair = carray(as_words(table[r.PAIRS]), (table[r.CAPACITY], r.PAIR))[slot]
    s = carray(as_doubles(table[r.SLOTS]), (table[r.CAPACITY], r.SLOT))[slot]
    if pair[r.STAMP] != table[r.LAST_STAMP] or s[r.KNOWN] == 0.0:
        return False
    normal, tangent = impulses(table, arbiter)
    s[r.PENDING] = 0.0
    s[r.NORMAL] = (normal + s[r.EXTRA_NORMAL]) / s[r.STEP]
    s[r.FORCE] = s[r.PUSH] - (tangent + s[r.EXTRA_TANGENT]) / s[r.STEP]
    return True
