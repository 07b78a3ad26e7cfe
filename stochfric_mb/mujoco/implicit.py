"""The implicit mode: friction, normal forces and the velocities at the step's end solved together, inside the step.

Each contact's force obeys ``F = force(t + h, u + h v, v)`` with the velocity at the step's end, ``v = c - h W F``.
MuJoCo's own solution of the step gives the accelerations, the normal forces and the active constraints at the last
guess of F; while the active constraints stay, all of them answer to a change of F linearly, through
``H = M + J^T D J`` (the matrix of MuJoCo's Newton solver). Gauss-Seidel over the contacts then finds F, and MuJoCo
solves again only if the answer would change a constraint's state. Nothing here knows a law's formula.

A law with modes that would switch within the step gets the state it has after the switch, and F is solved anew.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.coefficients.path import canonical_time
from stochfric_mb.compile import compiled
from stochfric_mb.laws.abi import MAX_STATE
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.contact import (
    add_rows,
    bodies_of,
    call,
    coefficients,
    contact_address,
    displacement,
    guards_at,
    half_step,
    keep_guards,
    point_of,
    put,
    side,
    slot_at_stage,
    switch_within,
    warm_row,
)
from stochfric_mb.mujoco.root import local_force

OUTER, SWEEPS, ROUNDS = 6, 20, 4
"""Most solutions by MuJoCo, sweeps over the contacts, and rounds of mode switches, in one step."""
NEWTON_EVERY, NEWTON_STEPS, HALVINGS = 3, 12, 6
"""Sweeps before Newton's method on all contacts is tried; its most steps, and most halvings of one."""
FORCE_TOLERANCE = 1.0e-10
"""Error of a force relative to mu_s N at which Newton's method ends."""
NEAR = 1.0e-2
"""Error of the guess relative to mu_s N from which Newton's method on all contacts may start."""
MAX_DENSE = 200
"""Above so many degrees of freedom the answer of the other constraints comes from repeated solutions alone."""
TOLERANCE = 1.0e-12
"""Change of the velocities in a sweep, relative to those that friction changes in a step, at which sweeps end."""
TURNED = 1.0e-9
"""How far beyond rest a sliding contact is braked, relative to the velocity taken, so that its law sees it turned."""
QUADRATIC, CONE = 1, 4
"""mjtConstraintState of rows that answer linearly."""
FRICTION_DOF, FRICTION_TENDON, ELLIPTIC = 1, 2, 7
"""mjtConstraint of rows with other states than on and off."""
EULER, IMPLICIT, IMPLICITFAST = 0, 2, 3
"""mjtIntegrator."""
EULER_DAMP, DAMPER = 1 << 15, 1 << 6
"""mjtDisableBit."""
U0, V0, SURFACE, MU, FREE = 0, 2, 4, 6, 8
"""Columns of a contact's numbers: displacement, velocity, surface velocity, coefficients, free velocity."""


@compiled
def is_last(model, instance):
    """Return whether no later plugin instance is of the same plugin."""
    plugins = n.pointer_field(model, n.M_PLUGIN)
    mine = n.load_int(plugins + 4 * instance)
    last = instance
    for i in range(instance + 1, n.int_field(model, n.M_NPLUGIN)):
        if n.load_int(plugins + 4 * i) == mine:
            last = i
    return last == instance


@compiled
def state_of(model, data, instance):
    """Return the address of an instance's state."""
    first = n.load_int(n.pointer_field(model, n.M_STATE_ADDRESS) + 4 * instance)
    return n.pointer_field(data, n.D_PLUGIN_STATE) + 8 * first


@compiled
def keep_warm_start(model, data, state):
    """Keep the acceleration that MuJoCo's solver starts from, so that evaluations between steps change nothing."""
    nv = n.int_field(model, n.M_NV)
    source, target = n.pointer_field(data, n.D_WARMSTART), warm_row(state)
    for j in range(0, 8 * nv, 8):
        n.store(target + j, n.load(source + j))


@compiled
def any_solved(model, data, instance):
    """Return whether an instance of the same plugin, up to this one, is in implicit mode in this step."""
    plugins = n.pointer_field(model, n.M_PLUGIN)
    mine = n.load_int(plugins + 4 * instance)
    for i in range(instance + 1):
        if n.load_int(plugins + 4 * i) == mine and n.load(state_of(model, data, i) + 8 * s.SOLVED) != 0.0:
            return True
    return False


