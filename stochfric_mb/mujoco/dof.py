"""Friction on joints and tendons: one generalised coordinate each, a given load, implicit in the velocity.

All joints and tendons with friction are solved together, at the first evaluation of a step: the end velocities

    rate_end = rate + h J qacc(forces),  force = law(u - h rate_end, -rate_end)

are found by solving MuJoCo's own acceleration for the forces at hand, then each joint in turn (Gauss-Seidel with
W = J M^-1 J^T), until nothing moves. So a stuck joint holds at any step size, and joints hold each other. With the
Runge-Kutta integrator, which evaluates within the step, the force is the law's at each instant instead.

State, commits and coefficient paths are those of contacts (`contact`), with one slot that always touches. Signs: the
counter-surface is at rest, so u = -position and v = -rate, and the law's force acts along +v on the coordinate.
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
from stochfric_mb.laws.abi import MAX_STATE, call_law
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.contact import slot
from stochfric_mb.mujoco.kinematics import JUMP
from stochfric_mb.mujoco.switching import call, coefficients, commit_slot, half_step, switch

KIND, OBJECT, LOAD = s.GEOM_BODY, s.GEOM_SURFACE, s.POINT
"""Header places with another meaning here: 0 joint or 1 tendon, its number, and the load [N or N m]."""
POSITION, BEFORE_FORCE = s.ON_BODY, s.WORK
"""Slot places with another meaning here: position [rad or m], force of the step before."""
RUNGE_KUTTA = 1
"""mjINT_RK4."""
QUADRATIC = 1
"""mjCNSTRSTATE_QUADRATIC."""
SOLUTIONS, SWEEPS, TRIALS, HALVINGS = 8, 50, 60, 16
"""Most solutions of MuJoCo's constraints, of the joints in turn, and of one joint's equation, in a step."""
ALONE, SLOPE, STOPPED = range(MAX_STATE, MAX_STATE + 3)
"""Behind a coordinate's law state: velocity and slope where it was solved alone, 1 where it has stopped in this step."""
START = 30
"""The search for a root begins with 2^-START of the way to the farthest point, and doubles."""
SETTLED = 1.0e-10
"""Change of an end velocity [rad/s or m/s] that ends the iterations."""


@compiled
def state_of(model, data, instance):
    """Return the address of an instance's state."""
    first = n.load_int(n.pointer_field(model, n.M_STATE_ADDRESS) + 4 * instance)
    return n.pointer_field(data, n.D_PLUGIN_STATE) + 8 * first


@compiled
def is_joint_friction(model, instance):
    """Return whether a plugin instance is friction on a joint or tendon."""
    return n.load_int(n.pointer_field(model, n.M_PLUGIN) + 4 * instance) == n.entry(n.JOINTS_SLOT)


@compiled
def compute(model, data, instance):
    """Add the friction of all joints and tendons; only the first instance does, for all."""
    count = 0
    for i in range(n.int_field(model, n.M_NPLUGIN)):
        if is_joint_friction(model, i):
            if count == 0 and i != instance:
                return
            count += 1
    states = np.empty(count, np.int64)
    count = 0
    for i in range(n.int_field(model, n.M_NPLUGIN)):
        if is_joint_friction(model, i):
            states[count] = state_of(model, data, i)
            count += 1
    runge_kutta = n.int_field(model, n.M_INTEGRATOR) == RUNGE_KUTTA
    starting = False
    for k in range(count):
        starting = begin(model, data, states[k], runge_kutta)
    if runge_kutta:
        for k in range(count):
            apply_now(model, data, states[k], starting)
    else:
        apply_implicit(model, data, states)


