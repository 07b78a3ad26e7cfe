"""Friction for a model that is compiled already, through ``mjcb_passive`` as a native function.

``mjcb_passive`` is one pointer for the whole process. The first `friction` context installs a function that calls what
was installed before and then serves every active context, found by the addresses of model and data; the last one puts
the earlier function back. The friction's state lies in the context, since such a model has no plugin state: copies of
the data and of the model are not covered, and are refused.

There is no ``advance`` here, so a step counts as accepted when the next one begins. Contact forces are gone by then:
the normal forces come from one more solution of MuJoCo's constraints at each step's start.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# pyright: reportCallIssue=false, reportAttributeAccessIssue=false
# (compiled functions are typed by numba; MuJoCo's bindings are not typed)

from __future__ import annotations

import ctypes
import functools
import threading
import warnings
from collections.abc import Mapping
from types import TracebackType
from typing import Any

import mujoco
import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from stochfric_mb.compile import compiled, native
from stochfric_mb.errors import InputError, SimulationError, require_name
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.mujoco import native as n
from stochfric_mb.mujoco import slots as s
from stochfric_mb.mujoco.attach import reading_of, require_slots
from stochfric_mb.mujoco.config import (
    R_DESCRIPTOR,
    R_HAS_MODE,
    R_LAW,
    R_N_DESCRIPTOR,
    R_N_PARAMETERS,
    R_NEEDS_MASS,
    R_PARAMETERS,
    R_STICK_SPEED,
    configuration,
    record_of,
)
from stochfric_mb.mujoco.contact import apply, begin, find, slot
from stochfric_mb.mujoco.dof import RUNGE_KUTTA
from stochfric_mb.mujoco.kinematics import contact_address, ordinal_of, side
from stochfric_mb.mujoco.options import check_options
from stochfric_mb.mujoco.plugin import UNSET, register
from stochfric_mb.mujoco.reading import Reading

MODEL, DATA, STATE, PHASE, SIGNATURE, GEOM_A, GEOM_B, WIDTH = range(8)
"""Words of a context's row: three addresses, evaluations since the step began, the model's signature, two geoms whose
native friction was switched off (-1 where an explicit pair had it)."""
CAPACITY = 256
"""Most pairs at a time, all contexts together."""
_rows = np.zeros((CAPACITY, WIDTH), dtype=np.int64)
_message = ctypes.create_string_buffer(
    b"stochfric_mb: this model's native friction is switched off by friction(model, data, ...), which covers that one "
    b"MjData only; copies, rollout and Batch need the friction in the model: add_friction(spec, ...)"
)
_lock = threading.Lock()
_alive: list[Any] = []


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
    ) -> None:
        """Prepare friction; nothing changes before the context is entered.

        Args:
            model: the model; its native friction of these pairs is off within the context, and back after it.
            data: the one data that is covered.
            pairs: (body's geom, counter-surface's geom) -> law, or `Friction` with a coefficient process.
            seed: first part of the coefficient paths' address; the third is the number of the pair in ``pairs``.
            sample: second part: the run of an ensemble.
            slots: most contacts of a pair at a time.

        Raises:
            InputError: data of another model, unknown geoms, geoms that cannot touch, a pair whose native friction
                cannot be switched off alone, or passive forces that are disabled.

        Warns:
            IntegratorWarning: the model uses the ``discrete`` integrator.
        """
        if data.model is not model and data.model._address != model._address:
            raise InputError("data belongs to another model; pass the model that it was made with")
        check_options(model.opt.disableflags, model.opt.integrator)
        self._model, self._data = model, data
        self._pairs = {names: _geoms(model, names) for names in pairs}
        self._plans = {names: _plan(model, geoms, names) for names, geoms in self._pairs.items()}
        self._states: dict[tuple[str, str], np.ndarray[Any, np.dtype[np.float64]]] = {}
        for contact, (names, law) in enumerate(pairs.items()):
            state = _fresh_state(as_friction(law), require_slots(slots), seed=seed, sample=sample, contact=contact)
            state[s.GEOM_BODY], state[s.GEOM_SURFACE] = self._pairs[names]
            self._states[names] = state
        self._kept: list[tuple[Any, int, int]] = []
        self._places: list[int] = []

    def __enter__(self) -> friction:
        """Switch the pairs' native friction off and this friction on."""
        register()
        with _lock:
            _require_free(self._model, self._data, self._pairs)
            for names, state in self._states.items():
                geoms, plan = self._pairs[names], self._plans[names]
                for array, place in plan:
                    self._kept.append((array, place, int(array[place])))
                    array[place] = 1
                place = int(np.flatnonzero(_rows[:, MODEL] == 0)[0])
                own = (-1, -1) if len(plan) == 1 else geoms
                _rows[place, 1:] = (
                    self._data._address, state.ctypes.data, 0, np.uint64(self._model.signature).astype(np.int64), *own
                )  # fmt: skip
                _rows[place, MODEL] = self._model._address  # last: a row with a model is complete
                self._places.append(place)
            _install()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        """Put the model and ``mjcb_passive`` back as they were.

        Raises:
            SimulationError: someone replaced ``mjcb_passive`` within the context, which switched the friction off.
        """
        with _lock:
            _rows[self._places, MODEL] = 0
            for array, place, value in reversed(self._kept):
                array[place] = value
            self._kept, self._places = [], []
            replaced = _uninstall()
        if error is None:
            self._warn_untouched()
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