@compiled
def solve_instances(model, data, instance):
    """Solve all instances in implicit mode together and add their forces; ``instance`` is the plugin's last one."""
    plugins = n.pointer_field(model, n.M_PLUGIN)
    mine = n.load_int(plugins + 4 * instance)
    room = 0
    for i in range(instance + 1):
        if n.load_int(plugins + 4 * i) == mine:
            state = state_of(model, data, i)
            if n.load(state + 8 * s.SOLVED) != 0.0:
                room += int(n.load(state + 8 * s.N_SLOTS))
    room = min(room, n.int_field(data, n.D_NCON))
    if room == 0:
        return
    places = np.empty((room, 4), np.int64)
    count = 0
    for i in range(instance + 1):
        if n.load_int(plugins + 4 * i) == mine:
            state = state_of(model, data, i)
            if n.load(state + 8 * s.SOLVED) != 0.0:
                count = gather(model, data, state, places, count)
    if count > 0:
        warm = warm_row(state_of(model, data, instance))
        solve(model, data, places[:count], n.vector(warm, n.int_field(model, n.M_NV)))


@compiled
def gather(model, data, state, places, count):
    """Append the instance's contacts as rows (contact, sign, slot, state); return how many rows there are now."""
    t = canonical_time(n.number_field(data, n.D_TIME), half_step(model))
    body, surface = int(n.load(state + 8 * s.GEOM_BODY)), int(n.load(state + 8 * s.GEOM_SURFACE))
    k = 0
    for i in range(n.int_field(data, n.D_NCON)):
        contact = contact_address(data, i)
        sign = side(contact, body, surface)
        if sign == 0:
            continue
        address = slot_at_stage(model, data, state, i, sign, t, k)
        k += 1
        if address == 0 or count == len(places):
            continue
        if n.int_field(contact, n.C_EFC) < 0:
            n.store(address + 8 * s.FX, 0.0)
            n.store(address + 8 * s.FY, 0.0)
            n.store(address + 8 * s.NORMAL, 0.0)
            continue
        places[count, 0] = i
        places[count, 1] = sign
        places[count, 2] = address
        places[count, 3] = state
        count += 1
    return count


@compiled
def solve(model, data, places, warm):  # noqa: PLR0915
    """Find the friction forces of the contacts in ``places``, add them to the passive forces and to the slots."""
    nv = n.int_field(model, n.M_NV)
    m = len(places)
    h = n.number_field(model, n.M_TIMESTEP)
    now = n.number_field(data, n.D_TIME)
    starting = now == n.load(places[0, 3] + 8 * s.EVALUATED)
    t = canonical_time(now, half_step(model))
    end = canonical_time(now + h, half_step(model))
    qacc, guess = n.vector(n.pointer_field(data, n.D_QACC), nv), n.vector(n.pointer_field(data, n.D_WARMSTART), nv)
    passive, qvel = n.vector(n.pointer_field(data, n.D_QFRC_PASSIVE), nv), n.vector(n.pointer_field(data, n.D_QVEL), nv)
    block = np.empty((3 + 6 * m + 12, nv))
    kept, base, u = block[0], block[1], block[2]
    tangent = block[3 : 3 + 2 * m]
    answer = block[3 + 2 * m : 3 + 4 * m]
    motion = block[3 + 4 * m : 3 + 6 * m]
    change, work = block[3 + 6 * m], block[4 + 6 * m :]
    n.move(qacc, kept)
    n.move(passive, base)
    n.move(warm, guess)
    normal = np.empty((m, nv))
    f, numbers, response, rows = np.empty((m, 2)), np.empty((m, 10)), np.empty((m, 4)), np.empty((m, 3))
    prepare(model, data, places, tangent, normal, numbers, f, work, starting, t, end, h, qvel)
    damped = damping(model, data, nv)
    hessian = np.empty((nv, nv))
    mass = np.empty((nv, nv)) if damped else hessian
    states = np.zeros(n.int_field(data, n.D_NEFC), np.int32)
    started(model, data)
    for outer in range(OUTER):
        n.move(base, passive)
        add_passive(tangent, f, passive)
        n.mj_fwdAcceleration(model, data)
        n.mj_fwdConstraint(model, data)
        n.move(qacc, guess)
        if states_changed(data, states) or outer == 0:
            responses(model, data, tangent, normal, hessian, mass, answer, motion, response, damped, nv, h)
        velocities(model, data, mass, qvel, qacc, u, work, damped, nv, h)
        normal_forces(data, places, normal, qacc, rows, nv)
        if outer == 0 and starting:
            start_guards(places, numbers, rows, t)
        change[:] = 0.0
        settle(places, tangent, answer, motion, normal, numbers, response, rows, f, u, change, end, h, nv)
        if starting:
            for _ in range(ROUNDS):
                if not switch_ahead(places, tangent, numbers, response, rows, u, t, end, h, nv):
                    break
                settle(places, tangent, answer, motion, normal, numbers, response, rows, f, u, change, end, h, nv)
        if consistent(model, data, states, change, qacc, nv):
            break
    n.move(base, passive)
    for j in range(nv):
        guess[j] += change[j]
    n.move(kept, qacc)
    add_passive(tangent, f, passive)
    if starting:
        for q in range(m):
            record(places[q, 2], numbers[q], response[q], f[q, 0], f[q, 1])


