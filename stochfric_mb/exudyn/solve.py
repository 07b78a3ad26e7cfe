"""Running an Exudyn system with friction: settings, event location, and a check of what comes back."""

from __future__ import annotations

from typing import Any

import exudyn

from stochfric_mb.errors import InputError, SimulationError, require_name
from stochfric_mb.exudyn.contact import REPEATS
from stochfric_mb.exudyn.hooks import SWITCH_ERROR, Hooks
from stochfric_mb.exudyn.methods import solve
from stochfric_mb.exudyn.normal import NO_CONSTRAINT, NO_REACTION
from stochfric_mb.exudyn.outcome import EXPLICIT, SOLVERS, Outcome
from stochfric_mb.exudyn.reactions import find_reactions

CONTRACTIVITY = 1.0e-3
"""Most that Newton's iterations may leave of a residual with an old Jacobian; 1e-2 to 1e-5 cost the same."""
MOST_STEPS = 2**31 - 1
"""Steps that Exudyn counts in one run; with more of them it never takes the first."""
SAME_TIME = 1.0e-9
"""What the time at which a run stopped may differ from the start of the one that goes on [s]: sums of steps are rounded."""


def silent_settings(dt: float, duration: float, start: float = 0.0) -> Any:
    """Return simulation settings for fixed steps that write no solution file and print nothing; sensors store every step.

    Raises:
        InputError: there are more steps than Exudyn counts.
    """
    if duration / dt > MOST_STEPS:
        raise InputError(
            f"exudyn: {duration:g} s are {duration / dt:.3g} steps of dt = {dt:g} s, over the {MOST_STEPS} that it counts: "
            "shorten the duration or raise dt"
        )
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = dt
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.verboseModeFile = 0
    settings.timeIntegration.automaticStepSize = False
    settings.timeIntegration.adaptiveStep = False
    settings.timeIntegration.startTime, settings.timeIntegration.endTime = start, start + duration
    settings.timeIntegration.numberOfSteps = round(duration / dt)
    return settings


def solve_dynamic(mbs: Any, settings: Any, *, solver: str = "rk44", locate: bool = True, resume: bool = False) -> None:
    """Run Exudyn's SolveDynamic with friction, fresh or as it was left, and check the outcome.

    Args:
        mbs: an assembled system with contacts from `add_friction`.
        settings: Exudyn's simulation settings; the fields that friction and, with ``locate``, event location need are set.
        solver: one of `SOLVERS`.
        locate: repeat steps so that they end where a law switches. After such a step the next ones end on the grid of
            fixed steps again, so that output times are met exactly. A system with constraints is then integrated by
            Newmark's method with constraints on velocities, since short steps spoil the reactions of those on positions.
        resume: go on from where the last run stopped, with the state of the system and of its friction there. The settings'
            ``startTime`` is the time at which it stopped; their steps are those of the rest.

    Raises:
        InputError: a normal force is read from a constraint, or a constraint holds a law with true stick, and the solver is
            explicit; or ``resume`` at another time than that at which the last run stopped.
        StabilityError: the step is beyond a contact's limit for an explicit solver.
        SimulationError: the solver gave up, the motion is not finite, or the normal force has grown so that the step was
            beyond a contact's limit.
        Exception: what a user's callback raised.
    """
    require_name("solver", solver, SOLVERS)
    integration = settings.timeIntegration
    hooks = Hooks.of(mbs)
    hooks.find()
    hooks.explicit = solver in EXPLICIT
    if hooks.explicit and any(contact.true_stick for contact in hooks.contacts):
        raise InputError(NO_CONSTRAINT)
    outcome = Outcome(hooks.contacts, solver, integration)
    dt = outcome.dt
    if solver in EXPLICIT and any(contact.needs_reactions for contact in hooks.contacts):
        raise InputError(NO_REACTION)
    if resume:
        _resume(mbs, hooks, integration.startTime)
    else:
        for contact in hooks.contacts:
            contact.prepare(dt, integration.startTime)
    outcome.require_step()
    hooks.install(locate=locate)
    _settle_settings(mbs, integration, hooks, dt if locate else 0.0)
    printed, exudyn.config.printToConsole = exudyn.config.printToConsole, False
    try:
        if not resume:
            find_reactions(mbs, settings, SOLVERS[solver], hooks.contacts, solve, hooks.put_aside)
        success = solve(mbs, settings, solverType=SOLVERS[solver], showHints=False)
    except exudyn.ExudynError as error:
        if isinstance(error.__cause__, Exception):
            raise error.__cause__ from error.__cause__.__cause__
        raise SimulationError(f"{outcome.where} failed: {error}") from error
    finally:
        exudyn.config.printToConsole = printed
        hooks.install(locate=False)
    outcome.require_success(mbs, success)


def _resume(mbs: Any, hooks: Hooks, start: float) -> None:
    """Let the system's initial state be the one in which the last run stopped, for all contacts.

    Raises:
        InputError: a contact did not stop at the time ``start`` [s].
    """
    for contact in hooks.contacts:
        if not abs(contact.time - start) <= SAME_TIME:
            raise InputError(
                f"resume: startTime = {start:g} s, but the last run stopped at t = {contact.time:g} s; set startTime to it, or "
                "solve without resume"
            )
    mbs.systemData.SetSystemState(mbs.systemData.GetSystemState(), exudyn.ConfigurationType.Initial)


def _settle_settings(mbs: Any, integration: Any, hooks: Hooks, dt: float) -> None:
    """Set what friction needs of the solver, and with dt [s] > 0 what event location needs."""
    # stick is stiff and slip is not: a new Jacobian where the old one is of little use makes 1 iteration a step instead of 5
    newton, constrained = integration.newton, len(mbs.systemData.GetAECoordinates()) > 0
    newton.modifiedNewtonContractivity = min(newton.modifiedNewtonContractivity, CONTRACTIVITY)
    if constrained:  # an old one leaves reactions off by 3e-3, and knows nothing of constraints that come and go
        newton.modifiedNewtonJacUpdatePerStep = True
    if any(contact.is_load for contact in hooks.contacts) and integration.computeLoadsJacobian == 0:
        integration.computeLoadsJacobian = 2
    integration.discontinuous.iterationTolerance = 0.1 * SWITCH_ERROR
    integration.discontinuous.maxIterations = 2 + REPEATS
    true_stick = any(contact.true_stick for contact in hooks.contacts)
    if dt > 0.0:
        _settle_location(integration, dt)
    if true_stick or (dt > 0.0 and constrained):
        # reactions of constraints on positions are spoilt by the short steps that location takes (error ~ 1/h^2)
        integration.generalizedAlpha.useNewmark = integration.generalizedAlpha.useIndex2Constraints = True


def _settle_location(integration: Any, dt: float) -> None:
    """Set the fields by which Exudyn repeats a step with the size a contact asks for, and goes back to dt at once."""
    integration.adaptiveStep = True
    integration.adaptiveStepRecoverySteps = 1
    integration.adaptiveStepRecoveryIterations = 50
    integration.adaptiveStepIncrease = 1.0e9
    integration.minimumStepSize = min(integration.minimumStepSize, 1.0e-7 * dt)
    integration.discontinuous.useRecommendedStepSize = True
