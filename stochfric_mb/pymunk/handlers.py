"""The space's handler for all collisions, shared by the user's callbacks and the compiled ones; errors that come out.

pymunk calls, for every contact, the handlers of its collision types and then the one for all collisions. Friction uses
only the last, so whatever the user's callbacks set for a contact is known to it, and none of them is replaced. While a
space has friction, an exception in any of its Python collision callbacks is raised by ``space.step`` (pymunk alone
prints and drops it), and so is a failure of the friction itself.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
import pymunk
from pymunk._chipmunk_cffi import ffi, lib
from pymunk._collision_handler import CollisionHandler

from stochfric_mb.errors import InputError
from stochfric_mb.pymunk import contacts
from stochfric_mb.pymunk import records as r
from stochfric_mb.pymunk.layout import address_of

ALL = (None, None)
"""Key of the handler for all collisions."""
_PHASES = {"begin": r.OLD_BEGIN, "pre_solve": r.OLD_BEFORE, "post_solve": r.OLD_AFTER, "separate": r.OLD_SEPARATE}
_POINTERS = {"begin": "beginFunc", "pre_solve": "preSolveFunc", "post_solve": "postSolveFunc", "separate": "separateFunc"}
_LIBRARY = {
    "begin": "ext_cpCollisionBeginFunc", "pre_solve": "ext_cpCollisionPreSolveFunc",
    "post_solve": "ext_cpCollisionPostSolveFunc", "separate": "ext_cpCollisionSeparateFunc",
}  # fmt: skip
_Callback = Callable[[pymunk.Arbiter, pymunk.Space, Any], None]


class Member(Protocol):
    """What a space's friction has to offer to the callbacks."""

    table: npt.NDArray[np.int64]
    """Its table."""

    @property
    def time(self) -> float:
        """Time of the force last applied [s]."""
        ...

    @time.setter
    def time(self, value: float) -> None: ...

    def prepare(self, dt: float) -> None:
        """Get ready for steps of ``dt`` [s]."""

    def problem(self) -> Exception | None:
        """Return what went wrong, or None."""


def attach(space: pymunk.Space, member: Member) -> None:
    """Let the compiled callbacks serve one more friction of a space.

    Raises:
        InputError: the space has as many as it can.
    """
    handler = _shared(space)
    if len(handler.members) == r.MAX_TABLES:
        raise InputError(f"this space has {r.MAX_TABLES} frictions already; list several shapes in one add_friction instead")
    handler.members.append(member)
    handler.publish()


def detach(space: pymunk.Space, member: Member) -> None:
    """Let the callbacks serve a friction no longer; the last one leaves the space's handlers as they were."""
    handler = space._handlers.get(ALL)
    if not isinstance(handler, SharedHandler) or member not in handler.members:
        return
    handler.members.remove(member)
    handler.publish()
    if not handler.members:
        _release(space, handler)


def members(space: pymunk.Space) -> list[Member]:
    """Return the frictions of a space, in the order in which they are asked."""
    handler = space._handlers.get(ALL)
    return handler.members if isinstance(handler, SharedHandler) else []


def raise_after_step(space: pymunk.Space, error: BaseException) -> None:
    """Have ``space.step`` raise ``error`` once the step is done; the first error of a step counts."""
    space.add_post_step_callback(_raise, _KEY, error)


_KEY = "stochfric_mb.pymunk: error in a collision callback"


def _raise(space: pymunk.Space, key: str, error: BaseException) -> None:
    waiting = space._post_step_callbacks
    for done in list(waiting):  # pymunk clears them after the last one, which an error keeps it from
        del waiting[done]
        if done == key:
            break
    raise error


