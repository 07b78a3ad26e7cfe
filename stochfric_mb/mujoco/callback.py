"""Friction for a model that is compiled already, through ``mjcb_passive`` as a native function.

``mjcb_passive`` is one pointer for the whole process. The first `friction` context installs a function that calls what
was installed before and then serves every active context (`callback_steps`), found by the addresses of model and data;
the last one puts the earlier function back. The friction's state lies in the context, since such a model has no plugin
state: copies of the data and of the model are not covered, and are refused.
"""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import ctypes
import threading
import warnings
from collections.abc import Mapping
from types import TracebackType
from typing import Any

import mujoco
import numpy as np

from stochfric_mb.errors import InputError, SimulationError
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.attach import reading_of, require_slots
from stochfric_mb.mujoco.callback_steps import CAPACITY, DATA, MODEL, ROWS, STATE, callback, prepare_solver
from stochfric_mb.mujoco.config import (
    MODES,
    R_DESCRIPTOR,
    R_HAS_MODE,
    R_LAW,
    R_LIMITS,
    R_N_DESCRIPTOR,
    R_N_PARAMETERS,
    R_NEEDS_HOLD,
    R_NEEDS_MASS,
    R_PARAMETERS,
    R_STICK_SPEED,
    configuration,
    record_of,
)
from stochfric_mb.mujoco.options import NO_PASSIVE_FORCES, SWITCHED_OFF, check_options
from stochfric_mb.mujoco.plugin import UNSET, register
from stochfric_mb.mujoco.reading import Reading
from stochfric_mb.mujoco.takeover import geoms_of, switches_of

_lock = threading.Lock()
_switched_off: dict[tuple[int, str, int], tuple[int, int]] = {}
"""(model's address, array, place) -> (contexts that need 1 there, the model's own value)."""


class ContactWarning(UserWarning):
    """A pair that was given friction and never touched."""


class friction:  # noqa: N801  (a context, used like a function)
    """Friction on geom pairs of a compiled model, for as long as the context lasts."""

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        pairs: Mapping[tuple[str, str], Law | Friction],
        *,
        seed: int = 0,
        sample: int = 0,
        slots: int = 16,
        mode: str = "auto",
    ) -> None:
        """Prepare friction; nothing changes before the context is entered.

        Args:
            model: the model; its native friction of these pairs is off within the context, and back after it.
            data: the one data that is covered.
            pairs: (body's geom, counter-surface's geom) -> law, or `Friction` with a coefficient process.
            seed: first part of the coefficient paths' address; the third is the number of the pair in ``pairs``.
            sample: second part: the run of an ensemble.
            slots: most contacts of a pair at a time.
            mode: ``auto`` (explicit steps below half the law's step limit, otherwise implicit ones), ``explicit`` or
                ``implicit``, as of `add_friction`.

        Raises:
            InputError: data of another model, unknown geoms, geoms that cannot touch, a pair whose native friction
                cannot be switched off alone, passive forces that are disabled, or a law that cannot run in this mode.

        Warns:
            IntegratorWarning: the model uses the ``discrete`` integrator.
        """
        if not isinstance(model, mujoco.MjModel):
            raise InputError(f"model is a {type(model).__name__}; compile it first, or use add_friction(spec, ...)")
        if not isinstance(pairs, Mapping):
            raise InputError(f"pairs is a {type(pairs).__name__}; write {{(body's geom, counter-surface's geom): law, ...}}")
        if data.model is not model and data.model._address != model._address:
            raise InputError("data belongs to another model; pass the model that it was made with")
        check_options(model.opt.disableflags, model.opt.integrator)
        self._model, self._data = model, data
        self._pairs = {names: geoms_of(model, names) for names in pairs}
        self._plans = {names: switches_of(model, geoms, names) for names, geoms in self._pairs.items()}
        self._states: dict[tuple[str, str], np.ndarray[Any, np.dtype[np.float64]]] = {}
        for contact, (names, law) in enumerate(pairs.items()):
            address = {"seed": seed, "sample": sample, "contact": contact}
            state = _fresh_state(as_friction(law), require_slots(slots), mode, int(model.nv), **address)
            state[s.GEOM_BODY], state[s.GEOM_SURFACE] = self._pairs[names]
            self._states[names] = state
        self._implicit = mode != "explicit"
        self._places: list[int] = []

    def __enter__(self) -> friction:
        """Switch the pairs' native friction off and this friction on."""
        register()
        if self._implicit:
            prepare_solver()
        with _lock:
            _require_free(self._model, self._data, self._pairs)
            for names, state in self._states.items():
                geoms, plan = self._pairs[names], self._plans[names]
                for array, place in plan:
                    _switch_off(self._model, array, place)
                place = int(np.flatnonzero(ROWS[:, MODEL] == 0)[0])
                own = (-1, -1) if len(plan) == 1 else geoms
                ROWS[place, 1:] = (
                    self._data._address, state.ctypes.data, 0, np.uint64(self._model.signature).astype(np.int64), *own
                )  # fmt: skip
                ROWS[place, MODEL] = self._model._address  # last: a row with a model is complete
                self._places.append(place)
            _install()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        """Put the model and ``mjcb_passive`` back as they were.

        Raises:
            SimulationError: someone replaced ``mjcb_passive`` or disabled passive forces within the context, which switched the
                friction off.
        """
        with _lock:
            ROWS[self._places, MODEL] = 0
            for array, place in [switch for plan in self._plans.values() for switch in plan] if self._places else []:
                _switch_back(self._model, array, place)
            self._places = []
            replaced = _uninstall()
        if error is None:
            self._warn_untouched()
            if self._model.opt.disableflags & NO_PASSIVE_FORCES == NO_PASSIVE_FORCES:
                raise SimulationError(f"passive forces were disabled while friction(...) was active: {SWITCHED_OFF}")
        if replaced and error is None:
            raise SimulationError(
                "mjcb_passive was replaced while friction(...) was active, which switched the friction off; set your callback "
                "before entering the context: it is called too"
            )

    def readings(self) -> dict[tuple[str, str], list[Reading]]:
        """Return what each pair did at its contacts at the last evaluation at a step's start."""
        out: dict[tuple[str, str], list[Reading]] = {}
        for names, state in self._states.items():
            first = s.DESCRIPTOR + int(state[s.N_DESCRIPTOR]) + int(state[s.N_SLOTS]) * s.SLOT
            block = state[first : first + int(state[s.N_CURRENT]) * s.SLOT].reshape(-1, s.SLOT)
            out[names] = [reading_of(self._model, state, row) for row in block]
        return out

    def _warn_untouched(self) -> None:
        for names, touched in self.touched().items():
            if not touched and self._states[names][s.EVALUATED] != UNSET:
                warnings.warn(f"geoms {names!r} never touched, so they had no friction", ContactWarning, stacklevel=3)

    def touched(self) -> dict[tuple[str, str], bool]:
        """Return for each pair whether it has ever touched."""
        return {names: bool(state[s.COEFFICIENTS] != UNSET or state[s.N_CURRENT]) for names, state in self._states.items()}


