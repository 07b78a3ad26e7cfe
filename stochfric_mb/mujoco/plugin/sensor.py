"""The engine plugin ``stochfric.sensor``: what a friction instance does, as MuJoCo sensor data.

A sensor names its friction instance, and how many contacts it lists::

    <instance name="watch"><config key="friction" value="friction_box_belt"/><config key="contacts" value="4"/></instance>
    ...
    <sensor><plugin name="rub" plugin="stochfric.sensor" instance="watch"/></sensor>

Its data are `FIELDS`, then `CONTACT_FIELDS` for each contact listed (zeros where there is none).
"""

from __future__ import annotations

import functools
from typing import Any

import mujoco
import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError, require_name
from stochfric_mb.mujoco.contact import tracking
from stochfric_mb.mujoco.joint import friction
from stochfric_mb.mujoco.memory import engine
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.structs import DATA, MODEL, array_at, data_at, model_at, record_at
from stochfric_mb.mujoco.plugin.configuration import enter
from stochfric_mb.mujoco.plugin.frictions import DOFS, PAIRS, copy, slot_of
from stochfric_mb.mujoco.plugin.registration import register_plugin
from stochfric_mb.numerics import memory as w

NAME = "stochfric.sensor"
"""Name of the plugin in MJCF."""
ATTRIBUTES = ("friction", "contacts")
"""Configuration keys: name of the friction instance, number of contacts listed (0 if not given)."""
CONTACT_FIELDS = ("force_x", "force_y", "force_z", "normal_force", "mu_s", "mu_k", "stick", "dissipated")
"""Numbers of each contact listed."""
FIELDS = (*CONTACT_FIELDS, "contacts")
"""First numbers of a sensor: sums of the friction force on the body (world axes; along the coordinate for a joint or
tendon) [N] and of the normal force [N], means of mu_s, mu_k and of the stick flag, sum of the dissipated energy [J] and
number of the contacts there are."""
MAX_CONTACTS, SHIFT = 64, 2**32


@functools.cache
def register() -> int:
    """Return MuJoCo's slot number of the plugin, registered now, with those of the frictions, unless it was before."""
    slot_of(PAIRS)
    slot_of(DOFS)
    return register_plugin(
        NAME,
        ATTRIBUTES,
        capability=mujoco.mjtPluginCapabilityBit.mjPLUGIN_SENSOR,
        first={"nstate": lambda model, instance: 0, "nsensordata": _nsensordata, "init": _init},
        compiled={"copy": copy, "reset": _reset, "compute": _compute},
        stage=int(mujoco.mjtStage.mjSTAGE_ACC),
    )


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
    require_name("friction", friction, [p.name for p in spec.plugins if p.plugin_name in (PAIRS, DOFS)])
    if int(contacts) != contacts or not 0 <= contacts <= MAX_CONTACTS:
        raise InputError(f"contacts = {contacts!r} must be a whole number from 0 to {MAX_CONTACTS}")
    name = name or friction
    instance = f"sensor_{name}"
    if name in {x.name for x in spec.sensors} or instance in {p.name for p in spec.plugins}:
        raise InputError(f"the model has a sensor {name!r} already; give another name")
    enter(spec, NAME, instance, {"friction": friction, "contacts": str(int(contacts))})
    sensor: Any = spec.add_sensor(name=name, type=mujoco.mjtSensor.mjSENS_PLUGIN)
    sensor.plugin.name = instance
    sensor.plugin.plugin_name = NAME
    sensor.plugin.active = True
    return name


def _nsensordata(model: int, instance: int, sensor: int) -> int:
    return len(FIELDS) + _listed(model, instance) * len(CONTACT_FIELDS)


def _listed(model: int, instance: int) -> int:
    """Return how many contacts a sensor instance lists.

    Raises:
        InputError: its key is malformed.
    """
    text = engine.plugin_text(model, instance, "contacts") or "0"
    if not text.isdecimal() or int(text) > MAX_CONTACTS:
        raise InputError(f"plugin key contacts = {text!r} must be a whole number from 0 to {MAX_CONTACTS}")
    return int(text)


def _init(model: int, data: int, instance: int) -> int:
    """Let the data find what the sensor watches: the friction's number, and the contacts listed times `SHIFT`."""
    friction = engine.plugin_text(model, instance, "friction")
    number = engine.id_in(model, mujoco.mjtObj.mjOBJ_PLUGIN, friction, -1)
    slots = array_at(record_at(MODEL, model).plugin, number + 1, np.int32)
    if number < 0 or slots[number] not in (slot_of(PAIRS), slot_of(DOFS)):
        raise InputError(f"plugin key friction = {friction!r} must name an instance of {PAIRS} or {DOFS} in the model")
    watched = array_at(record_at(DATA, data).plugin_data, instance + 1, np.int64)
    watched[instance] = number + SHIFT * _listed(model, instance)
    return 0


@compiled
def report(model, data, state):
    """Bring what can be read of a friction up to date; return the block to read, 0 committed or 1 current.

    After an evaluation these are the forces of the engine's solution for it, after a step those of the step.
    """
    m, d, header = model_at(model), data_at(data), s.header_record(state)
    if header.solved == 0.0 or header.n_current == 0.0:
        return 1
    if header.started == 0.0:
        return 0
    if header.place == s.PAIR:
        tracking.learn(data, state, 1, int(header.n_current), m)
    else:
        friction.learn(m, d, state, 1)
    return 1


@compiled
def measure(model, data, instance, sensor):
    """Write a sensor's data from the slots of its friction."""
    out = data_at(data).sensordata + 8 * w.int_at(model_at(model).sensor_adr, sensor)
    watched = w.word_at(data_at(data).plugin_data, instance)
    number, lines = watched % SHIFT, watched // SHIFT
    state = s.state_address(model, data, number)
    block = report(model, data, state)
    header = s.header_record(state)
    count = int(header.n_current if block == 1 else header.n_committed)
    width, line = len(FIELDS), len(CONTACT_FIELDS)
    for j in range(width + lines * line):
        w.put(out, j, 0.0)
    w.put(out, line, count)
    for k in range(count):
        slot = s.slot_at(state, block, k)
        (a, b, c), (d, e, f), x, y = slot.axis_1, slot.axis_2, slot.fx, slot.fy
        values = x * a + y * d, x * b + y * e, x * c + y * f, slot.normal, slot.mu_s, slot.mu_k, slot.stick, slot.energy
        for j in range(line):
            share = 1.0 / count if MEANS[j] else 1.0
            w.put(out, j, w.at(out, j) + share * values[j])
            if k < lines:
                w.put(out, width + k * line + j, values[j])


MEANS = tuple(f in ("mu_s", "mu_k", "stick") for f in CONTACT_FIELDS)
"""Which of the fields are means over the contacts; the others are sums."""


def _reset(model, state, plugin_data, instance):
    pass


def _compute(model, data, instance, capability):
    m = model_at(model)
    for i in range(m.nsensor):
        if w.int_at(m.sensor_plugin, i) == instance:
            measure(model, data, instance, i)
