"""The functions that an Exudyn system calls around its steps, shared by all its contacts and by the user's own."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Protocol

import exudyn

from stochfric_mb.exudyn import methods
from stochfric_mb.exudyn.commits import Commits
from stochfric_mb.exudyn.stepping import advance

symbolic: Any = exudyn.symbolic  # pyright: ignore[reportAttributeAccessIssue]  # a compiled submodule
"""Exudyn's symbols."""
SWITCH_ERROR = 10.0
"""Error that makes Exudyn repeat a step with the recommended size (its tolerance is set below it)."""


class Contact(Protocol):
    """What hooks need of a contact."""

    where: int
    """Address of the contact for compiled code."""

    @property
    def watched(self) -> bool:
        """Whether the next step may contain a switch."""
        ...

    def settle(self, t: float, bits: int) -> bool:
        """Do what `advance` asks for; return whether `watched` may have changed."""
        ...

    def prepare(self, dt: float, start: float) -> None:
        """Start afresh with the solver's step [s] at the time ``start`` [s]."""
        ...

    def begin(self, dt: float, start: float) -> bool:
        """Start afresh, unless a simulation goes on where it has stopped at the time ``start`` [s]; return which."""
        ...

    @property
    def time(self) -> float:
        """Time of the last accepted step [s]; not a number before the first."""
        ...

    def find(self) -> bool:
        """Find the contact's item in the system again, which others that are deleted renumber; False: it is gone."""
        ...

    def require_friction_at_rest(self) -> None:
        """Do nothing if the law gives friction without motion."""
        ...

    def locate(self, on: bool) -> None:
        """Say whether steps are to end where the law switches."""
        ...

    is_load: bool
    """Whether the force is a load."""
    true_stick: bool
    """Whether a constraint holds the contact while it sticks."""

    def step_limit(self) -> tuple[float, str]:
        """Return the largest step [s] of an explicit solver so far, and the formula behind it."""
        ...

    @property
    def needs_reactions(self) -> bool:
        """Whether the normal force is a reaction, which explicit solvers do not compute."""
        ...

    @property
    def refines(self) -> bool:
        """Whether trial steps tell what friction needs: one before the first step, and steps that are repeated."""
        ...

    def refine(self, t: float) -> bool:
        """Take what the trial step to t [s] tells; return whether the step must be repeated."""
        ...

    def take_trial(self) -> None:
        """Take what a trial step at the start tells."""
        ...

    def recommended_step(self, t: float) -> float:
        """Return the step [s] to repeat the one that ends at t with, or -1 to accept it."""
        ...


class Hooks:
    """PostStep commits all contacts; PostNewton, while a switch may be near, asks for steps that end there.

    A system has one slot for each. Functions that were there, or that the user puts there later, are called after these.
    """

    def __init__(self, mbs: Any) -> None:
        self.contacts: list[Contact] = []
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
