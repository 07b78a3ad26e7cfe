"""The engine plugin ``stochfric.pair``: friction of a pair of geoms, registered with MuJoCo once per process."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import ctypes
import functools
from typing import Any

import mujoco
from numba import types

from stochfric_mb.compile import compiled
from stochfric_mb.mujoco.contact import tracking
from stochfric_mb.mujoco.memory import engine, layout
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory import words as w
from stochfric_mb.mujoco.memory.structs import model_at
from stochfric_mb.mujoco.plugin import configuration, options
from stochfric_mb.mujoco.plugin.registration import register_plugin

NAME = "stochfric.pair"
"""Name of the plugin in MJCF."""
LAW, COEFFICIENTS, GEOM1, GEOM2, SEED, SAMPLE, CONTACT, SLOTS, MODE = range(9)
"""Places of the keys in `configuration.ATTRIBUTES`."""
DEFAULT_SLOTS = 16
_GEOM_OBJECT = 5
_POINTER, _INT = types.intp, types.int32
_SLOTS_MESSAGE = ctypes.create_string_buffer(
    b"stochfric_mb: more contacts than a friction has slots for; give add_friction(..., slots=...) the most that there can be"
)
_CONDIM_MESSAGE = ctypes.create_string_buffer(
    b"stochfric_mb: a contact of a pair with friction has condim 1, so MuJoCo's solver has no friction for the law to "
    b"steer; give the pair condim 3"
)
_CONE_MESSAGE = ctypes.create_string_buffer(
    b"stochfric_mb: explicit friction on a contact that has MuJoCo's own friction with pyramidal cones, which cannot be "
    b"taken out; give the pair condim 1, or the model cone='elliptic'"
)


@functools.cache
def register() -> int:
    """Return MuJoCo's slot number of the plugin, registered now unless it was before.

    Raises:
        MissingEngineError: this MuJoCo build has another struct layout than this package knows.
    """
    layout.verify()
    w.publish()
    for place, function in (
        (w.READER, configuration.READER), (w.EXPLAINER, configuration.EXPLAINER), (w.OPTIONS_CHECKER, options.CHECKER)
    ):  # fmt: skip
        w.TABLE[place] = ctypes.cast(function, ctypes.c_void_p).value or 0
    w.TABLE[w.NO_PASSIVE_MESSAGE] = ctypes.addressof(options.MESSAGE)
    for place, message in (
        (w.SLOTS_MESSAGE, _SLOTS_MESSAGE), (w.CONDIM_MESSAGE, _CONDIM_MESSAGE), (w.CONE_MESSAGE, _CONE_MESSAGE)
    ):  # fmt: skip
        w.TABLE[place] = ctypes.addressof(message)
    passive = int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_PASSIVE)
    return register_plugin(NAME, configuration.ATTRIBUTES, keys=w.PAIR_KEYS, capability=passive, callbacks=_CALLBACKS)


@compiled
def text_of(model, instance, key):
    """Return the address of a configuration value, 0 if there is none."""
    return engine.mj_getPluginConfig(model, instance, w.entry(w.PAIR_KEYS + key))


@compiled
def geom_of(model, instance, key):
    """Return the id of the geom that a key names, -1 for ``*``, -2 if there is none of that name."""
    text = text_of(model, instance, key)
    if text == 0:
        return -2
    if w.load_byte(text) == 42 and w.load_byte(text + 1) == 0:
        return -1
    geom = engine.mj_name2id(model, _INT(_GEOM_OBJECT), text)
    return geom if geom >= 0 else -2


@compiled
def record_of(model, instance):
    """Return the address of the header that the instance's state starts with, 0 if its configuration is malformed."""
    record = configuration.find_record(text_of(model, instance, LAW), text_of(model, instance, COEFFICIENTS))
    return record + 8 if record != 0 else 0


@compiled
def slots_of(model, instance):
    """Return the most contacts of the instance at a time, -1 if its configuration is malformed."""
    slots = configuration.parse_integer(text_of(model, instance, SLOTS), DEFAULT_SLOTS)
    return slots if 0 < slots <= configuration.MAX_SLOTS else -1


