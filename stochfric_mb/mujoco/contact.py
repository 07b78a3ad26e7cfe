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

from stochfric_mb.coefficients.path import CURSOR as CURSOR_SIZE
from stochfric_mb.coefficients.path import canonical_time, evaluate
from stochfric_mb.coefficients.processes import TIME
from stochfric_mb.compile import compiled
from stochfric_mb.laws.abi import MAX_STATE, call_law
from stochfric_mb.laws.contract import GUARDS
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s

CONTACTS_FULL = 1
"""mjWARN_CONTACTFULL."""
SWITCHES, BISECTIONS = 4, 40
"""Most switches of a law looked for within one step, and halvings of the step to find one."""
SUDDEN = 0.05
"""Change of the normal force in a step, relative to it, with which explicit friction (one step late) will not do."""
JUMP = 10.0
"""A displacement this many times beyond what the velocities allow is a body that was moved, not a motion."""


@compiled
def slot(state, current, k):
    """Return the address of slot ``k`` of the committed (0) or the current (1) block."""
    base = s.DESCRIPTOR + int(n.load(state + 8 * s.N_DESCRIPTOR))
    return state + 8 * (base + (current * int(n.load(state + 8 * s.N_SLOTS)) + k) * s.SLOT)


@compiled
def contact_address(data, i):
    """Return the address of contact ``i``."""
    return n.pointer_field(data, n.D_CONTACT) + i * n.entry(n.CONTACT_SIZE)


@compiled
def side(contact, body, surface):
    """Return +1 if geom 1 of the contact is the body, -1 if geom 2 is, 0 if the contact is none of ours.

    ``body`` or ``surface`` -1 stands for any geom; contacts of flexible bodies have geom -1 and are never ours.
    """
    a = n.int_field(contact, n.C_GEOM)
    b = n.load_int(n.field(contact, n.C_GEOM) + 4)
    if a < 0 or b < 0:
        return 0
    if a == body and (b == surface or surface < 0):
        return 1
    if b == body and (a == surface or surface < 0):
        return -1
    if body < 0 and b == surface:
        return 1
    if body < 0 and a == surface:
        return -1
    return 0


@compiled
def find(state, current, count, a, b, ordinal, guess):
    """Return the address of the slot of the contact (geoms a, b, number among equals), 0 if there is none."""
    for i in range(count):
        k = (guess + i) % count
        address = slot(state, current, k)
        if (
            n.load(address + 8 * s.GEOM_1) == a + 1
            and n.load(address + 8 * s.GEOM_2) == b + 1
            and n.load(address + 8 * s.ORDINAL) == ordinal
        ):
            return address
    return 0


@compiled
def ordinal_of(data, i):
    """Return how many earlier contacts join the same two geoms as contact ``i``."""
    a = n.load_word(n.field(contact_address(data, i), n.C_GEOM))
    count = 0
    for j in range(i):
        if n.load_word(n.field(contact_address(data, j), n.C_GEOM)) == a:
            count += 1
    return count


@compiled
def body_of(model, geom):
    """Return the body of a geom."""
    return n.load_int(n.pointer_field(model, n.M_GEOM_BODY) + 4 * geom)


@compiled
def velocity(model, data, body, x, y, z):
    """Return the velocity [m/s] of the body's material point at (x, y, z)."""
    root = n.load_int(n.pointer_field(model, n.M_BODY_ROOT) + 4 * body)
    c = n.pointer_field(data, n.D_SUBTREE_COM) + 24 * root
    rx, ry, rz = x - n.load(c), y - n.load(c + 8), z - n.load(c + 16)
    v = n.pointer_field(data, n.D_CVEL) + 48 * body
    wx, wy, wz = n.load(v), n.load(v + 8), n.load(v + 16)
    return (
        n.load(v + 24) + wy * rz - wz * ry,
        n.load(v + 32) + wz * rx - wx * rz,
        n.load(v + 40) + wx * ry - wy * rx,
    )


