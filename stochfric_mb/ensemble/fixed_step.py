"""What the fixed-step kernels share: the legs, the step that fits them, and the problem's numbers."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from stochfric_mb.ensemble.schedule import Array, Schedule, schedule
from stochfric_mb.errors import StabilityError
from stochfric_mb.scenario import Scenario


class Problem(NamedTuple):
    """What all samples share."""

    legs: Schedule
    """The common time grid."""
    n_steps: Array
    """Steps in each kind of leg, shape (n_kinds,), whole numbers."""
    descriptor: Array
    """Descriptor of the coefficient paths."""
    parameters: Array
    """The law's parameter vector."""
    stick_speed: float
    """Speed below which a contact counts as stuck [m/s]."""
    mass: float
    """m [kg]; then c [N s/m], k [N/m], N [N], k u_0 [N], W [rad/s], v_b [m/s], x and x' at t = 0, least slip [m]."""
    damping: float
    stiffness: float
    normal_force: float
    amplitude: float
    frequency: float
    belt_velocity: float
    position: float
    velocity: float
    least_slip: float


def problem(scenario: Scenario, output_times: Array, least_slip: float, dt: float) -> Problem:
    """Return what all samples of an ensemble share.

    Args:
        scenario: what is simulated.
        output_times: output times [s], shape (n_outputs,).
        least_slip: travel from which a slip counts as one [m].
        dt: longest step [s]; each leg is cut into equal steps not above it.

    Raises:
        StabilityError: dt is beyond the law's stability limit.
    """
    limit = scenario.step_limit()
    if dt > limit:
        raise StabilityError(
            f"dt = {dt:g} s is beyond the stability limit of {scenario.law.kind}, {scenario.law.step_limit_formula} = "
            f"{limit:g} s; give dt <= {0.5 * limit:g} s"
        )
    legs = schedule(scenario, output_times)
    b = scenario.mechanism
    return Problem(
        legs=legs,
        n_steps=np.array([math.ceil(h / dt - 1.0e-9) for h in legs.lengths], dtype=np.float64),
        descriptor=scenario.path(0).descriptor,
        parameters=scenario.law.parameters(),
        stick_speed=scenario.law.stick_speed,
        mass=b.mass,
        damping=b.damping,
        stiffness=b.stiffness,
        normal_force=b.normal_force,
        amplitude=b.stiffness * b.excitation_amplitude,
        frequency=b.excitation_angular_frequency,
        belt_velocity=b.belt_velocity,
        position=b.initial_position,
        velocity=b.initial_velocity,
        least_slip=least_slip,
    )