@compiled
def started(model, data):
    """Do what MuJoCo's step has yet to do before its solution: reference accelerations, bias and actuator forces."""
    n.mj_referenceConstraint(model, data)
    n.mj_rne(model, data, np.int32(0), n.pointer_field(data, n.D_QFRC_BIAS))
    if n.int_field(model, n.M_NU) > 0:
        n.mj_fwdActuation(model, data)
    dual = n.int_field(model, n.M_SOLVER) == 0 or n.int_field(model, n.M_NOSLIP) > 0
    if dual and n.pointer_field(data, n.D_EFC_AR) == 0:  # MuJoCo's inverse dynamics leave it out
        n.mj_projectConstraint(model, data)


@compiled
def prepare(model, data, places, tangent, normal, numbers, f, work, starting, t, end, h, qvel):
    """Fill the contacts' rows and their numbers at this instant; the first guess of F is that of the step before."""
    nv = len(qvel)
    for q in range(len(places)):
        contact, sign, address, state = contact_address(data, places[q, 0]), places[q, 1], places[q, 2], places[q, 3]
        body, surface = bodies_of(model, contact, sign)
        work[:2] = 0.0
        x, y, z = point_of(contact)
        put(state + 8 * s.POINT, x, y, z)
        add_rows(model, data, state, address, body, 1.0, nv, work.ctypes.data)
        add_rows(model, data, state, address, surface, -1.0, nv, work.ctypes.data)
        n.move(work[0], tangent[2 * q])
        n.move(work[1], tangent[2 * q + 1])
        efc_row(model, data, n.int_field(contact, n.C_EFC), normal[q])
        row = numbers[q]
        row[U0], row[U0 + 1] = n.load(address + 8 * s.UX), n.load(address + 8 * s.UY)
        row[SURFACE], row[SURFACE + 1] = n.load(address + 8 * s.SX), n.load(address + 8 * s.SY)
        vx, vy = row[SURFACE], row[SURFACE + 1]
        for j in range(nv):
            vx -= tangent[2 * q, j] * qvel[j]
            vy -= tangent[2 * q + 1, j] * qvel[j]
        row[V0], row[V0 + 1] = vx, vy
        if starting:
            f[q, 0], f[q, 1] = n.load(address + 8 * s.WORK), n.load(address + 8 * (s.WORK + 1))
        else:
            dx, dy = displacement(data, address, body, surface, t, vx, vy)
            row[U0] += dx
            row[U0 + 1] += dy
            f[q, 0], f[q, 1] = n.load(address + 8 * s.FX), n.load(address + 8 * s.FY)
        mu_s, mu_k = coefficients(state, end, row[U0] + h * vx, n.load(address + 8 * s.EVENTS))
        row[MU], row[MU + 1] = mu_s, mu_k


