"""The engine plugin ``stochfric.sensor``: what a friction instance does, as MuJoCo sensor data.

A sensor names its friction instance, and how many contacts it lists::

    <instance name="watch"><config key="friction" value="friction_box_belt"/><config key="contacts" value="4"/></instance>
    ...
    <sensor><plugin name="rub" plugin="stochfric.sensor" instance="watch"/></sensor>

Its data are `FIELDS`, then `CONTACT_FIELDS` for each contact listed (zeros where there is none).
"""

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
from stochfric_mb.errors import InputError, require_name
from stochfric_mb.mujoco.contact import tracking
from stochfric_mb.mujoco.joint import friction
from stochfric_mb.mujoco.memory import engine
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory import words as w
from stochfric_mb.mujoco.memory.structs import data_at, model_at
from stochfric_mb.mujoco.plugin.instance import parse_integer
from stochfric_mb.mujoco.plugin.joint import NAME as JOINTS
from stochfric_mb.mujoco.plugin.joint import register_joints
from stochfric_mb.mujoco.plugin.pair import NAME as PAIRS
from stochfric_mb.mujoco.plugin.pair import register
from stochfric_mb.mujoco.plugin.registration import register_plugin

NAME = "stochfric.sensor"
"""Name of the plugin in MJCF."""
ATTRIBUTES = ("friction", "contacts")
"""Configuration keys: name of the friction instance, number of contacts listed (0 if not given)."""
FIELDS = ("force_x", "force_y", "force_z", "normal_force", "mu_s", "mu_k", "stick", "dissipated", "contacts")
"""First numbers of a sensor: sums of the friction force on the body (world axes; along the coordinate for a joint or
tendon) [N] and of the normal force [N], means of mu_s, mu_k and of the stick flag, sum of the dissipated energy [J] and
number of the contacts there are."""
CONTACT_FIELDS = ("force_x", "force_y", "force_z", "normal_force", "mu_s", "mu_k", "stick", "dissipated")
"""Numbers of each contact listed."""
MAX_CONTACTS = 64
_PLUGIN_OBJECT = int(mujoco.mjtObj.mjOBJ_PLUGIN)
_POINTER, _INT = types.intp, types.int32


@functools.cache
def register_sensors() -> int:
    """Return MuJoCo's slot number of the plugin, registered now unless it was before."""
    register_joints()
    w.TABLE[w.SENSED_PLUGIN] = register()
    w.TABLE[w.SENSOR_KEYS + w.READER] = ctypes.cast(_EXPLAIN, ctypes.c_void_p).value or 0
    stage = int(mujoco.mjtStage.mjSTAGE_ACC)
    sensor = int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_SENSOR)
    return register_plugin(NAME, ATTRIBUTES, keys=w.SENSOR_KEYS, capability=sensor, callbacks=_CALLBACKS, stage=stage)


def add_sensor(spec: mujoco.MjSpec, friction: str, *, name: str = "", contacts: int = 0) -> str:
    """Return the name of a sensor that now measures a friction instance.

    Args:
        spec: the model, before it is compiled; changed in place.
        friction: name that `add_friction` returned.
        name: name of the sensor; that of the friction if not given.
        contacts: how many contacts to list after the sums.

    Raises:
        InputError: no such friction instance, a name that is taken, or too many contacts.
    """
    register_sensors()
    require_name("friction", friction, [p.name for p in spec.plugins if p.plugin_name in (PAIRS, JOINTS)])
    if int(contacts) != contacts or not 0 <= contacts <= MAX_CONTACTS:
        raise InputError(f"contacts = {contacts!r} must be a whole number from 0 to {MAX_CONTACTS}")
    name = name or friction
    instance = f"sensor_{name}"
    if name in {x.name for x in spec.sensors} or instance in {p.name for p in spec.plugins}:
        raise InputError(f"the model has a sensor {name!r} already; give another name")
    plugin: Any = spec.add_plugin(name=instance, plugin_name=NAME, active=True)
    plugin.config = {"friction": friction, "contacts": str(int(contacts))}
    spec.activate_plugin(NAME)
    sensor: Any = spec.add_sensor(name=name, type=mujoco.mjtSensor.mjSENS_PLUGIN)
    sensor.plugin.name = instance
    sensor.plugin.plugin_name = NAME
    sensor.plugin.active = True
    return name


