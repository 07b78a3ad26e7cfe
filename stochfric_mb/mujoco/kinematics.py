"""How the two bodies of a contact move: points, velocities, the tangent frame that goes along, the displacement in it."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import math

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.laws.plane import length
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s

JUMP = 10.0
"""A displacement this many times beyond what the velocities allow is a body that was moved, not a motion."""
NEAR = 1.0e-6
"""A displacement so near [m] to what the velocities say is a motion in any case."""


@compiled_inline
def contact_address(data, i):
    """Return the address of contact ``i``."""
    return n.pointer_field(data, n.D_CONTACT) + i * n.entry(n.CONTACT_SIZE)


@compiled_inline
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


@compiled_inline
def ordinal_of(data, i):
    """Return how many earlier contacts join the same two geoms as contact ``i``."""
    a = n.load_word(n.field(contact_address(data, i), n.C_GEOM))
    count = 0
    for j in range(i):
        if n.load_word(n.field(contact_address(data, j), n.C_GEOM)) == a:
            count += 1
    return count


@compiled_inline
def body_of(model, geom):
    """Return the body of a geom."""
    return n.load_int(n.pointer_field(model, n.M_GEOM_BODY) + 4 * geom)


@compiled_inline
def bodies_of(model, contact, sign):
    """Return the ids of the body and of the counter-surface's body."""
    a = body_of(model, n.int_field(contact, n.C_GEOM))
    b = body_of(model, n.load_int(n.field(contact, n.C_GEOM) + 4))
    return (a, b) if sign > 0 else (b, a)


@compiled_inline
def point_of(contact, address):
    """Return the contact point (world), at the height that the slot at ``address`` has for it."""
    p, f, lift = n.field(contact, n.C_POS), n.field(contact, n.C_FRAME), n.load(address + 8 * s.LIFT)
    return n.load(p) + lift * n.load(f), n.load(p + 8) + lift * n.load(f + 8), n.load(p + 16) + lift * n.load(f + 16)


@compiled_inline
def velocity(model, data, body, x, y, z):
    """Return the velocity [m/s] of the body's material point at (x, y, z)."""
    if body == 0:
        return 0.0, 0.0, 0.0
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


@compiled_inline
def spin(data, body, x, y, z):
    """Return the body's angular velocity [rad/s] about the direction (x, y, z)."""
    if body == 0:
        return 0.0
    v = n.pointer_field(data, n.D_CVEL) + 48 * body
    return n.load(v) * x + n.load(v + 8) * y + n.load(v + 16) * z


@compiled_inline
def to_body(data, body, x, y, z):
    """Return the world point (x, y, z) in the body's frame."""
    if body == 0:
        return x, y, z
    p = n.pointer_field(data, n.D_XPOS) + 24 * body
    r = n.pointer_field(data, n.D_XMAT) + 72 * body
    dx, dy, dz = x - n.load(p), y - n.load(p + 8), z - n.load(p + 16)
    return (
        n.load(r) * dx + n.load(r + 24) * dy + n.load(r + 48) * dz,
        n.load(r + 8) * dx + n.load(r + 32) * dy + n.load(r + 56) * dz,
        n.load(r + 16) * dx + n.load(r + 40) * dy + n.load(r + 64) * dz,
    )


@compiled_inline
def to_world(data, body, point):
    """Return the world position of the body's point stored at ``point``."""
    x, y, z = n.load(point), n.load(point + 8), n.load(point + 16)
    if body == 0:
        return x, y, z
    p = n.pointer_field(data, n.D_XPOS) + 24 * body
    r = n.pointer_field(data, n.D_XMAT) + 72 * body
    return (
        n.load(p) + n.load(r) * x + n.load(r + 8) * y + n.load(r + 16) * z,
        n.load(p + 8) + n.load(r + 24) * x + n.load(r + 32) * y + n.load(r + 40) * z,
        n.load(p + 16) + n.load(r + 48) * x + n.load(r + 56) * y + n.load(r + 64) * z,
    )