@compiled
def add_row(model, data, state, factor, target):
    """Add ``factor`` times the row of the coordinate's rate per generalised velocity to the vector at ``target``."""
    number = int(n.load(state + 8 * OBJECT))
    if n.load(state + 8 * KIND) == 0.0:
        address = target + 8 * n.load_int(n.pointer_field(model, n.M_JOINT_DOF) + 4 * number)
        n.store(address, n.load(address) + factor)
        return
    first = n.load_int(n.pointer_field(model, n.M_TENDON_ADDRESS) + 4 * number)
    columns = n.pointer_field(model, n.M_TENDON_COLUMN)
    row = n.pointer_field(data, n.D_TENDON_J)
    for j in range(first, first + n.load_int(n.pointer_field(model, n.M_TENDON_NNZ) + 4 * number)):
        address = target + 8 * n.load_int(columns + 4 * j)
        n.store(address, n.load(address) + factor * n.load(row + 8 * j))


@compiled
def along_row(model, data, state, vector):
    """Return the product of the coordinate's row with the vector at ``vector``: its rate, for qvel."""
    number = int(n.load(state + 8 * OBJECT))
    if n.load(state + 8 * KIND) == 0.0:
        return n.load(vector + 8 * n.load_int(n.pointer_field(model, n.M_JOINT_DOF) + 4 * number))
    first = n.load_int(n.pointer_field(model, n.M_TENDON_ADDRESS) + 4 * number)
    columns = n.pointer_field(model, n.M_TENDON_COLUMN)
    row = n.pointer_field(data, n.D_TENDON_J)
    total = 0.0
    for j in range(first, first + n.load_int(n.pointer_field(model, n.M_TENDON_NNZ) + 4 * number)):
        total += n.load(row + 8 * j) * n.load(vector + 8 * n.load_int(columns + 4 * j))
    return total


@compiled
def position_of(model, data, state):
    """Return the coordinate's position [rad or m]: a joint's, or a tendon's length."""
    number = int(n.load(state + 8 * OBJECT))
    if n.load(state + 8 * KIND) != 0.0:
        return n.load(n.pointer_field(data, n.D_TENDON_LENGTH) + 8 * number)
    return n.load(n.pointer_field(data, n.D_QPOS) + 8 * n.load_int(n.pointer_field(model, n.M_JOINT_QPOS) + 4 * number))


@compiled
def asleep(model, data, state):
    """Return whether MuJoCo has put the kinematic tree of the coordinate to sleep."""
    number = int(n.load(state + 8 * OBJECT))
    if n.load(state + 8 * KIND) == 0.0:
        dof = n.load_int(n.pointer_field(model, n.M_JOINT_DOF) + 4 * number)
    else:
        if n.load_int(n.pointer_field(model, n.M_TENDON_NNZ) + 4 * number) == 0:
            return True
        first = n.load_int(n.pointer_field(model, n.M_TENDON_ADDRESS) + 4 * number)
        dof = n.load_int(n.pointer_field(model, n.M_TENDON_COLUMN) + 4 * first)
    tree = n.load_int(n.pointer_field(model, n.M_DOF_TREE) + 4 * dof)
    return n.load_int(n.pointer_field(data, n.D_TREE_ASLEEP) + 4 * tree) >= 0


@compiled
def begin(model, data, state, located):
    """Make the current slot if a step starts now; return whether it does."""
    now = n.number_field(data, n.D_TIME)
    start = n.load(state + 8 * s.EVALUATED)
    if located and n.load(state + 8 * s.STARTED) != 0.0 and start < now <= start + 1.0001 * n.number_field(model, n.M_TIMESTEP):
        return False
    n.store(state + 8 * s.EVALUATED, now)
    n.store(state + 8 * s.STARTED, 1.0)
    known = n.load(state + 8 * s.ADVANCED) == now and n.load(state + 8 * s.N_COMMITTED) > 0.0
    t = canonical_time(now, half_step(model))
    address = slot(state, 1, 0)
    fill(model, data, state, address, slot(state, 0, 0) if known else 0, t)
    n.store(state + 8 * s.N_CURRENT, 1.0)
    load = n.load(state + 8 * LOAD)
    n.store(address + 8 * s.NORMAL, load)
    if located:
        commit_slot(state, address, n.law_row(int(n.load(state + 8 * s.LAW))), t, load, 1)
    else:
        commit_at_end(state, address, t)
    return True


