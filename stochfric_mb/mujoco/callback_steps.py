"""Friction contexts at work: what MuJoCo's passive callback runs, for every context of the model and data at hand.

There is no ``advance`` here, so a step counts as accepted when the next one begins; its forces are found again then
(`contact.replay`).
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false, reportCallIssue=false
# (compiled functions are typed by numba)

from __future__ import annotations

import ctypes
import functools
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from stochfric_mb.compile import compiled, native
from stochfric_mb.mujoco.contact import replay, tracking
from stochfric_mb.mujoco.memory import engine
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory import words as w
from stochfric_mb.mujoco.memory.structs import RUNGE_KUTTA, data_at, model_at, record_view

ROW = np.dtype([("model", np.int64), ("data", np.int64), ("state", np.int64), ("kept", np.int64), ("phase", np.int64)])
"""A context's pair: addresses of model, data, state and kept rows, evaluations since the step began."""
CAPACITY = 256
"""Most pairs at a time, all contexts together."""
ROWS = np.zeros(CAPACITY, dtype=ROW)
"""The active contexts' rows; one with a model is complete."""
_ROW_SIZE = ROW.itemsize
_row_record: Any = record_view(ROW)
_MESSAGE = ctypes.create_string_buffer(
    b"stochfric_mb: friction(model, data, ...) covers that one MjData only; copies, rollout and Batch need the friction in the "
    b"model: add_friction(spec, ...)"
)
_alive: list[Any] = []


@functools.cache
def callback() -> int:
    """Return the address of the compiled callback."""
    made = native(_passive, types.void(types.intp, types.intp))
    _alive.append(made)
    w.TABLE[w.CALLBACK_ROWS] = ROWS.ctypes.data
    w.TABLE[w.CALLBACK_MESSAGE] = ctypes.addressof(_MESSAGE)
    return made.address


def _passive(model, data):
    before = w.entry(w.CALLBACK_BEFORE)
    if before != 0:
        call_before(before, model, data)
    known, foreign = False, False
    for i in range(CAPACITY):
        row = _row_record(w.entry(w.CALLBACK_ROWS) + _ROW_SIZE * i)
        if row.model == model:
            if row.data == data:
                evaluate_row(model, data, row)
                known = True
            else:
                foreign = True
    if foreign and not known:
        engine.mju_error(w.entry(w.CALLBACK_MESSAGE))


@intrinsic
def call_before(typingctx, address, model, data):
    """Call a callback ``void (const mjModel*, mjData*)`` at an address."""

    def generate(context, builder, signature, args):
        kind = ir.FunctionType(ir.VoidType(), [ir.IntType(64), ir.IntType(64)])
        builder.call(builder.inttoptr(args[0], kind.as_pointer()), list(args[1:]))
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, types.intp), generate


@compiled
def evaluate_row(model, data, row):
    """Let a pair's friction act; the step before is committed first, when another one begins."""
    m, d, state = model_at(model), data_at(data), row.state
    header = s.header_record(state)
    if header.started != 0.0 and header.evaluated < d.time <= header.evaluated + 1.0001 * m.timestep:
        row.phase += 1
        stages = m.integrator == RUNGE_KUTTA and (row.phase > 1 or d.time < header.evaluated + 0.75 * m.timestep)
        if not stages or row.phase >= 4:
            tracking.commit(model, data, state)
            replay.settle(model, data, state, row.kept)
            tracking.close(model, data, state)
            row.phase = 0
    elif d.time != header.evaluated:
        header.n_committed, header.started, header.advanced, row.phase = 0.0, 0.0, s.UNSET, 0
    tracking.evaluate(model, data, state)
    replay.keep(model, data, state, row.kept)
