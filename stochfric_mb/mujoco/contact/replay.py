"""The engine's solution of a step that is over, found again: for `mjcb_passive`, which has no word of a step's end.

By the next step MuJoCo's constraints are gone, but not their solution's acceleration, ``qacc_warmstart``. So each evaluation
keeps the contacts' rows, and the next step finds their forces from them (MuJoCo's computation chapter, elliptic cones).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco.contact import solver
from stochfric_mb.mujoco.contact.kinematics import ordinal_after, side
from stochfric_mb.mujoco.contact.rows import is_sparse, rate_of
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.structs import RUNGE_KUTTA, contact_at, data_at, model_at, record_view
from stochfric_mb.numerics import memory as w

KEPT = np.dtype([
    ("sign", np.float64), ("dim", np.float64), ("mu", np.float64), ("frame", np.float64, (9,)),
    ("friction", np.float64, (5,)), ("mass", np.float64, (6,)), ("aref", np.float64, (6,)), ("jar", np.float64, (6,)),
])  # fmt: skip
"""A contact's rows; its rows of the Jacobian follow, 6 x nv."""
N_KEPT = KEPT.itemsize // 8
_kept_record: Any = record_view(KEPT)


def room(slots: int, nv: int) -> int:
    """Return the room that so many contacts need [doubles]."""
    return slots * (N_KEPT + 6 * nv)


@compiled
def keep(model, data, state, kept):
    """Keep the rows of the pair's contacts, each at the place of its current slot; ``kept`` is the address of the room."""
    m, d, header = model_at(model), data_at(data), s.header_record(state)
    count, size = int(header.n_current), N_KEPT + 6 * m.nv
    for k in range(count):
        _kept_record(kept + 8 * size * k).dim = 0.0
    k, ordinal = 0, 0
    for i in range(d.ncon):
        contact = contact_at(d, i)
        ordinal = ordinal_after(d, i, ordinal)
        sign = side(contact, int(header.geom_body), int(header.geom_surface))
        if sign == 0 or contact.efc_address < 0:
            continue
        number = s.find(state, 1, count, contact.geom[0], contact.geom[1], ordinal, k)
        k += 1
        if number < 0:
            continue
        place = kept + 8 * size * number
        row = _kept_record(place)
        row.sign, row.dim, row.mu = sign, contact.dim, contact.mu
        for j in range(9):
            row.frame[j] = contact.frame[j]
        for j in range(5):
            row.friction[j] = contact.friction[j]
        for j in range(contact.dim):
            e = contact.efc_address + j
            surface = contact.surfacevel[j - 1] if 0 < j < 4 else 0.0
            reference = w.at(d.efc_KBIP, 4 * e) * w.at(d.efc_KBIP, 4 * e + 2) * (w.at(d.efc_pos, e) - w.at(d.efc_margin, e))
            row.aref[j] = -w.at(d.efc_KBIP, 4 * e + 1) * (rate_of(m, d, e, d.qvel) + surface) - reference
            row.mass[j] = w.at(d.efc_D, e)
            keep_jacobian(m, d, e, place + 8 * (N_KEPT + j * m.nv))


@compiled
def keep_jacobian(m, d, row, target):
    """Copy a row of the constraint Jacobian, dense."""
    if not is_sparse(m):
        w.copy_bytes(d.efc_J + 8 * row * m.nv, target, 8 * m.nv)
        return
    for j in range(m.nv):
        w.put(target, j, 0.0)
    first = w.int_at(d.efc_J_rowadr, row)
    for k in range(first, first + w.int_at(d.efc_J_rownnz, row)):
        w.put(target, w.int_at(d.efc_J_colind, k), w.at(d.efc_J, k))


@compiled
def settle(model, data, state, kept):
    """Write the forces of the step that is over to the committed slots, which are the current ones of that step."""
    m, d, header = model_at(model), data_at(data), s.header_record(state)
    size = N_KEPT + 6 * m.nv
    for k in range(int(header.n_committed)):
        place, slot = kept + 8 * size * k, s.slot_at(state, 0, k)
        row = _kept_record(place)
        dim = int(row.dim)
        if dim == 0:
            continue
        for j in range(dim):
            total = -row.aref[j]
            for i in range(m.nv):
                total += w.at(place, N_KEPT + j * m.nv + i) * w.at(d.qacc_warmstart, i)
            row.jar[j] = total
        scale = cone_scale(row, dim)  # of the forces at the cone, 0 at rest on it, negative off it
        p, q = row.aref[1] + row.jar[1], row.aref[2] + row.jar[2]
        normal, a, b, others = 0.0, 0.0, 0.0, 0.0
        if scale == 0.0:
            normal, a, b = -row.mass[0] * row.jar[0], -row.mass[1] * row.jar[1], -row.mass[2] * row.jar[2]
            for j in range(3, dim):
                others += (row.mass[j] * row.jar[j] / row.friction[j - 1]) ** 2
        elif scale > 0.0:
            normal = scale
            size_of = tangent(row, dim)
            a = -scale / size_of * row.jar[1] * row.friction[0] ** 2
            b = -scale / size_of * row.jar[2] * row.friction[1] ** 2
            for j in range(3, dim):
                others += (scale / size_of * row.jar[j] * row.friction[j - 1]) ** 2
        if header.solved != 0.0:
            solver.settle(header, slot, row.frame, row.sign, normal, a, b, others, p, q, True, m.integrator != RUNGE_KUTTA)
        else:
            slot.normal = max(normal, 0.0)


@compiled
def tangent(row, dim):
    """Return T, the length of the tangential part of a contact's violation, each component times its coefficient."""
    total = 0.0
    for j in range(1, dim):
        total += (row.jar[j] * row.friction[j - 1]) ** 2
    return math.sqrt(total)


@compiled
def cone_scale(row, dim):
    """Return the normal force [N] of a contact at the surface of its cone, 0 inside of it, -1 where it does not press."""
    if dim == 1:
        return 0.0 if row.jar[0] < 0.0 else -1.0
    mu, size = row.mu, tangent(row, dim)
    top = row.jar[0] * mu
    if top >= mu * size:
        return -1.0
    if mu * top + size <= 0.0:
        return 0.0
    return -row.mass[0] / (mu * mu * (1.0 + mu * mu)) * (top - mu * size) * mu