@compiled_inline
def dot(address, x, y, z):
    """Return the scalar product of the vector at ``address`` with (x, y, z)."""
    return n.load(address) * x + n.load(address + 8) * y + n.load(address + 16) * z


@compiled_inline
def put(address, x, y, z):
    """Write a vector."""
    n.store(address, x)
    n.store(address + 8, y)
    n.store(address + 16, z)


@compiled_inline
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


@compiled_inline
def relative_velocity(model, data, contact, address, body, surface, sx, sy, sz):
    """Return the velocity [m/s] of the counter-surface relative to the body at the contact point, in world axes.

    (sx, sy, sz) is `surface_velocity`.
    """
    x, y, z = point_of(contact, address)
    bx, by, bz = velocity(model, data, body, x, y, z)
    cx, cy, cz = velocity(model, data, surface, x, y, z)
    return cx - bx + sx, cy - by + sy, cz - bz + sz


@compiled
def add_rows(model, data, address, body, sign, px, py, pz, nv, rows):
    """Add the velocity of the body's point at (px, py, pz), along both axes of a slot, per generalised velocity.

    ``rows`` is the address of two rows of generalised coordinates. The same as MuJoCo's ``mj_jac`` projected.
    """
    dofs, parents = n.pointer_field(model, n.M_BODY_DOFS), n.pointer_field(model, n.M_BODY_PARENT)
    while body > 0 and n.load_int(dofs + 4 * body) == 0:
        body = n.load_int(parents + 4 * body)
    if body == 0:
        return
    root = n.load_int(n.pointer_field(model, n.M_BODY_ROOT) + 4 * body)
    com = n.pointer_field(data, n.D_SUBTREE_COM) + 24 * root
    rx, ry, rz = px - n.load(com), py - n.load(com + 8), pz - n.load(com + 16)
    e1, e2 = address + 8 * s.AXIS_1, address + 8 * s.AXIS_2
    ax, ay, az = sign * n.load(e1), sign * n.load(e1 + 8), sign * n.load(e1 + 16)
    bx, by, bz = sign * n.load(e2), sign * n.load(e2 + 8), sign * n.load(e2 + 16)
    before = n.pointer_field(model, n.M_DOF_PARENT)
    motions = n.pointer_field(data, n.D_CDOF)
    dof = n.load_int(n.pointer_field(model, n.M_BODY_DOF) + 4 * body) + n.load_int(dofs + 4 * body) - 1
    while dof >= 0:
        c = motions + 48 * dof
        wx, wy, wz = n.load(c), n.load(c + 8), n.load(c + 16)
        x, y, z = n.load(c + 24) + wy * rz - wz * ry, n.load(c + 32) + wz * rx - wx * rz, n.load(c + 40) + wx * ry - wy * rx
        row = rows + 8 * dof
        n.store(row, n.load(row) + ax * x + ay * y + az * z)
        n.store(row + 8 * nv, n.load(row + 8 * nv) + bx * x + by * y + bz * z)
        dof = n.load_int(before + 4 * dof)


@compiled
def set_axes(data, contact, current, old, body, surface, step):
    """Write the tangent frame: the old one carried along with the contact, or a new one along the surface velocity."""
    f = n.field(contact, n.C_FRAME)
    nx, ny, nz = n.load(f), n.load(f + 8), n.load(f + 16)
    turn = 0.0
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
    if old != 0 and turn == 0.0 and abs(along) <= 1.0e-15:  # it has not moved, to rounding
        put(current + 8 * s.AXIS_1, x, y, z)
        put(current + 8 * s.AXIS_2, ny * z - nz * y, nz * x - nx * z, nx * y - ny * x)
        return
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
    far = (dx - mx) * (dx - mx) + (dy - my) * (dy - my)
    if far > NEAR * NEAR:
        allowed = JUMP * step * (length(vx, vy) + length(wx, wy)) + NEAR
        if not far <= allowed * allowed:
            return mx, my
    return dx, dy
