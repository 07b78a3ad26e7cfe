"""What the law answers at a contact: its force, or its cap, and the switches it passes within a step.

At the time of the force positions are known, velocities half a step earlier. The velocity is the one at hand plus half
a step of acceleration, in which the friction force is solved for together with the law: the leap-frog scheme, second
order wherever the force is smooth.
"""

from __future__ import annotations

import math

from stochfric_mb.coefficients.path import CURSOR, evaluate
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.laws.abi import MAX_STATE, call_law
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.numerics.cubic import hermite, value
from stochfric_mb.numerics.memory import as_doubles, carray
from stochfric_mb.numerics.root import bracket, is_wide, least_armed, narrowed, trial
from stochfric_mb.pymunk import records as r

ENDLESS = 1.0e12
"""A load no friction can hold, in normal forces: it asks a law for its cap."""
LONG = 1.0
"""Way after which a law slides steadily [m]: bristles turn over within micrometres."""
ITERATIONS = 30
"""Most iterations for the velocity at the time of the force."""
SWITCHES = 4
"""Most switches located within a step."""
RESOLUTION = 1.0e-12
"""Part of a step to which a switch is located [-]."""


@compiled
def settle(table, clock, s, contact, first, v_free, compliance):
    """Return the friction force [N] at the velocity v that it leads to, v = v_free - compliance F(v); commits at v."""
    s[r.PAST_MU_S], s[r.PAST_MU_K] = s[r.MU_S], s[r.MU_K]
    coefficients(table, s, contact)
    v, force = v_free, 0.0
    if not first:
        v, force = meet(table, s, v_free, compliance)
        if table[r.STATEFUL] == 1 and locate(table, clock, s, contact, v):
            v, force = meet(table, s, v_free, compliance)
    changed = remember(table, clock, s, contact, first, s[r.TIME], s[r.DISPLACEMENT], v, s[r.MU_S], s[r.MU_K], 0.0)
    if first:
        force = law_force(table, s, v, s[r.NORMAL], 0.0)
    elif changed and law_force(table, s, v, s[r.NORMAL], 0.0) != force:
        s[r.GUARDS_KNOWN] = 0.0
        v, force = meet(table, s, v_free, compliance)
    s[r.VELOCITY] = v
    s[r.PAST_VELOCITY], s[r.PAST_DISPLACEMENT] = v, s[r.DISPLACEMENT]
    return force


@compiled
def set_cap(table, clock, s, contact, first, rate, acceleration, inverse_mass, dt):
    """Set the cap [-] of pymunk's own friction: the law's answer to an endless load, or its steady friction.

    ``acceleration`` is the one of the last step without friction; while the contact is held it is carried on to this
    step along a line, so that break-away falls on the step nearest to it.
    """
    held = not first and abs(s[r.FORCE]) < s[r.CAP] * s[r.PAST_NORMAL] * (1.0 - 1.0e-9)
    now = acceleration
    if held:
        v = 0.0
        now += acceleration - s[r.PAST_ACCELERATION]
    elif first:
        v = rate
    else:
        v = rate + 0.5 * dt * (acceleration - inverse_mass * s[r.FORCE])
    s[r.PAST_ACCELERATION] = acceleration
    load = now / inverse_mass if inverse_mass > 0.0 else 0.0
    coefficients(table, s, contact)
    remember(table, clock, s, contact, first, s[r.TIME], s[r.DISPLACEMENT], v, s[r.MU_S], s[r.MU_K], load)
    s[r.VELOCITY] = v
    normal = s[r.NORMAL] if s[r.NORMAL] > 0.0 else 1.0
    if table[r.HOLDING] == 1:
        s[r.CAP] = abs(law_force(table, s, v, normal, math.copysign(ENDLESS * normal, load))) / normal
    else:
        stuck = held or (table[r.HAS_MODE] == 1 and s[r.STICK] == 1.0)
        s[r.CAP] = abs(steady_force(table, s, 0.0 if stuck else abs(v), clock[r.PEAK_SPEED], normal)) / normal
        s[r.GUARDS_KNOWN] = 0.0
    if not math.isfinite(s[r.CAP]):
        table[r.PROBLEM] |= r.NOT_FINITE
        s[r.CAP] = 0.0


@compiled_inline
def keep(before, guards):
    """Keep the guards for the next comparison: a loop, since numba's copy of a slice takes two seconds to compile."""
    for i in range(GUARDS):
        before[i] = guards[i]