@compiled
def fill(model, data, state, address, old, t):
    """Fill kinematics and mass of the current slot; its law state stays the old one."""
    for j in range(s.SLOT):
        n.store(address + 8 * j, n.load(old + 8 * j) if old != 0 else 0.0)
    position = position_of(model, data, state)
    v = -along_row(model, data, state, n.pointer_field(data, n.D_QVEL))
    u, du = -position, 0.0
    if old != 0:
        du = moved(old, position, v, t)
        u = n.load(old + 8 * s.UX) + du
        n.store(address + 8 * s.BEFORE, n.load(old + 8 * s.SINCE))
        n.store(address + 8 * (s.BEFORE + 1), n.load(old + 8 * s.UX))
        n.store(address + 8 * (s.BEFORE + 3), n.load(old + 8 * s.VX))
        n.store(address + 8 * BEFORE_FORCE, n.load(old + 8 * s.FX))
    n.store(address + 8 * (s.WORK + 2), du)
    n.store(address + 8 * s.UX, u)
    n.store(address + 8 * s.VX, v)
    n.store(address + 8 * s.AXIS_1, 1.0)
    n.store(address + 8 * s.SINCE, t)
    n.store(address + 8 * POSITION, position)
    nv = n.int_field(model, n.M_NV)
    rows = np.zeros((2, nv))
    add_row(model, data, state, 1.0, rows.ctypes.data)
    n.mj_solveM(model, data, rows.ctypes.data + 8 * nv, rows.ctypes.data, np.int32(1))
    mobility = along_row(model, data, state, rows.ctypes.data + 8 * nv)
    n.store(address + 8 * s.MASS, 1.0 / mobility if mobility > 0.0 else 0.0)


@compiled
def moved(old, position, v, t):
    """Return the displacement since the old slot; a coordinate that was put elsewhere moves by its mean velocity."""
    du = n.load(old + 8 * POSITION) - position
    step = t - n.load(old + 8 * s.SINCE)
    w = n.load(old + 8 * s.VX)
    mean = 0.5 * step * (v + w)
    if abs(du - mean) > JUMP * step * (abs(v) + abs(w)) + 1.0e-6:
        return mean
    return du


@compiled
def commit_at_end(state, address, t):
    """Run the law's commit (init at first) on a slot that an implicit step has brought here.

    Switches are not looked for within the step: an implicit step has no path within.
    """
    row = n.law_row(int(n.load(state + 8 * s.LAW)))
    if row == 0:
        return
    new = n.load(address + 8 * s.LIVE) == 0.0
    u, v = n.load(address + 8 * s.UX), n.load(address + 8 * s.VX)
    switch(state, address, row, n.INIT if new else n.COMMIT, t, u, 0.0, v, 0.0)
    if new:
        n.store(address + 8 * s.EVENTS, 0.0)
    mu_s, mu_k = coefficients(state, t, u, n.load(address + 8 * s.EVENTS))
    n.store(address + 8 * s.MU_S, mu_s)
    n.store(address + 8 * s.MU_K, mu_k)
    n.store(address + 8 * s.LIVE, 1.0)
    work = n.load(address + 8 * BEFORE_FORCE) * n.load(address + 8 * (s.WORK + 2))
    n.store(address + 8 * s.ENERGY, n.load(address + 8 * s.ENERGY) + work)


@compiled
def apply_now(model, data, state, starting):
    """Add the law's force at this instant."""
    target = n.pointer_field(data, n.D_QFRC_PASSIVE)
    row = n.law_row(int(n.load(state + 8 * s.LAW)))
    if row == 0:
        n.store(target, math.nan)
        return
    address = slot(state, 1, 0)
    t = canonical_time(n.number_field(data, n.D_TIME), half_step(model))
    u, v = n.load(address + 8 * s.UX), n.load(address + 8 * s.VX)
    mu_s, mu_k = n.load(address + 8 * s.MU_S), n.load(address + 8 * s.MU_K)
    if not starting:
        v = -along_row(model, data, state, n.pointer_field(data, n.D_QVEL))
        u += moved(address, position_of(model, data, state), v, t)
        mu_s, mu_k = coefficients(state, t, u, n.load(address + 8 * s.EVENTS))
    call(state, address, n.load_word(row + n.FORCE), t, u, 0.0, v, 0.0, mu_s, mu_k)
    force = n.load(state + 8 * s.OUTPUT)
    if starting:
        n.store(address + 8 * s.FX, force)
        work = 0.5 * (n.load(address + 8 * BEFORE_FORCE) + force) * n.load(address + 8 * (s.WORK + 2))
        n.store(address + 8 * s.ENERGY, n.load(address + 8 * s.ENERGY) + work)
    add_row(model, data, state, force, target)