def _geoms(model: mujoco.MjModel, names: tuple[str, str]) -> tuple[int, int]:
    if isinstance(names, str) or len(names) != 2:
        raise InputError(f"{names!r} is not a pair; give (body's geom, counter-surface's geom)")
    known = [model.geom(i).name for i in range(model.ngeom) if model.geom(i).name]
    body, surface = (model.geom(require_name("geom", name, known)).id for name in names)
    if model.body_weldid[model.geom_bodyid[body]] == model.body_weldid[model.geom_bodyid[surface]]:
        raise InputError(f"geoms {names!r} belong to one rigid body, so they never slide on each other; choose geoms that move")
    return body, surface


def _plan(model: mujoco.MjModel, geoms: tuple[int, int], names: tuple[str, str]) -> list[tuple[Any, int]]:
    """Return the integers of the model that must be 1 for the pair to have no native friction.

    Raises:
        InputError: the geoms never touch, or other contacts would change too.
    """
    for i in range(model.npair):
        if {int(model.pair_geom1[i]), int(model.pair_geom2[i])} == set(geoms):
            return [(model.pair_dim, i)]
    if not _may_touch(model, *geoms):
        raise InputError(
            f"geoms {names!r} never touch: their contype and conaffinity exclude each other and there is no pair of them; "
            "add a contact pair or change the masks"
        )
    changed = model.geom_condim.copy()
    changed[list(geoms)] = 1
    for geom in geoms:
        for other in range(model.ngeom):
            if {geom, other} == set(geoms) or not _may_touch(model, geom, other):
                continue
            if _dimension(model, model.geom_condim, geom, other) != _dimension(model, changed, geom, other):
                raise InputError(
                    f"native friction of {names!r} cannot be switched off without that of {model.geom(geom).name!r} and "
                    f"{model.geom(other).name or f'geom {other}'!r}; name the pair in the model (<contact><pair .../>) or use "
                    "add_friction(spec, ...)"
                )
    return [(model.geom_condim, geom) for geom in geoms]


def _may_touch(model: mujoco.MjModel, a: int, b: int) -> bool:
    if model.body_weldid[model.geom_bodyid[a]] == model.body_weldid[model.geom_bodyid[b]]:
        return False
    return bool(model.geom_contype[a] & model.geom_conaffinity[b] or model.geom_contype[b] & model.geom_conaffinity[a])


def _dimension(model: mujoco.MjModel, condim: Any, a: int, b: int) -> int:
    if model.geom_priority[a] != model.geom_priority[b]:
        return int(condim[a if model.geom_priority[a] > model.geom_priority[b] else b])
    return int(max(condim[a], condim[b]))


