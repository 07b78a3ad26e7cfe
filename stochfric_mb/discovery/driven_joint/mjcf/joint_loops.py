"""The controllers of an MJCF model's joints in a run: what they read, what they give, and what was recorded of that."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import column, in_si, product
from stochfric_mb.errors import InputError
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import JointLoop, Mjcf, ProportionalDerivative

Array = npt.NDArray[np.float64]


class RunLoop:
    """The controller of one joint in one run."""

    def __init__(self, run: Run, mechanism: Mjcf, joint: str, loop: JointLoop) -> None:
        if joint not in mechanism.drives or joint not in mechanism.positions:
            raise InputError(
                f"controller.joints.{joint}: {joint!r} has no drive that a controller could give; add mechanism.drives.{joint}"
            )
        if loop.factor and loop.factor not in run.constants:
            given = ", ".join(run.constants) or "none"
            raise InputError(
                f"run {run.name!r} has no constant {loop.factor!r} for controller.joints.{joint}.factor (it has: {given})"
            )
        drive = mechanism.drives[joint]
        self._loop, self._factor = loop, run.constants[loop.factor] if loop.factor else 1.0
        self._added = column(run, loop.added) if loop.added else np.zeros(len(run.time))
        self.reference = in_si(run, loop.reference, "position")
        """Reference position [m or rad], shape (count,)."""
        self.recorded = column(run, drive.columns[0])
        """What it gave, shape (count,): the first column of the joint's drive."""
        self.force = product(run, drive.gain, drive.columns[1:])
        """Force of one unit of that, shape (count,)."""

    def output(self, reference: Array, position: Array, velocity: Array, at: int | slice = slice(None)) -> Array:
        """Return what it gives at some samples."""
        loop = self._loop
        u = self._factor * (loop.position_gain * (reference - position) - loop.velocity_gain * velocity) + self._added[at]
        return np.minimum(np.maximum(u, -loop.limit), loop.limit)


def joint_loops(run: Run, mechanism: Mjcf, controller: object) -> dict[str, RunLoop]:
    """Return joint -> its controller in a run.

    Raises:
        InputError: a joint has no drive, or the run lacks a column or the factor.
    """
    loops = controller.joints if isinstance(controller, ProportionalDerivative) else {}
    return {joint: RunLoop(run, mechanism, joint, loop) for joint, loop in loops.items()}
