"""Faces: the stuck contacts that two bodies have on one plane hold as one spring, however many of them MuJoCo finds.

Where edges of two faces lie on each other, rounding decides whether MuJoCo finds four contacts, six or eight, and where. Two
things follow. Nothing that a face remembers may hang on one of them: its contacts share its stiffness by their normal forces,
and their deflections are those of one rigid displacement, which contacts that come up have from the start. And contacts between
the corners bear nothing, as statics allows: each would make the face stiffer, so that the normal force shakes by some percent
whenever one comes or goes.
"""

from __future__ import annotations

import math

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.laws.plane import length
from stochfric_mb.mujoco.contact.kinematics import dot, put, side
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.structs import contact_at
from stochfric_mb.numerics import memory as w

FLAT = 1.0 - 1.0e-6
"""Cosine between normals above which two contacts are of one face: they differ by less than 1.4 mrad."""
FEW, MANY = 4, 8
"""Numbers of contacts between which a face is looked at: fewer are corners, more are no face of two convex geoms."""
STRAIGHT = 1.0e-4
"""Distance from a line between two contacts, over their distance, below which a contact between them lies on it: the load at
which a body tips then differs by no more than that."""
CLOSE = 1.0e-4
"""Squares of distances that are so small a part of others are those of one place."""
FAR = 1.0e3
"""Position of a normal row [m] at which it bears nothing."""
CORNERS = 4
"""Most contacts as which a face counts: as stiff as so many are, of MuJoCo's own R, it stays with more of them."""
LEFT, TAKEN = -1.0, -2.0
"""Values of ``continues`` of a slot that has not found another one, and of a committed slot that one continues."""
NO_FACE = -1.0
"""Value of a slot's ``face`` before its face is known."""
WIDE = 2.0
"""Radii of gyration of a face's load, from its centre, beyond which its turn says nothing of a contact: of one that comes up
there, or bears so little that the turn is a quotient of rounding errors."""


@compiled_inline
def rest_on_corners(d, body, surface):
    """Take the load from contacts of a friction's pairs that lie between others of the same face."""
    first = 0
    while first < d.ncon:
        contact = contact_at(d, first)
        a, b, last = contact.geom[0], contact.geom[1], first + 1
        while last < d.ncon and contact_at(d, last).geom[0] == a and contact_at(d, last).geom[1] == b:
            last += 1
        if FEW < last - first <= MANY and side(contact, body, surface) != 0:
            for i in range(first, last):
                if is_between(d, i, first, last):
                    contact = contact_at(d, i)
                    contact.exclude = 1
                    w.put(d.efc_pos, contact.efc_address, FAR)
        first = last


@compiled
def is_between(d, i, first, last):
    """Return whether contact ``i`` lies on the line between two others from ``first`` to ``last`` that bear something."""
    contact = contact_at(d, i)
    if contact.exclude != 0 or contact.efc_address < 0:  # the latter where rows found no room in MuJoCo's arena
        return False
    p = contact.pos
    for j in range(first, last):
        for k in range(first, j):
            u, v = contact_at(d, j), contact_at(d, k)
            if i in (j, k) or u.exclude != 0 or v.exclude != 0:
                continue
            ax, ay, az = u.pos[0] - p[0], u.pos[1] - p[1], u.pos[2] - p[2]
            bx, by, bz = v.pos[0] - p[0], v.pos[1] - p[1], v.pos[2] - p[2]
            if ax * bx + ay * by + az * bz > 0.0:
                continue
            x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
            if x * x + y * y + z * z <= (STRAIGHT * squared_distance(u.pos, v.pos)) ** 2:
                return True
    return False


@compiled
def match(d, state, known, with_rows):
    """Let the current contacts continue committed slots of the same geoms; a current slot notes which, -1 for none.

    A contact and a slot belong together that are each other's nearest of those left over: so it depends on where contacts
    are alone, not on their order, which MuJoCo changes. ``with_rows`` leaves out contacts without rows.
    """
    header, count = s.header_record(state), 0
    for j in range(known):
        s.slot_at(state, 0, j).continues = LEFT
    for i in range(d.ncon):
        contact = contact_at(d, i)
        if side(contact, int(header.geom_body), int(header.geom_surface)) != 0 and (contact.efc_address >= 0 or not with_rows):
            s.require_room(header, count)
            slot, p = s.slot_at(state, 1, count), contact.pos
            slot.geom_1, slot.geom_2, slot.continues = contact.geom[0] + 1.0, contact.geom[1] + 1.0, LEFT
            put(slot.place, p[0], p[1], p[2])
            count += 1
    for k in range(min(count, known)):  # mostly contacts keep their order, and hardly move beside their distance
        slot, old = s.slot_at(state, 1, k), s.slot_at(state, 0, k)
        apart = squared_distance(slot.place, s.slot_at(state, 0, (k + 1) % known).place)
        if is_of_geoms(slot, old) and squared_distance(slot.place, old.place) < CLOSE * apart:
            slot.continues, old.continues = k, TAKEN
    changed = known > 0
    while changed:
        changed = False
        for k in range(count):
            if s.slot_at(state, 1, k).continues == LEFT:
                j = nearest(state, 1, k, known)
                if j >= 0 and nearest(state, 0, j, count) == k:
                    s.slot_at(state, 1, k).continues, s.slot_at(state, 0, j).continues = j, TAKEN
                    changed = True


