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
from stochfric_mb.mujoco.answer import MU, NORMAL, SURFACE, TURNED, U0, V0, VX, VY, law_at, slides
from stochfric_mb.mujoco.contact import add_rows, slot_at_stage, warm_row
from stochfric_mb.mujoco.holding import want_rest
from stochfric_mb.mujoco.kinematics import bodies_of, contact_address, displacement, point_of, put, side
from stochfric_mb.mujoco.switching import coefficients, guards_at, half_step, keep_guards, switch_within
from stochfric_mb.mujoco.together import settle, space_needed

OUTER, ROUNDS = 6, 4
"""Most solutions by MuJoCo, and rounds of mode switches, in one step."""
FULL = 1.0e-8
"""Part of a sliding force that is missing where it has brought the contact to rest."""
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
def solve(model, data, places, warm):  # noqa: PLR0912, PLR0915
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
    f, before, numbers, response = np.empty((m, 2)), np.empty((m, 2)), np.empty((m, 10)), np.empty((m, 4))
    at, coupling = np.empty((m, 3)), np.empty((3 * m, 2 * m))
    space = np.empty(space_needed(m))
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
            responses(model, data, tangent, hessian, mass, answer, motion, response, damped, nv, h)
            couple(data, places, tangent, normal, answer, motion, coupling, nv, h)
        velocities(model, data, mass, qvel, qacc, u, work, damped, nv, h)
        contact_motions(data, places, tangent, normal, numbers, qacc, u, at, nv)
        n.move(f, before)
        if outer == 0 and starting:
            start_guards(places, numbers, at, t)
        settle(places, coupling, numbers, at, f, response, end, h, space)
        if starting:
            for _ in range(ROUNDS):
                if not switch_ahead(places, coupling, numbers, response, at, f, t, end, h, space):
                    break
                settle(places, coupling, numbers, at, f, response, end, h, space)
        change[:] = 0.0
        for q in range(m):
            for i in range(2):
                step = f[q, i] - before[q, i]
                for j in range(nv):
                    change[j] += answer[2 * q + i, j] * step
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
def responses(model, data, tangent, hessian, mass, answer, motion, response, damped, nv, h):
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
def couple(data, places, tangent, normal, answer, motion, coupling, nv, h):
    """Fill by how much relative velocities [m/s] and normal forces [N] fall (three rows a contact) for each newton."""
    for q in range(len(places)):
        efc = n.int_field(contact_address(data, places[q, 0]), n.C_EFC)
        active = n.load_int(n.pointer_field(data, n.D_EFC_STATE) + 4 * efc) == QUADRATIC and nv <= MAX_DENSE
        d = n.load(n.pointer_field(data, n.D_EFC_D) + 8 * efc) if active else 0.0
        for i in range(len(tangent)):
            x, y, z = 0.0, 0.0, 0.0
            for j in range(nv):
                x += tangent[2 * q, j] * motion[i, j]
                y += tangent[2 * q + 1, j] * motion[i, j]
                z += normal[q, j] * answer[i, j]
            coupling[3 * q, i], coupling[3 * q + 1, i], coupling[3 * q + 2, i] = h * x, h * y, d * z


@compiled
def contact_motions(data, places, tangent, normal, numbers, qacc, u, at, nv):
    """Fill the contacts' relative velocities [m/s] at the step's end and normal forces [N], from MuJoCo's solution."""
    for q in range(len(places)):
        efc = n.int_field(contact_address(data, places[q, 0]), n.C_EFC)
        vx, vy, acceleration = numbers[q, SURFACE], numbers[q, SURFACE + 1], 0.0
        for j in range(nv):
            vx -= tangent[2 * q, j] * u[j]
            vy -= tangent[2 * q + 1, j] * u[j]
            acceleration += normal[q, j] * qacc[j]
        d, wanted = n.load(n.pointer_field(data, n.D_EFC_D) + 8 * efc), n.load(n.pointer_field(data, n.D_EFC_AREF) + 8 * efc)
        at[q, VX], at[q, VY], at[q, NORMAL] = vx, vy, max(d * (wanted - acceleration), 0.0)


@compiled
def start_guards(places, numbers, at, t):
    """Keep the guards at the step's start, with the normal forces of the step."""
    for q in range(len(places)):
        address, state = places[q, 2], places[q, 3]
        n.store(address + 8 * s.NORMAL, at[q, NORMAL])
        if n.load(state + 8 * s.HAS_MODE) != 0.0:
            row = n.law_row(int(n.load(state + 8 * s.LAW)))
            guards_at(state, address, row, t, numbers[q, U0], numbers[q, U0 + 1], numbers[q, V0], numbers[q, V0 + 1])
            keep_guards(state, address)


@compiled
def switch_ahead(places, coupling, numbers, response, at, f, t, end, h, space):
    """Let the laws with modes switch where they would within the step; return whether any did."""
    switched, rests = False, False
    for q in range(len(places)):
        address, state = places[q, 2], places[q, 3]
        if n.load(state + 8 * s.NEEDS_HOLD) != 0.0 and n.load(address + 8 * s.STICK) == 0.0:
            n.store(address + 8 * s.HOLD_X, f[q, 0])
            n.store(address + 8 * s.HOLD_Y, f[q, 1])
            rests = rests or stops(places, numbers, at, f, q, end, h)
    if rests:
        want_rest(places, coupling, numbers, at, f, response, h, space)
    for q in range(len(places)):
        address, state, row = places[q, 2], places[q, 3], numbers[q]
        if n.load(state + 8 * s.HAS_MODE) == 0.0 or not n.load(address + 8 * s.NORMAL) > 0.0:
            continue
        vx, vy = at[q, VX], at[q, VY]
        if stops(places, numbers, at, f, q, end, h):  # a little beyond rest, whatever rounding leaves
            vx, vy = -TURNED * row[V0], -TURNED * row[V0 + 1]
        switched = switch_slot(state, address, row, t, end, h, vx, vy) or switched
    return switched


@compiled
def stops(places, numbers, at, f, q, end, h):
    """Return whether a contact that slides comes to rest within the step: its force is less than the law's."""
    address, state = places[q, 2], places[q, 3]
    if not slides(state, address) or not n.load(address + 8 * s.NORMAL) > 0.0:
        return False
    gx, gy = law_at(state, address, end, h, numbers[q], at[q, VX], at[q, VY])
    return math.hypot(f[q, 0], f[q, 1]) < (1.0 - FULL) * math.hypot(gx, gy)


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