def _fresh_state(friction: Friction, slots: int, **address: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the state that the plugin would start with (no model is compiled: that would run others' callbacks)."""
    texts = configuration(friction, "", "", mode="explicit", slots=slots, **address)
    record = record_of(texts["law"], texts["coefficients"], 0)
    n_descriptor = int(record[R_N_DESCRIPTOR])
    state = np.zeros(s.state_size(n_descriptor, slots, 0))
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
        s.MODE: s.EXPLICIT,
        s.ADVANCED: UNSET,
        s.EVALUATED: UNSET,
        s.COEFFICIENTS: UNSET,
    }.items():
        state[place] = value
    state[s.PARAMETERS : s.PARAMETERS + s.MAX_PARAMETERS] = record[R_PARAMETERS : R_PARAMETERS + s.MAX_PARAMETERS]
    state[s.DESCRIPTOR : s.DESCRIPTOR + n_descriptor] = record[R_DESCRIPTOR:]
    return state


def _require_free(model: mujoco.MjModel, data: mujoco.MjData, pairs: Mapping[tuple[str, str], tuple[int, int]]) -> None:
    active = _rows[(_rows[:, MODEL] == model._address) & (_rows[:, DATA] == data._address)]
    taken = [_state_geoms(int(row[STATE])) for row in active]
    for names, geoms in pairs.items():
        if set(geoms) in taken:
            raise InputError(f"pair {names!r} has friction from another context already; leave that one first")
    if np.count_nonzero(_rows[:, MODEL] == 0) < len(pairs):
        raise InputError(f"more than {CAPACITY} pairs at a time; leave other friction contexts first")


def _state_geoms(address: int) -> set[int]:
    state = (ctypes.c_double * (s.GEOM_SURFACE + 1)).from_address(address)
    return {int(state[s.GEOM_BODY]), int(state[s.GEOM_SURFACE])}


def _pointer() -> ctypes.c_void_p:
    return ctypes.c_void_p.in_dll(n.library(), "mjcb_passive")


@functools.cache
def _function() -> int:
    """Return the address of the compiled callback."""
    made = native(_passive, types.void(types.intp, types.intp))
    _alive.append(made)
    n.TABLE[n.CALLBACK_ROWS] = _rows.ctypes.data
    n.TABLE[n.CALLBACK_MESSAGE] = ctypes.addressof(_message)
    return made.address


def _install() -> None:
    pointer, ours = _pointer(), _function()
    if pointer.value != ours:
        n.TABLE[n.CALLBACK_BEFORE] = pointer.value or 0
        pointer.value = ours


def _uninstall() -> bool:
    """Put the earlier callback back after the last context; return whether ours was not in its place."""
    pointer = _pointer()
    replaced = pointer.value != _function()
    if not replaced and not _rows[:, MODEL].any():
        pointer.value = n.TABLE[n.CALLBACK_BEFORE] or None
    return replaced


def _passive(model, data):
    before = n.entry(n.CALLBACK_BEFORE)
    if before != 0:
        call_before(before, model, data)
    table = n.entry(n.CALLBACK_ROWS)
    known, foreign = False, False
    for i in range(CAPACITY):
        row = table + 8 * WIDTH * i
        if n.load_word(row + 8 * MODEL) == 0:
            continue
        if n.load_word(row + 8 * MODEL) == model:
            if n.load_word(row + 8 * DATA) == data:
                evaluate_row(model, data, row)
                known = True
            else:
                foreign = True
        elif is_copy(model, row):
            foreign = True
    if foreign and not known:
        n.mju_error(n.entry(n.CALLBACK_MESSAGE))


@intrinsic
def call_before(typingctx, address, model, data):
    """Call a callback ``void (const mjModel*, mjData*)`` at an address."""

    def generate(context, builder, signature, args):
        kind = ir.FunctionType(ir.VoidType(), [ir.IntType(64), ir.IntType(64)])
        builder.call(builder.inttoptr(args[0], kind.as_pointer()), list(args[1:]))
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, types.intp), generate


@compiled
def is_copy(model, row):
    """Return whether a model is a copy, with native friction off, of the row's model."""
    if n.load_word(model + n.offset(n.M_SIGNATURE)) != n.load_word(row + 8 * SIGNATURE) or n.load_word(row + 8 * GEOM_A) < 0:
        return False
    condim = n.pointer_field(model, n.M_GEOM_CONDIM)
    a, b = n.load_word(row + 8 * GEOM_A), n.load_word(row + 8 * GEOM_B)
    return n.load_int(condim + 4 * a) == 1 and n.load_int(condim + 4 * b) == 1


