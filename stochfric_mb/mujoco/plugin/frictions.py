"""The engine plugins ``stochfric.pair`` and ``stochfric.dof``: friction of pairs of geoms, and of joints and tendons."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError
from stochfric_mb.mujoco.contact import tracking
from stochfric_mb.mujoco.joint import friction as coordinates
from stochfric_mb.mujoco.memory import engine, table
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.structs import DATA, MODEL, array_at, data_at, model_at, record_at, struct, verify
from stochfric_mb.mujoco.plugin import options
from stochfric_mb.mujoco.plugin.configuration import law_of
from stochfric_mb.mujoco.plugin.registration import register_plugin
from stochfric_mb.numerics import memory as w

PAIRS, DOFS = "stochfric.pair", "stochfric.dof"
"""Names of the plugins in MJCF."""
COMMON = ("law", "coefficients", "mode", "seed", "sample", "contact")
KEYS = {
    PAIRS: (*COMMON, "slots", "across", "direction", "geom1", "geom2"),
    DOFS: (*COMMON, "normal_force", "radius", "tendon", "joint"),
}
"""Configuration keys. geom1 is the body, geom2 the counter-surface, either may be ``*``. Of joint and tendon one is given;
normal_force is the given load [N or N m]; without it, radius [m] is that of the bearing on which the joint's reaction rubs (1
for a slide joint)."""
ANY = "*"
"""Stands for every geom that the other one can collide with; -1 as a number."""
NO_GEOM = -2


@functools.cache
def slot_of(name: str) -> int:
    """Return MuJoCo's slot number of one of the two plugins, registered now unless it was before.

    Raises:
        MissingEngineError: this MuJoCo build has another struct layout than this package knows.
    """
    verify()
    compute, advance = (_compute_pair, _advance_pair) if name == PAIRS else (_compute_dof, _advance_dof)
    return register_plugin(
        name,
        KEYS[name],
        capability=mujoco.mjtPluginCapabilityBit.mjPLUGIN_PASSIVE,
        first={"nstate": functools.partial(_nstate, name), "init": functools.partial(_init, name)},
        compiled={"copy": copy, "reset": _reset, "compute": compute, "advance": advance},
    )


# --- what Python looks at once ---------------------------------------------------------------------------------------


def _nstate(name: str, model: int, instance: int) -> int:
    return int(_law(name, model, instance)["n_all"][0])


def _init(name: str, model: int, data: int, instance: int) -> int:
    law = _law(name, model, instance)
    header = record_at(s.HEADER, law["start"][0])
    steered = name == PAIRS and header.mode != s.EXPLICIT
    options.check_options(record_at(MODEL, model), steered=steered, coordinate=name == DOFS)
    if name == DOFS:
        _require_row(model, header)
    elif not steered:
        _drop_native(model, int(header.geom_body), int(header.geom_surface))
    if steered:
        options.require_elliptic(record_at(MODEL, model))
        options.warn_of_stiff_damping(model)
    array_at(record_at(DATA, data).plugin_data, instance + 1, np.int64)[instance] = law["key"][0]
    return 0


def _law(name: str, model: int, instance: int) -> Any:
    """Return the `memory.state.LAW` of an instance, all of whose keys are checked.

    Raises:
        InputError: a key is malformed, or names what the model does not have.
    """
    texts = {key: engine.plugin_text(model, instance, key) for key in KEYS[name]}
    for key in ("seed", "sample", "contact"):
        if texts[key] and not (texts[key].isdecimal() and int(texts[key]) < 2**32):
            raise InputError(f"plugin key {key} = {texts[key]!r} is not a whole number in [0, 2^32); write one")
    return law_of(texts, _geoms(model, texts) if name == PAIRS else _coordinate(model, texts))


def _geoms(model: int, texts: Mapping[str, str]) -> tuple[int, int, int]:
    names = texts["geom1"], texts["geom2"]
    geoms = [-1 if name == ANY else engine.id_in(model, mujoco.mjtObj.mjOBJ_GEOM, name, NO_GEOM) for name in names]
    if NO_GEOM in geoms or names[0] == names[1]:
        raise InputError(
            f"plugin keys geom1 = {names[0]!r}, geom2 = {names[1]!r}: they must be two geoms of the model (one may be '*')"
        )
    return s.PAIR, geoms[0], geoms[1]


def covers(pair: tuple[Any, Any], geoms: tuple[Any, Any]) -> bool:
    """Return whether a pair, one of which may stand for any (``"*"``, or number -1), is of two geoms in either order."""
    return any(all(mine in (ANY, -1, its) for mine, its in zip(p, geoms, strict=True)) for p in (pair, pair[::-1]))


def _coordinate(model: int, texts: Mapping[str, str]) -> tuple[int, int, int]:
    if bool(texts["normal_force"]) == bool(texts["radius"]):
        raise InputError("plugin keys normal_force and radius: give one of them, the load or the radius of the bearing")
    joint, tendon = texts["joint"], texts["tendon"]
    kind = mujoco.mjtObj.mjOBJ_TENDON if tendon else mujoco.mjtObj.mjOBJ_JOINT
    number = engine.id_in(model, kind, tendon or joint, -1)
    kinds = array_at(record_at(MODEL, model).jnt_type, number + 1, np.int32)
    turns = not tendon and number >= 0 and kinds[number] < int(mujoco.mjtJoint.mjJNT_SLIDE)
    if number < 0 or turns or bool(joint) == bool(tendon) or (tendon and texts["radius"]):
        raise InputError(
            f"plugin keys joint = {joint!r}, tendon = {tendon!r}: give one of them, the name of a hinge or slide joint or of a "
            "tendon of the model (a tendon with normal_force)"
        )
    return s.TENDON if tendon else s.JOINT, number, number


def _drop_native(model: int, body: int, surface: int) -> None:
    """Take the pairs' native friction away for good, in the model: an explicit force replaces it.

    It stays in the model's file, so that a model without this plugin keeps its friction.
    """
    m = record_at(MODEL, model)
    first, second, dims = (array_at(p, m.npair, np.int32) for p in (m.pair_geom1, m.pair_geom2, m.pair_dim))
    for i, geoms in enumerate(zip(first, second, strict=True)):
        if covers((body, surface), geoms):
            dims[i] = 1


def _require_row(model: int, header: Any) -> None:
    """Let MuJoCo make the friction row that the law steers where the model, one from XML, gives no frictionloss."""
    m, number = record_at(struct("mjModel"), model), int(header.geom_surface)
    if header.place == s.TENDON:
        loss = array_at(m.tendon_frictionloss, number + 1)[number:]
    else:
        dof = int(array_at(m.jnt_dofadr, number + 1, np.int32)[number])
        loss = array_at(m.dof_frictionloss, dof + 1)[dof:]
    loss[loss == 0.0] = header.parameters[0] * (header.load or 1.0)


# --- what MuJoCo calls -----------------------------------------------------------------------------------------------


def copy(target, model, source, instance):
    """Let data that are a copy find what the original finds."""
    w.put_word(data_at(target).plugin_data, instance, w.word_at(data_at(source).plugin_data, instance))


def _reset(model, state, plugin_data, instance):
    address = table.address_of(plugin_data)
    if address == 0:
        return
    s.restart(address, state)
    header = s.header_record(state)
    header.seed = number_in(engine.mj_getPluginConfig(model, instance, w.c_string("seed")))
    header.sample = number_in(engine.mj_getPluginConfig(model, instance, w.c_string("sample")))
    header.contact = number_in(engine.mj_getPluginConfig(model, instance, w.c_string("contact")))


@compiled
def number_in(text):
    """Return the whole number of the C string at ``text``, which holds nothing else; 0 for none and for an empty one."""
    value, i = 0, 0
    while text != 0 and w.byte_at(text, i) != 0:
        value = 10 * value + w.byte_at(text, i) - 48
        i += 1
    return value


def _compute_pair(model, data, instance, capability):
    tracking.evaluate(model, data, s.state_address(model, data, instance), s.law_in(data, instance))


def _compute_dof(model, data, instance, capability):
    coordinates.evaluate(model, data, s.state_address(model, data, instance), s.law_in(data, instance))


def _advance_pair(model, data, instance):
    require_passive_forces(model, data, instance)
    tracking.finish(model, data, s.state_address(model, data, instance))


def _advance_dof(model, data, instance):
    require_passive_forces(model, data, instance)
    coordinates.finish(model, data, s.state_address(model, data, instance))


SWITCHED_OFF = f"stochfric_mb: {options.SWITCHED_OFF}"


@compiled
def require_passive_forces(model, data, instance):
    """Stop with MuJoCo's error where passive forces are off: they were switched off after the data were made."""
    header = s.header_record(s.state_address(model, data, instance))
    if header.started == 0.0 and model_at(model).disableflags & options.NO_PASSIVE_FORCES == options.NO_PASSIVE_FORCES:
        engine.mju_error(w.c_string(SWITCHED_OFF))