@compiled
def spin(data, body, x, y, z):
    """Return the body's angular velocity [rad/s] about the direction (x, y, z)."""
    v = n.pointer_field(data, n.D_CVEL) + 48 * body
    return n.load(v) * x + n.load(v + 8) * y + n.load(v + 16) * z


@compiled
def to_body(data, body, x, y, z):
    """Return the world point (x, y, z) in the body's frame."""
    p = n.pointer_field(data, n.D_XPOS) + 24 * body
    r = n.pointer_field(data, n.D_XMAT) + 72 * body
    dx, dy, dz = x - n.load(p), y - n.load(p + 8), z - n.load(p + 16)
    return (
        n.load(r) * dx + n.load(r + 24) * dy + n.load(r + 48) * dz,
        n.load(r + 8) * dx + n.load(r + 32) * dy + n.load(r + 56) * dz,
        n.load(r + 16) * dx + n.load(r + 40) * dy + n.load(r + 64) * dz,
    )


@compiled
def to_world(data, body, point):
    """Return the world position of the body's point stored at ``point``."""
    p = n.pointer_field(data, n.D_XPOS) + 24 * body
    r = n.pointer_field(data, n.D_XMAT) + 72 * body
    x, y, z = n.load(point), n.load(point + 8), n.load(point + 16)
    return (
        n.load(p) + n.load(r) * x + n.load(r + 8) * y + n.load(r + 16) * z,
        n.load(p + 8) + n.load(r + 24) * x + n.load(r + 32) * y + n.load(r + 40) * z,
        n.load(p + 16) + n.load(r + 48) * x + n.load(r + 56) * y + n.load(r + 64) * z,
    )


@compiled
def dot(address, x, y, z):
    """Return the scalar product of the vector at ``address`` with (x, y, z)."""
    return n.load(address) * x + n.load(address + 8) * y + n.load(address + 16) * z


@compiled
def put(address, x, y, z):
    """Write a vector."""
    n.store(address, x)
    n.store(address + 8, y)
    n.store(address + 16, z)


@compiled
def surface_velocity(contact, sign):
    """Return the velocity [m/s] of the counter-surface's belt relative to the body's, in world axes."""
    f = n.field(contact, n.C_FRAME)
    v = n.field(contact, n.C_SURFACEVEL)
    s1, s2 = sign * n.load(v), sign * n.load(v + 8)
    return (
        s1 * n.load(f + 24) + s2 * n.load(f + 48),
        s1 * n.load(f + 32) + s2 * n.load(f + 56),
        s1 * n.load(f + 40) + s2 * n.load(f + 64),
    )


@compiled
def relative_velocity(model, data, contact, sign, body, surface):
    """Return the velocity [m/s] of the counter-surface relative to the body at the contact point, in world axes."""
    x, y, z = point_of(contact)
    bx, by, bz = velocity(model, data, body, x, y, z)
    cx, cy, cz = velocity(model, data, surface, x, y, z)
    sx, sy, sz = surface_velocity(contact, sign)
    return cx - bx + sx, cy - by + sy, cz - bz + sz


@compiled
def point_of(contact):
    """Return the contact point (world)."""
    p = n.field(contact, n.C_POS)
    return n.load(p), n.load(p + 8), n.load(p + 16)


@compiled
def bodies_of(model, contact, sign):
    """Return the ids of the body and of the counter-surface's body."""
    a = body_of(model, n.int_field(contact, n.C_GEOM))
    b = body_of(model, n.load_int(n.field(contact, n.C_GEOM) + 4))
    return (a, b) if sign > 0 else (b, a)


