"""A joint or a tendon as one generalised coordinate: its position, its rate, the forces along it, its friction row."""

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco.memory import engine
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.structs import RUNGE_KUTTA
from stochfric_mb.numerics import memory as w

FRICTION_OF_JOINT, FRICTION_OF_TENDON = 1, 2
"""mjtConstraint."""
SLIDE = 2
"""mjtJoint."""


@compiled
def is_tendon(header):
    """Return whether an instance is friction of a tendon."""
    return header.place == s.TENDON


@compiled
def add_row(m, d, header, factor, target):
    """Add ``factor`` times the row of the coordinate's rate per generalised velocity to the vector at ``target``."""
    number = int(header.geom_surface)
    if not is_tendon(header):
        dof = w.int_at(m.jnt_dofadr, number)
        w.put(target, dof, w.at(target, dof) + factor)
        return
    first = w.int_at(m.ten_J_rowadr, number)
    for j in range(first, first + w.int_at(m.ten_J_rownnz, number)):
        dof = w.int_at(m.ten_J_colind, j)
        w.put(target, dof, w.at(target, dof) + factor * w.at(d.ten_J, j))


@compiled
def along_row(m, d, header, vector):
    """Return the product of the coordinate's row with the vector at ``vector``: its rate, for qvel."""
    number = int(header.geom_surface)
    if not is_tendon(header):
        return w.at(vector, w.int_at(m.jnt_dofadr, number))
    first, total = w.int_at(m.ten_J_rowadr, number), 0.0
    for j in range(first, first + w.int_at(m.ten_J_rownnz, number)):
        total += w.at(d.ten_J, j) * w.at(vector, w.int_at(m.ten_J_colind, j))
    return total


@compiled
def position_of(m, d, header):
    """Return the coordinate's position [rad or m]: a joint's, or a tendon's length."""
    number = int(header.geom_surface)
    if is_tendon(header):
        return w.at(d.ten_length, number)
    return w.at(d.qpos, w.int_at(m.jnt_qposadr, number))


@compiled
def friction_row(m, d, header):
    """Return the coordinate's friction row of MuJoCo's constraints, -1 if there is none (asleep, or frictionloss 0)."""
    number, tendon = int(header.geom_surface), is_tendon(header)
    kind = FRICTION_OF_TENDON if tendon else FRICTION_OF_JOINT
    place = number if tendon else w.int_at(m.jnt_dofadr, number)
    # they stand in the order of the coordinates, tendons last, so a joint's row is no further on than its place
    last = d.nf - 1 if tendon else min(place, d.nf - 1)
    for i in range(d.ne + last, d.ne - 1, -1):
        if w.int_at(d.efc_type, i) == kind and w.int_at(d.efc_id, i) == place:
            return i
    return -1


@compiled
def mobility(m, d, header):
    """Return the mobility [1/kg or 1/(kg m^2)] of the coordinate, J M^-1 J' of its row.

    With MuJoCo's M = L' D L that is the square of D^(-1/2) L'^-1 J', whose entries are those of the row and of what bears it.
    """
    part, total = s.room_in(header) if m.nv <= 4 * s.MAX_ROW else np.empty(m.nv), 0.0
    part[: m.nv] = 0.0
    add_row(m, d, header, 1.0, part.ctypes.data)
    for i in range(m.nv - 1, -1, -1):
        if part[i] != 0.0:
            first = w.int_at(m.M_rowadr, i)
            for k in range(first, first + w.int_at(m.M_rownnz, i) - 1):
                part[w.int_at(m.M_colind, k)] -= w.at(d.qLD, k) * part[i]
            total += part[i] * part[i] * w.at(d.qLDiagInv, i)
    return total


@compiled
def set_limit(d, row, limit):
    """Give a friction row its largest force [N or N m], wherever the solver looks for it."""
    w.put(d.efc_frictionloss, row, limit)
    if d.nisland > 0:
        w.put(d.iefc_frictionloss, w.int_at(d.map_efc2iefc, row), limit)


@compiled
def bearing_load(model, data, m, d, header):
    """Return the load [N, hinge N m] that the joint's own reaction makes in the last solution, times the bearing's radius.

    The reaction is the force between the joint's two bodies; along a slide joint's axis it is no load.
    """
    if not d.flg_rnepost or m.integrator == RUNGE_KUTTA:  # it is of the first stage there, where a sensor has asked for it
        engine.mj_rnePostConstraint(model, data)
    number = int(header.geom_surface)
    f, e = d.cfrc_int + 48 * w.int_at(m.jnt_bodyid, number) + 24, d.xaxis + 24 * number
    x, y, z = w.at(f, 0), w.at(f, 1), w.at(f, 2)
    if w.int_at(m.jnt_type, number) == SLIDE:
        along = x * w.at(e, 0) + y * w.at(e, 1) + z * w.at(e, 2)
        x, y, z = x - along * w.at(e, 0), y - along * w.at(e, 1), z - along * w.at(e, 2)
    return header.radius * math.sqrt(x * x + y * y + z * z)


@compiled
def resting_load(m, header):
    """Return the load [N, hinge N m] of the weight that the joint carries, before the first solution."""
    body = w.int_at(m.jnt_bodyid, int(header.geom_surface))
    g = m.gravity
    return header.radius * w.at(m.body_subtreemass, body) * math.sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2])
