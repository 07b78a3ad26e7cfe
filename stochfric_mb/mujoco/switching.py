"""A contact's law at work: its coefficients, its calls, the commit of its state, and the switches within a step."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import math

from stochfric_mb.coefficients.path import CURSOR as CURSOR_SIZE
from stochfric_mb.coefficients.path import evaluate
from stochfric_mb.coefficients.processes import TIME
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.laws.abi import call_law
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.laws.plane import length
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.kinematics import put

SWITCHES, SEARCHES = 4, 120
"""Most switches of a law looked for within one step, and instants looked at to find one."""
INSTANT = 5.0e-13
"""Part of a step to which the instant of a switch is found."""


@compiled_inline
def half_step(model):
    """Return half the engine's step [s]."""
    return 0.5 * n.number_field(model, n.M_TIMESTEP)


@compiled_inline
def coefficients(state, t, position, events):
    """Return (mu_s, mu_k) of the instance's path; along time, once for all its contacts."""
    kept = state + 8 * s.COEFFICIENTS
    if n.load(state + 8 * (s.DESCRIPTOR + 1)) != TIME:
        return coefficients_anew(state, t, position, events)
    if n.load(kept) != t:
        mu_s, mu_k = coefficients_anew(state, t, position, events)
        put(kept, t, mu_s, mu_k)
    return n.load(kept + 8), n.load(kept + 16)


@compiled
def coefficients_anew(state, t, position, events):
    """Return (mu_s, mu_k) of the instance's path, evaluated now."""
    return evaluate(
        n.vector(state + 8 * s.DESCRIPTOR, int(n.load(state + 8 * s.N_DESCRIPTOR))),
        n.vector(state + 8 * s.CURSOR, CURSOR_SIZE),
        int(n.load(state + 8 * s.SEED)),
        int(n.load(state + 8 * s.SAMPLE)),
        int(n.load(state + 8 * s.CONTACT)),
        t,
        position,
        events,
    )


@compiled_inline
def call(state, address, function, t, ux, uy, vx, vy, mu_s, mu_k):
    """Call one of the law's functions on a slot; the result goes to the work space."""
    call_law(
        function, t, ux, uy, vx, vy, n.load(address + 8 * s.NORMAL), mu_s, mu_k, n.load(address + 8 * s.MASS),
        n.load(address + 8 * s.HOLD_X), n.load(address + 8 * s.HOLD_Y),
        address + 8 * s.STATE, state + 8 * s.PARAMETERS, state + 8 * s.OUTPUT,
    )  # fmt: skip


@compiled
def commit_slot(state, address, row, t, total, count):
    """Run the commit (init for a new contact) of the law in ``row`` on a current slot.

    Contacts of one pair share the mass that they feel, in proportion to their normal forces.
    """
    normal_force = n.load(address + 8 * s.NORMAL)
    share = normal_force / total if total > 0.0 else 1.0 / count
    n.store(address + 8 * s.MASS, n.load(address + 8 * s.MASS) * share)
    if row == 0:
        return
    ux, uy = n.load(address + 8 * s.UX), n.load(address + 8 * s.UY)
    vx, vy = n.load(address + 8 * s.VX), n.load(address + 8 * s.VY)
    modes = n.load(state + 8 * s.HAS_MODE) != 0.0
    live = n.load(address + 8 * s.LIVE)
    new = live <= 0.0
    if not new and modes and n.load(address + 8 * s.IMPLICIT_STEP) == 0.0:
        switch_within(state, address, row, t)
    changed = switch(state, address, row, n.INIT if new else n.COMMIT, t, ux, uy, vx, vy)
    if live == 0.0:
        n.store(address + 8 * s.EVENTS, 0.0)
    mu_s, mu_k = coefficients(state, t, ux, n.load(address + 8 * s.EVENTS))
    n.store(address + 8 * s.MU_S, mu_s)
    n.store(address + 8 * s.MU_K, mu_k)
    n.store(address + 8 * s.LIVE, 1.0)
    if modes and changed:
        guards_at(state, address, row, t, ux, uy, vx, vy)
        keep_guards(state, address)


@compiled_inline
def keep_guards(state, address):
    """Copy the guards from the work space to the slot, for the search in the time that follows."""
    for j in range(GUARDS):
        n.store(address + 8 * (s.START_GUARDS + j), n.load(state + 8 * (s.OUTPUT + j)))


@compiled_inline
def guards_at(state, address, row, t, ux, uy, vx, vy):
    """Write the law's guards at this instant to the work space."""
    mu_s, mu_k = coefficients(state, t, ux, n.load(address + 8 * s.EVENTS))
    call(state, address, n.load_word(row + n.GUARD), t, ux, uy, vx, vy, mu_s, mu_k)