@compiled
def set_axes(data, contact, current, old, body, surface, step):
    """Write the tangent frame: the old one carried along with the contact, or a new one along the surface velocity."""
    f = n.field(contact, n.C_FRAME)
    nx, ny, nz = n.load(f), n.load(f + 8), n.load(f + 16)
    if old != 0:
        e = old + 8 * s.AXIS_1
        x, y, z = n.load(e), n.load(e + 8), n.load(e + 16)
        turn = 0.5 * step * (spin(data, body, nx, ny, nz) + spin(data, surface, nx, ny, nz))
        x, y, z = x + turn * (ny * z - nz * y), y + turn * (nz * x - nx * z), z + turn * (nx * y - ny * x)
    else:
        x, y, z = surface_velocity(contact, 1.0)
        if x * x + y * y + z * z == 0.0:
            x, y, z = (1.0, 0.0, 0.0) if abs(nx) < 0.9 else (0.0, 1.0, 0.0)
        elif x + y + z < 0.0:
            x, y, z = -x, -y, -z
    along = x * nx + y * ny + z * nz
    x, y, z = x - along * nx, y - along * ny, z - along * nz
    size = math.sqrt(x * x + y * y + z * z)
    if not size > 0.0:
        x, y, z, size = n.load(f + 24), n.load(f + 32), n.load(f + 40), 1.0
    x, y, z = x / size, y / size, z / size
    put(current + 8 * s.AXIS_1, x, y, z)
    put(current + 8 * s.AXIS_2, ny * z - nz * y, nz * x - nx * z, nx * y - ny * x)


@compiled
def displacement(data, address, body, surface, t, vx, vy):
    """Return the displacement [m] since the slot's time: of the two bodies' contact points, plus surface velocity.

    Where that is far from what the velocities allow, a body was put elsewhere or contacts changed places; then the
    mean velocity counts.
    """
    e1, e2 = address + 8 * s.AXIS_1, address + 8 * s.AXIS_2
    bx, by, bz = to_world(data, body, address + 8 * s.ON_BODY)
    cx, cy, cz = to_world(data, surface, address + 8 * s.ON_SURFACE)
    step = t - n.load(address + 8 * s.SINCE)
    dx = dot(e1, cx - bx, cy - by, cz - bz) + step * n.load(address + 8 * s.SX)
    dy = dot(e2, cx - bx, cy - by, cz - bz) + step * n.load(address + 8 * s.SY)
    wx, wy = n.load(address + 8 * s.VX), n.load(address + 8 * s.VY)
    mx, my = 0.5 * step * (vx + wx), 0.5 * step * (vy + wy)
    allowed = JUMP * step * (math.hypot(vx, vy) + math.hypot(wx, wy)) + 1.0e-6
    if math.hypot(dx - mx, dy - my) > allowed:
        return mx, my
    return dx, dy


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


@compiled
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
        rows = np.empty((7, nv))
        return _tangent_mass(model, data, state, contact, address, body, surface, nv, rows.ctypes.data)
    return _tangent_mass(model, data, state, contact, address, body, surface, nv, state + 8 * s.ROWS)


@compiled
def _tangent_mass(model, data, state, contact, address, body, surface, nv, rows):
    for j in range(2 * nv):
        n.store(rows + 8 * j, 0.0)
    x, y, z = point_of(contact)
    put(state + 8 * s.POINT, x, y, z)
    add_rows(model, data, state, address, body, 1.0, nv, rows)
    add_rows(model, data, state, address, surface, -1.0, nv, rows)
    n.mj_solveM(model, data, rows + 16 * nv, rows, np.int32(2))
    a, b, c = 0.0, 0.0, 0.0
    for j in range(0, 8 * nv, 8):
        a += n.load(rows + j) * n.load(rows + j + 16 * nv)
        b += n.load(rows + j + 8 * nv) * n.load(rows + j + 24 * nv)
        c += n.load(rows + j) * n.load(rows + j + 24 * nv)
    largest = 0.5 * (a + b) + math.hypot(0.5 * (a - b), c)
    return 1.0 / largest if largest > 0.0 else 0.0


