"""Friction on joints and tendons: one generalised coordinate each, a given load, implicit in the velocity.

All joints and tendons with friction are solved together, at the first evaluation of a step (`dof_implicit`). With the
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
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.contact import slot
from stochfric_mb.mujoco.coordinates import BEFORE_FORCE, LOAD, POSITION, add_row, along_row, position_of
from stochfric_mb.mujoco.dof_implicit import apply_implicit
from stochfric_mb.mujoco.kinematics import JUMP
from stochfric_mb.mujoco.switching import call, coefficients, commit_slot, half_step, switch

RUNGE_KUTTA = 1
"""mjINT_RK4."""


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


@compiled
def finish(data, state):
    """Commit the current slot when the engine accepts a step."""
    if n.load(state + 8 * s.N_CURRENT) == 0.0:
        return
    n.copy_bytes(slot(state, 1, 0), slot(state, 0, 0), 8 * s.SLOT)
    n.store(state + 8 * s.N_COMMITTED, 1.0)
    n.store(state + 8 * s.ADVANCED, n.number_field(data, n.D_TIME))
    n.store(state + 8 * s.STARTED, 0.0)
