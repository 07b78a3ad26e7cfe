"""The functions that an Exudyn system calls around its steps, shared by all its contacts and by the user's own."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import exudyn

from stochfric_mb.exudyn import methods
from stochfric_mb.exudyn.commits import Commits
from stochfric_mb.exudyn.contact import FrictionContact
from stochfric_mb.exudyn.stepping import advance

symbolic: Any = exudyn.symbolic  # pyright: ignore[reportAttributeAccessIssue]  # a compiled submodule
"""Exudyn's symbols."""
SWITCH_ERROR = 10.0
"""Error that makes Exudyn repeat a step with the recommended size (its tolerance is set below it)."""


class Hooks:
    """PostStep commits all contacts; PostNewton, while a switch may be near, asks for steps that end there.

    A system has one slot for each. Functions that were there, or that the user puts there later, are called after these.
    """

    def __init__(self, mbs: Any) -> None:
        self.contacts: list[FrictionContact] = []
        """All contacts of the system."""
        self.followers: list[Callable[[float], None]] = []
        """Functions of time [s] called after each accepted step, after the contacts have committed."""
        self.explicit = False
        """Whether the solver that runs, or ran last, integrates explicitly, and so computes no reactions."""
        self.running = False
        """Whether a solver runs whose contacts have been started."""
        self._mbs = mbs
        self._locating, self._joined = False, 0
        self._commits: Commits | None = None
        self._failure: BaseException | None = None
        self._own: dict[str, Callable[..., Any]] = {}
        self._other: dict[str, Callable[..., Any] | None] = {"PostStep": None, "PostNewton": None}

    @classmethod
    def of(cls, mbs: Any) -> Hooks:
        """Return the hooks of a system, made at the first call, and anew where the system was reset."""
        hooks = mbs.variables.get(methods.KEY)
        if hooks is None or (hooks._own and installed(mbs, "PostStep") is None):
            methods.wrap()
            hooks = mbs.variables[methods.KEY] = cls(mbs)
        return hooks

    def join(self) -> int:
        """Return the number of one more friction of the system: 0, 1, 2, ... in the order in which they are added."""
        self._joined += 1
        return self._joined - 1

    def find(self) -> bool:
        """Leave out contacts that were deleted from the system, and find those that moved; return whether any is left."""
        there = [contact for contact in self.contacts if contact.find()]
        if len(there) < len(self.contacts):
            self.contacts[:] = there
            self.install(locate=self._locating)
        return bool(there)

    @contextlib.contextmanager
    def in_progress(self) -> Iterator[None]:
        """Say while it lasts that a solver runs whose contacts have been started; raise what went wrong after a step."""
        before, self.running = self.running, True
        try:
            yield
            failure = self._failure
        finally:
            self.running, self._failure = before, None
        if failure is not None:
            raise failure

    def install(self, *, locate: bool) -> None:
        """Take the system's slots, remembering what is there; ``locate``: whether steps end where a law switches."""
        self._locating = locate
        for contact in self.contacts:
            contact.locate(locate)
        for slot in self._other:
            there = installed(self._mbs, slot)
            if there is not None and there is not self._own.get(slot):
                self._other[slot] = there
        self._fill()

    def chain(self, slot: str, function: Any) -> None:
        """Take a function that the user puts in a slot, 0 for none, to be called after ours."""
        methods.fill(self._mbs, slot, function)
        self._other[slot] = installed(self._mbs, slot)
        self._fill()

    def _fill(self) -> None:
        self._own = {"PostStep": self._post_step(), "PostNewton": self._post_newton()}
        methods.fill(self._mbs, "PostStep", self._own["PostStep"])
        self.watch()

    @contextlib.contextmanager
    def put_aside(self) -> Iterator[None]:
        """Empty the system's slots for a trial run that nobody is to notice, and fill them again after it."""
        there = {slot: _content(self._mbs, slot) for slot in ("PreStep", "PostStep", "PostNewton")}
        try:
            for slot in there:
                methods.fill(self._mbs, slot, 0)
            yield
        finally:
            for slot, function in there.items():
                methods.fill(self._mbs, slot, function)

    def watch(self) -> None:
        """Put PostNewton in place while it is needed, and take it away otherwise: it costs as much as a step."""
        other = self._other["PostNewton"]
        needed = self._locating and (other is not None or any(c.watched for c in self.contacts))
        if needed or any(c.refines for c in self.contacts):
            methods.fill(self._mbs, "PostNewton", self._own["PostNewton"])
        else:
            methods.fill(self._mbs, "PostNewton", other or 0)

    def _post_step(self) -> Callable[[Any, float], bool]:
        """Return the function that commits all contacts, then calls the user's: compiled where the engine calls such."""
        contacts, other, followers = self.contacts, self._other["PostStep"], tuple(self.followers)
        wheres, settles = [c.where for c in contacts], [c.settle for c in contacts]

        def finish(t: float, bits: Sequence[int]) -> bool:
            if self._failure is not None:
                return False
            try:
                for settle, its in zip(settles, bits, strict=True):
                    if its and settle(t, its):
                        self.watch()
                for follow in followers:
                    follow(t)
                return True if other is None else bool(other(self._mbs, t))
            except BaseException as error:
                self._failure = error
                return False

        self._commits = self._commits or Commits(self, self._mbs)
        function = self._commits.serve(wheres, finish, always=bool(followers or other))
        return function or (lambda _mbs, t: finish(t, [advance(t, where) for where in wheres]))

    def _post_newton(self) -> Callable[[Any, float], list[float]]:
        """Return the function that asks for a shorter step where a contact switches, and otherwise calls the user's."""
        contacts, other = self.contacts, self._other["PostNewton"]

        def post_newton(mbs: Any, t: float) -> list[float]:
            if sum(contact.refine(t) for contact in contacts):  # all of them
                return [SWITCH_ERROR, -1.0]
            steps = [step for contact in contacts if (step := contact.recommended_step(t)) > 0.0] if self._locating else []
            error, step = (0.0, -1.0) if other is None else other(mbs, t)
            if not steps:
                return [error, step]
            return [max(abs(error), SWITCH_ERROR), min(steps if step < 0.0 else [*steps, step])]

        return post_newton


def installed(mbs: Any, slot: str) -> Callable[..., Any] | None:
    """Return the function in one of the system's slots, or None."""
    function = _content(mbs, slot)
    if isinstance(function, symbolic.UserFunction):
        return function.Evaluate
    return function if callable(function) else None


def _content(mbs: Any, slot: str) -> Any:
    """Return what is in one of the system's slots as it can be put there again: a function, a symbolic one, or 0."""
    there = getattr(mbs, f"Get{slot}UserFunction")()
    return there["function"] if isinstance(there, dict) else there