@compiled
def add_rows(model, data, state, address, body, sign, nv, rows):
    """Add the body's point velocity per generalised velocity along both axes to the first two rows."""
    if body == 0:
        return
    jacobian = rows + 32 * nv
    n.mj_jac(model, data, jacobian, 0, state + 8 * s.POINT, np.int32(body))
    for i in range(2):
        e = address + 8 * (s.AXIS_1 + 3 * i)
        x, y, z = sign * n.load(e), sign * n.load(e + 8), sign * n.load(e + 16)
        row = rows + 8 * nv * i
        for j in range(0, 8 * nv, 8):
            k = jacobian + j
            n.store(row + j, n.load(row + j) + x * n.load(k) + y * n.load(k + 8 * nv) + z * n.load(k + 16 * nv))


@compiled
def clear_push(state, contact):
    """Start a sum of forces and torques about the contact's point."""
    put(state + 8 * s.FORCE, 0.0, 0.0, 0.0)
    put(state + 8 * s.TORQUE, 0.0, 0.0, 0.0)
    x, y, z = point_of(contact)
    put(state + 8 * s.POINT, x, y, z)


@compiled
def add_push(state, contact, fx, fy, fz):
    """Add a force on the body at the contact's point to the sum."""
    x, y, z = point_of(contact)
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


@compiled
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


@compiled
def half_step(model):
    """Return half the engine's step [s]."""
    return 0.5 * n.number_field(model, n.M_TIMESTEP)


@compiled
def begin(model, data, state):
    """Make the current slots for a step that starts now, at an accepted state."""
    now = n.number_field(data, n.D_TIME)
    n.store(state + 8 * s.EVALUATED, now)
    n.store(state + 8 * s.STARTED, 1.0)
    last = n.load(state + 8 * s.ADVANCED)
    known = int(n.load(state + 8 * s.N_COMMITTED)) if last == now else 0
    t = canonical_time(now, half_step(model))
    body, surface = int(n.load(state + 8 * s.GEOM_BODY)), int(n.load(state + 8 * s.GEOM_SURFACE))
    count, total, sudden = 0, 0.0, False
    for i in range(n.int_field(data, n.D_NCON)):
        contact = contact_address(data, i)
        sign = side(contact, body, surface)
        if sign == 0:
            continue
        if count == int(n.load(state + 8 * s.N_SLOTS)):
            n.mj_warning(data, np.int32(CONTACTS_FULL), np.int32(count))
            break
        total += track(model, data, state, i, sign, t, known, count)
        if n.load(state + 8 * s.MODE) == s.AUTO and not sudden:
            sudden = is_sudden(model, data, state, contact, slot(state, 1, count))
        count += 1
    n.store(state + 8 * s.N_CURRENT, float(count))
    star = body < 0 or surface < 0
    for k in range(count):
        address = slot(state, 1, k)
        if star:
            pair, among = pair_total(state, address, count)
            commit_slot(state, address, t, pair, among)
        else:
            commit_slot(state, address, t, total, count)
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
def track(model, data, state, i, sign, t, known, k):
    """Fill the kinematics of current slot ``k`` from contact ``i``; return its normal force [N]."""
    contact = contact_address(data, i)
    address = slot(state, 1, k)
    a = n.int_field(contact, n.C_GEOM)
    b = n.load_int(n.field(contact, n.C_GEOM) + 4)
    ordinal = ordinal_of(data, i)
    old = find(state, 0, known, a, b, ordinal, k) if known > 0 else 0
    if old != 0:
        normal_force = n.load(old + 8 * s.NORMAL)
        if n.load(old + 8 * s.LIVE) == 0.0:
            old = 0
    else:
        normal_force = predicted_normal_force(model, data, contact, n.pointer_field(data, n.D_WARMSTART))
    fill(model, data, state, contact, sign, t, address, old)
    n.store(address + 8 * s.GEOM_1, a + 1.0)
    n.store(address + 8 * s.GEOM_2, b + 1.0)
    n.store(address + 8 * s.ORDINAL, float(ordinal))
    n.store(address + 8 * s.NORMAL, normal_force)
    return normal_force


