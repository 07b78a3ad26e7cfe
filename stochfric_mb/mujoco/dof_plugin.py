"""The engine plugin ``stochfric.dof``: friction on a joint or a tendon, registered with MuJoCo once per process."""

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

from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError, require_number
from stochfric_mb.laws import Law
from stochfric_mb.mujoco import config, dof
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.coordinates import KIND, LOAD, OBJECT
from stochfric_mb.mujoco.options import CHECKER, options_allow, require_passive_forces
from stochfric_mb.mujoco.plugin import UNSET, register
from stochfric_mb.mujoco.registration import register_plugin

NAME = "stochfric.dof"
"""Name of the plugin in MJCF."""
ATTRIBUTES = ("law", "coefficients", "joint", "tendon", "normal_force", "seed", "sample", "contact")
"""Configuration keys; one of joint and tendon is given. normal_force is the given load [N or N m]."""
LAW, COEFFICIENTS, JOINT, TENDON, NORMAL_FORCE, SEED, SAMPLE, CONTACT = range(8)
_KEYS, _NUMBER_READER, _EXPLAINER = n.FURTHER + 40, n.FURTHER + 37, n.FURTHER + 38
_JOINT_OBJECT, _TENDON_OBJECT = int(mujoco.mjtObj.mjOBJ_JOINT), int(mujoco.mjtObj.mjOBJ_TENDON)
_SLIDE = int(mujoco.mjtJoint.mjJNT_SLIDE)
_POINTER, _INT = types.intp, types.int32
_numbers: dict[int, Any] = {}


@functools.cache
def register_joints() -> int:
    """Return MuJoCo's slot number of the plugin, registered now unless it was before.

    Raises:
        MissingEngineError: this MuJoCo build has another struct layout than this package knows.
    """
    register()
    n.TABLE[_NUMBER_READER] = ctypes.cast(_READER, ctypes.c_void_p).value or 0
    n.TABLE[n.OPTIONS_CHECKER] = ctypes.cast(CHECKER, ctypes.c_void_p).value or 0
    n.TABLE[_EXPLAINER] = ctypes.cast(_EXPLAIN, ctypes.c_void_p).value or 0
    passive = int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_PASSIVE)
    slot = register_plugin(NAME, ATTRIBUTES, keys=_KEYS, capability=passive, callbacks=_CALLBACKS)
    n.TABLE[n.JOINTS_SLOT] = slot
    return slot


def require_no_hold(law: Law) -> None:
    """Refuse a law that needs the holding force.

    Raises:
        InputError: says what to use instead.
    """
    if law.needs_holding_force:
        raise InputError(
            f"law {law.kind!r} needs the force that would hold the contact, which joints and tendons do not give; use "
            "elastic_stick with a small e_lim: it holds at any step"
        )


def _read_number(text: bytes | None, key: int, _: int) -> int:
    """Keep the number that a text stands for under its key (not a number if it stands for none)."""
    try:
        value = float((text or b"").decode())
    except ValueError:
        value = math.nan
    _numbers[key] = (ctypes.c_double * 2)(key, value)
    n.TABLE[n.CONFIGURATIONS + key % n.N_CONFIGURATIONS] = ctypes.addressof(_numbers[key])
    return 1


_READER = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_char_p, ctypes.c_int64, ctypes.c_int64)(_read_number)


def _explain_refusal(model: int, instance: int, _: int) -> int:
    """Raise the error that says why an instance was refused; ctypes prints it, MuJoCo refuses the model."""
    texts = {key: n.plugin_text(model, instance, key) for key in ATTRIBUTES}
    config.record_of(texts["law"], texts["coefficients"], 0)
    require_no_hold(config.friction_of(texts["law"], "").law)
    for key in ("seed", "sample", "contact"):
        if texts[key] and not (texts[key].isdecimal() and int(texts[key]) < 2**32):
            raise InputError(f"plugin key {key} = {texts[key]!r} is not a whole number in [0, 2^32); write one")
    require_number("plugin key normal_force", texts["normal_force"] or "none", above=0.0, unit="N or N m")
    raise InputError(
        f"plugin keys joint = {texts['joint']!r}, tendon = {texts['tendon']!r}: give one of them, the name of a hinge or "
        "slide joint or of a tendon of the model"
    )


_EXPLAIN = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)(_explain_refusal)


@compiled
def text_of(model, instance, key):
    """Return the address of a configuration value, 0 if there is none."""
    return n.mj_getPluginConfig(model, instance, n.entry(_KEYS + key))


@compiled
def given(text):
    """Return whether a configuration value is not empty."""
    return text != 0 and n.load_byte(text) != 0


@compiled
def number_of(text):
    """Return the number that a C string stands for, not a number if it stands for none."""
    key = config.text_hash(text, 88172645463325252) & 9007199254740991
    place = n.CONFIGURATIONS + key % n.N_CONFIGURATIONS
    for _ in range(2):
        address = n.entry(place)
        if address != 0 and n.load(address) == float(key):
            return n.load(address + 8)
        n.call_python(n.entry(_NUMBER_READER), text, key, 0)
    return math.nan


