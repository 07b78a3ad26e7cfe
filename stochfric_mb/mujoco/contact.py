"""Friction at the contacts of one plugin instance: kinematics from MuJoCo, force from the law, once-per-step commits.

At the first evaluation of a step (`begin`) each contact's committed slot, advanced along the displacement since its
commit, becomes a current slot: the law's ``commit`` runs with the state at the step's start, which is exact. All
Runge-Kutta stages use the current slots. Only `finish`, which the engine calls when it accepts the step, makes
current slots the committed ones; so evaluations between steps change nothing.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.coefficients.path import canonical_time
from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.laws.plane import length
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.kinematics import (
    add_rows,
    bodies_of,
    contact_address,
    displacement,
    dot,
    ordinal_of,
    point_of,
    put,
    relative_velocity,
    set_axes,
    side,
    surface_velocity,
    to_body,
)
from stochfric_mb.mujoco.level import common_overlap, lift, on_face
from stochfric_mb.mujoco.switching import call, coefficients, commit_slot, half_step

CONTACTS_FULL = 1
"""mjWARN_CONTACTFULL."""
GOLDEN = 0.6180339887498949
"""Golden ratio: its multiples spread evenly over their fractional parts."""
SUDDEN = 0.05
"""Change of the normal force in a step, relative to it, with which explicit friction (one step late) will not do."""


@compiled_inline
def slot(state, current, k):
    """Return the address of slot ``k`` of the committed (0) or the current (1) block."""
    base = s.DESCRIPTOR + int(n.load(state + 8 * s.N_DESCRIPTOR))
    return state + 8 * (base + (current * int(n.load(state + 8 * s.N_SLOTS)) + k) * s.SLOT)


@compiled_inline
def find(block, count, a, b, ordinal, guess):
    """Return the address of the slot of a contact (geoms a, b, number among equals) in a block, 0 if there is none."""
    for i in range(count):
        k = guess + i if guess + i < count else (guess + i) % count
        address = block + 8 * s.SLOT * k
        if (
            n.load(address + 8 * s.GEOM_1) == a + 1
            and n.load(address + 8 * s.GEOM_2) == b + 1
            and n.load(address + 8 * s.ORDINAL) == ordinal
        ):
            return address
    return 0


@compiled
def predicted_normal_force(model, data, contact, warm):
    """Return the normal force [N] that a contact would have with the acceleration of the step before, at ``warm``."""
    row = n.int_field(contact, n.C_EFC)
    if row < 0:
        return 0.0
    nv = n.int_field(model, n.M_NV)
    sparse = n.mj_isSparse(model) != 0
    count, first = nv, nv * row
    if sparse:
        count = n.load_int(n.pointer_field(data, n.D_EFC_NNZ) + 4 * row)
        first = n.load_int(n.pointer_field(data, n.D_EFC_ADDRESS) + 4 * row)
    jacobian, columns = n.pointer_field(data, n.D_EFC_J), n.pointer_field(data, n.D_EFC_COLUMN)
    qvel = n.pointer_field(data, n.D_QVEL)
    rate, acceleration = 0.0, 0.0
    for k in range(count):
        column = n.load_int(columns + 4 * (first + k)) if sparse else k
        j = n.load(jacobian + 8 * (first + k))
        rate += j * n.load(qvel + 8 * column)
        acceleration += j * n.load(warm + 8 * column)
    kbip = n.pointer_field(data, n.D_EFC_KBIP) + 32 * row
    gap = n.load(n.pointer_field(data, n.D_EFC_POS) + 8 * row) - n.load(n.pointer_field(data, n.D_EFC_MARGIN) + 8 * row)
    wanted = -n.load(kbip + 8) * rate - n.load(kbip) * n.load(kbip + 16) * gap
    return max(0.0, n.load(n.pointer_field(data, n.D_EFC_D) + 8 * row) * (wanted - acceleration))


@compiled_inline
def warm_row(state):
    """Return the address of the instance's row of generalised coordinates: the acceleration of the step before."""
    blocks = s.DESCRIPTOR + int(n.load(state + 8 * s.N_DESCRIPTOR)) + 2 * int(n.load(state + 8 * s.N_SLOTS)) * s.SLOT
    return state + 8 * blocks


