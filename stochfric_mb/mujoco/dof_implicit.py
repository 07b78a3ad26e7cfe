"""The implicit step of joints and tendons: forces that belong to the velocities at the step's end.

    rate_end = rate + h J qacc(forces),  force = law(u - h rate_end, -rate_end)

They are found by solving MuJoCo's own acceleration for the forces at hand, then the joints (`dof_sweeps`) with
W = J M^-1 J^T, until nothing moves. So a stuck joint holds at any step size, and joints hold each other.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.laws.abi import MAX_STATE
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.contact import slot
from stochfric_mb.mujoco.coordinates import BEFORE_FORCE, add_row, along_row, asleep
from stochfric_mb.mujoco.dof_root import STOPPED
from stochfric_mb.mujoco.dof_sweeps import SETTLED, settle
from stochfric_mb.mujoco.mobility import mobilities
from stochfric_mb.mujoco.switching import switch

SOLUTIONS = 8
"""Most solutions of MuJoCo's constraints in a step."""


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
