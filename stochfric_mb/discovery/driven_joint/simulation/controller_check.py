"""Whether a stated controller gives the drive that was recorded, from the measured motion: only then is it believed."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.driven_joint.balance.inverse_dynamics import position_of
from stochfric_mb.discovery.driven_joint.balance.weak_form import narrowest
from stochfric_mb.discovery.driven_joint.mjcf.joint_loops import joint_loops
from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import position_of_joint
from stochfric_mb.discovery.driven_joint.simulation.closed_loop import controller_output, signals_of
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import Cascade, Mjcf, PrismaticJoint

Array = npt.NDArray[np.float64]

SHIFTS = np.linspace(-2.0, 2.0, 17)
"""By how much the reference may come later than its sample [samples]: stiff loops turn half a sample into volts."""
Law = Callable[[Array, Array, Array], Array]
"""Reference, position and velocity, shape (n,) each -> what the controller gives, shape (n,)."""


def controller_misfit(dataset: Dataset) -> float | None:
    """Return by how much the stated controller errs, rms over the size of the recorded drive [-]; None: there is none.

    It is given the measured motion, so that neither friction nor the plant plays a part.

    Raises:
        InputError: a run lacks a column that the controller reads.
    """
    wrong, right = np.zeros(len(SHIFTS)), 0.0
    for run in dataset.test:
        for law, reference, position, given in _loops(dataset, run):
            window = narrowest(run)
            inside = slice(int(window.centres[0]), int(window.centres[-1]) + 1)
            velocity, at = window.through(position, 1), np.arange(len(position))
            measured = given[inside]
            right += float(measured @ measured)
            for i, late in enumerate(SHIFTS):
                moved = np.interp(at - late, at, reference)
                error = law(moved, position, velocity)[inside] - measured
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


def _loops(dataset: Dataset, run: Run) -> Iterator[tuple[Law, Array, Array, Array]]:
    """Yield the law, reference, position and recorded output of each controlled joint."""
    controller, joint = dataset.scenario.controller, run.mechanism(dataset.scenario)
    if isinstance(controller, Cascade) and isinstance(joint, PrismaticJoint):
        reference, added = signals_of(run, controller)
        law = functools.partial(_cascade, controller, added)
        yield law, reference, position_of(run), controller_output(run, joint)
    elif isinstance(joint, Mjcf):
        for name, loop in joint_loops(run, joint, controller).items():
            yield loop.output, loop.reference, position_of_joint(run, joint, name), loop.recorded


def _cascade(controller: Cascade, added: Array, reference: Array, position: Array, velocity: Array) -> Array:
    u = controller.velocity_gain * (controller.position_gain * (reference - position) - velocity) + added
    return np.clip(u, -controller.limit, controller.limit)