@compiled
def is_sudden(model, data, state, contact, address):
    """Return whether the normal force changes much within this step, as in an impact, or the contact is new.

    With the acceleration of the step before, the normal force changes by 1/(1 - d) times as much as it will, d being the
    constraint's impedance (MuJoCo's computation chapter, constraint model: R = (1 - d)/d A).
    """
    if n.load(address + 8 * s.LIVE) == 0.0:
        return True
    row, old = n.int_field(contact, n.C_EFC), n.load(address + 8 * s.NORMAL)
    if row < 0:
        return old > 0.0
    impedance = n.load(n.pointer_field(data, n.D_EFC_KBIP) + 32 * row + 16)
    change = (1.0 - impedance) * (predicted_normal_force(model, data, contact, warm_row(state)) - old)
    return abs(change) > SUDDEN * old


@compiled
def tangent_mass(model, data, state, contact, address, body, surface):
    """Return the mass [kg] that a tangential force feels, 1/(J M^-1 J^T) in the direction where it is smallest."""
    nv = n.int_field(model, n.M_NV)
    if nv > s.MAX_ROW:
        rows = np.empty((4, nv))
        return _tangent_mass(model, data, contact, address, body, surface, nv, rows.ctypes.data)
    return _tangent_mass(model, data, contact, address, body, surface, nv, state + 8 * s.ROWS)


@compiled_inline
def _tangent_mass(model, data, contact, address, body, surface, nv, rows):
    for j in range(2 * nv):
        n.store(rows + 8 * j, 0.0)
    x, y, z = point_of(contact, address)
    add_rows(model, data, address, body, 1.0, x, y, z, nv, rows)
    add_rows(model, data, address, surface, -1.0, x, y, z, nv, rows)
    n.mj_solveM(model, data, rows + 16 * nv, rows, np.int32(2))
    a, b, c = 0.0, 0.0, 0.0
    for j in range(0, 8 * nv, 8):
        a += n.load(rows + j) * n.load(rows + j + 16 * nv)
        b += n.load(rows + j + 8 * nv) * n.load(rows + j + 24 * nv)
        c += n.load(rows + j) * n.load(rows + j + 24 * nv)
    largest = 0.5 * (a + b) + length(0.5 * (a - b), c)
    return 1.0 / largest if largest > 0.0 else 0.0


@compiled_inline
def clear_push(state, contact, address):
    """Start a sum of forces and torques about the contact's point."""
    put(state + 8 * s.FORCE, 0.0, 0.0, 0.0)
    put(state + 8 * s.TORQUE, 0.0, 0.0, 0.0)
    x, y, z = point_of(contact, address)
    put(state + 8 * s.POINT, x, y, z)


@compiled_inline
def add_push(state, contact, address, fx, fy, fz):
    """Add a force on the body at the contact's point to the sum."""
    x, y, z = point_of(contact, address)
    f, m, p = state + 8 * s.FORCE, state + 8 * s.TORQUE, state + 8 * s.POINT
    x, y, z = x - n.load(p), y - n.load(p + 8), z - n.load(p + 16)
    put(f, n.load(f) + fx, n.load(f + 8) + fy, n.load(f + 16) + fz)
    put(
        m,
        n.load(m) + y * fz - z * fy,
        n.load(m + 8) + z * fx - x * fz,
        n.load(m + 16) + x * fy - y * fx,
    )