@compiled
def fill(model, data, state, contact, sign, t, address, old):
    """Fill frame, velocity, displacement, material points and mass of a slot; its law state stays the old one."""
    body, surface = bodies_of(model, contact, sign)
    vx, vy, vz = relative_velocity(model, data, contact, sign, body, surface)
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
    sx, sy, sz = surface_velocity(contact, sign)
    n.store(address + 8 * s.SX, dot(e1, sx, sy, sz))
    n.store(address + 8 * s.SY, dot(e2, sx, sy, sz))
    n.store(address + 8 * s.SINCE, t)
    x, y, z = point_of(contact)
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
def commit_slot(state, address, t, total, count):
    """Run the law's commit (init for a new contact) on a current slot.

    Contacts of one pair share the mass that they feel, in proportion to their normal forces.
    """
    normal_force = n.load(address + 8 * s.NORMAL)
    share = normal_force / total if total > 0.0 else 1.0 / count
    n.store(address + 8 * s.MASS, n.load(address + 8 * s.MASS) * share)
    row = n.law_row(int(n.load(state + 8 * s.LAW)))
    if row == 0:
        return
    ux, uy = n.load(address + 8 * s.UX), n.load(address + 8 * s.UY)
    vx, vy = n.load(address + 8 * s.VX), n.load(address + 8 * s.VY)
    modes = n.load(state + 8 * s.HAS_MODE) != 0.0
    if n.load(address + 8 * s.LIVE) == 0.0:
        changed = switch(state, address, n.load_word(row + n.INIT), t, ux, uy, vx, vy)
        n.store(address + 8 * s.EVENTS, 0.0)
    else:
        if modes and n.load(address + 8 * s.IMPLICIT_STEP) == 0.0:
            switch_within(state, address, row, t)
        changed = switch(state, address, n.load_word(row + n.COMMIT), t, ux, uy, vx, vy)
    mu_s, mu_k = coefficients(state, t, ux, n.load(address + 8 * s.EVENTS))
    n.store(address + 8 * s.MU_S, mu_s)
    n.store(address + 8 * s.MU_K, mu_k)
    n.store(address + 8 * s.LIVE, 1.0)
    if modes and changed:
        guards_at(state, address, row, t, ux, uy, vx, vy)
        keep_guards(state, address)


@compiled
def keep_guards(state, address):
    """Copy the guards from the work space to the slot, for the search in the time that follows."""
    for j in range(GUARDS):
        n.store(address + 8 * (s.START_GUARDS + j), n.load(state + 8 * (s.OUTPUT + j)))


@compiled
def guards_at(state, address, row, t, ux, uy, vx, vy):
    """Write the law's guards at this instant to the work space."""
    mu_s, mu_k = coefficients(state, t, ux, n.load(address + 8 * s.EVENTS))
    call(state, address, n.load_word(row + n.GUARD), t, ux, uy, vx, vy, mu_s, mu_k)


@compiled
def switch(state, address, function, t, ux, uy, vx, vy):
    """Give a slot the law state that ``function`` (init or commit) returns; return whether it is another one.

    Stick phases that begin are counted.
    """
    changed = n.load(address + 8 * s.LIVE) == 0.0
    mu_s, mu_k = coefficients(state, t, ux, n.load(address + 8 * s.EVENTS))
    call(state, address, function, t, ux, uy, vx, vy, mu_s, mu_k)
    for j in range(MAX_STATE):
        new = n.load(state + 8 * (s.OUTPUT + j))
        changed = changed or n.load(address + 8 * (s.STATE + j)) != new
        n.store(address + 8 * (s.STATE + j), new)
    was = n.load(address + 8 * s.STICK)
    if n.load(state + 8 * s.HAS_MODE) != 0.0:
        stuck = 1.0 if n.load(address + 8 * s.STATE) == 0.0 else 0.0
    else:
        stuck = 1.0 if math.hypot(vx, vy) <= n.load(state + 8 * s.STICK_SPEED) else 0.0
    n.store(address + 8 * s.STICK, stuck)
    if stuck > was:
        n.store(address + 8 * s.EVENTS, n.load(address + 8 * s.EVENTS) + 1.0)
    return changed


