"""The engine plugin ``stochfric.dof``: friction of a joint or a tendon, registered with MuJoCo once per process."""

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
from stochfric_mb.mujoco.joint import friction
from stochfric_mb.mujoco.memory import engine
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory import words as w
from stochfric_mb.mujoco.memory.structs import model_at
from stochfric_mb.mujoco.plugin import configuration, options
from stochfric_mb.mujoco.plugin.pair import register
from stochfric_mb.mujoco.plugin.registration import register_plugin

NAME = "stochfric.dof"
"""Name of the plugin in MJCF."""
ATTRIBUTES = ("law", "coefficients", "joint", "tendon", "normal_force", "seed", "sample", "contact", "radius", "mode")
"""Configuration keys; one of joint and tendon is given. normal_force is the given load [N or N m]; without it, radius [m] is
that of the bearing on which the joint's reaction rubs (1 for a slide joint)."""
LAW, COEFFICIENTS, JOINT, TENDON, NORMAL_FORCE, SEED, SAMPLE, CONTACT, RADIUS, MODE = range(10)
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
    w.TABLE[w.NUMBER_READER] = ctypes.cast(_READER, ctypes.c_void_p).value or 0
    w.TABLE[w.JOINT_EXPLAINER] = ctypes.cast(_EXPLAIN, ctypes.c_void_p).value or 0
    passive = int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_PASSIVE)
    slot = register_plugin(NAME, ATTRIBUTES, keys=w.JOINT_KEYS, capability=passive, callbacks=_CALLBACKS)
    w.TABLE[w.JOINTS_PLUGIN] = slot
    return slot


def _read_number(text: bytes | None, key: int, _: int) -> int:
    """Keep the number that a text stands for under its key (not a number if it stands for none)."""
    try:
        value = float((text or b"").decode())
    except ValueError:
        value = math.nan
    _numbers[key] = (ctypes.c_double * 2)(key, value)
    w.TABLE[w.CONFIGURATIONS + key % w.N_CONFIGURATIONS] = ctypes.addressof(_numbers[key])
    return 1


_READER = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_char_p, ctypes.c_int64, ctypes.c_int64)(_read_number)


def _number(text: str) -> float | str:
    """Return the number that a text stands for, or the text itself."""
    try:
        return float(text)
    except ValueError:
        return text


def _explain_refusal(model: int, instance: int, _: int) -> int:
    """Raise the error that says why an instance was refused; ctypes prints it, MuJoCo refuses the model."""
    texts = {key: engine.plugin_text(model, instance, key) for key in ATTRIBUTES}
    configuration.record_of(texts["law"], texts["coefficients"], 0)
    configuration.require_mode(configuration.friction_of(texts["law"], "").law, texts["mode"] or "auto")
    for key in ("seed", "sample", "contact"):
        if texts[key] and not (texts[key].isdecimal() and int(texts[key]) < 2**32):
            raise InputError(f"plugin key {key} = {texts[key]!r} is not a whole number in [0, 2^32); write one")
    if bool(texts["normal_force"]) == bool(texts["radius"]):
        raise InputError("plugin keys normal_force and radius: give one of them, the load or the radius of the bearing")
    for key in ("normal_force", "radius"):
        if texts[key]:
            require_number(f"plugin key {key}", _number(texts[key]), above=0.0)
    raise InputError(
        f"plugin keys joint = {texts['joint']!r}, tendon = {texts['tendon']!r}: give one of them, the name of a hinge or "
        "slide joint or of a tendon of the model (a tendon with normal_force)"
    )


_EXPLAIN = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)(_explain_refusal)


@compiled
def text_of(model, instance, key):
    """Return the address of a configuration value, 0 if there is none."""
    return engine.mj_getPluginConfig(model, instance, w.entry(w.JOINT_KEYS + key))


@compiled
def given(text):
    """Return whether a configuration value is not empty."""
    return text != 0 and w.load_byte(text) != 0


@compiled
def number_of(text):
    """Return the number that a C string stands for, not a number if it stands for none."""
    key = configuration.text_hash(text, 88172645463325252) & 9007199254740991
    place = w.CONFIGURATIONS + key % w.N_CONFIGURATIONS
    for _ in range(2):
        address = w.entry(place)
        if address != 0 and w.load(address) == float(key):
            return w.load(address + 8)
        w.call_python(w.entry(w.NUMBER_READER), text, key, 0)
    return math.nan