@compiled
def push(model, data, state, body, surface, target):
    """Add the generalised force of the sum on the body, and of its opposite on the surface."""
    f, m, p = state + 8 * s.FORCE, state + 8 * s.TORQUE, state + 8 * s.POINT
    if body > 0:
        n.mj_applyFT(model, data, f, m, p, np.int32(body), target)
    if surface > 0:
        g, k = state + 8 * s.COUNTER_FORCE, state + 8 * s.COUNTER_TORQUE
        put(g, -n.load(f), -n.load(f + 8), -n.load(f + 16))
        put(k, -n.load(m), -n.load(m + 8), -n.load(m + 16))
        n.mj_applyFT(model, data, g, k, p, np.int32(surface), target)


@compiled_inline
def told_by(model, data):
    """Return a sum that tells the velocities: with weights between 1 and 2, no two alike."""
    qvel, total, weight = n.pointer_field(data, n.D_QVEL), 0.0, 0.0
    for j in range(0, 8 * n.int_field(model, n.M_NV), 8):
        weight += GOLDEN
        weight -= 1.0 if weight >= 1.0 else 0.0
        total += (1.0 + weight) * n.load(qvel + j)
    return total


@compiled_inline
def was_pushed(model, data, state):
    """Return whether velocities were written since the last step, by more than the law's stick speed."""
    if n.load(state + 8 * s.FINISHED) == 0.0 or n.load(state + 8 * s.HAS_MODE) == 0.0:
        return False
    return abs(told_by(model, data) - n.load(state + 8 * s.VELOCITIES)) > n.load(state + 8 * s.STICK_SPEED)


@compiled
def begin(model, data, state, warm):
    """Make the current slots for a step that starts now, at an accepted state.

    ``warm`` is the address of the acceleration of the step before, from which new contacts get their normal forces.
    """
    now = n.number_field(data, n.D_TIME)
    n.store(state + 8 * s.EVALUATED, now)
    n.store(state + 8 * s.STARTED, 1.0)
    last = n.load(state + 8 * s.ADVANCED)
    known = int(n.load(state + 8 * s.N_COMMITTED)) if last == now else 0
    t = canonical_time(now, half_step(model))
    n.store(state + 8 * s.INSTANT, t)
    body, surface = int(n.load(state + 8 * s.GEOM_BODY)), int(n.load(state + 8 * s.GEOM_SURFACE))
    committed, current, n_slots = slot(state, 0, 0), slot(state, 1, 0), int(n.load(state + 8 * s.N_SLOTS))
    count, total, sudden, auto = 0, 0.0, False, n.load(state + 8 * s.MODE) == s.AUTO
    first, low, high = -1, 0.0, 0.0
    for i in range(n.int_field(data, n.D_NCON)):
        contact = contact_address(data, i)
        sign = side(contact, body, surface)
        if sign == 0:
            continue
        if count == n_slots:
            n.mj_warning(data, np.int32(CONTACTS_FULL), np.int32(count))
            break
        address = current + 8 * s.SLOT * count
        if first < 0 or not on_face(model, data, first, i, body, surface):
            first = i
            low, high = common_overlap(model, data, i, body, surface)
        total += track(model, data, state, i, sign, t, committed, known, address, count, warm, lift(contact, low, high))
        if auto and not sudden:
            sudden = is_sudden(model, data, state, contact, address)
        count += 1
    n.store(state + 8 * s.N_CURRENT, float(count))
    star = body < 0 or surface < 0
    row = n.law_row(int(n.load(state + 8 * s.LAW)))
    pushed = known > 0 and was_pushed(model, data, state)
    for k in range(count):
        address = current + 8 * s.SLOT * k
        fast = pushed and length(n.load(address + 8 * s.VX), n.load(address + 8 * s.VY)) > n.load(state + 8 * s.STICK_SPEED)
        if fast and n.load(address + 8 * s.LIVE) != 0.0:  # it slides from here on, whatever it did before
            n.store(address + 8 * s.LIVE, -1.0)
        pair, among = pair_total(state, address, count) if star else (total, count)
        commit_slot(state, address, row, t, pair, among)
    n.store(state + 8 * s.SOLVED, 1.0 if sudden or beyond_explicit(model, state, count, total, star) else 0.0)