@compiled
def efc_row(model, data, row, target):
    """Write a row of the constraint Jacobian as a dense vector."""
    nv = len(target)
    jacobian = n.pointer_field(data, n.D_EFC_J)
    if n.mj_isSparse(model) == 0:
        for j in range(nv):
            target[j] = n.load(jacobian + 8 * (nv * row + j))
        return
    target[:] = 0.0
    first = n.load_int(n.pointer_field(data, n.D_EFC_ADDRESS) + 4 * row)
    columns = n.pointer_field(data, n.D_EFC_COLUMN)
    for k in range(first, first + n.load_int(n.pointer_field(data, n.D_EFC_NNZ) + 4 * row)):
        target[n.load_int(columns + 4 * k)] = n.load(jacobian + 8 * k)


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
def responses(model, data, tangent, normal, hessian, mass, answer, motion, response, damped, nv, h):
    """Fill how accelerations (``answer``) and end velocities (``motion``, ``response``) answer to friction forces."""
    if nv <= MAX_DENSE:
        n.mj_fullM(model, data, hessian.ctypes.data)
        if damped:
            n.mj_fullM(model, data, mass.ctypes.data)
            coefficients = n.pointer_field(model, n.M_DAMPING)
            for j in range(nv):
                mass[j, j] += h * n.load(coefficients + 8 * j)
            factor(mass)
        add_active(model, data, hessian, nv)
        factor(hessian)
        for i in range(len(tangent)):
            n.move(tangent[i], answer[i])
            substitute(hessian, answer[i])
    else:
        n.mj_solveM(model, data, answer.ctypes.data, tangent.ctypes.data, np.int32(len(tangent)))
    for i in range(len(tangent)):
        if damped and nv <= MAX_DENSE:
            n.mj_mulM(model, data, motion[i].ctypes.data, answer[i].ctypes.data)
            substitute(mass, motion[i])
        else:
            n.move(answer[i], motion[i])
    for q in range(len(response)):
        for a in range(2):
            for b in range(2):
                total = 0.0
                for j in range(nv):
                    total += tangent[2 * q + a, j] * motion[2 * q + b, j]
                response[q, 2 * a + b] = total


@compiled
def add_active(model, data, hessian, nv):
    """Add J^T D J of the active constraints."""
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
            for k in range(nv):
                scaled = d * n.load(jacobian + 8 * (nv * i + k))
                if scaled != 0.0:
                    for j in range(nv):
                        hessian[k, j] += scaled * n.load(jacobian + 8 * (nv * i + j))


@compiled
def factor(a):
    """Replace a positive definite matrix by its lower Cholesky factor (the upper part is left as it was)."""
    for i in range(len(a)):
        for j in range(i + 1):
            total = a[i, j]
            for k in range(j):
                total -= a[i, k] * a[j, k]
            if i == j:
                a[i, i] = math.sqrt(total) if total > 0.0 else 1.0e-10
            else:
                a[i, j] = total / a[j, j]


@compiled
def substitute(a, x):
    """Replace x by the solution of A y = x, ``a`` from `factor`."""
    size = len(x)
    for i in range(size):
        total = x[i]
        for k in range(i):
            total -= a[i, k] * x[k]
        x[i] = total / a[i, i]
    for i in range(size - 1, -1, -1):
        total = x[i]
        for k in range(i + 1, size):
            total -= a[k, i] * x[k]
        x[i] = total / a[i, i]


@compiled
def velocities(model, data, mass, qvel, qacc, u, work, damped, nv, h):
    """Fill the velocities at the step's end as the integrator will make them from the accelerations."""
    if damped and nv <= MAX_DENSE:
        n.mj_mulM(model, data, work[0].ctypes.data, qacc.ctypes.data)
        substitute(mass, work[0])
        for j in range(nv):
            u[j] = qvel[j] + h * work[0, j]
    else:
        for j in range(nv):
            u[j] = qvel[j] + h * qacc[j]


@compiled
def normal_forces(data, places, normal, qacc, rows, nv):
    """Fill (normal force [N], its fall per relative acceleration [kg], 0) of each contact, from MuJoCo's solution."""
    for q in range(len(places)):
        efc = n.int_field(contact_address(data, places[q, 0]), n.C_EFC)
        acceleration = 0.0
        for j in range(nv):
            acceleration += normal[q, j] * qacc[j]
        d = n.load(n.pointer_field(data, n.D_EFC_D) + 8 * efc)
        force = d * (n.load(n.pointer_field(data, n.D_EFC_AREF) + 8 * efc) - acceleration)
        rows[q, 0] = max(force, 0.0)
        rows[q, 1] = d if force > 0.0 and nv <= MAX_DENSE else 0.0


@compiled
def settle(places, tangent, answer, motion, normal, numbers, response, rows, f, u, change, end, h, nv):
    """Find the forces of all contacts: each contact in turn, then Newton's method on all of them where that is slow."""
    ready = near(places, tangent, normal, numbers, rows, f, u, change, end, h, nv)
    if ready and newton_all(places, tangent, answer, motion, normal, numbers, rows, f, u, change, end, h, nv):
        return
    old = np.empty(nv)
    for i in range(SWEEPS):
        n.move(u, old)
        scale = sweep(places, tangent, answer, motion, normal, numbers, response, rows, f, u, change, end, h, nv)
        moved = 0.0
        for j in range(nv):
            moved = max(moved, abs(u[j] - old[j]))
        if len(places) == 1 or moved <= TOLERANCE * scale:
            return
        if i % NEWTON_EVERY == NEWTON_EVERY - 1 and newton_all(
            places, tangent, answer, motion, normal, numbers, rows, f, u, change, end, h, nv
        ):
            return