@compiled
def mode_of(model, instance):
    """Return the mode asked for, by its first letter; -1 if there is none such (auto by default)."""
    text = text_of(model, instance, MODE)
    if text == 0 or w.load_byte(text) in (0, 97):
        return s.AUTO
    return s.EXPLICIT if w.load_byte(text) == 101 else s.SOLVER if w.load_byte(text) == 115 else -1


def _nstate(model, instance):
    record, slots = record_of(model, instance), slots_of(model, instance)
    if record == 0:
        return _INT(-1)
    if slots < 0:
        w.call_python(w.entry(w.EXPLAINER), model, instance, 0)
        return _INT(-1)
    return _INT(s.state_size(int(s.header_record(record).n_descriptor), slots))


def _init(model, data, instance):
    record = record_of(model, instance)
    body, surface, mode = geom_of(model, instance, GEOM1), geom_of(model, instance, GEOM2), mode_of(model, instance)
    bad = record == 0 or slots_of(model, instance) < 0 or body == -2 or surface in (-2, body) or mode < 0
    if not bad:
        rest = s.header_record(record).rest
        bad = (mode == s.EXPLICIT and rest == s.RIGID) or (mode == s.SOLVER and rest == s.BRISTLE)
    for key in (SEED, SAMPLE, CONTACT):
        number = configuration.parse_integer(text_of(model, instance, key), 0)
        bad = bad or number < 0 or number > 4294967295
    if bad:
        w.call_python(w.entry(w.EXPLAINER), model, instance, 0)
        return _INT(-1)
    steered = mode != s.EXPLICIT and s.header_record(record).rest != s.BRISTLE
    if not steered:
        drop_native(model, body, surface)
    return _INT(0) if options.options_allow(model, steered) else _INT(-1)


@compiled
def drop_native(model, body, surface):
    """Take the pairs' native friction away for good, in the model: an explicit force replaces it.

    It stays in the model's file, so that a model without this plugin keeps its friction.
    """
    m = model_at(model)
    for i in range(m.npair):
        a, b = w.int_at(m.pair_geom1, i), w.int_at(m.pair_geom2, i)
        if (body in (a, -1) and surface in (b, -1)) or (body in (b, -1) and surface in (a, -1)):
            w.store_int(m.pair_dim + 4 * i, 1)


def _reset(model, state, plugin_data, instance):
    record, slots = record_of(model, instance), slots_of(model, instance)
    length = s.N_HEADER + int(s.header_record(record).n_descriptor)
    w.copy_bytes(record, state, 8 * length)
    for j in range(length, s.state_size(length - s.N_HEADER, slots)):
        w.put(state, j, 0.0)
    header = s.header_record(state)
    header.geom_body, header.geom_surface = geom_of(model, instance, GEOM1), geom_of(model, instance, GEOM2)
    header.seed = configuration.parse_integer(text_of(model, instance, SEED), 0)
    header.sample = configuration.parse_integer(text_of(model, instance, SAMPLE), 0)
    header.contact = configuration.parse_integer(text_of(model, instance, CONTACT), 0)
    header.n_slots, header.mode = slots, mode_of(model, instance)


def _compute(model, data, instance, capability):
    tracking.evaluate(model, data, s.state_address(model, data, instance))


def _advance(model, data, instance):
    state = s.state_address(model, data, instance)
    if s.header_record(state).started == 0.0:
        options.require_passive_forces(model)
    tracking.finish(model, data, state)


_CALLBACKS: dict[str, tuple[Any, Any]] = {
    "nstate": (_nstate, _INT(_POINTER, _INT)),
    "init": (_init, _INT(_POINTER, _POINTER, _INT)),
    "reset": (_reset, types.void(_POINTER, _POINTER, _POINTER, _INT)),
    "compute": (_compute, types.void(_POINTER, _POINTER, _INT, _INT)),
    "advance": (_advance, types.void(_POINTER, _POINTER, _INT)),
}
