"""Where seeds and parameters stand in ``plugin_state``, for ensembles that give each simulation its own."""

from __future__ import annotations

import dataclasses

import mujoco
import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, require_name
from stochfric_mb.laws import Law, make_law
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.engine import plugin_text
from stochfric_mb.mujoco.plugin.configuration import friction_of, law_header
from stochfric_mb.mujoco.plugin.frictions import DOFS, PAIRS
from stochfric_mb.mujoco.reading import instances, state_of

_ADDRESS = ("seed", "sample", "contact")
_MEANS = {"mu_s": 4, "mu_k": 5}
"""Places of the means in the coefficient descriptor."""


def state_index(model: mujoco.MjModel, instance: str, name: str) -> int:
    """Return the place in ``plugin_state`` of an instance's number: seed, sample, contact, normal_force or a parameter.

    Other numbers follow from the parameters: change them with `set_friction`.

    Raises:
        InputError: unknown instance or name; lists the known ones.
    """
    first, _, known, _ = _instance(model, instance)
    return first + known[require_name("number", name, known)]


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
        InputError: unknown instance or name; a seed, sample or contact that is not an integer in [0, 2^32); a load that is not
            positive; or parameters that the law refuses. Nothing is set then.
    """
    first, size, known, law = _instance(model, instance)
    new = np.array(states[..., first : first + size])
    for name, value in values.items():
        place = known[require_name("number", name, known)]
        numbers = np.asarray(value, dtype=np.float64)
        if name in _ADDRESS and not np.all((numbers >= 0) & (numbers < 2.0**32) & (numbers == np.floor(numbers))):
            raise InputError(f"{name} = {value!r} is not an integer in [0, 2^32); choose one in that range")
        if name == "normal_force" and not np.all((numbers > 0) & np.isfinite(numbers)):
            raise InputError(f"normal_force = {value!r} must be positive [N or N m]; choose loads above 0")
        new[..., place] = numbers
    if values.keys() - {*_ADDRESS, "normal_force"}:
        _renew_law(new.reshape(-1, size), law)
    new[..., s.place("cursor")] = 0.0  # the knots at hand belong to another address
    new[..., s.place("path_time")] = s.UNSET
    states[..., first : first + size] = new
    return states


def _renew_law(states: npt.NDArray[np.float64], law: Law) -> None:
    """Check the parameters of each state as the law itself does, and set what follows from them."""
    fields = dataclasses.fields(law)
    first = s.place("parameters")
    rows, which = np.unique(states[:, first : first + len(fields)], axis=0, return_inverse=True)
    for i, row in enumerate(rows):
        numbers = {
            f.name: f.metadata["choices"][int(x)] if "choices" in f.metadata else float(x)
            for f, x in zip(fields, row, strict=True)
        }
        header = s.header_of(law_header(make_law(law.kind, **numbers)))
        for k in np.flatnonzero(which.reshape(-1) == i):
            state = states[k]
            mine = s.header_of(state)
            mine.limits[:], mine.critical_step = header.limits, 0.0
            mine.stick_speed, mine.peak_speed = header.stick_speed, header.peak_speed
            for name, place in _MEANS.items():
                state[s.descriptor_place(mine) + place] = numbers[name]


def untouched(model: mujoco.MjModel, data: mujoco.MjData) -> list[str]:
    """Return the names of the pairs' friction instances that have had no contact since the data was reset."""
    return [name for name, i in instances(model, PAIRS).items() if not touched(state_of(model, data, i))]


def touched(state: npt.NDArray[np.float64]) -> bool:
    """Return whether a pair's state has had a contact since its start."""
    header = s.header_of(state)
    return bool(header.path_time != s.UNSET or header.n_current or header.n_committed)


def _instance(model: mujoco.MjModel, name: str) -> tuple[int, int, dict[str, int], Law]:
    """Return the place and the length of an instance's state, the places in it of what can be set, and the model's law."""
    names = instances(model)
    number = names[require_name("friction instance", name, names)]
    law = friction_of(plugin_text(model._address, number, "law"), "").law
    fields = (*_ADDRESS, "load") if number in instances(model, DOFS).values() else _ADDRESS
    known = {"normal_force" if field == "load" else field: s.place(field) for field in fields}
    known |= {field.name: s.place("parameters") + i for i, field in enumerate(dataclasses.fields(law))}
    return int(model.plugin_stateadr[number]), int(model.plugin_statenum[number]), known, law