@compiled
def evaluate_row(model, data, row):
    """Add the friction of one pair; a step that has just been accepted is committed first."""
    state = n.load_word(row + 8 * STATE)
    now, step = n.number_field(data, n.D_TIME), n.number_field(model, n.M_TIMESTEP)
    start = n.load(state + 8 * s.EVALUATED)
    phase = n.load_word(row + 8 * PHASE)
    if start < now <= start + 1.0001 * step:
        phase += 1
        stages = n.int_field(model, n.M_INTEGRATOR) == RUNGE_KUTTA and (phase > 1 or now < start + 0.75 * step)
        if stages and phase < 4:
            n.store_word(row + 8 * PHASE, phase)
            apply(model, data, state, n.pointer_field(data, n.D_WARMSTART))
            return
        keep_current(state, now)
        renew_normal_forces(model, data, state)
    elif now != start:
        n.store(state + 8 * s.N_COMMITTED, 0.0)
        n.store(state + 8 * s.ADVANCED, now)
        renew_normal_forces(model, data, state)
    n.store_word(row + 8 * PHASE, 0)
    begin(model, data, state, n.pointer_field(data, n.D_WARMSTART))
    apply(model, data, state, n.pointer_field(data, n.D_WARMSTART))


@compiled
def keep_current(state, now):
    """Make the current slots the committed ones."""
    count = int(n.load(state + 8 * s.N_CURRENT))
    n.copy_bytes(slot(state, 1, 0), slot(state, 0, 0), 8 * s.SLOT * count)
    n.store(state + 8 * s.N_COMMITTED, float(count))
    n.store(state + 8 * s.ADVANCED, now)


@compiled
def renew_normal_forces(model, data, state):
    """Give the committed slots the normal forces of a solution at this instant, with the friction of the last ones."""
    nv = n.int_field(model, n.M_NV)
    passive = n.vector(n.pointer_field(data, n.D_QFRC_PASSIVE), nv)
    qacc = n.vector(n.pointer_field(data, n.D_QACC), nv)
    actuator = n.vector(n.pointer_field(data, n.D_QFRC_ACTUATOR), nv)
    kept_passive, kept_qacc, kept_actuator = passive.copy(), qacc.copy(), actuator.copy()
    begin(model, data, state, n.pointer_field(data, n.D_WARMSTART))
    apply(model, data, state, n.pointer_field(data, n.D_WARMSTART))
    n.mj_rne(model, data, np.int32(0), n.pointer_field(data, n.D_QFRC_BIAS))
    n.mj_referenceConstraint(model, data)
    n.mj_fwdActuation(model, data)
    n.mj_fwdAcceleration(model, data)
    n.mj_fwdConstraint(model, data)
    write_normal_forces(model, data, state)
    n.move(kept_passive, passive)
    n.move(kept_qacc, qacc)
    n.move(kept_actuator, actuator)


@compiled
def write_normal_forces(model, data, state):
    """Write the contacts' normal forces to the committed slots; new contacts get a slot without a law state."""
    body, surface = int(n.load(state + 8 * s.GEOM_BODY)), int(n.load(state + 8 * s.GEOM_SURFACE))
    count, wrench = int(n.load(state + 8 * s.N_COMMITTED)), state + 8 * s.FORCE
    for i in range(n.int_field(data, n.D_NCON)):
        contact = contact_address(data, i)
        if side(contact, body, surface) == 0:
            continue
        a, b = n.int_field(contact, n.C_GEOM), n.load_int(n.field(contact, n.C_GEOM) + 4)
        ordinal = ordinal_of(data, i)
        address = find(slot(state, 0, 0), count, a, b, ordinal, 0) if count > 0 else 0
        if address == 0:
            if count == int(n.load(state + 8 * s.N_SLOTS)):
                continue
            address = slot(state, 0, count)
            count += 1
            n.store(address + 8 * s.GEOM_1, a + 1.0)
            n.store(address + 8 * s.GEOM_2, b + 1.0)
            n.store(address + 8 * s.ORDINAL, float(ordinal))
            n.store(address + 8 * s.LIVE, 0.0)
        n.mj_contactForce(model, data, np.int32(i), wrench)
        n.store(address + 8 * s.NORMAL, max(n.load(wrench), 0.0))
    n.store(state + 8 * s.N_COMMITTED, float(count))
