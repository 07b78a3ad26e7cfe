"""The engine plugin ``stochfric.pair``: compiled callbacks, registered with MuJoCo once per process."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import ctypes
import functools
import math
from typing import Any

import mujoco
from numba import types

from stochfric_mb.compile import compiled, native
from stochfric_mb.mujoco import config
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.contact import apply, begin, finish, solve_new, warm_row
from stochfric_mb.mujoco.implicit import any_solved, is_last, keep_warm_start, solve_instances
from stochfric_mb.mujoco.options import CHECKER, MESSAGE, options_allow, require_passive_forces
from stochfric_mb.mujoco.registration import register_plugin

NAME = "stochfric.pair"
"""Name of the plugin in MJCF."""
LAW, COEFFICIENTS, GEOM1, GEOM2, SEED, SAMPLE, CONTACT, SLOTS, MODE = range(9)
"""Places of the keys in `config.ATTRIBUTES`."""
DEFAULT_SLOTS = 16
UNSET = -1.0e300
"""Time of the last advance before the first one."""
_GEOM_OBJECT = 5
_POINTER, _INT = types.intp, types.int32
_alive: list[Any] = []


@functools.cache
def register() -> int:
    """Return MuJoCo's slot number of the plugin, registered now unless it was before.

    Raises:
        MissingEngineError: this MuJoCo build has another struct layout than this package knows.
    """
    n.fill_table()
    n.TABLE[n.READER] = ctypes.cast(config.READER, ctypes.c_void_p).value or 0
    n.TABLE[n.EXPLAINER] = ctypes.cast(config.EXPLAINER, ctypes.c_void_p).value or 0
    n.TABLE[n.OPTIONS_CHECKER] = ctypes.cast(CHECKER, ctypes.c_void_p).value or 0
    n.TABLE[n.NO_PASSIVE_MESSAGE] = ctypes.addressof(MESSAGE)
    n.TABLE[n.PREPARER] = ctypes.cast(_PREPARE_SOLVER, ctypes.c_void_p).value or 0
    passive = int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_PASSIVE)
    return register_plugin(NAME, config.ATTRIBUTES, keys=n.KEYS, capability=passive, callbacks=_CALLBACKS)


def _prepare_solver(model: int, data: int, instance: int) -> int:
    """Compile the solution of the implicit mode, and enter it where compiled code looks for it."""
    solver = native(_solve, _POINTER(_POINTER, _POINTER, _POINTER))
    _alive.append(solver)
    n.TABLE[n.SOLVER] = solver.address
    return 1


_PREPARE_SOLVER = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)(_prepare_solver)


def _solve(model, data, instance):
    solve_instances(model, data, instance)
    return 1


@compiled
def solver(model, data, instance):
    """Return the address of the implicit mode's solution, 0 if it cannot be compiled."""
    if n.entry(n.SOLVER) == 0:
        n.call_python(n.entry(n.PREPARER), model, data, instance)
    return n.entry(n.SOLVER)


@compiled
def state_address(model, data, instance):
    """Return the address of an instance's state."""
    first = n.load_int(n.pointer_field(model, n.M_STATE_ADDRESS) + 4 * instance)
    return n.pointer_field(data, n.D_PLUGIN_STATE) + 8 * first


@compiled
def text_of(model, instance, key):
    """Return the address of a configuration value, 0 if there is none."""
    return n.mj_getPluginConfig(model, instance, n.entry(n.KEYS + key))


@compiled
def geom_of(model, instance, key):
    """Return the id of the geom that a key names, -1 for ``*``, -2 if there is none of that name."""
    text = text_of(model, instance, key)
    if text == 0:
        return -2
    if n.load_byte(text) == 42 and n.load_byte(text + 1) == 0:
        return -1
    geom = n.mj_name2id(model, _INT(_GEOM_OBJECT), text)
    return geom if geom >= 0 else -2


@compiled
def record_of(model, instance):
    """Return the address of the instance's numbers, 0 if its configuration is malformed."""
    return config.find_record(text_of(model, instance, LAW), text_of(model, instance, COEFFICIENTS))


@compiled
def slots_of(model, instance):
    """Return the most contacts of the instance at a time, -1 if its configuration is malformed."""
    slots = config.parse_integer(text_of(model, instance, SLOTS), DEFAULT_SLOTS)
    return slots if 0 < slots <= config.MAX_SLOTS else -1


@compiled
def mode_of(model, instance):
    """Return the mode asked for, by its first letter; -1 if there is none such (auto by default)."""
    text = text_of(model, instance, MODE)
    if text == 0 or n.load_byte(text) in (0, 97):
        return s.AUTO
    return s.EXPLICIT if n.load_byte(text) == 101 else s.IMPLICIT if n.load_byte(text) == 105 else -1


@compiled
def size_of(model, record, slots):
    """Return the length of an instance's state [doubles], as `slots.state_size`."""
    descriptor = int(n.load(record + 8 * config.R_N_DESCRIPTOR))
    return s.DESCRIPTOR + descriptor + 2 * slots * s.SLOT + n.int_field(model, n.M_NV)


def _nstate(model, instance):
    record = record_of(model, instance)
    slots = slots_of(model, instance)
    if record == 0:
        return _INT(-1)
    if slots < 0:
        n.call_python(n.entry(n.EXPLAINER), model, instance, 0)
        return _INT(-1)
    return _INT(size_of(model, record, slots))


