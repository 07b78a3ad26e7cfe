"""Where the normal force of a contact comes from: a constant, a function of time, or the reaction of a constraint."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import exudyn

from stochfric_mb.errors import InputError, require_number

_OUTPUT = exudyn.OutputVariableType
_OBJECT_INDEX: Any = exudyn.ObjectIndex  # pyright: ignore[reportAttributeAccessIssue]  # a compiled name

JUMP, RESOLUTION = 1.0e-3, 1.0e-9
"""Part of the normal force that it must change by in a step to be looked at for a jump, and part of the step to which one is
located."""


class ConstantNormal:
    """The same normal force at all times."""

    changes = False
    """Whether it has to be asked for after each step."""
    reaction = False
    """Whether it is a result of the step: known only after it, and only where the solver computes reactions."""

    def __init__(self, force: float) -> None:
        self.force = force
        """Normal force [N]."""

    def at(self, t: float) -> float:
        """Return the normal force [N] at time t [s]."""
        return self.force


class TimedNormal:
    """A normal force that is a function of time."""

    changes, reaction = True, False

    def __init__(self, function: Callable[[float], float]) -> None:
        self._function = function

    def at(self, t: float) -> float:
        """Return the normal force [N] at time t [s], 0 where the function is negative.

        Raises:
            InputError: it is not a finite number.
        """
        return max(require_number(f"normal_force at t = {t:g} s", self._function(t), unit="N"), 0.0)

    def jump(self, t: float, ahead: float) -> tuple[float, float]:
        """Return the times [s] just before and after the first jump in the interval ``ahead`` [s] from t on; infinity: none.

        A step in which the middle is far from half way is halved; what then still changes as much has jumped.
        """
        low, high = t, t + ahead
        at_low, at_high = self.at(low), self.at(high)
        whole = abs(at_high - at_low)
        if whole <= JUMP * max(at_low, at_high) or abs(self.at(t + 0.5 * ahead) - 0.5 * (at_low + at_high)) <= 0.25 * whole:
            return math.inf, math.inf
        while high - low > RESOLUTION * ahead and low < 0.5 * (low + high) < high:
            middle = 0.5 * (low + high)
            at_middle = self.at(middle)
            if abs(at_middle - at_low) > 0.25 * whole:
                high, at_high = middle, at_middle
            else:
                low, at_low = middle, at_middle
        return (low, high) if abs(at_high - at_low) > 0.25 * whole else (math.inf, math.inf)


class ReactionNormal:
    """The size of a constraint's reaction."""

    changes, reaction = True, True

    def __init__(self, mbs: Any, number: Any, across: Sequence[int] = (0, 1, 2)) -> None:
        """Read the reaction of object ``number``, of which the components ``across`` press the surfaces together."""
        self._mbs, self._object, self._across = mbs, number, across
        kind = mbs.GetObject(number)["objectType"]
        if not (kind.startswith("Joint") or "Coordinate" in kind) or "Spring" in kind:
            raise InputError(
                f"normal_force: object {int(number)} is a {kind}; name a constraint or a joint, whose "
                "reaction is the normal force"
            )
        local = kind.startswith("Joint") and kind != "JointRevolute2D"
        self._variable = _OUTPUT.ForceLocal if local else _OUTPUT.Force

    def at(self, t: float) -> float:
        """Return the normal force [N] after the last step; ``t`` is not used."""
        force = self._mbs.GetObjectOutput(self._object, self._variable)
        if isinstance(force, float):
            return abs(force)
        return math.hypot(*(force[i] for i in self._across if i < len(force)))


Normal = ConstantNormal | TimedNormal | ReactionNormal


def as_normal(mbs: Any, normal_force: Any) -> Normal:
    """Return the source of a normal force.

    Args:
        mbs: the system.
        normal_force: number [N], > 0; function of time; constraint or joint, by its index or its name.

    Raises:
        InputError: it is none of these, or a name or index that the system does not have.
    """
    if isinstance(normal_force, _OBJECT_INDEX):
        return ReactionNormal(mbs, normal_force)
    if isinstance(normal_force, str):
        names = [mbs.GetObject(i)["name"] for i in range(mbs.systemData.NumberOfObjects())]
        if normal_force not in names:
            raise InputError(f"normal_force: no object is called {normal_force!r}; there are {', '.join(names)}")
        return ReactionNormal(mbs, mbs.GetObjectNumber(normal_force))
    if callable(normal_force):
        function: Any = normal_force
        return TimedNormal(function)
    return ConstantNormal(require_number("normal_force", normal_force, above=0.0, unit="N"))


NO_CONSTRAINT = (
    "a law with true stick is held by a constraint on velocities, for which explicit solvers have no use: take "
    "solve_dynamic(..., solver='generalized_alpha'); mbs.SolveDynamic needs generalizedAlpha.useNewmark and "
    "useIndex2Constraints"
)
NO_REACTION = (
    "an explicit solver computes no reactions, Exudyn reports them as 0: a normal force from a constraint needs "
    "solver='generalized_alpha', or give normal_force as a number or a function of time"
)