@compiled_inline
def switch(state, address, row, function, t, ux, uy, vx, vy):
    """Give a slot the law state that ``function`` of its row (init or commit) returns; return whether it is another one.

    Stick phases that begin are counted.
    """
    changed = n.load(address + 8 * s.LIVE) == 0.0
    mu_s, mu_k = coefficients(state, t, ux, n.load(address + 8 * s.EVENTS))
    call(state, address, n.load_word(row + function), t, ux, uy, vx, vy, mu_s, mu_k)
    for j in range(n.load_word(row + n.N_STATE)):
        new = n.load(state + 8 * (s.OUTPUT + j))
        changed = changed or n.load(address + 8 * (s.STATE + j)) != new
        n.store(address + 8 * (s.STATE + j), new)
    was = n.load(address + 8 * s.STICK)
    if n.load(state + 8 * s.HAS_MODE) != 0.0:
        stuck = 1.0 if n.load(address + 8 * s.STATE) == 0.0 else 0.0
    else:
        stuck = 1.0 if length(vx, vy) <= n.load(state + 8 * s.STICK_SPEED) else 0.0
    n.store(address + 8 * s.STICK, stuck)
    if stuck > was:
        n.store(address + 8 * s.EVENTS, n.load(address + 8 * s.EVENTS) + 1.0)
    return changed


@compiled_inline
def switch_within(state, address, row, t):
    """Let a law with modes switch where it should have within the step that has just ended.

    Where one of the law's guards has changed sign, ``commit`` runs with the state there, by the cubic through both
    ends of the step: what the law remembers of a switch then does not depend on where the step ended.
    """
    if guard_crossed(state, address, row, t, 1.0):
        switch_at_crossings(state, address, row, t)
    else:
        keep_guards(state, address)


@compiled
def switch_at_crossings(state, address, row, t):
    """Switch the law where its guards cross zero within the step, one of which does."""
    before = n.load(address + 8 * s.BEFORE)
    start = 0.0
    for _ in range(SWITCHES):
        end = first_crossing(state, address, row, t, start)
        ux, uy, vx, vy = between(address, t, end)
        now = before + end * (t - before)
        switch(state, address, row, n.COMMIT, now, ux, uy, vx, vy)
        guards_at(state, address, row, now, ux, uy, vx, vy)
        keep_guards(state, address)
        start = end
        if not guard_crossed(state, address, row, t, 1.0):
            keep_guards(state, address)
            return


@compiled
def first_crossing(state, address, row, t, low):
    """Return the part of the step, after ``low``, just behind which no guard that was positive is so any more.

    False position on the least of them (Dahlquist and Bjorck, the Illinois method), which ends on both sides of the root.
    """
    end, at_low, at_end = 1.0, least_guard(state, address, row, t, low), least_guard(state, address, row, t, 1.0)
    last = 0
    for k in range(SEARCHES):
        if end - low <= 2.0 * INSTANT:
            break
        middle = low - at_low * (end - low) / (at_end - at_low) if at_low > 0.0 else 0.5 * (low + end)
        if k % 4 == 3:
            middle = 0.5 * (low + end)
        middle = min(max(middle, low + INSTANT), end - INSTANT)
        value = least_guard(state, address, row, t, middle)
        if value > 0.0:
            low, at_low = middle, value
            at_end *= 0.5 if last > 0 else 1.0
            last = 1
        else:
            end, at_end = middle, value
            at_low *= 0.5 if last < 0 else 1.0
            last = -1
    return end


@compiled
def between(address, t, part):
    """Return displacement [m] and velocity [m/s] at a part of the step that ends at ``t``: the cubic through its ends."""
    b = address + 8 * s.BEFORE
    h = t - n.load(b)
    ux, uy, vx, vy = n.load(b + 8), n.load(b + 16), n.load(b + 24), n.load(b + 32)
    dx, dy = n.load(address + 8 * s.UX) - ux, n.load(address + 8 * s.UY) - uy
    wx, wy = n.load(address + 8 * s.VX), n.load(address + 8 * s.VY)
    p, q = part, 1.0 - part
    end, here, there = p * p * (3.0 - 2.0 * p), p * q * q * h, -p * p * q * h
    rise, early, late = 6.0 * p * q / h, q * (1.0 - 3.0 * p), p * (3.0 * p - 2.0)
    return (
        ux + end * dx + here * vx + there * wx,
        uy + end * dy + here * vy + there * wy,
        rise * dx + early * vx + late * wx,
        rise * dy + early * vy + late * wy,
    )


@compiled_inline
def guard_crossed(state, address, row, t, part):
    """Return whether a guard that was positive at the start of the search is not positive at a part of the step."""
    return least_guard(state, address, row, t, part) <= 0.0


@compiled_inline
def least_guard(state, address, row, t, part):
    """Return the least of the guards that were positive at the start of the search, at a part of the step."""
    if part == 1.0:
        now, ux, uy = t, n.load(address + 8 * s.UX), n.load(address + 8 * s.UY)
        vx, vy = n.load(address + 8 * s.VX), n.load(address + 8 * s.VY)
    else:
        ux, uy, vx, vy = between(address, t, part)
        before = n.load(address + 8 * s.BEFORE)
        now = before + part * (t - before)
    guards_at(state, address, row, now, ux, uy, vx, vy)
    least = math.inf
    for j in range(GUARDS):
        if n.load(address + 8 * (s.START_GUARDS + j)) > 0.0:
            least = min(least, n.load(state + 8 * (s.OUTPUT + j)))
    return least