@compiled
def pair_total(state, address, count):
    """Return the normal force [N] and the number of the contacts between the same two geoms."""
    total, among = 0.0, 0
    for k in range(count):
        other = slot(state, 1, k)
        if (
            n.load(other + 8 * s.GEOM_1) == n.load(address + 8 * s.GEOM_1)
            and n.load(other + 8 * s.GEOM_2) == n.load(address + 8 * s.GEOM_2)
        ):  # fmt: skip
            total += n.load(other + 8 * s.NORMAL)
            among += 1
    return total, among


@compiled
def beyond_explicit(model, state, count, total, star):
    """Return whether this step's forces must be solved: asked for, needed by the law, or the explicit limit is near.

    An explicit step is left when it is beyond half the law's limit, and taken again when the normal force over the
    mass has fallen to a quarter of that which the limit allows.
    """
    mode = n.load(state + 8 * s.MODE)
    if mode == s.EXPLICIT:
        return False
    if mode == s.IMPLICIT or n.load(state + 8 * s.NEEDS_HOLD) != 0.0:
        return True
    step = n.number_field(model, n.M_TIMESTEP)
    if n.load(state + 8 * s.CRITICAL_STEP) != step:
        n.store(state + 8 * s.CRITICAL, critical_ratio(state, 2.0 * step))
        n.store(state + 8 * s.CRITICAL_STEP, step)
    critical = n.load(state + 8 * s.CRITICAL)
    for k in range(count):
        address = slot(state, 1, k)
        if star:
            total, _ = pair_total(state, address, count)
        limit = critical if n.load(address + 8 * s.IMPLICIT_STEP) == 0.0 else 0.25 * critical
        if total > limit * n.load(address + 8 * s.FELT):
            return True
    return False


@compiled
def critical_ratio(state, step):
    """Return the normal force over the mass [N/kg] at which the law's step limit falls to ``step``; infinite if never."""
    limits = state + 8 * s.LIMITS
    for k in range(s.N_LIMITS):
        low = n.load(limits + 8 * k)
        if low <= step:
            if k == 0:
                return 0.0
            high = n.load(limits + 8 * (k - 1))
            part = math.log(high / step) / math.log(high / low) if high < math.inf else 1.0
            return 10.0 ** (k - 5 + part)
    return math.inf


@compiled
def track(model, data, state, i, sign, t, committed, known, address, k, warm, height):
    """Fill the kinematics of the current slot at ``address``, the ``k``-th, from contact ``i``; return its normal force [N].

    ``known`` slots at ``committed`` hold what the step before left; the contact touches ``height`` above its point.
    """
    contact = contact_address(data, i)
    a = n.int_field(contact, n.C_GEOM)
    b = n.load_int(n.field(contact, n.C_GEOM) + 4)
    ordinal = ordinal_of(data, i)
    old = find(committed, known, a, b, ordinal, k) if known > 0 else 0
    if old != 0:
        normal_force = n.load(old + 8 * s.NORMAL)
        if n.load(old + 8 * s.LIVE) == 0.0:
            old = 0
    else:
        normal_force = predicted_normal_force(model, data, contact, warm)
    n.store(address + 8 * s.LIFT, height)
    fill(model, data, state, contact, sign, t, address, old)
    n.store(address + 8 * s.GEOM_1, a + 1.0)
    n.store(address + 8 * s.GEOM_2, b + 1.0)
    n.store(address + 8 * s.ORDINAL, float(ordinal))
    n.store(address + 8 * s.NORMAL, normal_force)
    return normal_force


