"""Three methods of Exudyn's systems, wrapped so that friction survives what a script does with them.

A PostStep function of the user's alone would keep contacts from committing; implicit solvers ask for the force once before
any function of ours is called; and a solver's success says little. Systems without friction are left alone.
"""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Iterator
from typing import Any

import exudyn

from stochfric_mb.exudyn.outcome import SOLVERS, Outcome
from stochfric_mb.exudyn.reactions import find_reactions

KEY = "stochfric_mb"
"""Where a system's variables hold its hooks."""
NO_TOLERANCE = 1.0e30
"""A tolerance that no error estimate exceeds."""
_SETTERS: dict[str, Callable[[Any, Any], None]] = {}
"""Slot -> Exudyn's own method that fills it."""
_SOLVE: list[Callable[..., Any]] = []
"""Exudyn's own method that solves."""


def fill(mbs: Any, slot: str, function: Any) -> None:
    """Put a function in one of the system's slots as it is, 0 for none."""
    if slot in _SETTERS:
        _SETTERS[slot](mbs, function)
    else:
        getattr(mbs, f"Set{slot}UserFunction")(function)


def solve(mbs: Any, settings: Any, **options: Any) -> bool:
    """Return what Exudyn's SolveDynamic returns, contacts as they are."""
    with fixed_steps(settings.timeIntegration):
        return (_SOLVE[0] if _SOLVE else exudyn.MainSystem.SolveDynamic)(mbs, settings, **options)


@contextlib.contextmanager
def fixed_steps(integration: Any) -> Iterator[None]:
    """Let no error estimate end a run whose steps are fixed: DOPRI5 gives up at its first step beyond the tolerances."""
    if integration.automaticStepSize:
        yield
        return
    given = integration.absoluteTolerance, integration.relativeTolerance
    integration.absoluteTolerance = integration.relativeTolerance = NO_TOLERANCE
    try:
        yield
    finally:
        integration.absoluteTolerance, integration.relativeTolerance = given


def wrap() -> None:
    """Have systems with friction chain what the user puts in the slots, and start and check contacts when they are solved."""
    for slot in ("PostStep", "PostNewton"):
        if slot not in _SETTERS:
            _SETTERS[slot] = getattr(exudyn.MainSystem, f"Set{slot}UserFunction")
            setattr(exudyn.MainSystem, f"Set{slot}UserFunction", _chaining(slot))
    if not _SOLVE:
        _SOLVE.append(exudyn.MainSystem.SolveDynamic)
        exudyn.MainSystem.SolveDynamic = _checked(_SOLVE[0])


def _chaining(slot: str) -> Callable[[Any, Any], None]:
    def set_function(mbs: Any, value: Any) -> None:
        hooks = mbs.variables.get(KEY)
        if hooks is None:
            fill(mbs, slot, value)
        else:
            hooks.chain(slot, value)

    set_function.__doc__ = _SETTERS[slot].__doc__
    return set_function


def _checked(method: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(method)
    def solve_dynamic(mbs: Any, simulationSettings: Any = None, solverType: Any = None, *arguments: Any, **options: Any) -> Any:
        hooks = mbs.variables.get(KEY)
        if hooks is None or not hooks.contacts or simulationSettings is None:
            return method(mbs, simulationSettings, solverType, *arguments, **options)
        kind = SOLVERS["generalized_alpha"] if solverType is None else solverType
        name = next((name for name, known in SOLVERS.items() if known == kind), str(kind))
        outcome = Outcome(hooks.contacts, name, simulationSettings.timeIntegration, masses_needed=False)
        start = simulationSettings.timeIntegration.startTime
        fresh = [contact for contact in hooks.contacts if contact.begin(outcome.dt, start)]
        outcome.require_step()
        if outcome.implicit:
            find_reactions(mbs, simulationSettings, kind, fresh, solve, hooks.put_aside)
        with fixed_steps(simulationSettings.timeIntegration):
            success = method(mbs, simulationSettings, solverType, *arguments, **options)
        if success:
            outcome.require_success(mbs, success)
        return success

    return solve_dynamic