@compiled
def locate(table, clock, s, contact, v):
    """Commit at each point within the last step where the law switches, found on its guards.

    Between its ends the step is a cubic in displacement and linear in velocity and coefficients. Without this, a
    switch would be late by up to a step, and what the law remembers of it (such as where a contact stuck) first order.
    Returns whether the state has changed.
    """
    out = s[r.OUT : r.OUT + GUARDS]
    before = s[r.GUARDS_AT : r.GUARDS_AT + GUARDS]
    low = 0.0
    changed = False
    for _ in range(SWITCHES):
        if s[r.GUARDS_KNOWN] == 0.0:
            guards_at(table, s, v, low)
            keep(before, out)
        ask_guards(table, s, s[r.TIME], s[r.DISPLACEMENT], v, s[r.MU_S], s[r.MU_K])
        at_end = least_armed(before, out)
        if at_end > 0.0:
            keep(before, out)
            s[r.GUARDS_KNOWN] = 1.0
            return changed
        b = bracket(low, least_armed(before, before), 1.0, at_end)
        while is_wide(b, RESOLUTION):
            part = trial(b, RESOLUTION)
            b = narrowed(b, part, least_guard(table, s, v, part))
        low = b.negative
        if low >= 1.0:
            return changed
        u, w, mu_s, mu_k = between(s, v, low)
        changed |= remember(table, clock, s, contact, False, s[r.TIME] - (1.0 - low) * s[r.STEP], u, w, mu_s, mu_k, 0.0)
        s[r.GUARDS_KNOWN] = 0.0
    return changed


@compiled
def least_guard(table, s, v, theta):
    """Return the least guard at a fraction of the last step, among those that were positive where the search began."""
    guards_at(table, s, v, theta)
    return least_armed(s[r.GUARDS_AT : r.GUARDS_AT + GUARDS], s[r.OUT : r.OUT + GUARDS])


@compiled
def between(s, v, theta):
    """Return displacement, velocity, mu_s and mu_k at a fraction of the last step."""
    path = hermite(s[r.STEP], s[r.PAST_DISPLACEMENT], s[r.PAST_VELOCITY], s[r.DISPLACEMENT], v)
    rest = 1.0 - theta
    mu_s = rest * s[r.PAST_MU_S] + theta * s[r.MU_S]
    mu_k = rest * s[r.PAST_MU_K] + theta * s[r.MU_K]
    return value(path, theta), rest * s[r.PAST_VELOCITY] + theta * v, mu_s, mu_k


@compiled
def guards_at(table, s, v, theta):
    """Write the law's guards at a fraction of the last step into the slot's scratch space."""
    u, w, mu_s, mu_k = between(s, v, theta)
    ask_guards(table, s, s[r.TIME] - (1.0 - theta) * s[r.STEP], u, w, mu_s, mu_k)


@compiled_inline
def ask_guards(table, s, time, u, v, mu_s, mu_k):
    """Write the law's guards there into the slot's scratch space."""
    call_law(
        table[r.GUARD], time, u, 0.0, v, 0.0, s[r.NORMAL], mu_s, mu_k, s[r.EFFECTIVE_MASS], 0.0, 0.0,
        s[r.STATE : r.STATE + MAX_STATE].ctypes.data, table[r.PARAMETERS], s[r.OUT : r.OUT + MAX_STATE].ctypes.data,
    )  # fmt: skip


@compiled
def meet(table, s, v_free, compliance):
    """Return the root v [m/s] of v - v_free + compliance F(v), and F(v) [N], by a safeguarded secant iteration.

    The slope of the last step usually gives the root at once; otherwise the force at v_free gives the other end.
    """
    f0 = law_force(table, s, v_free, s[r.NORMAL], 0.0)
    v0, g0 = v_free, compliance * f0
    if g0 == 0.0:
        return v0, f0
    v1 = v0 - g0 / (1.0 + compliance * max(s[r.SLOPE], 0.0))
    f1 = law_force(table, s, v1, s[r.NORMAL], 0.0)
    g1 = v1 - v_free + compliance * f1
    if abs(g1) > 0.1 * abs(g0):
        v1 = v0 - g0
        f1 = law_force(table, s, v1, s[r.NORMAL], 0.0)
        g1 = v1 - v_free + compliance * f1
    if v1 != v0:
        s[r.SLOPE] = (f1 - f0) / (v1 - v0)
    for _ in range(ITERATIONS):
        if abs(g1) <= 1.0e-13 * abs(v1) + 1.0e-16 * abs(v_free) + 1.0e-18 or g1 == g0:
            break
        v2 = v1 - g1 * (v1 - v0) / (g1 - g0)
        f2 = law_force(table, s, v2, s[r.NORMAL], 0.0)
        g2 = v2 - v_free + compliance * f2
        if g2 * g1 < 0.0:
            v0, g0 = v1, g1
        elif g1 * g0 < 0.0:
            g0 *= 0.5
        else:
            v0, g0 = v1, g1
        v1, g1, f1 = v2, g2, f2
    return v1, f1