@compiled_inline
def fill(model, data, state, contact, sign, t, address, old):
    """Fill frame, velocity, displacement, material points and mass of a slot; its law state stays the old one."""
    body, surface = bodies_of(model, contact, sign)
    sx, sy, sz = surface_velocity(contact, sign)
    vx, vy, vz = relative_velocity(model, data, contact, address, body, surface, sx, sy, sz)
    ux, uy = n.load(state + 8 * s.ORIGIN), 0.0
    dx, dy = 0.0, 0.0
    step = 0.0
    if old != 0:
        e1, e2 = old + 8 * s.AXIS_1, old + 8 * s.AXIS_2
        dx, dy = displacement(data, old, body, surface, t, dot(e1, vx, vy, vz), dot(e2, vx, vy, vz))
        ux, uy = n.load(old + 8 * s.UX) + dx, n.load(old + 8 * s.UY) + dy
        step = t - n.load(old + 8 * s.SINCE)
        for j in range(s.STATE, s.SLOT):
            n.store(address + 8 * j, n.load(old + 8 * j))
        for j in (s.STICK, s.EVENTS, s.ENERGY, s.HOLD_X, s.HOLD_Y, s.FELT, s.IMPLICIT_STEP):
            n.store(address + 8 * j, n.load(old + 8 * j))
        put(address + 8 * s.BEFORE, n.load(old + 8 * s.SINCE), n.load(old + 8 * s.UX), n.load(old + 8 * s.UY))
        n.store(address + 8 * (s.BEFORE + 3), n.load(old + 8 * s.VX))
        n.store(address + 8 * (s.BEFORE + 4), n.load(old + 8 * s.VY))
        n.store(address + 8 * s.WORK, n.load(old + 8 * s.FX))
        n.store(address + 8 * (s.WORK + 1), n.load(old + 8 * s.FY))
    else:
        for j in (s.STICK, s.EVENTS, s.ENERGY, s.WORK, s.WORK + 1, s.HOLD_X, s.HOLD_Y, s.FELT, s.IMPLICIT_STEP):
            n.store(address + 8 * j, 0.0)
    n.store(address + 8 * s.LIVE, 1.0 if old != 0 else 0.0)
    n.store(address + 8 * (s.WORK + 2), dx)
    n.store(address + 8 * (s.WORK + 3), dy)
    set_axes(data, contact, address, old, body, surface, step)
    e1, e2 = address + 8 * s.AXIS_1, address + 8 * s.AXIS_2
    n.store(address + 8 * s.UX, ux)
    n.store(address + 8 * s.UY, uy)
    n.store(address + 8 * s.VX, dot(e1, vx, vy, vz))
    n.store(address + 8 * s.VY, dot(e2, vx, vy, vz))
    n.store(address + 8 * s.SX, dot(e1, sx, sy, sz))
    n.store(address + 8 * s.SY, dot(e2, sx, sy, sz))
    n.store(address + 8 * s.SINCE, t)
    x, y, z = point_of(contact, address)
    bx, by, bz = to_body(data, body, x, y, z)
    put(address + 8 * s.ON_BODY, bx, by, bz)
    cx, cy, cz = to_body(data, surface, x, y, z)
    put(address + 8 * s.ON_SURFACE, cx, cy, cz)
    explicit = n.load(address + 8 * s.IMPLICIT_STEP) == 0.0
    needed = explicit and n.load(state + 8 * s.NEEDS_MASS) != 0.0
    if needed or (old == 0 and n.load(state + 8 * s.MODE) != s.EXPLICIT):
        n.store(address + 8 * s.FELT, tangent_mass(model, data, state, contact, address, body, surface))
    n.store(address + 8 * s.MASS, n.load(address + 8 * s.FELT) if n.load(state + 8 * s.NEEDS_MASS) != 0.0 else 0.0)


