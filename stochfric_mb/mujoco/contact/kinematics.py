"""How the two bodies of a contact move: points, velocities, the tangent frame that goes along, the displacement in it."""

from __future__ import annotations

import math

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.laws.plane import length
from stochfric_mb.mujoco.memory.structs import contact_at
from stochfric_mb.numerics import memory as w

JUMP = 10.0
"""A displacement this many times beyond what the velocities allow is a body that was moved, not a motion."""
NEAR = 1.0e-6
"""A displacement so near [m] to what the velocities say is a motion in any case."""


@compiled_inline
def side(contact, body, surface):
    """Return +1 if geom 1 of the contact is the body, -1 if geom 2 is, 0 if the contact is none of ours.

    ``body`` or ``surface`` -1 stands for any geom; contacts of flexible bodies have geom -1 and are never ours.
    """
    a, b = contact.geom[0], contact.geom[1]
    if a < 0 or b < 0 or is_idle(contact):
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
def is_idle(contact):
    """Return whether a contact that has rows bears nothing (see `contact.face`)."""
    return contact.exclude != 0 and contact.efc_address >= 0


@compiled_inline
def ordinal_after(d, i, ordinal):
    """Return how many contacts before contact ``i`` join the same two geoms, from ``ordinal``, that number of the one before.

    They follow each other in MuJoCo's list.
    """
    if i == 0:
        return 0
    last, geoms = contact_at(d, i - 1), contact_at(d, i).geom
    if last.geom[0] != geoms[0] or last.geom[1] != geoms[1]:
        return 0
    return ordinal if is_idle(last) else ordinal + 1


@compiled_inline
def bodies_of(m, contact, sign):
    """Return the ids of the body and of the counter-surface's body."""
    a, b = w.int_at(m.geom_bodyid, contact.geom[0]), w.int_at(m.geom_bodyid, contact.geom[1])
    return (a, b) if sign > 0 else (b, a)


@compiled_inline
def velocity(m, d, body, x, y, z):
    """Return the velocity [m/s] of the body's material point at (x, y, z)."""
    if body == 0:
        return 0.0, 0.0, 0.0
    c = d.subtree_com + 24 * w.int_at(m.body_rootid, body)
    rx, ry, rz = x - w.at(c, 0), y - w.at(c, 1), z - w.at(c, 2)
    v = d.cvel + 48 * body
    ax, ay, az = w.at(v, 0), w.at(v, 1), w.at(v, 2)
    return w.at(v, 3) + ay * rz - az * ry, w.at(v, 4) + az * rx - ax * rz, w.at(v, 5) + ax * ry - ay * rx


@compiled_inline
def spin(d, body, x, y, z):
    """Return the body's angular velocity [rad/s] about the direction (x, y, z)."""
    if body == 0:
        return 0.0
    v = d.cvel + 48 * body
    return w.at(v, 0) * x + w.at(v, 1) * y + w.at(v, 2) * z


@compiled_inline
def to_body(d, body, x, y, z):
    """Return the world point (x, y, z) in the body's frame."""
    if body == 0:
        return x, y, z
    p, r = d.xpos + 24 * body, d.xmat + 72 * body
    x, y, z = x - w.at(p, 0), y - w.at(p, 1), z - w.at(p, 2)
    return (
        w.at(r, 0) * x + w.at(r, 3) * y + w.at(r, 6) * z,
        w.at(r, 1) * x + w.at(r, 4) * y + w.at(r, 7) * z,
        w.at(r, 2) * x + w.at(r, 5) * y + w.at(r, 8) * z,
    )


@compiled_inline
def turned(d, body, x, y, z):
    """Return the vector (x, y, z) of the body's frame in world axes."""
    if body == 0:
        return x, y, z
    r = d.xmat + 72 * body
    return (
        w.at(r, 0) * x + w.at(r, 1) * y + w.at(r, 2) * z,
        w.at(r, 3) * x + w.at(r, 4) * y + w.at(r, 5) * z,
        w.at(r, 6) * x + w.at(r, 7) * y + w.at(r, 8) * z,
    )


@compiled_inline
def to_world(d, body, point):
    """Return the world position of a point given in the body's frame."""
    x, y, z = turned(d, body, point[0], point[1], point[2])
    if body == 0:
        return x, y, z
    p = d.xpos + 24 * body
    return x + w.at(p, 0), y + w.at(p, 1), z + w.at(p, 2)


@compiled_inline
def dot(vector, x, y, z):
    """Return the scalar product of a vector with (x, y, z)."""
    return vector[0] * x + vector[1] * y + vector[2] * z


@compiled_inline
def put(vector, x, y, z):
    """Write a vector."""
    vector[0] = x
    vector[1] = y
    vector[2] = z