@compiled
def near(places, tangent, normal, numbers, rows, f, u, change, end, h, nv):
    """Return whether the guess is so near to the laws' forces, and the speeds to those before, that Newton may start."""
    for q in range(len(places)):
        address, state, row = places[q, 2], places[q, 3], numbers[q]
        if n.load(state + 8 * s.NEEDS_HOLD) != 0.0:
            return False
        vx, vy = contact_motion(address, row, tangent, normal, rows, u, change, q, nv)
        gx, gy = law_at(state, address, end, h, row, vx, vy)
        turned = slides(state, address) and gx * vx + gy * vy < 0.0
        if turned or math.hypot(f[q, 0] - gx, f[q, 1] - gy) > NEAR * row[MU] * n.load(address + 8 * s.NORMAL):
            return False
        edge = n.load(state + 8 * s.STICK_SPEED)
        if n.load(state + 8 * s.HAS_MODE) == 0.0 and (math.hypot(vx, vy) > edge) != (math.hypot(row[V0], row[V0 + 1]) > edge):
            return False
    return True


@compiled
def sweep(places, tangent, answer, motion, normal, numbers, response, rows, f, u, change, end, h, nv):
    """Let each contact in turn find its force at the others' last ones; return the velocity that friction can change."""
    scale = 0.0
    for q in range(len(places)):  # all from the same velocities, so that contacts alike share alike
        address = places[q, 2]
        if n.load(places[q, 3] + 8 * s.NEEDS_HOLD) != 0.0:
            vx, vy = contact_motion(address, numbers[q], tangent, normal, rows, u, change, q, nv)
            part = share(places, rows, q)
            hold(address, response[q], h, part * vx, part * vy)
            n.store(address + 8 * s.HOLD_X, n.load(address + 8 * s.HOLD_X) + f[q, 0])
            n.store(address + 8 * s.HOLD_Y, n.load(address + 8 * s.HOLD_Y) + f[q, 1])
    for q in range(len(places)):
        address, state = places[q, 2], places[q, 3]
        row, w = numbers[q], response[q]
        vx, vy = contact_motion(address, row, tangent, normal, rows, u, change, q, nv)
        row[FREE] = vx + h * (w[0] * f[q, 0] + w[1] * f[q, 1])
        row[FREE + 1] = vy + h * (w[2] * f[q, 0] + w[3] * f[q, 1])
        fx, fy = local_force(state, address, force_function(state), end, h, row, w, f[q, 0], f[q, 1])
        if slides(state, address):
            part = brake(row, w, h, fx, fy)
            fx, fy = part * fx, part * fy
        add_force(f, answer, motion, u, change, q, fx - f[q, 0], fy - f[q, 1], h, nv)
        scale = max(scale, h * max(w[0], w[3]) * row[MU] * n.load(address + 8 * s.NORMAL))
    return scale


@compiled
def share(places, rows, q):
    """Return the contact's part of the normal force of its instance: stuck contacts share what holds them likewise."""
    total = 0.0
    for k in range(len(places)):
        if places[k, 3] == places[q, 3]:
            total += rows[k, 0]
    return rows[q, 0] / total if total > 0.0 else 1.0


@compiled
def slides(state, address):
    """Return whether the contact is one of a law with modes that slides."""
    return n.load(state + 8 * s.HAS_MODE) != 0.0 and n.load(address + 8 * s.STICK) == 0.0


@compiled
def brake(row, w, h, fx, fy):
    """Return the part of a sliding contact's force that brings it to rest, at most 1.

    Sliding friction does not turn a velocity over: the law switches there, which `switch_ahead` then sees.
    """
    free = fx * row[FREE] + fy * row[FREE + 1]
    felt = h * (fx * (w[0] * fx + w[1] * fy) + fy * (w[2] * fx + w[3] * fy))
    return min(1.0, max(free, 0.0) * (1.0 + TURNED) / felt) if felt > free else 1.0


@compiled
def force_function(state):
    """Return the address of the law's force."""
    return n.load_word(n.law_row(int(n.load(state + 8 * s.LAW))) + n.FORCE)