@compiled
def switch_within(state, address, row, t):
    """Let a law with modes switch where it should have within the step that has just ended.

    Where one of the law's guards has changed sign, ``commit`` runs with the state there, by the cubic through both
    ends of the step: what the law remembers of a switch then does not depend on where the step ended.
    """
    before = n.load(address + 8 * s.BEFORE)
    start = 0.0
    for _ in range(SWITCHES):
        if not guard_crossed(state, address, row, t, 1.0):
            keep_guards(state, address)
            return
        low, end = start, 1.0
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + end)
            if guard_crossed(state, address, row, t, middle):
                end = middle
            else:
                low = middle
        ux, uy, vx, vy = between(address, t, end)
        now = before + end * (t - before)
        switch(state, address, n.load_word(row + n.COMMIT), now, ux, uy, vx, vy)
        guards_at(state, address, row, now, ux, uy, vx, vy)
        keep_guards(state, address)
        start = end


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


@compiled
def guard_crossed(state, address, row, t, part):
    """Return whether a guard that was positive at the start of the search is not positive at a part of the step."""
    if part == 1.0:
        ux, uy = n.load(address + 8 * s.UX), n.load(address + 8 * s.UY)
        guards_at(state, address, row, t, ux, uy, n.load(address + 8 * s.VX), n.load(address + 8 * s.VY))
    else:
        ux, uy, vx, vy = between(address, t, part)
        before = n.load(address + 8 * s.BEFORE)
        guards_at(state, address, row, before + part * (t - before), ux, uy, vx, vy)
    for j in range(GUARDS):
        if n.load(address + 8 * (s.START_GUARDS + j)) > 0.0 and n.load(state + 8 * (s.OUTPUT + j)) <= 0.0:
            return True
    return False


@compiled
def call(state, address, function, t, ux, uy, vx, vy, mu_s, mu_k):
    """Call one of the law's functions on a slot; the result goes to the work space."""
    call_law(
        function, t, ux, uy, vx, vy, n.load(address + 8 * s.NORMAL), mu_s, mu_k, n.load(address + 8 * s.MASS),
        n.load(address + 8 * s.HOLD_X), n.load(address + 8 * s.HOLD_Y),
        address + 8 * s.STATE, state + 8 * s.PARAMETERS, state + 8 * s.OUTPUT,
    )  # fmt: skip


@compiled
def apply(model, data, state):
    """Add the friction forces at this instant; at a step's start also record them."""
    now = n.number_field(data, n.D_TIME)
    starting = now == n.load(state + 8 * s.EVALUATED)
    t = canonical_time(now, half_step(model))
    row = n.law_row(int(n.load(state + 8 * s.LAW)))
    target = n.pointer_field(data, n.D_QFRC_PASSIVE)
    if row == 0:
        n.store(target, math.nan)
        return
    geom, other = int(n.load(state + 8 * s.GEOM_BODY)), int(n.load(state + 8 * s.GEOM_SURFACE))
    k = 0
    last_body, last_surface = -1, -1
    for i in range(n.int_field(data, n.D_NCON)):
        contact = contact_address(data, i)
        sign = side(contact, geom, other)
        if sign == 0:
            continue
        address = slot_at_stage(model, data, state, i, sign, t, k)
        k += 1
        if address == 0:
            continue
        body, surface = bodies_of(model, contact, sign)
        if body != last_body or surface != last_surface:
            if last_body >= 0:
                push(model, data, state, last_body, last_surface, target)
            clear_push(state, contact)
            last_body, last_surface = body, surface
        apply_contact(model, data, state, contact, sign, body, surface, address, n.load_word(row + n.FORCE), t, starting)
    if last_body >= 0:
        push(model, data, state, last_body, last_surface, target)


