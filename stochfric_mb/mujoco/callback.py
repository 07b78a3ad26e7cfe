"""Friction for a model that is compiled already, through ``mjcb_passive`` as a native function.

``mjcb_passive`` is one pointer for the whole process. The first `friction` context installs a function that calls what
was installed before and then serves every active context (`callback_steps`), found by the addresses of model and data;
the last one puts the earlier function back. The friction's state lies in the context, since such a model has no plugin
state: other data of the model are refused while it lasts.
"""

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
from stochfric_mb.mujoco.anisotropy import ISOTROPIC, Anisotropy
from stochfric_mb.mujoco.callback_steps import BEFORE, CAPACITY, ROW, ROWS, callback
from stochfric_mb.mujoco.contact import replay
from stochfric_mb.mujoco.memory import state as s
from stochfric_mb.mujoco.memory.engine import library
from stochfric_mb.mujoco.memory.structs import DISCRETE, record_at
from stochfric_mb.mujoco.pairs import ContactWarning, condim_of, require_pair
from stochfric_mb.mujoco.plugin import options
from stochfric_mb.mujoco.plugin.configuration import configuration, law_of, require_slots
from stochfric_mb.mujoco.plugin.frictions import ANY
from stochfric_mb.mujoco.reading import Reading, readings_of
from stochfric_mb.mujoco.states import touched

_lock = threading.Lock()
Array = np.ndarray[Any, np.dtype[np.float64]]


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
        anisotropy: Mapping[tuple[str, str], Anisotropy] | None = None,
    ) -> None:
        """Prepare friction; nothing changes before the context is entered.

        Args:
            model: the model; with elliptic cones, and nothing of it is changed.
            data: the one data that is covered.
            pairs: (body's geom, counter-surface's geom) -> law, or `Friction` with a coefficient process.
            seed: first part of the coefficient paths' address; the third is the number of the pair in ``pairs``.
            sample: second part: the run of an ensemble.
            slots: most contacts of a pair at a time.
            mode: ``auto``, ``solver`` or ``explicit``, as of `add_friction`.
            anisotropy: pair of ``pairs`` -> how its coefficients differ by direction, for those whose do.

        Raises:
            InputError: data of another model, unknown geoms, geoms that cannot touch or touch without friction, pyramidal
                cones, passive forces that are disabled, the ``discrete`` integrator, or a law that cannot run in this mode.

        Warns:
            IntegratorWarning: damping and a long step let stuck contacts slip, see `options.warn_of_stiff_damping`.
        """
        if not isinstance(model, mujoco.MjModel):
            raise InputError(f"model is a {type(model).__name__}; compile it first, or use add_friction(spec, ...)")
        if not isinstance(pairs, Mapping):
            raise InputError(f"pairs is a {type(pairs).__name__}; write {{(body's geom, counter-surface's geom): law, ...}}")
        if data.model is not model and data.model._address != model._address:
            raise InputError("data belongs to another model; pass the model that it was made with")
        options.check_options(model.opt)
        options.require_elliptic(model.opt)
        if model.opt.integrator == DISCRETE:
            raise InputError(
                "integrator discrete leaves nothing of its constraints to a context, which finds a step's forces when the next "
                "one begins; use add_friction(spec, ...), or Euler, implicitfast, implicit or RK4"
            )
        options.warn_of_stiff_damping(model._address)
        directed = dict(anisotropy or {})
        for names in directed.keys() - pairs.keys():
            raise InputError(f"anisotropy of {names!r}, which is none of the pairs {list(pairs)}; name one of them")
        if directed:
            options.require_primal(model.opt)
        self._model, self._data = model, data
        self._states: dict[tuple[str, str], Array] = {}
        self._kept = np.zeros((len(pairs), replay.room(require_slots(slots), int(model.nv))))
        self._rows, self._places = np.zeros(len(pairs), ROW), np.zeros(0, dtype=int)
        for contact, (names, law) in enumerate(pairs.items()):
            address: Any = {"seed": seed, "sample": sample, "contact": contact}
            anisotropic = directed.get(names, ISOTROPIC)
            texts = configuration(as_friction(law), **address, slots=slots, mode=mode, anisotropy=anisotropic)
            prepared = law_of(texts, (s.PAIR, *_geoms_of(model, names)))
            state = self._states[names] = np.zeros(int(prepared["n_all"][0]))
            s.restart(prepared.ctypes.data, state.ctypes.data)
            for key, number in address.items():
                s.header_of(state)[key] = number
            addresses = data._address, state.ctypes.data, self._kept[contact].ctypes.data
            self._rows[contact] = (0, *addresses, 0, prepared.ctypes.data)

    def __enter__(self) -> friction:
        """Switch this friction on in place of the pairs' own."""
        ours, pointer = callback().address, _installed()
        with _lock:
            _require_free(self._model, self._data, self._states)
            self._places = np.flatnonzero(ROWS["model"] == 0)[: len(self._rows)]
            ROWS[self._places] = self._rows
            ROWS["model"][self._places] = self._model._address  # last: a row with a model is complete
            if pointer.value != ours:
                BEFORE[0], pointer.value = pointer.value or 0, ours
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        """Put ``mjcb_passive`` back as it was.

        Raises:
            SimulationError: someone replaced ``mjcb_passive`` or disabled passive forces within the context, which switched the
                friction off.
        """
        with _lock:
            ROWS["model"][self._places] = 0
            self._places = self._places[:0]
            pointer = _installed()
            replaced = pointer.value != callback().address
            if not replaced and not ROWS["model"].any():
                pointer.value = int(BEFORE[0]) or None
        if error is not None:
            return
        for names, met in self.touched().items():
            if not met and s.header_of(self._states[names]).evaluated != s.UNSET:
                warnings.warn(f"geoms {names!r} never touched, so they had no friction", ContactWarning, stacklevel=2)
        if self._model.opt.disableflags & options.NO_PASSIVE_FORCES == options.NO_PASSIVE_FORCES:
            raise SimulationError(f"passive forces were disabled while friction(...) was active: {options.SWITCHED_OFF}")
        if replaced:
            raise SimulationError(
                "mjcb_passive was replaced while friction(...) was active, which switched the friction off; set your callback "
                "before entering the context: it is called too"
            )

    def readings(self) -> dict[tuple[str, str], list[Reading]]:
        """Return what each pair did at its contacts, as `stochfric_mb.mujoco.readings` does."""
        return {names: readings_of(self._model, self._data, state) for names, state in self._states.items()}

    def touched(self) -> dict[tuple[str, str], bool]:
        """Return for each pair whether it has ever touched."""
        return {names: touched(state) for names, state in self._states.items()}