@compiled_inline
def surface_velocity(contact, sign):
    """Return the velocity [m/s] of the counter-surface's belt relative to the body's, in world axes."""
    f, v = contact.frame, contact.surfacevel
    s1, s2 = sign * v[0], sign * v[1]
    return s1 * f[3] + s2 * f[6], s1 * f[4] + s2 * f[7], s1 * f[5] + s2 * f[8]


@compiled_inline
def relative_velocity(m, d, contact, body, surface, sx, sy, sz):
    """Return the velocity [m/s] of the counter-surface relative to the body at the contact point, in world axes.

    (sx, sy, sz) is `surface_velocity`.
    """
    p = contact.pos
    bx, by, bz = velocity(m, d, body, p[0], p[1], p[2])
    cx, cy, cz = velocity(m, d, surface, p[0], p[1], p[2])
    return cx - bx + sx, cy - by + sy, cz - bz + sz


@compiled
def add_forces(m, d, body, surface, point, axis, force, target):
    """Add the generalised force of a force [N] along an axis on the body at a point, and of its opposite on the surface."""
    add_force(m, d, body, point, force * axis[0], force * axis[1], force * axis[2], target)
    add_force(m, d, surface, point, -force * axis[0], -force * axis[1], -force * axis[2], target)


@compiled_inline
def add_force(m, d, body, point, x, y, z, target):
    """Add the generalised force of a force on a body at a point to the vector at ``target``, as ``mj_applyFT`` does."""
    while body > 0 and w.int_at(m.body_dofnum, body) == 0:
        body = w.int_at(m.body_parentid, body)
    if body == 0:
        return
    com = d.subtree_com + 24 * w.int_at(m.body_rootid, body)
    rx, ry, rz = point[0] - w.at(com, 0), point[1] - w.at(com, 1), point[2] - w.at(com, 2)
    tx, ty, tz = ry * z - rz * y, rz * x - rx * z, rx * y - ry * x
    dof = w.int_at(m.body_dofadr, body) + w.int_at(m.body_dofnum, body) - 1
    while dof >= 0:
        c = d.cdof + 48 * dof
        turning = w.at(c, 0) * tx + w.at(c, 1) * ty + w.at(c, 2) * tz
        w.put(target, dof, w.at(target, dof) + turning + w.at(c, 3) * x + w.at(c, 4) * y + w.at(c, 5) * z)
        dof = w.int_at(m.dof_parentid, dof)


@compiled_inline
def set_axes(d, contact, slot, old, known, body, surface, step):
    """Write the tangent frame: the old one carried along with the contact, or a new one along the surface velocity."""
    f = contact.frame
    nx, ny, nz = f[0], f[1], f[2]
    turn = 0.0
    if known:
        e = old.axis_1
        x, y, z = e[0], e[1], e[2]
        turn = 0.5 * step * (spin(d, body, nx, ny, nz) + spin(d, surface, nx, ny, nz))
        x, y, z = x + turn * (ny * z - nz * y), y + turn * (nz * x - nx * z), z + turn * (nx * y - ny * x)
    else:
        x, y, z = surface_velocity(contact, 1.0)
        if x * x + y * y + z * z == 0.0:
            x, y, z = (1.0, 0.0, 0.0) if abs(nx) < 0.9 else (0.0, 1.0, 0.0)
        elif x + y + z < 0.0:
            x, y, z = -x, -y, -z
    along = x * nx + y * ny + z * nz
    if not known or turn != 0.0 or abs(along) > 1.0e-15:  # else it has not moved, to rounding
        x, y, z = x - along * nx, y - along * ny, z - along * nz
        size = math.sqrt(x * x + y * y + z * z)
        if not size > 0.0:
            x, y, z, size = f[3], f[4], f[5], 1.0
        x, y, z = x / size, y / size, z / size
    put(slot.axis_1, x, y, z)
    put(slot.axis_2, ny * z - nz * y, nz * x - nx * z, nx * y - ny * x)


@compiled
def displacement(d, slot, body, surface, t, vx, vy):
    """Return the displacement [m] since the slot's time: of the two bodies' contact points, plus surface velocity.

    Where that is far from what the velocities allow, a body was put elsewhere or contacts changed places; then the
    mean velocity counts.
    """
    bx, by, bz = to_world(d, body, slot.on_body)
    cx, cy, cz = to_world(d, surface, slot.on_surface)
    step = t - slot.since
    dx = dot(slot.axis_1, cx - bx, cy - by, cz - bz) + step * slot.sx
    dy = dot(slot.axis_2, cx - bx, cy - by, cz - bz) + step * slot.sy
    wx, wy = slot.vx, slot.vy
    mx, my = 0.5 * step * (vx + wx), 0.5 * step * (vy + wy)
    far = (dx - mx) * (dx - mx) + (dy - my) * (dy - my)
    if far > NEAR * NEAR:
        allowed = JUMP * step * (length(vx, vy) + length(wx, wy)) + NEAR
        if not far <= allowed * allowed:
            return mx, my
    return dx, dy
