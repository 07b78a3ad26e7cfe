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
from stochfric_mb.mujoco import config
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.contact import slot
from stochfric_mb.mujoco.dof import state_of
from stochfric_mb.mujoco.dof_plugin import NAME as JOINTS
from stochfric_mb.mujoco.dof_plugin import register_joints
from stochfric_mb.mujoco.plugin import NAME as PAIRS
from stochfric_mb.mujoco.plugin import register
from stochfric_mb.mujoco.registration import register_plugin

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
_KEYS, _FRICTION_SLOT, _EXPLAINER = n.FURTHER + 50, n.FURTHER + 52, n.FURTHER + 53
_PLUGIN_OBJECT = int(mujoco.mjtObj.mjOBJ_PLUGIN)
_POINTER, _INT = types.intp, types.int32


@functools.cache
def register_sensors() -> int:
    """Return MuJoCo's slot number of the plugin, registered now unless it was before."""
    register_joints()
    n.TABLE[_FRICTION_SLOT] = register()
    n.TABLE[_EXPLAINER] = ctypes.cast(_EXPLAIN, ctypes.c_void_p).value or 0
    stage = int(mujoco.mjtStage.mjSTAGE_ACC)
    sensor = int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_SENSOR)
    return register_plugin(NAME, ATTRIBUTES, keys=_KEYS, capability=sensor, callbacks=_CALLBACKS, stage=stage)


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
    friction, contacts = (n.plugin_text(model, instance, key) for key in ATTRIBUTES)
    raise InputError(
        f"plugin keys friction = {friction!r}, contacts = {contacts!r}: friction must name an instance of {PAIRS} or {JOINTS} "
        f"in the model, and contacts be a whole number from 0 to {MAX_CONTACTS}"
    )


_EXPLAIN = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_int64, ctypes.c_int64)(_explain_refusal)


@compiled
def watched(model, instance):
    """Return the friction instance that a sensor instance names, -1 if there is none."""
    text = n.mj_getPluginConfig(model, instance, n.entry(_KEYS))
    number = n.mj_name2id(model, _INT(_PLUGIN_OBJECT), text) if text != 0 else -1
    if number < 0:
        return -1
    kind = n.load_int(n.pointer_field(model, n.M_PLUGIN) + 4 * number)
    return number if kind in (n.entry(_FRICTION_SLOT), n.entry(n.JOINTS_SLOT)) else -1


@compiled
def listed(model, instance):
    """Return how many contacts a sensor instance lists, -1 if its key is malformed."""
    count = config.parse_integer(n.mj_getPluginConfig(model, instance, n.entry(_KEYS + 1)), 0)
    return count if 0 <= count <= MAX_CONTACTS else -1


@compiled
def measure(model, data, instance, sensor):
    """Write a sensor's data from the current slots of its friction."""
    out = n.pointer_field(data, n.D_SENSORDATA) + 8 * n.load_int(n.pointer_field(model, n.M_SENSOR_ADDRESS) + 4 * sensor)
    state = state_of(model, data, watched(model, instance))
    count, lines = int(n.load(state + 8 * s.N_CURRENT)), listed(model, instance)
    width, line = len(FIELDS), len(CONTACT_FIELDS)
    for j in range(width + lines * line):
        n.store(out + 8 * j, 0.0)
    n.store(out + 8 * line, float(count))
    for k in range(count):
        row = slot(state, 1, k)
        for j in range(line):
            value = measured(row, j)
            share = 1.0 / count if MEANS[j] else 1.0
            n.store(out + 8 * j, n.load(out + 8 * j) + share * value)
            if k < lines:
                n.store(out + 8 * (width + k * line + j), value)


MEANS = tuple(f in ("mu_s", "mu_k", "stick") for f in CONTACT_FIELDS)
"""Which of the fields are means over the contacts; the others are sums."""


@compiled
def measured(row, j):
    """Return one of `CONTACT_FIELDS` from a slot."""
    if j < 3:
        along = n.load(row + 8 * s.FX) * n.load(row + 8 * (s.AXIS_1 + j))
        return along + n.load(row + 8 * s.FY) * n.load(row + 8 * (s.AXIS_2 + j))
    if j == 3:
        return n.load(row + 8 * s.NORMAL)
    if j == 4:
        return n.load(row + 8 * s.MU_S)
    if j == 5:
        return n.load(row + 8 * s.MU_K)
    if j == 6:
        return n.load(row + 8 * s.STICK)
    return n.load(row + 8 * s.ENERGY)


def _nstate(model, instance):
    return _INT(0)


def _nsensordata(model, instance, sensor):
    return _INT(len(FIELDS) + max(listed(model, instance), 0) * len(CONTACT_FIELDS))


def _init(model, data, instance):
    if watched(model, instance) < 0 or listed(model, instance) < 0:
        n.call_python(n.entry(_EXPLAINER), model, instance, 0)
        return _INT(-1)
    return _INT(0)


def _reset(model, state, plugin_data, instance):
    pass


def _compute(model, data, instance, capability):
    for i in range(n.int_field(model, n.M_NSENSOR)):
        if n.load_int(n.pointer_field(model, n.M_SENSOR_PLUGIN) + 4 * i) == instance:
            measure(model, data, instance, i)


_CALLBACKS: dict[str, tuple[Any, Any]] = {
    "nstate": (_nstate, _INT(_POINTER, _INT)),
    "nsensordata": (_nsensordata, _INT(_POINTER, _INT, _INT)),
    "init": (_init, _INT(_POINTER, _POINTER, _INT)),
    "reset": (_reset, types.void(_POINTER, _POINTER, _POINTER, _INT)),
    "compute": (_compute, types.void(_POINTER, _POINTER, _INT, _INT)),
}