def _geoms_of(model: mujoco.MjModel, names: tuple[str, str]) -> tuple[int, int]:
    """Return the ids of two geoms given by name, or refuse those that cannot slide on each other with friction."""
    pair = require_pair(names, [model.geom(i).name for i in range(model.ngeom)])
    if ANY in pair:
        raise InputError(f"{names!r}: a compiled model's pairs are named one by one; use add_friction(spec, ...) for '*'")
    body, surface = (model.geom(name).id for name in pair)
    if model.body_weldid[model.geom_bodyid[body]] == model.body_weldid[model.geom_bodyid[surface]]:
        raise InputError(f"geoms {names!r} belong to one rigid body, so they never slide on each other; choose geoms that move")
    condim = condim_of(model, body, surface)
    if condim == 0:
        raise InputError(
            f"geoms {names!r} never touch: their contype and conaffinity exclude each other and there is no pair of them; "
            "add a contact pair or change the masks"
        )
    if condim < 3:
        raise InputError(
            f"geoms {names!r} touch without friction (condim 1), so there is none for the law to set; give the pair, or one "
            "of the geoms, condim 3"
        )
    return body, surface


def _require_free(model: mujoco.MjModel, data: mujoco.MjData, states: Mapping[tuple[str, str], Array]) -> None:
    active = ROWS["state"][(ROWS["model"] == model._address) & (ROWS["data"] == data._address)]
    taken = [{header.geom_body, header.geom_surface} for header in (record_at(s.HEADER, state) for state in active)]
    for names, state in states.items():
        if {s.header_of(state).geom_body, s.header_of(state).geom_surface} in taken:
            raise InputError(f"pair {names!r} has friction from another context already; leave that one first")
    if np.count_nonzero(ROWS["model"] == 0) < len(states):
        raise InputError(f"more than {CAPACITY} pairs at a time; leave other friction contexts first")


def _installed() -> ctypes.c_void_p:
    """Return MuJoCo's ``mjcb_passive`` itself: what is written to its ``value`` is installed."""
    return ctypes.c_void_p.in_dll(library(), "mjcb_passive")
