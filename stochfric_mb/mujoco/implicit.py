"""The implicit mode: friction, normal forces and the velocities at the step's end solved together, inside the step.

Each contact's force obeys ``F = force(t + h, u + h v, v)`` with the velocity at the step's end, ``v = c - h W F``.
MuJoCo's own solution of the step gives the accelerations, the normal forces and the active constraints at the last
guess of F; while the active constraints stay, all of them answer to a change of F linearly, through
``H = M + J^T D J`` (the matrix of MuJoCo's Newton solver). `together` then finds F, and MuJoCo
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
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.ahead import SWITCH_SPACE, start_guards, switch_ahead
from stochfric_mb.mujoco.answer import MU, NUMBERS
from stochfric_mb.mujoco.contact import slot_at_stage, warm_row
from stochfric_mb.mujoco.kinematics import contact_address, side
from stochfric_mb.mujoco.responses import (
    MAX_DENSE,
    add_passive,
    consistent,
    contact_motions,
    copy,
    couple,
    damping,
    responses,
    states_changed,
)
from stochfric_mb.mujoco.rows import prepare
from stochfric_mb.mujoco.switching import half_step
from stochfric_mb.mujoco.together import settle, space_needed

OUTER, ROUNDS = 6, 4
"""Most solutions by MuJoCo, and rounds of mode switches, in one step."""


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
    n.mj_markStack(data)
    places = n.stack_words(data, room, 5)
    count = 0
    for i in range(instance + 1):
        if n.load_int(plugins + 4 * i) == mine:
            state = state_of(model, data, i)
            if n.load(state + 8 * s.SOLVED) != 0.0:
                count = gather(model, data, state, places, count)
    if count > 0:
        warm = warm_row(state_of(model, data, instance))
        solve(model, data, places[:count], n.vector(warm, n.int_field(model, n.M_NV)))
    n.mj_freeStack(data)


@compiled
def gather(model, data, state, places, count):
    """Append the instance's contacts as rows (contact, sign, slot, state, law's force); return how many rows there are now."""
    t = canonical_time(n.number_field(data, n.D_TIME), half_step(model))
    body, surface = int(n.load(state + 8 * s.GEOM_BODY)), int(n.load(state + 8 * s.GEOM_SURFACE))
    k = 0
    force = n.load_word(n.law_row(int(n.load(state + 8 * s.LAW))) + n.FORCE)
    for i in range(n.int_field(data, n.D_NCON)):
        contact = contact_address(data, i)
        sign = side(contact, body, surface)
        if sign == 0:
            continue
        address = slot_at_stage(model, data, state, i, sign, t, k, warm_row(state))
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
        places[count, 4] = force
        count += 1
    return count


@compiled
def solve(model, data, places, warm):
    """Find the friction forces of the contacts in ``places``, add them to the passive forces and to the slots."""
    nv, m, rows = n.int_field(model, n.M_NV), len(places), n.int_field(data, n.D_NEFC)
    h = n.number_field(model, n.M_TIMESTEP)
    now = n.number_field(data, n.D_TIME)
    starting = now == n.load(places[0, 3] + 8 * s.EVALUATED)
    t = canonical_time(now, half_step(model))
    end = canonical_time(now + h, half_step(model))
    qacc, guess = n.vector(n.pointer_field(data, n.D_QACC), nv), n.vector(n.pointer_field(data, n.D_WARMSTART), nv)
    passive, qvel = n.vector(n.pointer_field(data, n.D_QFRC_PASSIVE), nv), n.vector(n.pointer_field(data, n.D_QVEL), nv)
    kept, base, change = n.stack(data, nv), n.stack(data, nv), n.stack(data, nv)
    tangent, normal = n.stack_table(data, nv, 2 * m), n.stack_table(data, nv, m)
    answer, motion = n.stack_table(data, nv, 2 * m), n.stack_table(data, nv, 2 * m)
    f, before, numbers = n.stack_table(data, m, 2), n.stack_table(data, m, 2), n.stack_table(data, m, NUMBERS)
    at, coupling, response = n.stack_table(data, m, 3), n.stack_table(data, 3 * m, 2 * m), n.stack_table(data, m, 4)
    space = n.stack(data, max(space_needed(m), 2 * rows, 7 * nv, SWITCH_SPACE))
    states = n.stack(data, rows)
    damped = damping(model, data, nv)
    dense = nv if nv <= MAX_DENSE else 0
    hessian, mass = n.stack_table(data, dense, dense), n.stack_table(data, dense if damped else 0, dense)
    n.move(qacc, kept)
    n.move(passive, base)
    n.move(warm, guess)
    prepare(model, data, places, tangent, normal, numbers, f, space, starting, t, end, h, qvel)
    started(model, data)
    for outer in range(OUTER):
        n.move(base, passive)
        add_passive(tangent, f, passive)
        n.mj_fwdAcceleration(model, data)
        n.mj_fwdConstraint(model, data)
        n.move(qacc, guess)
        if states_changed(data, states) or outer == 0:
            responses(model, data, tangent, hessian, mass, answer, motion, damped, h, space)
            couple(data, places, tangent, normal, answer, motion, coupling, response, h)
        contact_motions(model, data, places, tangent, normal, numbers, mass, qvel, qacc, change, at, damped, h)
        copy(f, before)
        if outer == 0 and starting:
            start_guards(places, numbers, at, t)
        settle(places, coupling, numbers, at, f, response, end, h, space)
        if starting:
            for _ in range(ROUNDS):
                if not switch_ahead(places, coupling, numbers, response, at, f, t, end, h, space):
                    break
                settle(places, coupling, numbers, at, f, response, end, h, space)
        accelerate(answer, f, before, change)
        if consistent(model, data, states, change, qacc, space):
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
def accelerate(answer, f, before, change):
    """Fill the change of the accelerations from the forces before to those now."""
    for j in range(len(change)):
        total = 0.0
        for q in range(len(f)):
            total += answer[j, 2 * q] * (f[q, 0] - before[q, 0]) + answer[j, 2 * q + 1] * (f[q, 1] - before[q, 1])
        change[j] = total


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