def _init(model, data, instance):
    bad = record_of(model, instance) == 0 or slots_of(model, instance) < 0
    body, surface = geom_of(model, instance, GEOM1), geom_of(model, instance, GEOM2)
    bad = bad or body == -2 or surface in (-2, body)
    mode = mode_of(model, instance)
    bad = bad or mode < 0
    bad = bad or (mode == s.EXPLICIT and n.load(record_of(model, instance) + 8 * config.R_NEEDS_HOLD) != 0.0)
    for key in (SEED, SAMPLE, CONTACT):
        number = config.parse_integer(text_of(model, instance, key), 0)
        bad = bad or number < 0 or number > 4294967295
    if bad:
        n.call_python(n.entry(n.EXPLAINER), model, instance, 0)
        return _INT(-1)
    if not options_allow(model):
        return _INT(-1)
    implicit = mode == s.IMPLICIT or n.load(record_of(model, instance) + 8 * config.R_NEEDS_HOLD) != 0.0
    return _INT(-1) if implicit and solver(model, data, instance) == 0 else _INT(0)


def _reset(model, state, plugin_data, instance):
    record = record_of(model, instance)
    slots = slots_of(model, instance)
    n_descriptor = int(n.load(record + 8 * config.R_N_DESCRIPTOR))
    for j in range(size_of(model, record, slots)):
        n.store(state + 8 * j, 0.0)
    n.store(state + 8 * s.LAW, n.load(record + 8 * config.R_LAW))
    n.store(state + 8 * s.GEOM_BODY, float(geom_of(model, instance, GEOM1)))
    n.store(state + 8 * s.GEOM_SURFACE, float(geom_of(model, instance, GEOM2)))
    n.store(state + 8 * s.SEED, float(config.parse_integer(text_of(model, instance, SEED), 0)))
    n.store(state + 8 * s.SAMPLE, float(config.parse_integer(text_of(model, instance, SAMPLE), 0)))
    n.store(state + 8 * s.CONTACT, float(config.parse_integer(text_of(model, instance, CONTACT), 0)))
    n.store(state + 8 * s.N_SLOTS, float(slots))
    n.store(state + 8 * s.N_DESCRIPTOR, float(n_descriptor))
    n.store(state + 8 * s.N_PARAMETERS, n.load(record + 8 * config.R_N_PARAMETERS))
    n.store(state + 8 * s.STICK_SPEED, n.load(record + 8 * config.R_STICK_SPEED))
    n.store(state + 8 * s.HAS_MODE, n.load(record + 8 * config.R_HAS_MODE))
    n.store(state + 8 * s.NEEDS_MASS, n.load(record + 8 * config.R_NEEDS_MASS))
    n.store(state + 8 * s.NEEDS_HOLD, n.load(record + 8 * config.R_NEEDS_HOLD))
    n.store(state + 8 * s.MODE, float(mode_of(model, instance)))
    for j in range(s.N_LIMITS):
        n.store(state + 8 * (s.LIMITS + j), n.load(record + 8 * (config.R_LIMITS + j)))
    n.store(state + 8 * s.ADVANCED, UNSET)
    n.store(state + 8 * s.EVALUATED, UNSET)
    n.store(state + 8 * s.COEFFICIENTS, UNSET)
    for j in range(s.MAX_PARAMETERS):
        n.store(state + 8 * (s.PARAMETERS + j), n.load(record + 8 * (config.R_PARAMETERS + j)))
    for j in range(n_descriptor):
        n.store(state + 8 * (s.DESCRIPTOR + j), n.load(record + 8 * (config.R_DESCRIPTOR + j)))


def _compute(model, data, instance, capability):
    state = state_address(model, data, instance)
    now = n.number_field(data, n.D_TIME)
    start = n.load(state + 8 * s.EVALUATED)
    stage = start < now <= start + 1.0001 * n.number_field(model, n.M_TIMESTEP)
    if not stage or n.load(state + 8 * s.STARTED) == 0.0:
        if n.load(state + 8 * s.STARTED) == 0.0:
            keep_warm_start(model, data, state)
        begin(model, data, state, warm_row(state))
    else:
        solve_new(model, data, state)
    if n.load(state + 8 * s.SOLVED) == 0.0:
        apply(model, data, state, warm_row(state))
    if is_last(model, instance) and any_solved(model, data, instance):
        function = solver(model, data, instance)
        if function == 0:
            n.store(n.pointer_field(data, n.D_QFRC_PASSIVE), math.nan)
        else:
            n.call_function(function, model, data, instance)


def _advance(model, data, instance):
    state = state_address(model, data, instance)
    if n.load(state + 8 * s.STARTED) == 0.0:
        require_passive_forces(model)
    finish(model, data, state)


_CALLBACKS: dict[str, tuple[Any, Any]] = {
    "nstate": (_nstate, _INT(_POINTER, _INT)),
    "init": (_init, _INT(_POINTER, _POINTER, _INT)),
    "reset": (_reset, types.void(_POINTER, _POINTER, _POINTER, _INT)),
    "compute": (_compute, types.void(_POINTER, _POINTER, _INT, _INT)),
    "advance": (_advance, types.void(_POINTER, _POINTER, _INT)),
}
