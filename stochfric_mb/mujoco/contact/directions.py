"""Friction that differs by direction: the contact's tangents turned to it, and lengths in which all directions are alike.

With e the tangent across the direction, r the coefficients' ratio, and s = r^2 - 1, the law sees of a velocity or deflection v
the length sqrt(v^2 + s (v e)^2), and of a force F the length sqrt(F^2 + (1/r^2 - 1) (F e)^2), see `Anisotropy`.
"""

from __future__ import annotations

import math

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.mujoco.contact.kinematics import dot, put, turned
from stochfric_mb.mujoco.contact.rows import is_sparse
from stochfric_mb.mujoco.memory import engine
from stochfric_mb.mujoco.memory.structs import PGS
from stochfric_mb.numerics import memory as w

ALONG_NORMAL = 1.0e-6
"""Part of the direction in the tangent plane below which it has none, and friction is the same in all directions."""

DUAL = "stochfric_mb: friction that differs by direction needs the Newton or CG solver, without noslip iterations"


@compiled_inline
def product(stretch, e, a, b):
    """Return the scalar product of two vectors, stretched by 1 + ``stretch`` along e."""
    return dot(a, b[0], b[1], b[2]) + stretch * dot(a, e[0], e[1], e[2]) * dot(b, e[0], e[1], e[2])


@compiled_inline
def size(stretch, e, a):
    """Return the length of a vector, stretched by sqrt(1 + ``stretch``) along e."""
    return math.sqrt(max(product(stretch, e, a, a), 0.0))


@compiled_inline
def stretch_of(header):
    """Return r^2 - 1, for velocities and deflections."""
    return header.across * header.across - 1.0


@compiled_inline
def force_stretch_of(header):
    """Return 1/r^2 - 1, for forces."""
    return 1.0 / (header.across * header.across) - 1.0


@compiled
def turn(m, d, header, slot, contact, body):
    """Turn a contact's tangents, and its rows, so that the first lies along the direction; note the second in the slot."""
    put(slot.side, 0.0, 0.0, 0.0)
    slot.across = 1.0
    # these make the rows' matrix before the passive stage
    if m.solver == PGS or m.noslip_iterations > 0:
        engine.mju_error(w.c_string(DUAL))
    f, e = contact.frame, header.direction
    x, y, z = turned(d, body, e[0], e[1], e[2])
    c, b = x * f[3] + y * f[4] + z * f[5], x * f[6] + y * f[7] + z * f[8]
    part = math.sqrt(c * c + b * b)
    if not part > ALONG_NORMAL * math.sqrt(dot(e, e[0], e[1], e[2])):
        return
    c, b = c / part, b / part
    for j in range(3):
        f[3 + j], f[6 + j] = c * f[3 + j] + b * f[6 + j], c * f[6 + j] - b * f[3 + j]
    v = contact.surfacevel
    v[0], v[1] = c * v[0] + b * v[1], c * v[1] - b * v[0]
    turn_rows(m, d, contact.efc_address + 1, c, b)
    if contact.dim == 6:
        turn_rows(m, d, contact.efc_address + 4, c, b)
    put(slot.side, f[6], f[7], f[8])
    slot.across = header.across


@compiled
def turn_rows(m, d, row, c, b):
    """Turn two successive rows of the constraint Jacobian, which have the same columns."""
    first, second, count = row * m.nv, (row + 1) * m.nv, m.nv
    if is_sparse(m):
        first, second, count = w.int_at(d.efc_J_rowadr, row), w.int_at(d.efc_J_rowadr, row + 1), w.int_at(d.efc_J_rownnz, row)
    for k in range(count):
        x, y = w.at(d.efc_J, first + k), w.at(d.efc_J, second + k)
        w.put(d.efc_J, first + k, c * x + b * y)
        w.put(d.efc_J, second + k, c * y - b * x)
