"""Whether a run can be trusted: steps beyond the limits of its contacts, solvers that report success with nonsense."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import exudyn
import numpy as np

from stochfric_mb.errors import SimulationError, StabilityError
from stochfric_mb.exudyn.contact import FrictionContact

_TYPE = exudyn.DynamicSolverType
SOLVERS = {
    "rk44": _TYPE.RK44,
    "generalized_alpha": _TYPE.GeneralizedAlpha,
    "dopri5": _TYPE.DOPRI5,
    "velocity_verlet": _TYPE.VelocityVerlet,
}
"""Name of a solver -> Exudyn's own."""
EXPLICIT = ("rk44", "dopri5", "velocity_verlet")
_IMPLICIT = ("generalized_alpha", str(_TYPE.TrapezoidalIndex2))
_ADAPTING = ("dopri5", str(_TYPE.ODE23))


class Outcome:
    """The checks before and after one run of a solver."""

    def __init__(self, contacts: Sequence[FrictionContact], solver: str, integration: Any) -> None:
        """Look at a run to come.

        Args:
            contacts: the contacts of the system.
            solver: name of the solver, or Exudyn's own for one that has none.
            integration: Exudyn's settings of the time integration.
        """
        self.dt = (integration.endTime - integration.startTime) / max(integration.numberOfSteps, 1)
        """Step [s]."""
        self.where = f"Exudyn ({solver}, dt = {self.dt:g} s)"
        """What runs, for messages."""
        self.implicit = solver in _IMPLICIT
        """Whether the solver is implicit: it has no limit, and computes reactions."""
        adapts = solver in _ADAPTING and integration.automaticStepSize
        self._contacts = () if self.implicit or adapts else contacts

    def require_step(self) -> None:
        """Do nothing if the step is within the limits of all contacts.

        Raises:
            StabilityError: it is not.
        """
        if broken := self.broken_limit():
            raise StabilityError(f"{self.where}: {broken}")

    def require_success(self, mbs: Any, success: bool) -> None:
        """Do nothing if the solver succeeded with a finite state, and the limits have not sunk below the step meanwhile.

        Raises:
            SimulationError: otherwise; it names the limit that was broken.
        """
        broken = self.broken_limit()
        advice = broken or "use a smaller step or another solver"
        if not success:
            raise SimulationError(f"{self.where} gave up: {advice}")
        state = np.concatenate([mbs.systemData.GetODE2Coordinates(), mbs.systemData.GetODE2Coordinates_t()])
        if not np.all(np.isfinite(state)):
            raise SimulationError(f"{self.where} reported success with a state that is not finite: {advice}")
        if broken:
            raise SimulationError(f"{self.where} reported success, but the outcome is not to be trusted: {broken}")

    def broken_limit(self) -> str:
        """Return what says that the step is beyond a contact's limit for explicit solvers, "" if it is not."""
        limit, formula = min((contact.step_limit() for contact in self._contacts), default=(math.inf, ""))
        if self.dt <= limit:
            return ""
        return (
            f"dt is beyond the stability limit {limit:.3g} s ({formula}) of an explicit solver; use dt <= {0.5 * limit:.2g} s "
            "or solver='generalized_alpha'"
        )