@compiled
def contact_motion(address, row, tangent, normal, rows, u, change, q, nv):
    """Return the contact's relative velocity [m/s] at the step's end; its normal force goes to the slot."""
    vx, vy, normal_force = row[SURFACE], row[SURFACE + 1], rows[q, 0]
    for j in range(nv):
        vx -= tangent[2 * q, j] * u[j]
        vy -= tangent[2 * q + 1, j] * u[j]
        normal_force -= rows[q, 1] * normal[q, j] * change[j]
    n.store(address + 8 * s.NORMAL, max(normal_force, 0.0))
    return vx, vy


@compiled
def add_force(f, answer, motion, u, change, q, dx, dy, h, nv):
    """Change the force of contact ``q``, with the velocities and the accelerations."""
    if dx == 0.0 and dy == 0.0:
        return
    f[q, 0] += dx
    f[q, 1] += dy
    for j in range(nv):
        u[j] += h * (motion[2 * q, j] * dx + motion[2 * q + 1, j] * dy)
        change[j] += answer[2 * q, j] * dx + answer[2 * q + 1, j] * dy


@compiled
def residual(places, tangent, normal, numbers, rows, f, u, change, r, end, h, nv):
    """Fill ``r`` with force minus the law's force; return the largest part of mu_s N that it is.

    Where friction has turned a sliding velocity over, that is infinite, and ``r`` is incomplete.
    """
    worst = 0.0
    for q in range(len(places)):
        address, state = places[q, 2], places[q, 3]
        row = numbers[q]
        vx, vy = contact_motion(address, row, tangent, normal, rows, u, change, q, nv)
        if is_held(places, q):
            r[2 * q], r[2 * q + 1] = 0.0, 0.0
            continue
        gx, gy = law_at(state, address, end, h, row, vx, vy)
        if slides(state, address) and gx * vx + gy * vy < 0.0:
            return math.inf
        r[2 * q], r[2 * q + 1] = f[q, 0] - gx, f[q, 1] - gy
        size, cap = math.hypot(r[2 * q], r[2 * q + 1]), row[MU] * n.load(address + 8 * s.NORMAL)
        worst = max(worst, size / cap if cap > 0.0 else (0.0 if size == 0.0 else 1.0))
    return worst


@compiled
def is_held(places, q):
    """Return whether true stick holds the contact."""
    return n.load(places[q, 3] + 8 * s.NEEDS_HOLD) != 0.0 and n.load(places[q, 2] + 8 * s.STICK) != 0.0


@compiled
def law_at(state, address, end, h, row, vx, vy):
    """Return the law's force [N] at an end velocity."""
    call(state, address, force_function(state), end, row[U0] + h * vx, row[U0 + 1] + h * vy, vx, vy, row[MU], row[MU + 1])
    return n.load(state + 8 * s.OUTPUT), n.load(state + 8 * (s.OUTPUT + 1))


@compiled
def newton_all(places, tangent, answer, motion, normal, numbers, rows, f, u, change, end, h, nv):  # noqa: PLR0912
    """Improve all forces by Newton's method with difference quotients of the laws; return whether it converged.

    Contacts that true stick holds keep their forces, which several of them may share in many ways; then it is for the
    sweeps to say whether all is found.
    """
    m = len(places)
    held = 0
    for q in range(m):
        held += is_held(places, q)
    if held == m:
        return False
    a, slopes, x, r = np.empty((2 * m, 2 * m)), np.empty((m, 6)), np.empty(2 * m), np.empty(2 * m)
    worst = residual(places, tangent, normal, numbers, rows, f, u, change, r, end, h, nv)
    if worst == math.inf:
        return False
    for _ in range(NEWTON_STEPS):
        if worst <= FORCE_TOLERANCE:
            return held == 0
        for q in range(m):
            if is_held(places, q):
                slopes[q] = 0.0
            else:
                law_slopes(places, tangent, numbers, slopes[q], f, r, u, q, end, h, nv)
        for i in range(2 * m):
            q = i // 2
            v, w, k = slopes[q, i % 2], slopes[q, 2 + i % 2], slopes[q, 4 + i % 2] * rows[q, 1]
            for j in range(2 * m):
                total = 0.0
                for c in range(nv):
                    z = h * motion[j, c]
                    total += v * tangent[2 * q, c] * z + w * tangent[2 * q + 1, c] * z + k * normal[q, c] * answer[j, c]
                a[i, j] = total
            a[i, i] += 1.0
        n.move(r, x)
        if not eliminate(a, x):
            return False
        part, better = 1.0, False
        for _ in range(HALVINGS):
            for q in range(m):
                add_force(f, answer, motion, u, change, q, -part * x[2 * q], -part * x[2 * q + 1], h, nv)
            new = residual(places, tangent, normal, numbers, rows, f, u, change, r, end, h, nv)
            if new < worst:
                worst, better = new, True
                break
            for q in range(m):
                add_force(f, answer, motion, u, change, q, part * x[2 * q], part * x[2 * q + 1], h, nv)
            part *= 0.5
        if not better:
            residual(places, tangent, normal, numbers, rows, f, u, change, r, end, h, nv)
            return held == 0 and worst <= 1.0e3 * FORCE_TOLERANCE
    return held == 0 and worst <= FORCE_TOLERANCE