@compiled
def object_of(model, instance):
    """Return (0 joint or 1 tendon, its number), the number -1 if there is none of that name or of a wrong kind."""
    joint, tendon = text_of(model, instance, JOINT), text_of(model, instance, TENDON)
    if given(joint) == given(tendon):
        return 0, -1
    if given(tendon):
        return 1, n.mj_name2id(model, _INT(_TENDON_OBJECT), tendon)
    number = n.mj_name2id(model, _INT(_JOINT_OBJECT), joint)
    if number >= 0 and n.load_int(n.pointer_field(model, n.M_JOINT_TYPE) + 4 * number) < _SLIDE:
        return 0, -1
    return 0, number


@compiled
def record_of(model, instance):
    """Return the address of the instance's numbers, 0 if its configuration is malformed."""
    return config.find_record(text_of(model, instance, LAW), text_of(model, instance, COEFFICIENTS))


def _nstate(model, instance):
    record = record_of(model, instance)
    if record == 0:
        return _INT(-1)
    return _INT(s.DESCRIPTOR + int(n.load(record + 8 * config.R_N_DESCRIPTOR)) + 2 * s.SLOT)


def _init(model, data, instance):
    record = record_of(model, instance)
    bad = record == 0 or n.load(record + 8 * config.R_NEEDS_HOLD) != 0.0
    _, number = object_of(model, instance)
    load = number_of(text_of(model, instance, NORMAL_FORCE))
    bad = bad or number < 0 or not 0.0 < load < 1.0e300
    for key in (SEED, SAMPLE, CONTACT):
        value = config.parse_integer(text_of(model, instance, key), 0)
        bad = bad or value < 0 or value > 4294967295
    if bad:
        n.call_python(n.entry(_EXPLAINER), model, instance, 0)
        return _INT(-1)
    return _INT(0) if options_allow(model) else _INT(-1)


def _reset(model, state, plugin_data, instance):
    record = record_of(model, instance)
    n_descriptor = int(n.load(record + 8 * config.R_N_DESCRIPTOR))
    for j in range(s.DESCRIPTOR + n_descriptor + 2 * s.SLOT):
        n.store(state + 8 * j, 0.0)
    kind, number = object_of(model, instance)
    n.store(state + 8 * KIND, float(kind))
    n.store(state + 8 * OBJECT, float(number))
    n.store(state + 8 * LOAD, number_of(text_of(model, instance, NORMAL_FORCE)))
    n.store(state + 8 * s.LAW, n.load(record + 8 * config.R_LAW))
    n.store(state + 8 * s.SEED, float(config.parse_integer(text_of(model, instance, SEED), 0)))
    n.store(state + 8 * s.SAMPLE, float(config.parse_integer(text_of(model, instance, SAMPLE), 0)))
    n.store(state + 8 * s.CONTACT, float(config.parse_integer(text_of(model, instance, CONTACT), 0)))
    n.store(state + 8 * s.N_SLOTS, 1.0)
    n.store(state + 8 * s.N_DESCRIPTOR, float(n_descriptor))
    n.store(state + 8 * s.N_PARAMETERS, n.load(record + 8 * config.R_N_PARAMETERS))
    n.store(state + 8 * s.STICK_SPEED, n.load(record + 8 * config.R_STICK_SPEED))
    n.store(state + 8 * s.HAS_MODE, n.load(record + 8 * config.R_HAS_MODE))
    n.store(state + 8 * s.NEEDS_MASS, n.load(record + 8 * config.R_NEEDS_MASS))
    n.store(state + 8 * s.ADVANCED, UNSET)
    n.store(state + 8 * s.EVALUATED, UNSET)
    n.store(state + 8 * s.COEFFICIENTS, UNSET)
    for j in range(s.MAX_PARAMETERS):
        n.store(state + 8 * (s.PARAMETERS + j), n.load(record + 8 * (config.R_PARAMETERS + j)))
    for j in range(n_descriptor):
        n.store(state + 8 * (s.DESCRIPTOR + j), n.load(record + 8 * (config.R_DESCRIPTOR + j)))


def _compute(model, data, instance, capability):
    dof.compute(model, data, instance)


def _advance(model, data, instance):
    state = dof.state_of(model, data, instance)
    if n.load(state + 8 * s.STARTED) == 0.0:
        require_passive_forces(model)
    dof.finish(data, state)


_CALLBACKS: dict[str, tuple[Any, Any]] = {
    "nstate": (_nstate, _INT(_POINTER, _INT)),
    "init": (_init, _INT(_POINTER, _POINTER, _INT)),
    "reset": (_reset, types.void(_POINTER, _POINTER, _POINTER, _INT)),
    "compute": (_compute, types.void(_POINTER, _POINTER, _INT, _INT)),
    "advance": (_advance, types.void(_POINTER, _POINTER, _INT)),
}
