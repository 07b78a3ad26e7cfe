"""The engine plugin ``stochfric.dof``: friction of a joint or a tendon, registered with MuJoCo once per process."""

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
from stochfric_mb.mujoco.joint import friction
from stochfric_mb.mujoco.memory import engine
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory import words as w
from stochfric_mb.mujoco.memory.structs import model_at
from stochfric_mb.mujoco.plugin import configuration, options
from stochfric_mb.mujoco.plugin import instance as instances
from stochfric_mb.mujoco.plugin.pair import register
from stochfric_mb.mujoco.plugin.registration import register_plugin

NAME = "stochfric.dof"
"""Name of the plugin in MJCF."""
ATTRIBUTES = (
    "law", "coefficients", "mode", "normal_force", "radius", "tendon", "seed", "sample", "contact", "joint",
)  # fmt: skip
"""Configuration keys; one of joint and tendon is given. normal_force is the given load [N or N m]; without it, radius [m] is
that of the bearing on which the joint's reaction rubs (1 for a slide joint)."""
TENDON, JOINT = w.JOINT_KEYS + 5, w.JOINT_KEYS + 9
_JOINT_OBJECT, _TENDON_OBJECT = int(mujoco.mjtObj.mjOBJ_JOINT), int(mujoco.mjtObj.mjOBJ_TENDON)
_SLIDE = int(mujoco.mjtJoint.mjJNT_SLIDE)
_POINTER, _INT = types.intp, types.int32


@functools.cache
def register_joints() -> int:
    """Return MuJoCo's slot number of the plugin, registered now unless it was before.

    Raises:
        MissingEngineError: this MuJoCo build has another struct layout than this package knows.
    """
    register()
    w.TABLE[w.JOINT_KEYS + w.READER] = ctypes.cast(_READER, ctypes.c_void_p).value or 0
    passive = int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_PASSIVE)
    slot = register_plugin(NAME, ATTRIBUTES, keys=w.JOINT_KEYS, capability=passive, callbacks=_CALLBACKS)
    w.TABLE[w.JOINTS_PLUGIN] = slot
    return slot


def _require_place(model: int, texts: Mapping[str, str]) -> None:
    if bool(texts["normal_force"]) == bool(texts["radius"]):
        raise InputError("plugin keys normal_force and radius: give one of them, the load or the radius of the bearing")
    kinds = {"joint": mujoco.mjtObj.mjOBJ_JOINT, "tendon": mujoco.mjtObj.mjOBJ_TENDON}
    known = [configuration.id_in(model, kind, texts[key]) >= 0 for key, kind in kinds.items() if texts[key]]
    if known != [True] or (texts["tendon"] and texts["radius"]):
        raise InputError(
            f"plugin keys joint = {texts['joint']!r}, tendon = {texts['tendon']!r}: give one of them, the name of a hinge or "
            "slide joint or of a tendon of the model (a tendon with normal_force)"
        )


_READER = configuration.reader(ATTRIBUTES, _require_place)


@compiled
def object_of(model, instance):
    """Return (0 joint or 1 tendon, its number), the number -1 if there is none of that name or of a wrong kind."""
    joint, tendon = instances.text_of(model, instance, JOINT), instances.text_of(model, instance, TENDON)
    if instances.is_given(joint) == instances.is_given(tendon):
        return 0, -1
    if instances.is_given(tendon):
        return 1, engine.mj_name2id(model, _INT(_TENDON_OBJECT), tendon)
    number = engine.mj_name2id(model, _INT(_JOINT_OBJECT), joint)
    if number >= 0 and w.int_at(model_at(model).jnt_type, number) < _SLIDE:
        return 0, -1
    return 0, number


def _nstate(model, instance):
    return _INT(instances.size_of(model, instance, w.JOINT_KEYS))


def _init(model, data, instance):
    record = instances.record_of(model, instance, w.JOINT_KEYS)
    _, number = object_of(model, instance)
    if record == 0 or number < 0 or not instances.has_address(model, instance, w.JOINT_KEYS):
        instances.explain(model, instance, w.JOINT_KEYS, 0)
        return _INT(-1)
    return _INT(0) if options.options_allow(model, False) else _INT(-1)


def _reset(model, state, plugin_data, instance):
    instances.reset(model, state, instance, w.JOINT_KEYS)
    header = s.header_record(state)
    header.geom_body, header.geom_surface = object_of(model, instance)


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