# --- the implicit step -----------------------------------------------------------------------------------------------


@compiled
def apply_implicit(model, data, states):
    """Add the forces that belong to the velocities at the step's end."""
    nv = n.int_field(model, n.M_NV)
    count = len(states)
    h = n.number_field(model, n.M_TIMESTEP)
    target = n.pointer_field(data, n.D_QFRC_PASSIVE)
    qacc = n.vector(n.pointer_field(data, n.D_QACC), nv)
    actuator = n.vector(n.pointer_field(data, n.D_QFRC_ACTUATOR), nv)
    passive, qvel = n.vector(target, nv), n.vector(n.pointer_field(data, n.D_QVEL), nv)
    kept_qacc, kept_actuator, others = qacc.copy(), actuator.copy(), passive.copy()  # qacc is an input of mj_inverse
    forces, end, ahead = np.empty(count), np.empty(count), np.empty(nv)
    awake, memory = np.empty(count, np.bool_), np.zeros((count, STOPPED + 1))
    for k in range(count):
        address = slot(states[k], 1, 0)
        awake[k] = not asleep(model, data, states[k]) and n.load(address + 8 * s.MASS) > 0.0
        if n.law_row(int(n.load(states[k] + 8 * s.LAW))) == 0:
            n.store(target, math.nan)
            return
        forces[k] = n.load(address + 8 * BEFORE_FORCE) if awake[k] else 0.0
        for j in range(MAX_STATE):
            memory[k, j] = n.load(address + 8 * (s.STATE + j))
    mobility = mobilities(model, data, states, False)
    n.mj_rne(model, data, np.int32(0), n.pointer_field(data, n.D_QFRC_BIAS))
    n.mj_referenceConstraint(model, data)
    n.mj_fwdActuation(model, data)
    for _ in range(SOLUTIONS):
        n.move(others, passive)
        for k in range(count):
            add_row(model, data, states[k], forces[k], target)
        n.mj_fwdAcceleration(model, data)
        n.mj_fwdConstraint(model, data)
        ahead[:] = qvel + h * qacc
        for k in range(count):
            end[k] = along_row(model, data, states[k], ahead.ctypes.data)
        if n.int_field(data, n.D_NEFC) > 0:
            mobility = mobilities(model, data, states, True)
        change = settle(states, awake, mobility, h, end, forces, memory)
        if n.int_field(data, n.D_NEFC) == 0 or change < 10.0 * SETTLED:
            break
    n.move(others, passive)
    for k in range(count):
        if awake[k]:
            add_row(model, data, states[k], forces[k], target)
            keep_force(states[k], forces[k], memory[k, STOPPED] != 0.0)
    n.move(kept_qacc, qacc)
    n.move(kept_actuator, actuator)


@compiled
def mobilities(model, data, states, constrained):
    """Return W = J H^-1 J^T of all coordinates, shape (n, n) [rate per impulse].

    H is the mass matrix; with ``constrained``, plus that of the constraints that push (MuJoCo's soft constraints are
    quadratic there), so that W is what a change of force really does. Elliptic cones count as open.
    """
    nv, count = n.int_field(model, n.M_NV), len(states)
    rows, out = np.zeros((count, nv)), np.zeros((count, count))
    for k in range(count):
        add_row(model, data, states[k], 1.0, rows[k].ctypes.data)
    solved = rows.copy()
    if constrained:
        matrix = np.zeros((nv, nv))
        n.mj_fullM(model, data, matrix.ctypes.data)
        add_constraints(model, data, matrix)
        solved = eliminate(matrix, solved.T.copy()).T.copy()
    else:
        n.mj_solveM(model, data, solved.ctypes.data, rows.ctypes.data, np.int32(count))
    for k in range(count):
        for j in range(count):
            out[j, k] = along_row(model, data, states[j], solved[k].ctypes.data)
    return out


