"""Running an Exudyn system with friction: settings, event location, and a check of what comes back."""

from __future__ import annotations

from typing import Any

import exudyn
import numpy as np

from stochfric_mb.errors import InputError, SimulationError, require_name
from stochfric_mb.exudyn.hooks import SWITCH_ERROR, Hooks
from stochfric_mb.exudyn.normal import NO_REACTION

_TYPE = exudyn.DynamicSolverType
SOLVERS = {
    "rk44": _TYPE.RK44,
    "generalized_alpha": _TYPE.GeneralizedAlpha,
    "dopri5": _TYPE.DOPRI5,
    "velocity_verlet": _TYPE.VelocityVerlet,
}
"""Name of a solver -> Exudyn's own."""
EXPLICIT = ("rk44", "dopri5", "velocity_verlet")


def silent_settings(dt: float, duration: float) -> Any:
    """Return simulation settings for fixed steps that write no file and print nothing."""
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.active = False
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.verboseModeFile = 0
    settings.timeIntegration.automaticStepSize = False
    settings.timeIntegration.adaptiveStep = False
    settings.timeIntegration.absoluteTolerance = settings.timeIntegration.relativeTolerance = 1.0e30  # dopri5 rejects no step
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.numberOfSteps = round(duration / dt)
    return settings


def solve_dynamic(mbs: Any, settings: Any, *, solver: str = "rk44", locate: bool = True) -> None:
    """Run Exudyn's SolveDynamic with fresh friction and check the outcome.

    Args:
        mbs: an assembled system with contacts from `add_friction`.
        settings: Exudyn's simulation settings; with ``locate`` the fields that event location needs are set.
        solver: one of `SOLVERS`.
        locate: repeat steps so that they end where a law switches. After such a step the next ones end on the grid of
            fixed steps again, so that output times are met exactly.

    Raises:
        InputError: a normal force is read from a constraint, and the solver is explicit.
        SimulationError: the solver gave up, or the motion is not finite.
        Exception: what a user's callback raised.
    """
    require_name("solver", solver, SOLVERS)
    integration = settings.timeIntegration
    dt = (integration.endTime - integration.startTime) / integration.numberOfSteps
    hooks = Hooks.of(mbs)
    if solver in EXPLICIT and any(contact.needs_reactions for contact in hooks.contacts):
        raise InputError(NO_REACTION)
    for contact in hooks.contacts:
        contact.prepare(dt)
    hooks.install(locate=locate)
    if any(contact.is_load for contact in hooks.contacts) and integration.computeLoadsJacobian == 0:
        integration.computeLoadsJacobian = 2
    if locate:
        _settle_location(integration, dt)
    printed, exudyn.config.printToConsole = exudyn.config.printToConsole, False
    try:
        success = mbs.SolveDynamic(settings, solverType=SOLVERS[solver], showHints=False)
    except exudyn.ExudynError as error:
        if isinstance(error.__cause__, Exception):
            raise error.__cause__ from error.__cause__.__cause__
        raise SimulationError(f"Exudyn ({solver}, dt = {dt:g} s) failed: {error}") from error
    finally:
        exudyn.config.printToConsole = printed
        hooks.install(locate=False)
    if not success:
        raise SimulationError(f"Exudyn ({solver}, dt = {dt:g} s) gave up; use a smaller step or another solver")
    for what in (mbs.systemData.GetODE2Coordinates(), mbs.systemData.GetODE2Coordinates_t()):
        if not np.all(np.isfinite(what)):
            raise SimulationError(
                f"Exudyn ({solver}, dt = {dt:g} s) reported success with a state that is not finite; use a smaller step"
            )


def _settle_location(integration: Any, dt: float) -> None:
    """Set the fields by which Exudyn repeats a step with the size a contact asks for, and goes back to dt at once."""
    integration.adaptiveStep = True
    integration.adaptiveStepRecoverySteps = 1
    integration.adaptiveStepRecoveryIterations = 50
    integration.adaptiveStepIncrease = 1.0e9
    integration.minimumStepSize = min(integration.minimumStepSize, 1.0e-7 * dt)
    integration.discontinuous.iterationTolerance = 0.1 * SWITCH_ERROR
    integration.discontinuous.maxIterations = 2
    integration.discontinuous.useRecommendedStepSize = True
