"""How accelerations, velocities at the step's end and normal forces answer to friction, while the constraints stay.

Friction forces stand in columns: two for each contact, its tangents.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco.answer import NORMAL, SURFACE, VX, VY
from stochfric_mb.mujoco.kinematics import contact_address
from stochfric_mb.mujoco.linear import factor, substitute

MAX_DENSE = 200
"""Above so many degrees of freedom the answer of the other constraints comes from repeated solutions alone."""
QUADRATIC, CONE = 1, 4
"""mjtConstraintState of rows that answer linearly."""
FRICTION_DOF, FRICTION_TENDON, ELLIPTIC = 1, 2, 7
"""mjtConstraint of rows with other states than on and off."""
EULER, IMPLICIT, IMPLICITFAST = 0, 2, 3
"""mjtIntegrator."""
EULER_DAMP, DAMPER = 1 << 15, 1 << 6
"""mjtDisableBit."""


@compiled
def damping(model, data, nv):
    """Return whether the integrator damps the joints within the step."""
    integrator, off = n.int_field(model, n.M_INTEGRATOR), n.int_field(model, n.M_DISABLE)
    if integrator not in (EULER, IMPLICIT, IMPLICITFAST) or off & DAMPER or (integrator == EULER and off & EULER_DAMP):
        return False
    coefficients = n.pointer_field(model, n.M_DAMPING)
    largest = 0.0
    for j in range(0, 8 * nv, 8):
        largest = max(largest, n.load(coefficients + j))
    return largest > 0.0


@compiled
def responses(model, data, tangent, hessian, mass, answer, motion, damped, h, work):
    """Fill how accelerations (``answer``) and end velocities (``motion``, over h) answer to friction forces.

    H = M + J^T D J answers for the accelerations (MuJoCo's computation chapter, solvers); joint damping B within the step
    makes (1 - (M + h B)^-1 h B) of them the change of the velocity over h. ``mass`` keeps the factors of M + h B.
    """
    nv = len(tangent)
    copy(tangent, answer)
    if nv > MAX_DENSE:
        solve_mass(model, data, answer, work)
        copy(answer, motion)
        return
    n.mj_fullM(model, data, hessian.ctypes.data)
    if damped:
        copy(hessian, mass)
        coefficients = n.pointer_field(model, n.M_DAMPING)
        for j in range(nv):
            mass[j, j] += h * n.load(coefficients + 8 * j)
        factor(mass)
    add_active(model, data, hessian)
    factor(hessian)
    substitute(hessian, answer)
    damp(model, mass, answer, motion, damped, h)


@compiled
def copy(source, target):
    """Copy a matrix."""
    rows, columns = source.shape
    for i in range(rows):
        for j in range(columns):
            target[i, j] = source[i, j]


@compiled
def solve_mass(model, data, x, work):
    """Replace the columns of ``x`` by the solutions of M y = x; ``work`` has room for two of them."""
    nv, width = x.shape
    for i in range(width):
        for j in range(nv):
            work[j] = x[j, i]
        n.mj_solveM(model, data, work[nv:].ctypes.data, work.ctypes.data, np.int32(1))
        for j in range(nv):
            x[j, i] = work[nv + j]


@compiled
def damp(model, mass, accelerations, changes, damped, h):
    """Fill the changes of velocity over h that the accelerations make, with the joints' damping within the step."""
    nv, width = accelerations.shape
    if not damped:
        copy(accelerations, changes)
        return
    coefficients = n.pointer_field(model, n.M_DAMPING)
    for j in range(nv):
        b = h * n.load(coefficients + 8 * j)
        for i in range(width):
            changes[j, i] = b * accelerations[j, i]
    substitute(mass, changes)
    for j in range(nv):
        for i in range(width):
            changes[j, i] = accelerations[j, i] - changes[j, i]


@compiled
def add_active(model, data, hessian):
    """Add J^T D J of the active constraints to the lower triangle."""
    nv = len(hessian)
    states, stiffness = n.pointer_field(data, n.D_EFC_STATE), n.pointer_field(data, n.D_EFC_D)
    jacobian = n.pointer_field(data, n.D_EFC_J)
    sparse = n.mj_isSparse(model) != 0
    for i in range(n.int_field(data, n.D_NEFC)):
        state = n.load_int(states + 4 * i)
        if state not in (QUADRATIC, CONE):
            continue
        d = n.load(stiffness + 8 * i)
        if sparse:
            first = n.load_int(n.pointer_field(data, n.D_EFC_ADDRESS) + 4 * i)
            last = first + n.load_int(n.pointer_field(data, n.D_EFC_NNZ) + 4 * i)
            columns = n.pointer_field(data, n.D_EFC_COLUMN)
            for k in range(first, last):
                scaled = d * n.load(jacobian + 8 * k)
                row = hessian[n.load_int(columns + 4 * k)]
                for j in range(first, last):
                    row[n.load_int(columns + 4 * j)] += scaled * n.load(jacobian + 8 * j)
        else:
            line = n.vector(jacobian + 8 * nv * i, nv)
            for k in range(nv):
                scaled = d * line[k]
                if scaled != 0.0:
                    row = hessian[k]
                    for j in range(k + 1):
                        row[j] += scaled * line[j]


@compiled
def couple(data, places, tangent, normal, answer, motion, coupling, response, h):
    """Fill by how much relative velocities [m/s] and normal forces [N] fall (three rows a contact) for each newton.

    ``response`` gets the velocity's part for the contact's own force, over h.
    """
    nv, width = tangent.shape
    for q in range(len(places)):
        efc = n.int_field(contact_address(data, places[q, 0]), n.C_EFC)
        active = n.load_int(n.pointer_field(data, n.D_EFC_STATE) + 4 * efc) == QUADRATIC and nv <= MAX_DENSE
        d = n.load(n.pointer_field(data, n.D_EFC_D) + 8 * efc) if active else 0.0
        x, y, z = coupling[3 * q], coupling[3 * q + 1], coupling[3 * q + 2]
        for i in range(width):
            x[i], y[i], z[i] = 0.0, 0.0, 0.0
        for j in range(nv):
            a, b, c = h * tangent[j, 2 * q], h * tangent[j, 2 * q + 1], d * normal[j, q]
            if a != 0.0 or b != 0.0 or c != 0.0:
                moved, accelerated = motion[j], answer[j]
                for i in range(width):
                    x[i] += a * moved[i]
                    y[i] += b * moved[i]
                    z[i] += c * accelerated[i]
        response[q, 0], response[q, 1] = x[2 * q] / h, x[2 * q + 1] / h
        response[q, 2], response[q, 3] = y[2 * q] / h, y[2 * q + 1] / h


@compiled
def contact_motions(model, data, places, tangent, normal, numbers, mass, qvel, qacc, change, at, damped, h):
    """Fill the contacts' relative velocities [m/s] at the step's end and normal forces [N], from MuJoCo's solution.

    The velocities at the step's end are as the integrator will make them; ``change`` is to work in.
    """
    nv = len(qvel)
    damp(model, mass, qacc.reshape(nv, 1), change.reshape(nv, 1), damped and nv <= MAX_DENSE, h)
    for q in range(len(places)):
        vx, vy, acceleration = numbers[q, SURFACE], numbers[q, SURFACE + 1], 0.0
        for j in range(nv):
            u = qvel[j] + h * change[j]
            vx -= tangent[j, 2 * q] * u
            vy -= tangent[j, 2 * q + 1] * u
            acceleration += normal[j, q] * qacc[j]
        efc = n.int_field(contact_address(data, places[q, 0]), n.C_EFC)
        d, wanted = n.load(n.pointer_field(data, n.D_EFC_D) + 8 * efc), n.load(n.pointer_field(data, n.D_EFC_AREF) + 8 * efc)
        at[q, VX], at[q, VY], at[q, NORMAL] = vx, vy, max(d * (wanted - acceleration), 0.0)


@compiled
def states_changed(data, states):
    """Copy the constraints' states; return whether any is another than before."""
    changed = False
    source = n.pointer_field(data, n.D_EFC_STATE)
    for i in range(len(states)):
        now = n.load_int(source + 4 * i)
        changed = changed or states[i] != now
        states[i] = now
    return changed


@compiled
def consistent(model, data, states, change, qacc, space):
    """Return whether the answer leaves all constraints in the states that it was found with; ``space`` is to work in."""
    nv = len(qacc)
    largest, scale = 0.0, 0.0
    for j in range(nv):
        largest = max(largest, abs(change[j]))
        scale = max(scale, abs(qacc[j]))
    if largest <= 1.0e-12 * (1.0 + scale):
        return True
    if nv > MAX_DENSE:
        return False
    rows = len(states)
    a, b = space[:rows], space[rows : 2 * rows]
    n.mj_mulJacVec(model, data, a.ctypes.data, qacc.ctypes.data)
    n.mj_mulJacVec(model, data, b.ctypes.data, change.ctypes.data)
    kinds, target = n.pointer_field(data, n.D_EFC_TYPE), n.pointer_field(data, n.D_EFC_AREF)
    for i in range(rows):
        kind = n.load_int(kinds + 4 * i)
        if kind == 0 or b[i] == 0.0:
            continue
        gap = a[i] - n.load(target + 8 * i)
        if kind in (FRICTION_DOF, FRICTION_TENDON, ELLIPTIC):
            if abs(b[i]) > 1.0e-9 * (1.0 + abs(gap)):
                return False
        elif (gap + b[i] < 0.0) != (states[i] == QUADRATIC) and abs(gap + b[i]) > 1.0e-9 * (1.0 + abs(gap)):
            return False
    return True


@compiled
def add_passive(tangent, f, passive):
    """Add the generalised forces of the contacts' friction."""
    for q in range(len(f)):
        x, y = f[q, 0], f[q, 1]
        for j in range(len(passive)):
            passive[j] += tangent[j, 2 * q] * x + tangent[j, 2 * q + 1] * y