class Guarded:
    """A user's callback whose exception is raised after the step."""

    def __init__(self, function: _Callback) -> None:
        """Wrap ``function``."""
        self.function = function

    def __call__(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        """Call the function and keep its exception for the end of the step."""
        try:
            self.function(arbiter, space, data)
        except BaseException as error:
            raise_after_step(space, error)

    def __reduce__(self) -> tuple[Any, ...]:
        """Copy and pickle as the function alone: the copy of a space has no friction."""
        return _itself, (self.function,)


def _itself(function: _Callback) -> _Callback:
    return function


def _bare(function: Any) -> Any:
    return function.function if isinstance(function, Guarded) else function


def _guarded_property(phase: str) -> Any:
    def get(self: CollisionHandler) -> Any:
        return _bare(getattr(self, f"_{phase}"))

    def set_(self: GuardedHandler, function: Any) -> None:
        self.put(phase, function if function is None or isinstance(function, Guarded) else Guarded(function))

    return property(get, set_)


class GuardedHandler(CollisionHandler):
    """A collision handler whose callbacks are guarded, those set now and later."""

    def put(self, phase: str, function: Guarded | None) -> None:
        """Set one callback."""
        getattr(CollisionHandler, phase).fset(self, function)

    begin = _guarded_property("begin")  # pyright: ignore[reportIncompatibleMethodOverride]
    pre_solve = _guarded_property("pre_solve")  # pyright: ignore[reportIncompatibleMethodOverride]
    post_solve = _guarded_property("post_solve")  # pyright: ignore[reportIncompatibleMethodOverride]
    separate = _guarded_property("separate")  # pyright: ignore[reportIncompatibleMethodOverride]


class SharedHandler(GuardedHandler):
    """The handler for all collisions, with the compiled callbacks in it and the user's chained."""

    members: list[Member]
    """Frictions, those added first are asked first."""
    context: npt.NDArray[np.int64]
    """What the compiled callbacks know of this handler."""
    made: bool
    """Whether the handler was made for friction."""

    def put(self, phase: str, function: Guarded | None) -> None:
        """Chain one callback; the compiled one stays in front."""
        setattr(self, f"_{phase}", function)
        old = ffi.addressof(lib, "DoNothing") if function is None else getattr(lib, _LIBRARY[phase])
        self.context[_PHASES[phase]] = address_of(old)

    def publish(self) -> None:
        """Tell the compiled callbacks which tables there are."""
        self.context[r.N_TABLES] = len(self.members)
        for i, member in enumerate(self.members):
            self.context[r.TABLES + i] = member.table.ctypes.data


class _Alarm:
    """What pymunk's own C callback finds in place of a handler when the compiled callbacks need Python."""

    data = {"post_solve": None}  # noqa: RUF012  (never changed)

    def __init__(self, space: pymunk.Space, members: list[Member]) -> None:
        self.space = weakref.ref(space)
        self.members = members

    @property
    def _space(self) -> pymunk.Space | None:
        return self.space()

    def _post_solve(self, _arbiter: pymunk.Arbiter, space: pymunk.Space, _data: None) -> None:
        dt = float(lib.cpSpaceGetCurrentTimeStep(space._space))
        for member in self.members:
            try:
                member.prepare(dt)
                error = member.problem()
            except Exception as failure:
                error = failure
            if error is not None:
                raise_after_step(space, error)


class _Handlers(dict[Any, CollisionHandler]):
    """The handlers of a space with friction: new ones are guarded too."""

    def __setitem__(self, key: Any, handler: CollisionHandler) -> None:
        if not isinstance(handler, GuardedHandler):
            _guard(handler, GuardedHandler)
        super().__setitem__(key, handler)


_contexts: dict[int, tuple[npt.NDArray[np.int64], Any]] = {}
"""Contexts in use, kept until released: a space may call ``separate`` while it is being taken apart."""


def _shared(space: pymunk.Space) -> SharedHandler:
    """Return the space's handler for all collisions, with the compiled callbacks in it."""
    present = space._handlers.get(ALL)
    if isinstance(present, SharedHandler):
        return present
    space._handlers = _Handlers(space._handlers)
    for handler in space._handlers.values():
        _guard(handler, GuardedHandler)
    made = ALL not in space._handlers
    space.on_collision(*ALL)
    handler: Any = space._handlers[ALL]
    frictions: list[Member] = []
    alarm = ffi.new_handle(_Alarm(space, frictions))
    context = np.zeros(r.CONTEXT, dtype=np.int64)
    context[r.OLD_DATA] = address_of(handler._handler.userData)
    context[r.ALARM] = address_of(lib.ext_cpCollisionPostSolveFunc)
    context[r.ALARM_DATA] = address_of(alarm)
    _contexts[context.ctypes.data] = context, alarm
    handler.context, handler.members, handler.made = context, frictions, made
    handler._handler.userData = ffi.cast("void *", context.ctypes.data)
    _guard(handler, SharedHandler)
    for phase, pointer in _POINTERS.items():
        address = ffi.cast("cpCollisionBeginFunc", getattr(contacts.callbacks(), phase))
        setattr(handler._handler, pointer, address)
    return handler


def _guard(handler: CollisionHandler, kind: type[GuardedHandler]) -> None:
    """Make a handler one of ``kind``, its callbacks guarded."""
    handler.__class__ = kind
    for phase in _PHASES:
        setattr(handler, phase, getattr(handler, phase))


def _release(space: pymunk.Space, handler: SharedHandler) -> None:
    """Give the handlers back to pymunk alone."""
    context, made = handler.context, handler.made
    handler._handler.userData = ffi.cast("void *", int(context[r.OLD_DATA]))
    del handler.context, handler.members, handler.made
    for each in space._handlers.values():
        callbacks = {phase: getattr(each, phase) for phase in _PHASES}
        each.__class__ = CollisionHandler
        for phase, function in callbacks.items():
            setattr(each, phase, function)
    space._handlers = dict(space._handlers)
    if made and not any(getattr(handler, phase) for phase in _PHASES):
        del space._handlers[ALL]
    if space._locked:  # released by a callback: the compiled one that called it still holds the context
        space.add_post_step_callback(_forget, context.ctypes.data)
    else:
        del _contexts[context.ctypes.data]


def _forget(_space: pymunk.Space, address: int) -> None:
    del _contexts[address]
