"""Methods of Exudyn's systems and solvers, wrapped so that friction survives what a script does with them.

A PostStep function of the user's alone would keep contacts from committing; implicit solvers ask for the force once before
any function of ours is called; and a solver's success says little. Systems without friction are left alone.
"""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Iterator
from typing import Any

import exudyn

from stochfric_mb.errors import InputError
from stochfric_mb.exudyn.normal import NO_CONSTRAINT
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
    hooks = mbs.variables[KEY]
    with hooks.in_progress(), fixed_steps(settings.timeIntegration):
        return _SOLVE[0](mbs, settings, **options)


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
        for solver in (exudyn.MainSolverExplicit, exudyn.MainSolverImplicitSecondOrder):
            for name in ("SolveSystem", "InitializeSolver"):
                setattr(solver, name, _started(getattr(solver, name), static=False))
        # not InitializeSolver of the static one, with which Exudyn linearises systems
        exudyn.MainSolverStatic.SolveSystem = _started(exudyn.MainSolverStatic.SolveSystem, static=True)


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
        if hooks is None or hooks.running or simulationSettings is None or not hooks.find():
            return method(mbs, simulationSettings, solverType, *arguments, **options)
        kind = SOLVERS["generalized_alpha"] if solverType is None else solverType
        outcome = _start(mbs, hooks, simulationSettings, kind)
        with hooks.in_progress(), fixed_steps(simulationSettings.timeIntegration):
            success = method(mbs, simulationSettings, solverType, *arguments, **options)
        if success:
            outcome.require_success(mbs, success)
        return success

    return solve_dynamic


def _started(method: Any, *, static: bool) -> Callable[..., Any]:
    """Return a solver object's method that solves or initialises, with contacts started before it."""

    @functools.wraps(method)
    def solve_or_initialise(solver: Any, mainSystem: Any, simulationSettings: Any) -> Any:
        hooks = mainSystem.variables.get(KEY)
        if hooks is None or hooks.running or not hooks.find():
            return method(solver, mainSystem, simulationSettings)
        integration = simulationSettings.timeIntegration
        outcome = None
        if static:
            for contact in hooks.contacts:
                contact.require_friction_at_rest()
                contact.prepare(1.0 / max(simulationSettings.staticSolver.numberOfLoadSteps, 1), 0.0)
        else:
            outcome = _start(mainSystem, hooks, simulationSettings, integration.solverType)
        with hooks.in_progress(), fixed_steps(integration):
            success = method(solver, mainSystem, simulationSettings)
        if success and outcome is not None and method.__name__ == "SolveSystem":
            outcome.require_success(mainSystem, success)
        return success

    return solve_or_initialise


def _start(mbs: Any, hooks: Any, settings: Any, kind: Any) -> Outcome:
    """Start the contacts of a system for one of Exudyn's dynamic solvers; return the checks of its outcome."""
    name = next((name for name, known in SOLVERS.items() if known == kind), str(kind))
    outcome = Outcome(hooks.contacts, name, settings.timeIntegration)
    hooks.explicit = not outcome.implicit
    alpha = settings.timeIntegration.generalizedAlpha
    newmark = outcome.implicit and alpha.useNewmark and alpha.useIndex2Constraints
    if not newmark and any(contact.true_stick for contact in hooks.contacts):
        raise InputError(NO_CONSTRAINT)
    start = settings.timeIntegration.startTime
    fresh = [contact for contact in hooks.contacts if contact.begin(outcome.dt, start)]
    outcome.require_step()
    if outcome.implicit:
        find_reactions(mbs, settings, kind, fresh, solve, hooks.put_aside)
    return outcome