@compiled
def slot_at_stage(model, data, state, i, sign, t, k):
    """Return the current slot of contact ``i``; one that was born within the step gets a slot of its own."""
    contact = contact_address(data, i)
    a = n.int_field(contact, n.C_GEOM)
    b = n.load_int(n.field(contact, n.C_GEOM) + 4)
    count = int(n.load(state + 8 * s.N_CURRENT))
    address = find(state, 1, count, a, b, ordinal_of(data, i), k) if count > 0 else 0
    if address != 0 or count == int(n.load(state + 8 * s.N_SLOTS)):
        return address
    n.store(state + 8 * s.N_CURRENT, count + 1.0)
    normal_force = track(model, data, state, i, sign, t, 0, count)
    address = slot(state, 1, count)
    commit_slot(state, address, t, normal_force, 1)
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
        if count == 0 or find(state, 1, count, a, b, ordinal_of(data, i), k) == 0:
            n.store(state + 8 * s.SOLVED, 1.0)
            return
        k += 1


@compiled
def apply_contact(model, data, state, contact, sign, body, surface, address, force, t, starting):
    """Add the friction force of one contact to the sum."""
    e1, e2 = address + 8 * s.AXIS_1, address + 8 * s.AXIS_2
    ux, uy = n.load(address + 8 * s.UX), n.load(address + 8 * s.UY)
    if starting:
        vx, vy = n.load(address + 8 * s.VX), n.load(address + 8 * s.VY)
        mu_s, mu_k = n.load(address + 8 * s.MU_S), n.load(address + 8 * s.MU_K)
    else:
        wx, wy, wz = relative_velocity(model, data, contact, sign, body, surface)
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
        fx * n.load(e1) + fy * n.load(e2),
        fx * n.load(e1 + 8) + fy * n.load(e2 + 8),
        fx * n.load(e1 + 16) + fy * n.load(e2 + 16),
    )


@compiled
def finish(model, data, state):
    """Commit the current slots when the engine accepts a step, with the normal forces of its last solution."""
    count = int(n.load(state + 8 * s.N_CURRENT))
    n_slots = int(n.load(state + 8 * s.N_SLOTS))
    for j in range(count * s.SLOT):
        n.store(slot(state, 0, 0) + 8 * j, n.load(slot(state, 1, 0) + 8 * j))
    for k in range(count):
        n.store(slot(state, 0, k) + 8 * s.NORMAL, 0.0)
    body, surface = int(n.load(state + 8 * s.GEOM_BODY)), int(n.load(state + 8 * s.GEOM_SURFACE))
    wrench = np.empty(6)
    k = 0
    for i in range(n.int_field(data, n.D_NCON)):
        contact = contact_address(data, i)
        if side(contact, body, surface) == 0:
            continue
        a = n.int_field(contact, n.C_GEOM)
        b = n.load_int(n.field(contact, n.C_GEOM) + 4)
        ordinal = ordinal_of(data, i)
        address = find(state, 0, count, a, b, ordinal, k) if count > 0 else 0
        k += 1
        if address == 0:
            if count == n_slots:
                continue
            address = slot(state, 0, count)
            count += 1
            n.store(address + 8 * s.GEOM_1, a + 1.0)
            n.store(address + 8 * s.GEOM_2, b + 1.0)
            n.store(address + 8 * s.ORDINAL, float(ordinal))
            n.store(address + 8 * s.LIVE, 0.0)
        n.mj_contactForce(model, data, np.int32(i), wrench.ctypes.data)
        n.store(address + 8 * s.NORMAL, max(wrench[0], 0.0))
    n.store(state + 8 * s.N_COMMITTED, float(count))
    n.store(state + 8 * s.ADVANCED, n.number_field(data, n.D_TIME))
    n.store(state + 8 * s.STARTED, 0.0)
