"""Stochastic friction between shapes of any pymunk space, from the moment it is added until it is removed."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pymunk
from pymunk._chipmunk_cffi import ffi, lib
from pymunk._collision_handler import CollisionHandler

from stochfric_mb.coefficients import CoefficientPath, PerEvent
from stochfric_mb.errors import InputError, SimulationError, require_number
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law
from stochfric_mb.laws.abi import native_law
from stochfric_mb.pymunk import contacts as c
from stochfric_mb.pymunk.layout import address_of, layout

Shapes = pymunk.Shape | Sequence[pymunk.Shape] | int
_PHASES = {"begin": c.OLD_BEGIN, "pre_solve": c.OLD_BEFORE, "post_solve": c.OLD_AFTER, "separate": c.OLD_SEPARATE}
_POINTERS = {"begin": "beginFunc", "pre_solve": "preSolveFunc", "post_solve": "postSolveFunc", "separate": "separateFunc"}
_LIBRARY = {
    "begin": "ext_cpCollisionBeginFunc", "pre_solve": "ext_cpCollisionPreSolveFunc",
    "post_solve": "ext_cpCollisionPostSolveFunc", "separate": "ext_cpCollisionSeparateFunc",
}  # fmt: skip


@dataclasses.dataclass(frozen=True)
class ContactReading:
    """What one contact had in the step last taken."""

    a: int
    """Number of shape a, in the order given (with collision types: pymunk's address of it)."""
    b: int
    """Number of shape b, likewise."""
    touching: bool
    """Whether the shapes touched in that step; forces are 0 where they did not."""
    force: float
    """Friction force on the body of a [N], positive along the velocity of b relative to a."""
    normal_force: float
    """Normal force [N]."""
    velocity: float
    """Velocity of b relative to a along the contact [m/s], along (n_y, -n_x) of the normal n from b to a."""
    mu_s: float
    """Static coefficient [-]."""
    mu_k: float
    """Kinetic coefficient [-]."""
    stick: bool
    """Whether the contact sticks."""


class ContactFriction:
    """Friction added to a space by `add_friction`; ``remove()`` takes it away."""

    def __init__(self, space: pymunk.Space, friction: Friction, path: CoefficientPath, table: npt.NDArray[np.int64]) -> None:
        """Hold what the compiled callbacks use; called by `add_friction`."""
        self.space = space
        self.friction = friction
        self.path = path
        self._table = table
        self._parameters = friction.law.parameters()
        self._pairs = np.zeros((int(table[c.CAPACITY]), c.PAIR), dtype=np.int64)
        self._slots = np.zeros((int(table[c.CAPACITY]), c.SLOT))
        self._clock = np.array([0.0, friction.law.stick_speed])
        self._handlers: list[CollisionHandler] = []
        self._names: dict[int, int] = {}
        table[c.PAIRS] = self._pairs.ctypes.data
        table[c.SLOTS] = self._slots.ctypes.data
        table[c.CLOCK] = self._clock.ctypes.data
        table[c.PARAMETERS] = self._parameters.ctypes.data
        table[c.DESCRIPTOR] = path.descriptor.ctypes.data

    @property
    def time(self) -> float:
        """Time of the force last applied [s]; the coefficients run along it."""
        return float(self._clock[c.NOW])

    @time.setter
    def time(self, value: float) -> None:
        self._clock[c.NOW] = value

    def readings(self) -> list[ContactReading]:
        """Return what each contact had in the step last taken, in the order in which contacts are numbered.

        Raises:
            SimulationError: see `check`.
        """
        self.check()
        now = lib.cpSpaceGetTimestamp(self.space._space)
        rows = zip(self._pairs[: self._table[c.USED]], self._slots, strict=False)
        return [self._reading(pair, slot, int(pair[c.STAMP]) == now) for pair, slot in rows]

    def step_limit(self) -> float:
        """Return the largest stable step [s] of the law for the contacts that touched in the step last taken."""
        now = lib.cpSpaceGetTimestamp(self.space._space)
        slots = self._slots[: self._table[c.USED]][self._pairs[: self._table[c.USED], c.STAMP] == now]
        limits = [self.friction.law.step_limit(s[c.NORMAL], s[c.EFFECTIVE_MASS]) for s in slots if s[c.NORMAL] > 0.0]
        return float(min(limits, default=math.inf))

    def slot(self, number: int = 0) -> npt.NDArray[np.float64]:
        """Return the live record of a contact (entries named in `stochfric_mb.pymunk.contacts`)."""
        return self._slots[number]

    def check(self) -> None:
        """Do nothing while all is well.

        Raises:
            SimulationError: the law gave a force that is not finite, or there are more contacts than ``max_contacts``.
        """
        problem = int(self._table[c.PROBLEM])
        if problem & c.NOT_FINITE:
            raise SimulationError(
                f"the law {self.friction.law.kind!r} gave a force that is not finite; lower dt or check its parameters"
            )
        if problem & c.OVERFLOW:
            raise SimulationError(
                f"more than max_contacts = {self._table[c.CAPACITY]} pairs of shapes touched, and the rest had pymunk's own "
                "friction; raise max_contacts"
            )

    def remove(self) -> None:
        """Take the friction away: the handlers and pymunk's own friction are as they were before."""
        for handler in self._handlers:
            _restore(handler)
        self._handlers.clear()

    def _reading(self, pair: npt.NDArray[np.int64], slot: npt.NDArray[np.float64], touching: bool) -> ContactReading:
        a, b = int(pair[c.SHAPE_A]), int(pair[c.SHAPE_B])
        return ContactReading(
            a=self._names.get(a, a),
            b=self._names.get(b, b),
            touching=touching,
            force=float(slot[c.FORCE]) if touching else 0.0,
            normal_force=float(slot[c.NORMAL]) if touching else 0.0,
            velocity=float(slot[c.VELOCITY]),
            mu_s=float(slot[c.MU_S]),
            mu_k=float(slot[c.MU_K]),
            stick=touching and bool(slot[c.STICK]),
        )


def add_friction(
    space: pymunk.Space,
    a: Shapes,
    b: Shapes,
    friction: Law | Friction,
    *,
    seed: int = 0,
    sample: int = 0,
    max_contacts: int = 256,
) -> ContactFriction:
    """Let a friction law act where ``a`` touches ``b``, instead of pymunk's own friction; the handle that undoes it.

    Laws with true stick (coulomb, karnopp, stribeck) set the cap of pymunk's own friction solver; all others are
    applied as forces. Nothing else changes: call ``space.step(dt)`` as before. The time of the coefficients starts at 0
    and each contact has a path of its own, numbered in the order of ``a`` then ``b``, or by first touch if collision
    types are given. Handlers on the same collision types go on working, those set later too.

    Args:
        space: the space.
        a: the bodies: a shape, shapes, or a collision type.
        b: the counter-surfaces: a shape, shapes, or a collision type.
        friction: a law, or a law with random coefficients.
        seed: first part of the address of the coefficient paths.
        sample: second part.
        max_contacts: most pairs of shapes that may ever touch, if collision types are given.

    Raises:
        InputError: shapes that are not in the space, sensors, or a mixture of shapes and types.
        SimulationError: this build of pymunk has an unknown layout.
    """
    friction = as_friction(friction)
    path = friction.path(seed, sample)
    pairs = [] if isinstance(a, int) and isinstance(b, int) else _pairs(space, a, b)
    capacity = len(pairs) or int(require_number("max_contacts", max_contacts, low=1.0))
    table = _table(friction, path, capacity)
    table[c.LAST_STAMP] = lib.cpSpaceGetTimestamp(space._space)
    handle = ContactFriction(space, friction, path, table)
    if isinstance(a, int) and isinstance(b, int):
        table[[c.BY_TYPE, c.TYPE_A, c.TYPE_B]] = 1, a, b
        keys: Iterable[tuple[int, int]] = [(a, b)]
    else:
        _fill(handle, pairs)
        keys = _keys(space, pairs)
    for key in keys:
        handle._handlers.append(_take_over(space, key, handle))
    return handle


def _pairs(space: pymunk.Space, a: Shapes, b: Shapes) -> list[tuple[pymunk.Shape, pymunk.Shape]]:
    if isinstance(a, int) or isinstance(b, int):
        raise InputError(f"a = {a!r} and b = {b!r}: give shapes for both, or collision types for both")
    first = [a] if isinstance(a, pymunk.Shape) else list(a)
    second = [b] if isinstance(b, pymunk.Shape) else list(b)
    for shape in first + second:
        if shape.space is not space:
            raise InputError(f"shape {shape!r} is not in this space; add it to the space before its friction")
        if shape.sensor:
            raise InputError(f"shape {shape!r} is a sensor and feels no contact force; set shape.sensor = False")
    pairs = [(x, y) for x in first for y in second if x.body is not y.body]
    if not pairs:
        raise InputError("a and b hold no two shapes on different bodies; nothing could touch")
    return pairs


def _table(friction: Friction, path: CoefficientPath, capacity: int) -> npt.NDArray[np.int64]:
    law = friction.law
    functions = native_law(law.kind)
    table = np.zeros(c.TABLE, dtype=np.int64)
    table[c.CAPACITY] = capacity
    table[[c.INIT, c.FORCE_LAW, c.COMMIT, c.GUARD]] = functions.init, functions.force, functions.commit, functions.guards
    table[c.DESCRIPTOR_SIZE] = len(path.descriptor)
    table[[c.SEED, c.SAMPLE]] = path.seed, path.sample
    table[c.HAS_MODE] = law.state_names[:1] == ("mode",)
    table[c.PER_EVENT] = isinstance(friction.process, PerEvent)
    table[c.HOLDING] = law.needs_holding_force
    table[c.STATEFUL] = bool(law.state_names)
    table[c.LAYOUT :] = layout()
    return table


def _fill(handle: ContactFriction, pairs: list[tuple[pymunk.Shape, pymunk.Shape]]) -> None:
    for i, (x, y) in enumerate(pairs):
        handle._pairs[i] = address_of(x._shape), address_of(y._shape), i, -1
    for shapes in zip(*pairs, strict=True):
        for i, shape in enumerate(dict.fromkeys(shapes)):
            handle._names[address_of(shape._shape)] = i
    handle._table[c.USED] = len(pairs)


def _keys(space: pymunk.Space, pairs: list[tuple[pymunk.Shape, pymunk.Shape]]) -> list[tuple[int, int]]:
    """Return the pairs of collision types to listen to, each unordered pair once, as the user ordered it if he did."""
    keys: dict[frozenset[int], tuple[int, int]] = {}
    for x, y in pairs:
        key = (x.collision_type, y.collision_type)
        turned = (y.collision_type, x.collision_type)
        keys.setdefault(frozenset(key), turned if turned in space._handlers else key)
    return list(keys.values())


class _SharedHandler(CollisionHandler):
    """A collision handler whose Python callbacks are called by the compiled ones, in the order of time."""

    _context: npt.NDArray[np.int64]
    _friction: ContactFriction

    def _chain(self, phase: str, function: Callable[..., None] | None) -> None:
        setattr(self, f"_{phase}", function)
        self._context[_PHASES[phase]] = address_of(_original(phase, function))
        if phase in ("begin", "separate"):
            ours = getattr(c.callbacks(), phase)
            pointer = _original(phase, None) if function is None else ffi.cast("cpCollisionBeginFunc", ours)
            setattr(self._handler, _POINTERS[phase], pointer)

    begin = property(lambda self: self._begin, lambda self, f: self._chain("begin", f))  # pyright: ignore[reportIncompatibleMethodOverride]
    pre_solve = property(lambda self: self._pre_solve, lambda self, f: self._chain("pre_solve", f))  # pyright: ignore[reportIncompatibleMethodOverride]
    post_solve = property(lambda self: self._post_solve, lambda self, f: self._chain("post_solve", f))  # pyright: ignore[reportIncompatibleMethodOverride]
    separate = property(lambda self: self._separate, lambda self, f: self._chain("separate", f))  # pyright: ignore[reportIncompatibleMethodOverride]


_contexts: dict[int, npt.NDArray[np.int64]] = {}
"""Contexts in use, kept until removed: a space may call ``separate`` while it is being taken apart."""


def _original(phase: str, function: Callable[..., None] | None) -> Any:
    return ffi.addressof(lib, "DoNothing") if function is None else getattr(lib, _LIBRARY[phase])


def _take_over(space: pymunk.Space, key: tuple[int, int], handle: ContactFriction) -> CollisionHandler:
    """Put the compiled callbacks in front of a handler's own; what was there is chained."""
    space.on_collision(*key)
    handler: Any = space._handlers[key]
    if isinstance(handler, _SharedHandler):
        raise InputError(
            f"collision types {key} already have friction; remove() it first, or give all shapes of these types at once"
        )
    context = np.zeros(c.CONTEXT, dtype=np.int64)
    context[c.OLD_DATA] = address_of(handler._handler.userData)
    context[c.TABLE_ADDRESS] = handle._table.ctypes.data
    _contexts[context.ctypes.data] = context
    handler.__class__ = _SharedHandler
    handler._context, handler._friction = context, handle
    handler._handler.userData = ffi.cast("void *", context.ctypes.data)
    for phase in _PHASES:
        handler._chain(phase, getattr(handler, f"_{phase}"))
    handler._handler.preSolveFunc = ffi.cast("cpCollisionPreSolveFunc", c.callbacks().before)
    handler._handler.postSolveFunc = ffi.cast("cpCollisionPostSolveFunc", c.callbacks().after)
    return handler


def _restore(handler: CollisionHandler) -> None:
    """Give a handler back to pymunk alone."""
    assert isinstance(handler, _SharedHandler)
    context = handler._context
    handler._handler.userData = ffi.cast("void *", int(context[c.OLD_DATA]))
    del handler._context, handler._friction
    handler.__class__ = CollisionHandler  # pyright: ignore[reportAttributeAccessIssue]
    for phase in _PHASES:
        setattr(handler, phase, getattr(handler, f"_{phase}"))
    del _contexts[context.ctypes.data]
