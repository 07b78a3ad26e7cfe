"""Friction contexts at work: what MuJoCo's passive callback runs, for every context of the model and data at hand.

There is no ``advance`` here, so a step counts as accepted when the next one begins. Contact forces are gone by then: after
an explicit step the normal forces come from one more solution of MuJoCo's constraints; the implicit mode has found them.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import ctypes
import functools
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from stochfric_mb.compile import compiled, native
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.contact import apply, begin, find, normal_force_of, slot, solve_new, warm_row
from stochfric_mb.mujoco.dof import RUNGE_KUTTA
from stochfric_mb.mujoco.implicit import gather, keep_warm_start, solve
from stochfric_mb.mujoco.kinematics import contact_address, ordinal_of, side

MODEL, DATA, STATE, PHASE, SIGNATURE, GEOM_A, GEOM_B, WIDTH = range(8)
"""Words of a context's row: three addresses, evaluations since the step began, the model's signature, two geoms whose
native friction was switched off (-1 where an explicit pair had it)."""
CAPACITY = 256
"""Most pairs at a time, all contexts together."""
ROWS = np.zeros((CAPACITY, WIDTH), dtype=np.int64)
"""The active contexts' rows; one with a model is complete."""
_MESSAGE = ctypes.create_string_buffer(
    b"stochfric_mb: this model's native friction is switched off by friction(model, data, ...), which covers that one "
    b"MjData only; copies, rollout and Batch need the friction in the model: add_friction(spec, ...)"
)
_alive: list[Any] = []


@functools.cache
def callback() -> int:
    """Return the address of the compiled callback."""
    made = native(_passive, types.void(types.intp, types.intp))
    _alive.append(made)
    n.TABLE[n.CALLBACK_ROWS] = ROWS.ctypes.data
    n.TABLE[n.CALLBACK_MESSAGE] = ctypes.addressof(_MESSAGE)
    return made.address


@functools.cache
def prepare_solver() -> None:
    """Compile the solution of the implicit mode, and enter it where the callback looks for it."""
    made = native(_solve, types.intp(types.intp, types.intp, types.intp))
    _alive.append(made)
    n.TABLE[n.CALLBACK_SOLVER] = made.address


def _solve(model, data, _):
    solve_rows(model, data)
    return 1


def _passive(model, data):
    before = n.entry(n.CALLBACK_BEFORE)
    if before != 0:
        call_before(before, model, data)
    table = n.entry(n.CALLBACK_ROWS)
    known, foreign, solved = False, False, False
    for i in range(CAPACITY):
        row = table + 8 * WIDTH * i
        if n.load_word(row + 8 * MODEL) == 0:
            continue
        if n.load_word(row + 8 * MODEL) == model:
            if n.load_word(row + 8 * DATA) == data:
                evaluate_row(model, data, row)
                known = True
                solved = solved or n.load(n.load_word(row + 8 * STATE) + 8 * s.SOLVED) != 0.0
            else:
                foreign = True
        elif is_copy(model, row):
            foreign = True
    if foreign and not known:
        n.mju_error(n.entry(n.CALLBACK_MESSAGE))
    if solved:
        n.call_function(n.entry(n.CALLBACK_SOLVER), model, data, 0)


@intrinsic
def call_before(typingctx, address, model, data):
    """Call a callback ``void (const mjModel*, mjData*)`` at an address."""

    def generate(context, builder, signature, args):
        kind = ir.FunctionType(ir.VoidType(), [ir.IntType(64), ir.IntType(64)])
        builder.call(builder.inttoptr(args[0], kind.as_pointer()), list(args[1:]))
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, types.intp), generate


@compiled
def is_copy(model, row):
    """Return whether a model is a copy, with native friction off, of the row's model."""
    if n.load_word(model + n.offset(n.M_SIGNATURE)) != n.load_word(row + 8 * SIGNATURE) or n.load_word(row + 8 * GEOM_A) < 0:
        return False
    condim = n.pointer_field(model, n.M_GEOM_CONDIM)
    a, b = n.load_word(row + 8 * GEOM_A), n.load_word(row + 8 * GEOM_B)
    return n.load_int(condim + 4 * a) == 1 and n.load_int(condim + 4 * b) == 1


@compiled
def evaluate_row(model, data, row):
    """Begin a pair's step or go on with it, and add its friction if it is explicit; the step before is committed first."""
    state = n.load_word(row + 8 * STATE)
    now, step = n.number_field(data, n.D_TIME), n.number_field(model, n.M_TIMESTEP)
    start = n.load(state + 8 * s.EVALUATED)
    phase = n.load_word(row + 8 * PHASE)
    if start < now <= start + 1.0001 * step:
        phase += 1
        stages = n.int_field(model, n.M_INTEGRATOR) == RUNGE_KUTTA and (phase > 1 or now < start + 0.75 * step)
        if stages and phase < 4:
            n.store_word(row + 8 * PHASE, phase)
            solve_new(model, data, state)
            apply_explicit(model, data, state)
            return
        keep_current(state, now)
        keep_warm_start(model, data, state)
        if n.load(state + 8 * s.SOLVED) == 0.0:
            renew_normal_forces(model, data, state)
    elif now != start:
        n.store(state + 8 * s.N_COMMITTED, 0.0)
        n.store(state + 8 * s.ADVANCED, now)
        keep_warm_start(model, data, state)
        if n.load(state + 8 * s.MODE) == s.EXPLICIT:
            renew_normal_forces(model, data, state)
    n.store_word(row + 8 * PHASE, 0)
    begin(model, data, state, warm_row(state))
    apply_explicit(model, data, state)