@compiled
def law_slopes(places, tangent, numbers, slope, f, r, u, q, end, h, nv):
    """Fill the slopes of the law's force: by vx (x, y) transposed, by vy, and by the normal force."""
    address, state, row = places[q, 2], places[q, 3], numbers[q]
    vx, vy = row[SURFACE], row[SURFACE + 1]
    for j in range(nv):
        vx -= tangent[2 * q, j] * u[j]
        vy -= tangent[2 * q + 1, j] * u[j]
    gx, gy = f[q, 0] - r[2 * q], f[q, 1] - r[2 * q + 1]
    step = 1.0e-4 * n.load(state + 8 * s.STICK_SPEED)
    ax, ay = law_at(state, address, end, h, row, vx + step, vy)
    slope[0], slope[1] = (ax - gx) / step, (ay - gy) / step
    ax, ay = law_at(state, address, end, h, row, vx, vy + step)
    slope[2], slope[3] = (ax - gx) / step, (ay - gy) / step
    normal_force = n.load(address + 8 * s.NORMAL)
    more = 1.0e-6 * normal_force
    slope[4], slope[5] = 0.0, 0.0
    if more > 0.0:
        n.store(address + 8 * s.NORMAL, normal_force + more)
        ax, ay = law_at(state, address, end, h, row, vx, vy)
        n.store(address + 8 * s.NORMAL, normal_force)
        slope[4], slope[5] = (ax - gx) / more, (ay - gy) / more


@compiled
def eliminate(a, x):
    """Replace x by the solution of A y = x (Gauss, partial pivots); return whether A is regular."""
    size = len(x)
    for k in range(size):
        p = k
        for i in range(k + 1, size):
            if abs(a[i, k]) > abs(a[p, k]):
                p = i
        if a[p, k] == 0.0:
            return False
        if p != k:
            for j in range(k, size):
                a[k, j], a[p, j] = a[p, j], a[k, j]
            x[k], x[p] = x[p], x[k]
        for i in range(k + 1, size):
            part = a[i, k] / a[k, k]
            if part != 0.0:
                for j in range(k + 1, size):
                    a[i, j] -= part * a[k, j]
                x[i] -= part * x[k]
    for i in range(size - 1, -1, -1):
        total = x[i]
        for j in range(i + 1, size):
            total -= a[i, j] * x[j]
        x[i] = total / a[i, i]
    return True


@compiled
def hold(address, w, h, vx, vy):
    """Write the force that takes (vx, vy) from the velocity within the step; a direction that cannot move needs none."""
    a, b, d = w[0], 0.5 * (w[1] + w[2]), w[3]
    det = a * d - b * b
    if det > 1.0e-9 * (a + d) * (a + d):
        n.store(address + 8 * s.HOLD_X, (d * vx - b * vy) / (h * det))
        n.store(address + 8 * s.HOLD_Y, (a * vy - b * vx) / (h * det))
    elif a + d > 0.0:  # one direction only: W = lambda e e^T, and its trace is lambda
        trace = a + d
        x = (a * vx + b * vy) / (h * trace * trace)
        y = (b * vx + d * vy) / (h * trace * trace)
        n.store(address + 8 * s.HOLD_X, x)
        n.store(address + 8 * s.HOLD_Y, y)
    else:
        n.store(address + 8 * s.HOLD_X, 0.0)
        n.store(address + 8 * s.HOLD_Y, 0.0)


@compiled
def start_guards(places, numbers, rows, t):
    """Keep the guards at the step's start, with the normal forces of the step."""
    for q in range(len(places)):
        address, state = places[q, 2], places[q, 3]
        n.store(address + 8 * s.NORMAL, rows[q, 0])
        if n.load(state + 8 * s.HAS_MODE) != 0.0:
            row = n.law_row(int(n.load(state + 8 * s.LAW)))
            guards_at(state, address, row, t, numbers[q, U0], numbers[q, U0 + 1], numbers[q, V0], numbers[q, V0 + 1])
            keep_guards(state, address)


