"""Where seeds and parameters stand in ``plugin_state``, for ensembles that give each simulation its own."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import dataclasses
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, require_name
from stochfric_mb.laws import law_class
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.attach import friction_instances
from stochfric_mb.mujoco.config import friction_of
from stochfric_mb.mujoco.coordinates import LOAD
from stochfric_mb.mujoco.joints import joint_instances
from stochfric_mb.mujoco.native import plugin_text
from stochfric_mb.mujoco.plugin import UNSET

_ADDRESS = {"seed": s.SEED, "sample": s.SAMPLE, "contact": s.CONTACT}
_MEANS = {"mu_s": 4, "mu_k": 5}
"""Places of the means in the coefficient descriptor."""


def state_index(model: mujoco.MjModel, instance: str, name: str) -> int:
    """Return the place in ``plugin_state`` of an instance's number: seed, sample, contact, normal_force or a parameter.

    mu_s and mu_k stand at a second place too: change them with `set_friction`.

    Raises:
        InputError: unknown instance or name; lists the known ones.
    """
    return _places(model, instance, name)[0]


def set_friction(
    states: npt.NDArray[np.float64], model: mujoco.MjModel, instance: str, **values: npt.ArrayLike
) -> npt.NDArray[np.float64]:
    """Return ``states`` with an instance's seeds, samples or parameters set in place.

    Args:
        states: ``data.plugin_state``, or that of a batch, shape (nsim, n): ``batch.bind("plugin_state")``.
        model: the model.
        instance: name that `add_friction` returned.
        values: e.g. ``seed=np.arange(100)`` or ``mu_s=0.7``, one value or one for each simulation.

    Raises:
        InputError: unknown instance or name, or a seed, sample or contact that is not an integer in [0, 2^32).
    """
    first = int(model.plugin_stateadr[_instance(model, instance)])
    for name, value in values.items():
        numbers = np.asarray(value, dtype=np.float64)
        if name in _ADDRESS and not np.all((numbers >= 0) & (numbers < 2.0**32) & (numbers == np.floor(numbers))):
            raise InputError(f"{name} = {value!r} is not an integer in [0, 2^32); choose one in that range")
        for place in _places(model, instance, name):
            states[..., place] = numbers
    states[..., first + s.CURSOR] = 0.0  # the knots at hand belong to another address
    states[..., first + s.COEFFICIENTS] = UNSET
    return states


def untouched(model: mujoco.MjModel, data: mujoco.MjData) -> list[str]:
    """Return the names of the pairs' friction instances that have had no contact since the data was reset."""
    out: list[str] = []
    for i in friction_instances(model):
        first = int(model.plugin_stateadr[i])
        state = data.plugin_state[first : first + int(model.plugin_statenum[i])]
        if state[s.COEFFICIENTS] == UNSET and not state[s.N_CURRENT] and not state[s.N_COMMITTED]:
            out.append(_name(model, i))
    return out


def _name(model: mujoco.MjModel, instance: int) -> str:
    return mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_PLUGIN, instance) or f"#{instance}"


def _instance(model: mujoco.MjModel, name: str) -> int:
    names = {_name(model, i): i for i in friction_instances(model) + joint_instances(model)}
    return names[require_name("friction instance", name, names)]


def _places(model: mujoco.MjModel, instance: str, name: str) -> list[int]:
    number = _instance(model, instance)
    first = int(model.plugin_stateadr[number])
    law = friction_of(plugin_text(model, number, "law"), "").law
    fields = [f.name for f in dataclasses.fields(law_class(law.kind))]
    loads = {"normal_force": LOAD} if number in joint_instances(model) else {}
    known: dict[str, Any] = _ADDRESS | loads | {field: s.PARAMETERS + i for i, field in enumerate(fields)}
    place = known[require_name("number", name, known)]
    means = [first + s.DESCRIPTOR + _MEANS[name]] if name in _MEANS else []
    return [first + place, *means]