@compiled
def apply_explicit(model, data, state):
    """Add the friction of a pair whose step is explicit."""
    if n.load(state + 8 * s.SOLVED) == 0.0:
        apply(model, data, state, warm_row(state))


@compiled
def solve_rows(model, data):
    """Solve the pairs of this data whose step is implicit together and add their forces."""
    table, room, warm = n.entry(n.CALLBACK_ROWS), 0, 0
    for i in range(CAPACITY):
        state = state_to_solve(model, data, table + 8 * WIDTH * i)
        if state != 0:
            room += int(n.load(state + 8 * s.N_SLOTS))
            warm = warm_row(state)
    room = min(room, n.int_field(data, n.D_NCON))
    if room == 0:
        return
    n.mj_markStack(data)
    places = n.stack_words(data, room, 5)
    count = 0
    for i in range(CAPACITY):
        state = state_to_solve(model, data, table + 8 * WIDTH * i)
        if state != 0:
            count = gather(model, data, state, places, count)
    if count > 0:
        solve(model, data, places[:count], n.vector(warm, n.int_field(model, n.M_NV)))
    n.mj_freeStack(data)


@compiled
def state_to_solve(model, data, row):
    """Return the address of a row's state if it is of this model and data and in an implicit step, otherwise 0."""
    if n.load_word(row + 8 * MODEL) != model or n.load_word(row + 8 * DATA) != data:
        return 0
    state = n.load_word(row + 8 * STATE)
    return state if n.load(state + 8 * s.SOLVED) != 0.0 else 0


@compiled
def keep_current(state, now):
    """Make the current slots the committed ones."""
    count = int(n.load(state + 8 * s.N_CURRENT))
    n.copy_bytes(slot(state, 1, 0), slot(state, 0, 0), 8 * s.SLOT * count)
    n.store(state + 8 * s.N_COMMITTED, float(count))
    n.store(state + 8 * s.ADVANCED, now)


@compiled
def renew_normal_forces(model, data, state):
    """Give the committed slots the normal forces of a solution at this instant, with the friction of the last ones."""
    nv = n.int_field(model, n.M_NV)
    passive = n.vector(n.pointer_field(data, n.D_QFRC_PASSIVE), nv)
    qacc = n.vector(n.pointer_field(data, n.D_QACC), nv)
    actuator = n.vector(n.pointer_field(data, n.D_QFRC_ACTUATOR), nv)
    kept_passive, kept_qacc, kept_actuator = passive.copy(), qacc.copy(), actuator.copy()
    begin(model, data, state, warm_row(state))
    apply(model, data, state, warm_row(state))
    n.mj_rne(model, data, np.int32(0), n.pointer_field(data, n.D_QFRC_BIAS))
    n.mj_referenceConstraint(model, data)
    n.mj_fwdActuation(model, data)
    n.mj_fwdAcceleration(model, data)
    n.mj_fwdConstraint(model, data)
    write_normal_forces(model, data, state)
    n.move(kept_passive, passive)
    n.move(kept_qacc, qacc)
    n.move(kept_actuator, actuator)


@compiled
def write_normal_forces(model, data, state):
    """Write the contacts' normal forces to the committed slots; new contacts get a slot without a law state."""
    body, surface = int(n.load(state + 8 * s.GEOM_BODY)), int(n.load(state + 8 * s.GEOM_SURFACE))
    count, wrench = int(n.load(state + 8 * s.N_COMMITTED)), state + 8 * s.FORCE
    for i in range(n.int_field(data, n.D_NCON)):
        contact = contact_address(data, i)
        if side(contact, body, surface) == 0:
            continue
        a, b = n.int_field(contact, n.C_GEOM), n.load_int(n.field(contact, n.C_GEOM) + 4)
        ordinal = ordinal_of(data, i)
        address = find(slot(state, 0, 0), count, a, b, ordinal, 0) if count > 0 else 0
        if address == 0:
            if count == int(n.load(state + 8 * s.N_SLOTS)):
                continue
            address = slot(state, 0, count)
            count += 1
            n.store(address + 8 * s.GEOM_1, a + 1.0)
            n.store(address + 8 * s.GEOM_2, b + 1.0)
            n.store(address + 8 * s.ORDINAL, float(ordinal))
            n.store(address + 8 * s.LIVE, 0.0)
        n.store(address + 8 * s.NORMAL, normal_force_of(model, data, i, wrench))
    n.store(state + 8 * s.N_COMMITTED, float(count))