@compiled
def object_of(model, instance):
    """Return (0 joint or 1 tendon, its number), the number -1 if there is none of that name or of a wrong kind."""
    joint, tendon = text_of(model, instance, JOINT), text_of(model, instance, TENDON)
    if given(joint) == given(tendon):
        return 0, -1
    if given(tendon):
        return 1, engine.mj_name2id(model, _INT(_TENDON_OBJECT), tendon)
    number = engine.mj_name2id(model, _INT(_JOINT_OBJECT), joint)
    if number >= 0 and w.int_at(model_at(model).jnt_type, number) < _SLIDE:
        return 0, -1
    return 0, number


@compiled
def record_of(model, instance):
    """Return the address of the header that the instance's state starts with, 0 if its configuration is malformed."""
    record = configuration.find_record(text_of(model, instance, LAW), text_of(model, instance, COEFFICIENTS))
    return record + 8 if record != 0 else 0


@compiled
def mode_of(model, instance):
    """Return the mode asked for, by its first letter; -1 if there is none such (auto by default)."""
    text = text_of(model, instance, MODE)
    if text == 0 or w.load_byte(text) in (0, 97):
        return s.AUTO
    return s.EXPLICIT if w.load_byte(text) == 101 else s.SOLVER if w.load_byte(text) == 115 else -1


def _nstate(model, instance):
    record = record_of(model, instance)
    if record == 0:
        return _INT(-1)
    return _INT(s.state_size(int(s.header_record(record).n_descriptor), 1))


def _init(model, data, instance):
    record, mode = record_of(model, instance), mode_of(model, instance)
    kind, number = object_of(model, instance)
    load, radius = text_of(model, instance, NORMAL_FORCE), text_of(model, instance, RADIUS)
    bad = record == 0 or number < 0 or given(load) == given(radius) or (kind == 1 and given(radius)) or mode < 0
    if not bad:
        bad = not 0.0 < number_of(load if given(load) else radius) < 1.0e300
        rest = s.header_record(record).rest
        bad = bad or (mode == s.EXPLICIT and rest == s.RIGID) or (mode == s.SOLVER and rest == s.BRISTLE)
    for key in (SEED, SAMPLE, CONTACT):
        value = configuration.parse_integer(text_of(model, instance, key), 0)
        bad = bad or value < 0 or value > 4294967295
    if bad:
        w.call_python(w.entry(w.JOINT_EXPLAINER), model, instance, 0)
        return _INT(-1)
    return _INT(0) if options.options_allow(model, False) else _INT(-1)


def _reset(model, state, plugin_data, instance):
    record = record_of(model, instance)
    length = s.N_HEADER + int(s.header_record(record).n_descriptor)
    w.copy_bytes(record, state, 8 * length)
    for j in range(length, s.state_size(length - s.N_HEADER, 1)):
        w.put(state, j, 0.0)
    header = s.header_record(state)
    header.geom_body, header.geom_surface = object_of(model, instance)
    if given(text_of(model, instance, NORMAL_FORCE)):
        header.load = number_of(text_of(model, instance, NORMAL_FORCE))
    else:
        header.radius = number_of(text_of(model, instance, RADIUS))
    header.seed = configuration.parse_integer(text_of(model, instance, SEED), 0)
    header.sample = configuration.parse_integer(text_of(model, instance, SAMPLE), 0)
    header.contact = configuration.parse_integer(text_of(model, instance, CONTACT), 0)
    header.n_slots, header.mode = 1, mode_of(model, instance)


def _compute(model, data, instance, capability):
    friction.evaluate(model, data, s.state_address(model, data, instance))


def _advance(model, data, instance):
    state = s.state_address(model, data, instance)
    if s.header_record(state).started == 0.0:
        options.require_passive_forces(model)
    friction.finish(model, data, state)


_CALLBACKS: dict[str, tuple[Any, Any]] = {
    "nstate": (_nstate, _INT(_POINTER, _INT)),
    "init": (_init, _INT(_POINTER, _POINTER, _INT)),
    "reset": (_reset, types.void(_POINTER, _POINTER, _POINTER, _INT)),
    "compute": (_compute, types.void(_POINTER, _POINTER, _INT, _INT)),
    "advance": (_advance, types.void(_POINTER, _POINTER, _INT)),
}