def _explain_refusal(model: int, instance: int, _: int) -> int:
    friction, contacts = (engine.plugin_text(model, instance, key) for key in ATTRIBUTES)
    raise InputError(
        f"plugin keys friction = {friction!r}, contacts = {contacts!r}: friction must name an instance of {PAIRS} or {JOINTS} "
        f"in the model, and contacts be a whole number from 0 to {MAX_CONTACTS}"
    )


_EXPLAIN = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)(_explain_refusal)


@compiled
def watched(model, instance):
    """Return the friction instance that a sensor instance names, -1 if there is none."""
    text = engine.mj_getPluginConfig(model, instance, w.entry(w.SENSOR_KEYS))
    number = engine.mj_name2id(model, _INT(_PLUGIN_OBJECT), text) if text != 0 else -1
    if number < 0:
        return -1
    kind = w.int_at(model_at(model).plugin, number)
    return number if kind in (w.entry(w.SENSED_PLUGIN), w.entry(w.JOINTS_PLUGIN)) else -1


@compiled
def listed(model, instance):
    """Return how many contacts a sensor instance lists, -1 if its key is malformed."""
    count = parse_integer(engine.mj_getPluginConfig(model, instance, w.entry(w.SENSOR_KEYS + 1)), 0)
    return count if 0 <= count <= MAX_CONTACTS else -1


@compiled
def report(model, data, instance):
    """Bring what can be read of a friction instance up to date; return the block to read, 0 committed or 1 current."""
    state = s.state_address(model, data, instance)
    if w.int_at(model_at(model).plugin, instance) == w.entry(w.JOINTS_PLUGIN):
        return friction.report(model, data, state)
    return tracking.report(model, data, state)


@compiled
def measure(model, data, instance, sensor):
    """Write a sensor's data from the slots of its friction."""
    out = data_at(data).sensordata + 8 * w.int_at(model_at(model).sensor_adr, sensor)
    number = watched(model, instance)
    block, state = report(model, data, number), s.state_address(model, data, number)
    header = s.header_record(state)
    count, lines = int(header.n_current if block == 1 else header.n_committed), listed(model, instance)
    width, line = len(FIELDS), len(CONTACT_FIELDS)
    for j in range(width + lines * line):
        w.put(out, j, 0.0)
    w.put(out, line, count)
    for k in range(count):
        slot = s.slot_at(state, block, k)
        for j in range(line):
            value = measured(slot, j)
            share = 1.0 / count if MEANS[j] else 1.0
            w.put(out, j, w.at(out, j) + share * value)
            if k < lines:
                w.put(out, width + k * line + j, value)


MEANS = tuple(f in ("mu_s", "mu_k", "stick") for f in CONTACT_FIELDS)
"""Which of the fields are means over the contacts; the others are sums."""


@compiled
def measured(slot, j):
    """Return one of `CONTACT_FIELDS` from a slot."""
    if j < 3:
        return slot.fx * slot.axis_1[j] + slot.fy * slot.axis_2[j]
    if j == 3:
        return slot.normal
    if j == 4:
        return slot.mu_s
    if j == 5:
        return slot.mu_k
    if j == 6:
        return slot.stick
    return slot.energy


def _nstate(model, instance):
    return _INT(0)


def _nsensordata(model, instance, sensor):
    return _INT(len(FIELDS) + max(listed(model, instance), 0) * len(CONTACT_FIELDS))


def _init(model, data, instance):
    if watched(model, instance) < 0 or listed(model, instance) < 0:
        w.call_python(w.entry(w.SENSOR_KEYS + w.READER), model, instance, 0)
        return _INT(-1)
    return _INT(0)


def _reset(model, state, plugin_data, instance):
    pass


def _compute(model, data, instance, capability):
    m = model_at(model)
    for i in range(m.nsensor):
        if w.int_at(m.sensor_plugin, i) == instance:
            measure(model, data, instance, i)


_CALLBACKS: dict[str, tuple[Any, Any]] = {
    "nstate": (_nstate, _INT(_POINTER, _INT)),
    "nsensordata": (_nsensordata, _INT(_POINTER, _INT, _INT)),
    "init": (_init, _INT(_POINTER, _POINTER, _INT)),
    "reset": (_reset, types.void(_POINTER, _POINTER, _POINTER, _INT)),
    "compute": (_compute, types.void(_POINTER, _POINTER, _INT, _INT)),
}