@compiled
def apply(model, data, state, warm):
    """Add the friction forces at this instant; at a step's start also record them."""
    now = n.number_field(data, n.D_TIME)
    starting = now == n.load(state + 8 * s.EVALUATED)
    t = n.load(state + 8 * s.INSTANT) if starting else canonical_time(now, half_step(model))
    row = n.law_row(int(n.load(state + 8 * s.LAW)))
    target = n.pointer_field(data, n.D_QFRC_PASSIVE)
    if row == 0:
        n.store(target, math.nan)
        return
    geom, other = int(n.load(state + 8 * s.GEOM_BODY)), int(n.load(state + 8 * s.GEOM_SURFACE))
    current, count = slot(state, 1, 0), int(n.load(state + 8 * s.N_CURRENT))
    k = 0
    last_body, last_surface = -1, -1
    for i in range(n.int_field(data, n.D_NCON)):
        contact = contact_address(data, i)
        sign = side(contact, geom, other)
        if sign == 0:
            continue
        if starting:  # `begin` has just gone through the same contacts
            address = current + 8 * s.SLOT * k if k < count else 0
        else:
            address = slot_at_stage(model, data, state, i, sign, t, k, warm)
        k += 1
        if address == 0:
            continue
        body, surface = bodies_of(model, contact, sign)
        if body != last_body or surface != last_surface:
            if last_body >= 0:
                push(model, data, state, last_body, last_surface, target)
            clear_push(state, contact, address)
            last_body, last_surface = body, surface
        apply_contact(model, data, state, contact, sign, body, surface, address, n.load_word(row + n.FORCE), t, starting)
    if last_body >= 0:
        push(model, data, state, last_body, last_surface, target)


@compiled_inline
def slot_at_stage(model, data, state, i, sign, t, k, warm):
    """Return the current slot of contact ``i``; one that was born within the step gets a slot of its own."""
    contact = contact_address(data, i)
    a = n.int_field(contact, n.C_GEOM)
    b = n.load_int(n.field(contact, n.C_GEOM) + 4)
    count = int(n.load(state + 8 * s.N_CURRENT))
    address = find(slot(state, 1, 0), count, a, b, ordinal_of(data, i), k) if count > 0 else 0
    if address != 0 or count == int(n.load(state + 8 * s.N_SLOTS)):
        return address
    n.store(state + 8 * s.N_CURRENT, count + 1.0)
    address = slot(state, 1, count)
    normal_force = track(model, data, state, i, sign, t, 0, 0, address, count, warm, 0.0)
    commit_slot(state, address, n.law_row(int(n.load(state + 8 * s.LAW))), t, normal_force, 1)
    n.store(address + 8 * s.LIVE, 0.0)
    return address


@compiled
def solve_new(model, data, state):
    """In auto mode, solve the rest of a step within which a contact is born: its explicit limit is not known."""
    if n.load(state + 8 * s.MODE) != s.AUTO or n.load(state + 8 * s.SOLVED) != 0.0:
        return
    body, surface = int(n.load(state + 8 * s.GEOM_BODY)), int(n.load(state + 8 * s.GEOM_SURFACE))
    count = int(n.load(state + 8 * s.N_CURRENT))
    k = 0
    for i in range(n.int_field(data, n.D_NCON)):
        contact = contact_address(data, i)
        if side(contact, body, surface) == 0:
            continue
        a, b = n.int_field(contact, n.C_GEOM), n.load_int(n.field(contact, n.C_GEOM) + 4)
        if count == 0 or find(slot(state, 1, 0), count, a, b, ordinal_of(data, i), k) == 0:
            n.store(state + 8 * s.SOLVED, 1.0)
            return
        k += 1


