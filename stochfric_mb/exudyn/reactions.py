"""Trial steps at the start of a run, for contacts whose friction needs a reaction or the force that holds them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from typing import Any

import exudyn

from stochfric_mb.exudyn.contact import FrictionContact

TRIAL = 1.0e-2
"""Part of a step after which reactions at the start are taken."""


def find_reactions(
    mbs: Any,
    settings: Any,
    solver_type: Any,
    contacts: Sequence[FrictionContact],
    solve: Callable[..., bool],
    unnoticed: Callable[[], AbstractContextManager[None]],
) -> None:
    """Let contacts whose normal force is a reaction, or which a force holds, know it at the start.

    Two steps of a small part of the step, which the user's functions do not notice: the first without friction, the second
    with that of the first.

    Args:
        mbs: the system.
        settings: Exudyn's settings of the run to come; they are not changed.
        solver_type: Exudyn's implicit solver that will run.
        contacts: contacts that start.
        solve: Exudyn's own method that solves.
        unnoticed: what empties the system's slots while it lasts.
    """
    pressed = [contact for contact in contacts if contact.refines]
    if not pressed:
        return
    trial = exudyn.SimulationSettings()
    trial.SetDictionary(settings.GetDictionary())
    trial.solution.file.write = trial.solution.sensors.active = False
    integration = trial.timeIntegration
    dt = (integration.endTime - integration.startTime) / max(integration.numberOfSteps, 1)
    integration.endTime, integration.numberOfSteps = integration.startTime + TRIAL * dt, 1
    integration.automaticStepSize = integration.adaptiveStep = False
    integration.verboseMode = integration.verboseModeFile = 0
    integration.generalizedAlpha.useNewmark = integration.generalizedAlpha.useIndex2Constraints = True
    with unnoticed():
        for _ in range(2):
            solve(mbs, trial, solverType=solver_type, showHints=False)
            for contact in pressed:
                contact.take_trial()
