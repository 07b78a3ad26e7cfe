"""The engine plugin ``stochfric.pair``: friction of a pair of geoms, registered with MuJoCo once per process."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import ctypes
import functools
from collections.abc import Mapping
from typing import Any

import mujoco
from numba import types

from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError
from stochfric_mb.mujoco.contact import tracking
from stochfric_mb.mujoco.memory import engine, layout
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory import words as w
from stochfric_mb.mujoco.memory.structs import model_at
from stochfric_mb.mujoco.plugin import configuration, options
from stochfric_mb.mujoco.plugin import instance as instances
from stochfric_mb.mujoco.plugin.registration import register_plugin

NAME = "stochfric.pair"
"""Name of the plugin in MJCF."""
ATTRIBUTES = (
    "law", "coefficients", "mode", "slots", "across", "direction", "seed", "sample", "contact", "geom1", "geom2",
)  # fmt: skip
"""Configuration keys; geom1 is the body, geom2 the counter-surface, either may be ``*``."""
GEOM1, GEOM2 = w.PAIR_KEYS + 9, w.PAIR_KEYS + 10
_GEOM_OBJECT = int(mujoco.mjtObj.mjOBJ_GEOM)
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

_PRIMAL_MESSAGE = ctypes.create_string_buffer(
    b"stochfric_mb: friction that differs by direction needs the Newton or CG solver, without noslip iterations"
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
        (w.PAIR_KEYS + w.READER, _READER),
        (w.OPTIONS_CHECKER, options.CHECKER),
        (w.WARNER, options.WARNER),
    ):
        w.TABLE[place] = ctypes.cast(function, ctypes.c_void_p).value or 0
    w.TABLE[w.NO_PASSIVE_MESSAGE] = ctypes.addressof(options.MESSAGE)
    for place, message in (
        (w.SLOTS_MESSAGE, _SLOTS_MESSAGE), (w.CONDIM_MESSAGE, _CONDIM_MESSAGE), (w.CONE_MESSAGE, _CONE_MESSAGE),
        (w.PRIMAL_MESSAGE, _PRIMAL_MESSAGE),
    ):  # fmt: skip
        w.TABLE[place] = ctypes.addressof(message)
    passive = int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_PASSIVE)
    return register_plugin(NAME, ATTRIBUTES, keys=w.PAIR_KEYS, capability=passive, callbacks=_CALLBACKS)


def _require_geoms(model: int, texts: Mapping[str, str]) -> None:
    names = texts["geom1"], texts["geom2"]
    known = [name == "*" or configuration.id_in(model, mujoco.mjtObj.mjOBJ_GEOM, name) >= 0 for name in names]
    if not all(known) or names[0] == names[1]:
        raise InputError(
            f"plugin keys geom1 = {names[0]!r}, geom2 = {names[1]!r}: they must be two geoms of the model (one may be '*')"
        )


_READER = configuration.reader(ATTRIBUTES, _require_geoms)


@compiled
def geom_of(model, instance, key):
    """Return the id of the geom that a key names, -1 for ``*``, -2 if there is none of that name."""
    text = instances.text_of(model, instance, key)
    if text == 0:
        return -2
    if w.load_byte(text) == 42 and w.load_byte(text + 1) == 0:
        return -1
    geom = engine.mj_name2id(model, _INT(_GEOM_OBJECT), text)
    return geom if geom >= 0 else -2


def _nstate(model, instance):
    return _INT(instances.size_of(model, instance, w.PAIR_KEYS))


def _init(model, data, instance):
    record = instances.record_of(model, instance, w.PAIR_KEYS)
    body, surface = geom_of(model, instance, GEOM1), geom_of(model, instance, GEOM2)
    if record == 0 or body == -2 or surface in (-2, body) or not instances.has_address(model, instance, w.PAIR_KEYS):
        instances.explain(model, instance, w.PAIR_KEYS, 0)
        return _INT(-1)
    header = s.header_record(record)
    steered = header.mode != s.EXPLICIT and header.rest != s.BRISTLE
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
    instances.reset(model, state, instance, w.PAIR_KEYS)
    header = s.header_record(state)
    header.geom_body, header.geom_surface = geom_of(model, instance, GEOM1), geom_of(model, instance, GEOM2)


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