@compiled_inline
def apply_contact(model, data, state, contact, sign, body, surface, address, force, t, starting):
    """Add the friction force of one contact to the sum."""
    e1, e2 = address + 8 * s.AXIS_1, address + 8 * s.AXIS_2
    ux, uy = n.load(address + 8 * s.UX), n.load(address + 8 * s.UY)
    if starting:
        vx, vy = n.load(address + 8 * s.VX), n.load(address + 8 * s.VY)
        mu_s, mu_k = n.load(address + 8 * s.MU_S), n.load(address + 8 * s.MU_K)
    else:
        sx, sy, sz = surface_velocity(contact, sign)
        wx, wy, wz = relative_velocity(model, data, contact, address, body, surface, sx, sy, sz)
        vx, vy = dot(e1, wx, wy, wz), dot(e2, wx, wy, wz)
        dx, dy = displacement(data, address, body, surface, t, vx, vy)
        ux, uy = ux + dx, uy + dy
        mu_s, mu_k = coefficients(state, t, ux, n.load(address + 8 * s.EVENTS))
    call(state, address, force, t, ux, uy, vx, vy, mu_s, mu_k)
    fx, fy = n.load(state + 8 * s.OUTPUT), n.load(state + 8 * (s.OUTPUT + 1))
    if starting:
        n.store(address + 8 * s.FX, fx)
        n.store(address + 8 * s.FY, fy)
        n.store(address + 8 * s.IMPLICIT_STEP, 0.0)
        w = address + 8 * s.WORK
        work = 0.5 * ((n.load(w) + fx) * n.load(w + 16) + (n.load(w + 8) + fy) * n.load(w + 24))
        n.store(address + 8 * s.ENERGY, n.load(address + 8 * s.ENERGY) + work)
        n.store(w + 16, 0.0)
        n.store(w + 24, 0.0)
    add_push(
        state,
        contact,
        address,
        fx * n.load(e1) + fy * n.load(e2),
        fx * n.load(e1 + 8) + fy * n.load(e2 + 8),
        fx * n.load(e1 + 16) + fy * n.load(e2 + 16),
    )


@compiled_inline
def normal_force_of(model, data, i, wrench):
    """Return the normal force [N] of contact ``i`` in MuJoCo's last solution; ``wrench`` is room for six numbers."""
    contact = contact_address(data, i)
    if n.int_field(contact, n.C_DIM) == 1:
        row = n.int_field(contact, n.C_EFC)
        return max(n.load(n.pointer_field(data, n.D_EFC_FORCE) + 8 * row), 0.0) if row >= 0 else 0.0
    n.mj_contactForce(model, data, np.int32(i), wrench)
    return max(n.load(wrench), 0.0)


@compiled
def finish(model, data, state):
    """Commit the current slots when the engine accepts a step, with the normal forces of its last solution."""
    count = int(n.load(state + 8 * s.N_CURRENT))
    n_slots = int(n.load(state + 8 * s.N_SLOTS))
    committed = slot(state, 0, 0)
    n.copy_bytes(slot(state, 1, 0), committed, 8 * s.SLOT * count)
    for k in range(count):
        n.store(committed + 8 * (s.SLOT * k + s.NORMAL), 0.0)
    body, surface = int(n.load(state + 8 * s.GEOM_BODY)), int(n.load(state + 8 * s.GEOM_SURFACE))
    wrench = state + 8 * s.FORCE
    k = 0
    for i in range(n.int_field(data, n.D_NCON)):
        contact = contact_address(data, i)
        if side(contact, body, surface) == 0:
            continue
        a = n.int_field(contact, n.C_GEOM)
        b = n.load_int(n.field(contact, n.C_GEOM) + 4)
        ordinal = ordinal_of(data, i)
        address = find(committed, count, a, b, ordinal, k) if count > 0 else 0
        k += 1
        if address == 0:
            if count == n_slots:
                continue
            address = committed + 8 * s.SLOT * count
            count += 1
            n.store(address + 8 * s.GEOM_1, a + 1.0)
            n.store(address + 8 * s.GEOM_2, b + 1.0)
            n.store(address + 8 * s.ORDINAL, float(ordinal))
            n.store(address + 8 * s.LIVE, 0.0)
        n.store(address + 8 * s.NORMAL, normal_force_of(model, data, i, wrench))
    n.store(state + 8 * s.N_COMMITTED, float(count))
    n.store(state + 8 * s.ADVANCED, n.number_field(data, n.D_TIME))
    n.store(state + 8 * s.STARTED, 0.0)
    n.store(state + 8 * s.VELOCITIES, told_by(model, data))
    n.store(state + 8 * s.FINISHED, 1.0)