def _fresh_state(friction: Friction, slots: int, mode: str, nv: int, **address: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the state that the plugin would start with (no model is compiled: that would run others' callbacks)."""
    texts = configuration(friction, "", "", mode=mode, slots=slots, **address)
    record = record_of(texts["law"], texts["coefficients"], 0)
    n_descriptor = int(record[R_N_DESCRIPTOR])
    state = np.zeros(s.state_size(n_descriptor, slots, nv))
    for place, value in {
        s.LAW: record[R_LAW],
        s.SEED: address["seed"],
        s.SAMPLE: address["sample"],
        s.CONTACT: address["contact"],
        s.N_SLOTS: slots,
        s.N_DESCRIPTOR: n_descriptor,
        s.N_PARAMETERS: record[R_N_PARAMETERS],
        s.STICK_SPEED: record[R_STICK_SPEED],
        s.HAS_MODE: record[R_HAS_MODE],
        s.NEEDS_MASS: record[R_NEEDS_MASS],
        s.NEEDS_HOLD: record[R_NEEDS_HOLD],
        s.MODE: MODES.index(mode),
        s.ADVANCED: UNSET,
        s.EVALUATED: UNSET,
        s.COEFFICIENTS: UNSET,
    }.items():
        state[place] = value
    state[s.LIMITS : s.LIMITS + s.N_LIMITS] = record[R_LIMITS : R_LIMITS + s.N_LIMITS]
    state[s.PARAMETERS : s.PARAMETERS + s.MAX_PARAMETERS] = record[R_PARAMETERS : R_PARAMETERS + s.MAX_PARAMETERS]
    state[s.DESCRIPTOR : s.DESCRIPTOR + n_descriptor] = record[R_DESCRIPTOR:]
    return state


def _require_free(model: mujoco.MjModel, data: mujoco.MjData, pairs: Mapping[tuple[str, str], tuple[int, int]]) -> None:
    active = ROWS[(ROWS[:, MODEL] == model._address) & (ROWS[:, DATA] == data._address)]
    taken = [_state_geoms(int(row[STATE])) for row in active]
    for names, geoms in pairs.items():
        if set(geoms) in taken:
            raise InputError(f"pair {names!r} has friction from another context already; leave that one first")
    if np.count_nonzero(ROWS[:, MODEL] == 0) < len(pairs):
        raise InputError(f"more than {CAPACITY} pairs at a time; leave other friction contexts first")


def _state_geoms(address: int) -> set[int]:
    state = (ctypes.c_double * (s.GEOM_SURFACE + 1)).from_address(address)
    return {int(state[s.GEOM_BODY]), int(state[s.GEOM_SURFACE])}


def _switch_off(model: mujoco.MjModel, array: str, place: int) -> None:
    """Write 1 to an integer of the model, and remember what was there."""
    numbers = getattr(model, array)
    count, own = _switched_off.get((model._address, array, place), (0, int(numbers[place])))
    _switched_off[model._address, array, place] = count + 1, own
    numbers[place] = 1


def _switch_back(model: mujoco.MjModel, array: str, place: int) -> None:
    """Put back what `_switch_off` found, with the last context that needs it."""
    count, own = _switched_off.pop((model._address, array, place))
    if count > 1:
        _switched_off[model._address, array, place] = count - 1, own
    else:
        getattr(model, array)[place] = own


def _pointer() -> ctypes.c_void_p:
    return ctypes.c_void_p.in_dll(n.library(), "mjcb_passive")


def _install() -> None:
    pointer, ours = _pointer(), callback()
    if pointer.value != ours:
        n.TABLE[n.CALLBACK_BEFORE] = pointer.value or 0
        pointer.value = ours


def _uninstall() -> bool:
    """Put the earlier callback back after the last context; return whether ours was not in its place."""
    pointer = _pointer()
    replaced = pointer.value != callback()
    if not replaced and not ROWS[:, MODEL].any():
        pointer.value = n.TABLE[n.CALLBACK_BEFORE] or None
    return replaced