@compiled
def switch_ahead(places, tangent, numbers, response, rows, u, t, end, h, nv):
    """Let the laws with modes switch where they would within the step; return whether any did."""
    switched = False
    for q in range(len(places)):
        address, state = places[q, 2], places[q, 3]
        if n.load(state + 8 * s.HAS_MODE) == 0.0 or not n.load(address + 8 * s.NORMAL) > 0.0:
            continue
        row = numbers[q]
        vx, vy = row[SURFACE], row[SURFACE + 1]
        for j in range(nv):
            vx -= tangent[2 * q, j] * u[j]
            vy -= tangent[2 * q + 1, j] * u[j]
        if n.load(state + 8 * s.NEEDS_HOLD) != 0.0 and n.load(address + 8 * s.STICK) == 0.0:  # what holds it once at rest
            fx, fy = n.load(address + 8 * s.HOLD_X), n.load(address + 8 * s.HOLD_Y)
            part = share(places, rows, q)
            hold(address, response[q], h, part * row[V0], part * row[V0 + 1])
            n.store(address + 8 * s.HOLD_X, fx - n.load(address + 8 * s.HOLD_X))
            n.store(address + 8 * s.HOLD_Y, fy - n.load(address + 8 * s.HOLD_Y))
        switched = switch_slot(state, address, row, t, end, h, vx, vy) or switched
    return switched


@compiled
def switch_slot(state, address, row, t, end, h, vx, vy):
    """Run `switch_within` on a slot over the step to come; return whether its law state is another one."""
    before, now = address + 8 * s.BEFORE, address + 8 * s.UX
    kept = np.empty(9 + MAX_STATE)
    for j in range(5):
        kept[j] = n.load(before + 8 * j)
    for j in range(4):
        kept[5 + j] = n.load(now + 8 * j)
    for j in range(MAX_STATE):
        kept[9 + j] = n.load(address + 8 * (s.STATE + j))
    put(before, t, row[U0], row[U0 + 1])
    n.store(before + 24, row[V0])
    n.store(before + 32, row[V0 + 1])
    put(now, row[U0] + h * vx, row[U0 + 1] + h * vy, vx)
    n.store(now + 24, vy)
    switch_within(state, address, n.law_row(int(n.load(state + 8 * s.LAW))), end)
    for j in range(5):
        n.store(before + 8 * j, kept[j])
    for j in range(4):
        n.store(now + 8 * j, kept[5 + j])
    changed = False
    for j in range(MAX_STATE):
        changed = changed or n.load(address + 8 * (s.STATE + j)) != kept[9 + j]
    return changed


@compiled
def consistent(model, data, states, change, qacc, nv):
    """Return whether the answer leaves all constraints in the states that it was found with."""
    largest, scale = 0.0, 0.0
    for j in range(nv):
        largest = max(largest, abs(change[j]))
        scale = max(scale, abs(qacc[j]))
    if largest <= 1.0e-12 * (1.0 + scale):
        return True
    if nv > MAX_DENSE:
        return False
    rows = len(states)
    a, b = np.empty(rows), np.empty(rows)
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
            passive[j] += tangent[2 * q, j] * x + tangent[2 * q + 1, j] * y


@compiled
def record(address, row, w, fx, fy):
    """Keep the force, the coefficients, the dissipated energy and the mass felt in the slot."""
    n.store(address + 8 * s.FX, fx)
    n.store(address + 8 * s.FY, fy)
    n.store(address + 8 * s.MU_S, row[MU])
    n.store(address + 8 * s.MU_K, row[MU + 1])
    n.store(address + 8 * s.IMPLICIT_STEP, 1.0)
    b = address + 8 * s.WORK
    work = n.load(b) * n.load(b + 16) + n.load(b + 8) * n.load(b + 24)  # the force was constant over the step
    n.store(address + 8 * s.ENERGY, n.load(address + 8 * s.ENERGY) + work)
    n.store(b + 16, 0.0)
    n.store(b + 24, 0.0)
    largest = 0.5 * (w[0] + w[3]) + math.hypot(0.5 * (w[0] - w[3]), 0.5 * (w[1] + w[2]))
    n.store(address + 8 * s.FELT, 1.0 / largest if largest > 0.0 else 0.0)
