"""Whether a stated controller gives the drive that was recorded, from the measured motion: only then is it believed."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.inverse_dynamics import position_of
from stochfric_mb.discovery.driven_joint.balance.weak_form import narrowest
from stochfric_mb.discovery.driven_joint.mjcf.joint_loops import RunLoop, joint_loops
from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import position_of_joint
from stochfric_mb.discovery.driven_joint.simulation.closed_loop import CascadeLoop
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import Cascade, Mjcf

Array = npt.NDArray[np.float64]

SHIFTS = np.linspace(-2.0, 2.0, 17)
"""By how much the reference may come later than its sample [samples]: stiff loops turn half a sample into volts."""


def controller_misfit(dataset: Dataset) -> float | None:
    """Return by how much the stated controller errs, rms over the size of the recorded drive [-]; None: there is none.

    It is given the measured motion, so that neither friction nor the plant plays a part.

    Raises:
        InputError: a run lacks a column that the controller reads.
    """
    wrong, right = np.zeros(len(SHIFTS)), 0.0
    for run in dataset.test:
        for loop, position in _loops(dataset, run):
            window = narrowest(run)
            inside = slice(int(window.centres[0]), int(window.centres[-1]) + 1)
            velocity, at = window.through(position, 1), np.arange(len(position))
            measured = loop.recorded[inside]
            right += float(measured @ measured)
            for i, late in enumerate(SHIFTS):
                moved = np.interp(at - late, at, loop.reference)
                error = loop.output(moved, position, velocity)[inside] - measured
                wrong[i] += float(error @ error)
    return float(np.sqrt(wrong.min() / right)) if right > 0.0 else None


def disbelieved(misfit: float | None) -> list[str]:
    """Return a note that the stated controller is not believed; empty: it is, or there is none."""
    if misfit is None or misfit <= criteria.CONTROLLER_MISFIT:
        return []
    return [
        f"the stated controller does not give the recorded drive: from the measured motion and its reference it errs by "
        f"{100.0 * misfit:.0f} % of the drive (rms; at most {100.0 * criteria.CONTROLLER_MISFIT:.0f} % are believed). It is "
        "left out of every simulation; check its gains, limit, reference, their units, and what is added to its output"
    ]


def _loops(dataset: Dataset, run: Run) -> list[tuple[RunLoop | CascadeLoop, Array]]:
    """Return the controller of each controlled joint in a run, and the joint's position, shape (n,)."""
    controller, joint = dataset.scenario.controller, run.mechanism(dataset.scenario)
    if isinstance(controller, Cascade):
        return [(CascadeLoop(run, joint, controller), position_of(run))]
    if isinstance(joint, Mjcf):
        return [(loop, position_of_joint(run, joint, n)) for n, loop in joint_loops(run, joint, controller).items()]
    return []
