"""Friction contexts at work: what MuJoCo's passive callback runs, for every context of the model and data at hand.

There is no ``advance`` here, so a step counts as accepted when the next one begins; its forces are found again then
(`contact.replay`).
"""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from numba import types

from stochfric_mb.compile import compiled, native
from stochfric_mb.mujoco.contact import replay, tracking
from stochfric_mb.mujoco.memory import engine, table
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.structs import RUNGE_KUTTA, data_at, model_at, record_view
from stochfric_mb.numerics import memory as w
from stochfric_mb.numerics.memory import function_at

ROW = np.dtype([(f, np.int64) for f in ("model", "data", "state", "kept", "phase", "law")])
"""A context's pair: addresses of model, data, state and kept rows, evaluations since the step began, address of the law."""
CAPACITY = 256
"""Most pairs at a time, all contexts together."""
BEFORE, ROWS = np.zeros(1, dtype=np.int64), np.zeros(CAPACITY, dtype=ROW)
"""Address of the callback that was there before, 0 if there was none; the active contexts' rows, complete with a model."""
BEFORE_KEY, ROWS_KEY = 1, 2
_ROW_SIZE = ROW.itemsize
_row_record: Any = record_view(ROW)
FOREIGN = (
    "stochfric_mb: friction(model, data, ...) covers that one MjData only; copies, rollout and Batch need the friction in the "
    "model: add_friction(spec, ...)"
)


@functools.cache
def callback() -> Any:
    """Return the compiled callback; ``.address`` is its pointer."""
    table.enter(BEFORE_KEY, BEFORE.ctypes.data)
    table.enter(ROWS_KEY, ROWS.ctypes.data)
    return native(_passive, types.void(types.intp, types.intp))


def _passive(model, data):
    before, rows = w.word_at(table.address_of(BEFORE_KEY), 0), table.address_of(ROWS_KEY)
    if before != 0:
        call_before(before, model, data)
    known, foreign = False, False
    for i in range(CAPACITY):
        row = _row_record(rows + _ROW_SIZE * i)
        if row.model == model:
            if row.data == data:
                evaluate_row(model, data, row)
                known = True
            else:
                foreign = True
    if foreign and not known:
        engine.mju_error(w.c_string(FOREIGN))


call_before = function_at(types.void, types.intp, types.intp)
"""Call a callback ``void (const mjModel*, mjData*)`` at an address."""


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
    tracking.evaluate(model, data, state, s.law_at(row.law))
    replay.keep(model, data, state, row.kept)