@compiled
def add_constraints(model, data, matrix):
    """Add J^T D J of the constraints in their quadratic zone to the matrix."""
    nv = n.int_field(model, n.M_NV)
    sparse = n.mj_isSparse(model) != 0
    jacobian, columns = n.pointer_field(data, n.D_EFC_J), n.pointer_field(data, n.D_EFC_COLUMN)
    for i in range(n.int_field(data, n.D_NEFC)):
        if n.load_int(n.pointer_field(data, n.D_ROW_STATE) + 4 * i) != QUADRATIC:
            continue
        weight = n.load(n.pointer_field(data, n.D_EFC_D) + 8 * i)
        first, length = nv * i, nv
        if sparse:
            first = n.load_int(n.pointer_field(data, n.D_EFC_ADDRESS) + 4 * i)
            length = n.load_int(n.pointer_field(data, n.D_EFC_NNZ) + 4 * i)
        for a in range(length):
            row = n.load_int(columns + 4 * (first + a)) if sparse else a
            value = weight * n.load(jacobian + 8 * (first + a))
            for b in range(length):
                column = n.load_int(columns + 4 * (first + b)) if sparse else b
                matrix[row, column] += value * n.load(jacobian + 8 * (first + b))


@compiled
def eliminate(matrix, right):
    """Return the solution of matrix x = right (both are overwritten), by elimination with pivots."""
    size = len(matrix)
    for i in range(size):
        best = i
        for j in range(i + 1, size):
            if abs(matrix[j, i]) > abs(matrix[best, i]):
                best = j
        for k in range(i, size):
            matrix[i, k], matrix[best, k] = matrix[best, k], matrix[i, k]
        for k in range(right.shape[1]):
            right[i, k], right[best, k] = right[best, k], right[i, k]
        for j in range(i + 1, size):
            factor = matrix[j, i] / matrix[i, i]
            if factor != 0.0:
                for k in range(i, size):
                    matrix[j, k] -= factor * matrix[i, k]
                for k in range(right.shape[1]):
                    right[j, k] -= factor * right[i, k]
    for i in range(size - 1, -1, -1):
        for k in range(right.shape[1]):
            for j in range(i + 1, size):
                right[i, k] -= matrix[i, j] * right[j, k]
            right[i, k] /= matrix[i, i]
    return right


@compiled
def settle(states, awake, mobility, h, end, forces, memory):
    """Solve all coordinates for forces and end velocities; return the first sweep's largest change of velocity.

    Sweeps solve one coordinate after the other; between them one Newton step moves all at once.
    """
    first = 0.0
    for sweep in range(SWEEPS):
        largest = 0.0
        for k in range(len(states)):
            if awake[k]:
                reach = h * mobility[k, k]
                change = solve_one(states[k], h, reach, reach * forces[k] - end[k], memory[k]) - forces[k]
                forces[k] += change
                for j in range(len(states)):
                    end[j] += h * mobility[j, k] * change
                largest = max(largest, reach * abs(change))
        if sweep == 0:
            first = largest
        if largest < SETTLED or len(states) == 1:
            break
        newton_step(states, awake, mobility, h, end, forces, memory)
    return first