@compiled
def remember(table, clock, s, contact, first, time, u, v, mu_s, mu_k, load):
    """Commit (or, at first contact, start) the state of the law; count stick phases; return whether anything changed."""
    was_stuck = s[r.STICK]
    state = s[r.STATE : r.STATE + MAX_STATE]
    out = s[r.OUT : r.OUT + MAX_STATE]
    call_law(
        table[r.INIT] if first else table[r.COMMIT], time, u, 0.0, v, 0.0, s[r.NORMAL], mu_s, mu_k,
        s[r.EFFECTIVE_MASS], load, 0.0,
        state.ctypes.data, table[r.PARAMETERS], out.ctypes.data,
    )  # fmt: skip
    changed = False
    for i in range(table[r.N_STATE]):
        changed = changed or state[i] != out[i]
        state[i] = out[i]
    stuck = state[0] == 0.0 if table[r.HAS_MODE] == 1 else abs(v) <= clock[r.STICK_SPEED]
    s[r.STICK] = 1.0 if stuck else 0.0
    if stuck and was_stuck == 0.0 and not first:
        s[r.EVENTS] += 1.0
        if table[r.PER_EVENT] == 1:
            coefficients(table, s, contact)
            changed = True
    return changed


@compiled_inline
def coefficients(table, s, contact):
    """Evaluate mu_s and mu_k of the contact at its time, displacement and number of stick phases."""
    s[r.MU_S], s[r.MU_K] = evaluate(
        carray(as_doubles(table[r.DESCRIPTOR]), table[r.DESCRIPTOR_SIZE]), s[r.CURSOR_AT : r.CURSOR_AT + CURSOR],
        table[r.SEED], table[r.SAMPLE], contact, s[r.TIME], s[r.DISPLACEMENT], s[r.EVENTS],
    )  # fmt: skip


@compiled
def steady_force(table, s, speed, peak, normal_force):
    """Return the friction force [N] of the law in steady sliding at ``speed`` [m/s], at least the speed ``peak``.

    A law with a memory begins there and slides `LONG` metres. Below the speed of its largest steady friction a law holds,
    so that one is the static cap.
    """
    v = max(speed, peak)
    state = s[r.OUT : r.OUT + MAX_STATE]
    mass, p = s[r.EFFECTIVE_MASS], table[r.PARAMETERS]
    mu_s, mu_k = s[r.MU_S], s[r.MU_K]
    out = s[r.STEADY : r.STEADY + MAX_STATE]
    call_law(
        table[r.INIT], 0.0, 0.0, 0.0, v, 0.0, normal_force, mu_s, mu_k, mass, 0.0, 0.0, state.ctypes.data, p, out.ctypes.data
    )
    call_law(
        table[r.COMMIT], LONG / v, LONG, 0.0, v, 0.0, normal_force, mu_s, mu_k, mass, 0.0, 0.0, out.ctypes.data, p,
        state.ctypes.data,
    )  # fmt: skip
    call_law(
        table[r.FORCE_LAW], LONG / v, LONG, 0.0, v, 0.0, normal_force, mu_s, mu_k, mass, 0.0, 0.0, state.ctypes.data, p,
        out.ctypes.data,
    )  # fmt: skip
    return out[0]


@compiled_inline
def law_force(table, s, v, normal_force, load):
    """Return the friction force [N] of the law at velocity v [m/s] and load [N]."""
    out = s[r.OUT : r.OUT + MAX_STATE]
    call_law(
        table[r.FORCE_LAW], s[r.TIME], s[r.DISPLACEMENT], 0.0, v, 0.0, normal_force, s[r.MU_S], s[r.MU_K], s[r.EFFECTIVE_MASS],
        load, 0.0, s[r.STATE : r.STATE + MAX_STATE].ctypes.data, table[r.PARAMETERS], out.ctypes.data,
    )  # fmt: skip
    return out[0]