@compiled
def nearest(state, block, k, count):
    """Return which of the first ``count`` slots of the other block that are left over is nearest to slot ``k``, -1 for none."""
    slot = s.slot_at(state, block, k)
    number, least = -1, math.inf
    for j in range(count):
        other = s.slot_at(state, 1 - block, j)
        if other.continues == LEFT and is_of_geoms(slot, other):
            distance = squared_distance(slot.place, other.place)
            if distance < least:
                number, least = j, distance
    return number


@compiled_inline
def is_of_geoms(slot, other):
    """Return whether two slots are of contacts between the same two geoms."""
    return slot.geom_1 == other.geom_1 and slot.geom_2 == other.geom_2


@compiled_inline
def squared_distance(a, b):
    """Return the square of the distance between two points [m^2]."""
    x, y, z = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return x * x + y * y + z * z


@compiled_inline
def share_out(state, count):
    """Let the current contacts of each face share its stiffness and its deflection."""
    for k in range(count):
        slot = s.slot_at(state, 1, k)
        slot.face, slot.weight = NO_FACE, 1.0
    for k in range(count):
        if s.slot_at(state, 1, k).face == NO_FACE:
            share_face(state, k, count)


@compiled
def share_face(state, first, count):
    """Share among the contacts of the face that contact ``first`` belongs to.

    Contacts that came up have the mean normal force of the others. A weight is that force over the mean of the face.
    """
    top = s.slot_at(state, 1, first)
    total, resistance, members, new, stuck = 0.0, 0.0, 0, 0, False
    for j in range(first, count):
        slot = s.slot_at(state, 1, j)
        if is_of_face(slot, top):
            slot.face = first
            members += 1
            resistance += slot.resistance
            stuck = stuck or slot.slides == 0.0
            total += max(slot.given, 0.0)
            new += slot.given < 0.0
    shared = members > 1 and stuck and total > 0.0
    mean = total / (members - new) if shared else 0.0
    total += mean * new
    if shared:
        make_rigid(state, first, count)
    for j in range(first, count):
        slot = s.slot_at(state, 1, j)
        if slot.face == first:
            slot.given = slot.given if slot.given >= 0.0 else mean
            if shared:
                slot.weight, slot.resistance = min(members, CORNERS) * slot.given / total, resistance / members


@compiled_inline
def make_rigid(state, first, count):
    """Make the deflections of a face's stuck contacts those of a rigid displacement z_0 + theta n x (x - c).

    It is the one that agrees best with the contacts' own, weighed by their normal forces, so that the forces keep their sum.
    """
    top = s.slot_at(state, 1, first)
    e, f, o = top.axis_1, top.axis_2, top.place
    load, ca, cb, za, zb, moment, inertia = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(first, count):
        slot = s.slot_at(state, 1, j)
        if slot.slides == 0.0 and slot.given > 0.0 and slot.face == first:
            g, p, z = slot.given, slot.place, slot.z
            a, b = dot(e, p[0] - o[0], p[1] - o[1], p[2] - o[2]), dot(f, p[0] - o[0], p[1] - o[1], p[2] - o[2])
            u, v = dot(e, z[0], z[1], z[2]), dot(f, z[0], z[1], z[2])
            load, ca, cb, za, zb = load + g, ca + g * a, cb + g * b, za + g * u, zb + g * v
            moment, inertia = moment + g * (a * v - b * u), inertia + g * (a * a + b * b)
    if load == 0.0:
        return
    ca, cb, za, zb = ca / load, cb / load, za / load, zb / load
    own = inertia - load * (ca * ca + cb * cb)
    theta = (moment - load * (ca * zb - cb * za)) / own if own > CLOSE * inertia else 0.0
    radius = WIDE * math.sqrt(max(own, 0.0) / load)
    for j in range(first, count):
        slot = s.slot_at(state, 1, j)
        if slot.slides == 0.0 and slot.face == first:
            p = slot.place
            a, b = dot(e, p[0] - o[0], p[1] - o[1], p[2] - o[2]) - ca, dot(f, p[0] - o[0], p[1] - o[1], p[2] - o[2]) - cb
            far = length(a, b)
            turn = theta * radius / far if far > radius else theta
            u, v = za - turn * b, zb + turn * a
            put(slot.z, u * e[0] + v * f[0], u * e[1] + v * f[1], u * e[2] + v * f[2])


@compiled_inline
def is_of_face(slot, top):
    """Return whether a contact is of the same face as another one, with the same bodies and normal."""
    if slot.bodies != top.bodies:
        return False
    n = slot.normal_axis
    return dot(top.normal_axis, n[0], n[1], n[2]) > FLAT
