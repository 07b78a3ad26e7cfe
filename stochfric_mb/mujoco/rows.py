"""The contacts of a step: rows of the generalised coordinates, displacements, velocities and coefficients."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.answer import MU, RESTS, SURFACE, U0, V0
from stochfric_mb.mujoco.kinematics import add_rows, bodies_of, contact_address, displacement, point_of
from stochfric_mb.mujoco.switching import coefficients


@compiled
def prepare(model, data, places, tangent, normal, numbers, f, work, starting, t, end, h, qvel):
    """Fill the contacts' columns and their numbers at this instant; the first guess of F is that of the step before.

    ``work`` has room for two rows of generalised coordinates.
    """
    nv = len(qvel)
    for q in range(len(places)):
        contact, sign, address, state = contact_address(data, places[q, 0]), places[q, 1], places[q, 2], places[q, 3]
        body, surface = bodies_of(model, contact, sign)
        for j in range(2 * nv):
            work[j] = 0.0
        x, y, z = point_of(contact, address)
        add_rows(model, data, address, body, 1.0, x, y, z, nv, work.ctypes.data)
        add_rows(model, data, address, surface, -1.0, x, y, z, nv, work.ctypes.data)
        for j in range(nv):
            tangent[j, 2 * q], tangent[j, 2 * q + 1] = work[j], work[nv + j]
        efc_row(model, data, n.int_field(contact, n.C_EFC), normal, q)
        row = numbers[q]
        row[U0], row[U0 + 1] = n.load(address + 8 * s.UX), n.load(address + 8 * s.UY)
        row[SURFACE], row[SURFACE + 1] = n.load(address + 8 * s.SX), n.load(address + 8 * s.SY)
        vx, vy = row[SURFACE], row[SURFACE + 1]
        for j in range(nv):
            vx -= work[j] * qvel[j]
            vy -= work[nv + j] * qvel[j]
        row[V0], row[V0 + 1] = vx, vy
        if starting:
            f[q, 0], f[q, 1] = n.load(address + 8 * s.WORK), n.load(address + 8 * (s.WORK + 1))
        else:
            dx, dy = displacement(data, address, body, surface, t, vx, vy)
            row[U0] += dx
            row[U0 + 1] += dy
            f[q, 0], f[q, 1] = n.load(address + 8 * s.FX), n.load(address + 8 * s.FY)
        mu_s, mu_k = coefficients(state, end, row[U0] + h * vx, n.load(address + 8 * s.EVENTS))
        row[MU], row[MU + 1], row[RESTS] = mu_s, mu_k, 0.0


@compiled
def efc_row(model, data, row, target, q):
    """Write a row of the constraint Jacobian as the dense column ``q``."""
    nv = len(target)
    jacobian = n.pointer_field(data, n.D_EFC_J)
    if n.mj_isSparse(model) == 0:
        for j in range(nv):
            target[j, q] = n.load(jacobian + 8 * (nv * row + j))
        return
    for j in range(nv):
        target[j, q] = 0.0
    first = n.load_int(n.pointer_field(data, n.D_EFC_ADDRESS) + 4 * row)
    columns = n.pointer_field(data, n.D_EFC_COLUMN)
    for k in range(first, first + n.load_int(n.pointer_field(data, n.D_EFC_NNZ) + 4 * row)):
        target[n.load_int(columns + 4 * k), q] = n.load(jacobian + 8 * k)