@compiled
def newton_step(states, awake, mobility, h, end, forces, memory):
    """Move all forces and end velocities by one Newton step, from the law's slopes where each was solved alone."""
    count = len(states)
    matrix, miss = np.eye(count), np.zeros((count, 1))
    for k in range(count):
        if awake[k]:
            slope = max(memory[k, SLOPE], 0.0)
            miss[k, 0] = slope * (-end[k] - memory[k, ALONE])
            for j in range(count):
                if awake[j]:
                    matrix[k, j] += slope * h * mobility[k, j]
    change = eliminate(matrix, miss)[:, 0].copy()
    moved_by = h * mobility @ change
    part = best_part(states, awake, memory, h, forces, end, change, moved_by)
    forces += part * change
    end += part * moved_by


@compiled
def best_part(states, awake, memory, h, forces, end, change, moved_by):
    """Return which part of a Newton step to take, 0 to 1: to the least of the potential of which the solution is the minimum.

    The potential 1/2 p W^-1 p/h + sum of the integrals of F is convex where friction grows with velocity.
    """
    if not rise(states, awake, memory, h, forces, end, change, moved_by, 0.0) < 0.0:
        return 0.0
    if rise(states, awake, memory, h, forces, end, change, moved_by, 1.0) <= 0.0:
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if rise(states, awake, memory, h, forces, end, change, moved_by, middle) <= 0.0:
            low = middle
        else:
            high = middle
    return low


@compiled
def rise(states, awake, memory, h, forces, end, change, moved_by, part):
    """Return the slope of the potential along a Newton step, after a part of it."""
    total = 0.0
    for k in range(len(states)):
        if awake[k]:
            row = n.law_row(int(n.load(states[k] + 8 * s.LAW)))
            v = -(end[k] + part * moved_by[k])
            force = force_at_end(states[k], slot(states[k], 1, 0), row, memory[k], h, v)
            total -= moved_by[k] * (force - forces[k] - part * change[k])
    return total


@compiled
def solve_one(state, h, reach, free, memory):
    """Return the force that belongs to the end velocity v = free - reach force of one coordinate.

    Args:
        state: address of its state.
        h: step [s].
        reach: velocity per force [rad/s per N m or m/s per N].
        free: end velocity (counter-surface minus coordinate) without the force [rad/s or m/s].
        memory: the law's state, changed here where sliding stops within the step; the velocity found and the slope
            there are written behind it.
    """
    address = slot(state, 1, 0)
    row = n.law_row(int(n.load(state + 8 * s.LAW)))
    before = n.load(address + 8 * s.VX)
    v = root(state, address, row, memory, h, reach, free, before if memory[STOPPED] == 0.0 else 0.0)
    if v * before < 0.0 and memory[STOPPED] == 0.0:
        at_rest(state, address, row, memory)
        memory[STOPPED] = 1.0
        v = root(state, address, row, memory, h, reach, free, 0.0)
    small = 1.0e-9 * reach * n.load(address + 8 * s.MU_S) * n.load(address + 8 * s.NORMAL) + 1.0e-300
    force = force_at_end(state, address, row, memory, h, v)
    memory[ALONE] = v
    memory[SLOPE] = (force_at_end(state, address, row, memory, h, v + small) - force) / small
    return (free - v) / reach


@compiled
def at_rest(state, address, row, memory):
    """Replace the law's memory by what its commit makes of it at zero velocity: sliding does not turn over within a step."""
    call_law(
        n.load_word(row + n.COMMIT), n.load(address + 8 * s.SINCE), n.load(address + 8 * s.UX), 0.0, 0.0, 0.0,
        n.load(address + 8 * s.NORMAL), n.load(address + 8 * s.MU_S), n.load(address + 8 * s.MU_K),
        n.load(address + 8 * s.MASS), 0.0, 0.0, memory.ctypes.data, state + 8 * s.PARAMETERS, state + 8 * s.OUTPUT,
    )  # fmt: skip
    for j in range(MAX_STATE):
        memory[j] = n.load(state + 8 * (s.OUTPUT + j))


