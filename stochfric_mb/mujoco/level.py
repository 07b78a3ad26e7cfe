"""The height at which contacts on one face touch: the same for all of them, where their overlaps have one in common.

MuJoCo puts a contact's point halfway between two surfaces that overlap. On one face the points so lie at different
heights where loads differ, and a body that turns a little as its load moves rubs its contacts against each other, by
about 1e-7 m: no motion of the surfaces, yet more than a stiff bristle stands. Anywhere within its overlap the point is
as good. On one height all contacts of a rigid face move as one but for spinning about the normal.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import math

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco.kinematics import bodies_of, contact_address, dot, side

PARALLEL = 1.0 - 1.0e-12
"""Cosine from which two normals are those of one face."""


@compiled_inline
def on_face(model, data, i, j, body, surface):
    """Return whether contacts ``i`` and ``j`` join the same two bodies along the same normal."""
    if i == j:
        return True
    a, b = contact_address(data, i), contact_address(data, j)
    sign, other = side(a, body, surface), side(b, body, surface)
    f = n.field(b, n.C_FRAME)
    if other == 0 or dot(n.field(a, n.C_FRAME), n.load(f), n.load(f + 8), n.load(f + 16)) < PARALLEL:
        return False
    return bodies_of(model, a, sign) == bodies_of(model, b, other)


@compiled
def common_overlap(model, data, i, body, surface):
    """Return the lowest and the highest height [m], along the normal of contact ``i``, in the overlaps of all on its face.

    The lowest is above the highest where they have none in common, and where the contact is the only one.
    """
    contact = contact_address(data, i)
    frame = n.field(contact, n.C_FRAME)
    low, high, among = -math.inf, math.inf, 0
    for j in range(n.int_field(data, n.D_NCON)):
        if on_face(model, data, i, j, body, surface):
            other = contact_address(data, j)
            p = n.field(other, n.C_POS)
            height = dot(frame, n.load(p), n.load(p + 8), n.load(p + 16))
            half = 0.5 * abs(n.number_field(other, n.C_DISTANCE))
            low, high, among = max(low, height - half), min(high, height + half), among + 1
    return (low, high) if among > 1 else (math.inf, -math.inf)


@compiled_inline
def lift(contact, low, high):
    """Return how far [m], along the contact's normal, its point lies below the middle of the common overlap."""
    if low > high:
        return 0.0
    p = n.field(contact, n.C_POS)
    return 0.5 * (low + high) - dot(n.field(contact, n.C_FRAME), n.load(p), n.load(p + 8), n.load(p + 16))