@compiled
def force_at_end(state, address, row, memory, h, v):
    """Return the law's force at the step's end with the velocity v."""
    call_law(
        n.load_word(row + n.FORCE), n.load(address + 8 * s.SINCE) + h, n.load(address + 8 * s.UX) + h * v, 0.0, v, 0.0,
        n.load(address + 8 * s.NORMAL), n.load(address + 8 * s.MU_S), n.load(address + 8 * s.MU_K),
        n.load(address + 8 * s.MASS), 0.0, 0.0, memory.ctypes.data, state + 8 * s.PARAMETERS, state + 8 * s.OUTPUT,
    )  # fmt: skip
    return n.load(state + 8 * s.OUTPUT)


@compiled
def miss_at(state, address, row, memory, h, reach, free, v):
    """Return v - free + reach F(v) [rad/s or m/s], zero at the end velocity."""
    return v - free + reach * force_at_end(state, address, row, memory, h, v)


@compiled
def root(state, address, row, memory, h, reach, free, guess):
    """Return the root v of v - free + reach F(v) that is reached first on the way from ``guess``.

    A force that falls with velocity can have several roots: a joint that sticks or creeps stays on its branch.
    Friction is bounded or grows with v, so a root lies between ``free`` and ``free`` less what F(free) or mu_s N does.
    """
    most = max(
        abs(force_at_end(state, address, row, memory, h, free)), n.load(address + 8 * s.MU_S) * n.load(address + 8 * s.NORMAL)
    )
    width = reach * most * (1.0 + 1.0e-9) + 1.0e-300
    small, exact = 1.0e-9 * width, 1.0e-13 * (abs(free) + width)
    x, miss = guess, miss_at(state, address, row, memory, h, reach, free, guess)
    if abs(miss) <= exact:
        return x
    following = newton(state, address, row, memory, h, reach, free, x, miss, small)
    if abs(miss_at(state, address, row, memory, h, reach, free, following)) <= exact:
        return following
    end = free + math.copysign(width, -miss)
    step = (end - x) * 2.0**-START
    for _ in range(START + 1):
        if miss_at(state, address, row, memory, h, reach, free, x + step) * miss <= 0.0:
            break
        x += step
        step *= 2.0
    return bracketed(state, address, row, memory, h, reach, free, min(x, x + step), max(x, x + step), small, exact)


@compiled
def newton(state, address, row, memory, h, reach, free, x, miss, small):
    """Return the next velocity by Newton's method, with a difference for the slope."""
    slope = (miss_at(state, address, row, memory, h, reach, free, x + small) - miss) / small
    return x - miss / slope if slope > 0.0 else x - miss


@compiled
def bracketed(state, address, row, memory, h, reach, free, low, high, small, exact):
    """Return the root between ``low`` and ``high``: Newton's method, halving where it leaves the bracket."""
    x = 0.5 * (low + high)
    for _ in range(TRIALS):
        miss = miss_at(state, address, row, memory, h, reach, free, x)
        if abs(miss) <= exact:
            break
        if miss > 0.0:
            high = x
        else:
            low = x
        following = newton(state, address, row, memory, h, reach, free, x, miss, min(small, 1.0e-3 * (high - low)))
        if not low < following < high:
            following = 0.5 * (low + high)
        if following in (low, high):
            break
        x = following
    return x


@compiled
def keep_force(state, force, stopped):
    """Write the force of the step to the current slot, and the stick that began within the step."""
    address = slot(state, 1, 0)
    n.store(address + 8 * s.FX, force)
    if stopped:
        row = n.law_row(int(n.load(state + 8 * s.LAW)))
        switch(
            state,
            address,
            row,
            n.COMMIT,
            n.load(address + 8 * s.SINCE),
            n.load(address + 8 * s.UX),
            0.0,
            0.0,
            0.0,
        )


@compiled
def finish(data, state):
    """Commit the current slot when the engine accepts a step."""
    if n.load(state + 8 * s.N_CURRENT) == 0.0:
        return
    for j in range(s.SLOT):
        n.store(slot(state, 0, 0) + 8 * j, n.load(slot(state, 1, 0) + 8 * j))
    n.store(state + 8 * s.N_COMMITTED, 1.0)
    n.store(state + 8 * s.ADVANCED, n.number_field(data, n.D_TIME))
    n.store(state + 8 * s.STARTED, 0.0)
