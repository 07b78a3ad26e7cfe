"""What the fixed-step kernels share: the problem's numbers, the rows of a group, and what a step is made of.

For x'' = a(x, x') the formula of Runge and Kutta needs two sums of its four accelerations a_0 .. a_3::

    x + h x' + h^2/6 (a_0 + a_1 + a_2)
    x' + h/6 ((a_0 + a_1 + a_2) + (a_1 + a_2) + a_3)
"""

from __future__ import annotations

import math
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.ensemble.lanes import A_K, A_S, B_K, B_S, LANES, SHARED_ROWS, V, X, fma, note_crossings
from stochfric_mb.ensemble.schedule import Array, Schedule, schedule
from stochfric_mb.errors import StabilityError
from stochfric_mb.mechanisms.belt_box import BoxNumbers
from stochfric_mb.scenario import Scenario

# Rows of the flat array beside the shared ones: velocity one step before, position and velocity of a stage, sum of the first
# three accelerations, sum of the second and third, change of the pair to the next knot, mu_s
OLD_V, STAGE_X, STAGE_V, SUM, MIDDLE, D_S, D_K, MU = (LANES * (SHARED_ROWS + i) for i in range(8))
STEP_ROWS = SHARED_ROWS + 8
"""Rows so far; a kernel's own rows follow them."""


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
    box: BoxNumbers
    """The mechanism."""
    position: float
    """x at t = 0 [m]; then x' [m/s]."""
    velocity: float
    least_slip: float
    """Travel from which a slip counts as one [m]."""


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
    check_step(scenario, dt)
    legs = schedule(scenario, output_times)
    return Problem(
        legs=legs,
        n_steps=np.array([math.ceil(h / dt - 1.0e-9) for h in legs.lengths], dtype=np.float64),
        descriptor=scenario.path(0).descriptor,
        parameters=scenario.law.parameters(),
        stick_speed=scenario.law.stick_speed,
        box=scenario.mechanism.numbers(),
        position=scenario.mechanism.initial_position,
        velocity=scenario.mechanism.initial_velocity,
        least_slip=least_slip,
    )


def check_step(scenario: Scenario, dt: float) -> None:
    """Check that the law is stable at a step dt [s].

    Raises:
        StabilityError: it is not.
    """
    limit = scenario.step_limit()
    if dt > limit:
        raise StabilityError(
            f"dt = {dt:g} s is beyond the stability limit of {scenario.law.kind}, {scenario.law.step_limit_formula} = "
            f"{limit:.3g} s; give dt <= {0.5 * limit:.3g} s"
        )


def stepping(law: ModuleType) -> Any:
    """Return the ``leg`` of a kernel that steps; its module has, beside `kernel`'s functions, these compiled ones.

    ::

        acceleration(j, w, tau, drive, numbers, m)   x'' of lane j at its stage, tau after the start of the step
        finish(w_old, w, h, drive, numbers, m)       fourth stage and end of the step of all lanes; returns how many have
                                                     passed a switch, and how many have passed v_s or turned over
        switch(q, t, h, w, part, m)                  makes the step again for the lanes that have passed a switch

    ``w`` is the part of the way between knots, ``part`` that of a step, ``drive`` the excitation per unit of mass.
    """
    acceleration, finish, switch, file = law.acceleration, law.finish, law.switch, str(law.__file__)

    def stage(w, tau, ahead, middle, drive, numbers, m):
        for j in range(LANES):
            finish_stage(j, acceleration(j, w, tau, drive, numbers, m), ahead, middle, m)

    def leg(q, i, numbers, m, tally, pending):
        _changes_to_next_knot(m)
        n_steps = int(q.n_steps[q.legs.kind[i]])
        h = q.legs.length[i] / n_steps
        part = (q.legs.to_knot[i] - q.legs.from_knot[i]) / n_steps
        for step in range(n_steps):
            t = q.legs.start[i] + step * h
            w = q.legs.from_knot[i] + step * part
            f0, f1, f2 = _drives(q.box.drive / q.box.mass, q.box.frequency, t, h)
            go(w, 0.0, 0.5 * h, 0.0, f0, numbers, m)
            go(w + 0.5 * part, 0.5 * h, 0.5 * h, 1.0, f1, numbers, m)
            go(w + 0.5 * part, 0.5 * h, h, 1.0, f1, numbers, m)
            switched, crossed = finish(w, w + part, h, f2, numbers, m)
            if switched > 0:
                switch(q, t, h, w, part, m)
            if switched + crossed > 0:
                _note_step(q, t, h, w, m, tally, pending)
        return True

    go = compiled(stage, parts=file)
    return compiled_inline(leg, parts=file)


@compiled
def at_start(m):
    """Write x and x' at t = 0 into the rows of the stage."""
    m[STAGE_X : STAGE_X + LANES] = m[X : X + LANES]
    m[STAGE_V : STAGE_V + LANES] = m[V : V + LANES]


@compiled
def _changes_to_next_knot(m):
    """Write the change of each pair to the next knot."""
    for j in range(LANES):
        m[D_S + j] = m[B_S + j] - m[A_S + j]
        m[D_K + j] = m[B_K + j] - m[A_K + j]


@compiled_inline
def _drives(amplitude, frequency, t, h):
    """Return amplitude cos(frequency t) at the start, the middle and the end of a step."""
    if amplitude == 0.0:
        return 0.0, 0.0, 0.0
    return (
        amplitude * math.cos(frequency * t),
        amplitude * math.cos(frequency * (t + 0.5 * h)),
        amplitude * math.cos(frequency * (t + h)),
    )


@compiled_inline
def finish_stage(j, a, ahead, middle, m):
    """Take the acceleration a of lane j, and go ``ahead`` [s] from the start of the step with it.

    ``middle`` is 0 for the first stage and 1 for the second and third.
    """
    v = m[STAGE_V + j]
    m[SUM + j] += a
    m[MIDDLE + j] += middle * a
    m[STAGE_X + j] = fma(ahead, v, m[X + j])
    m[STAGE_V + j] = fma(ahead, a, m[V + j])


@compiled_inline
def end_of_step(j, a, h, m):
    """Return x and x' of lane j at the end of the step from the fourth acceleration a."""
    v, three = m[V + j], m[SUM + j]
    return fma(h * h / 6.0, three, fma(h, v, m[X + j])), fma(h / 6.0, three + m[MIDDLE + j] + a, v)


@compiled_inline
def begin_step(j, x, v, m):
    """Make x and x' the state of lane j that the next step starts from."""
    m[OLD_V + j] = m[V + j]
    m[X + j] = m[STAGE_X + j] = x
    m[V + j] = m[STAGE_V + j] = v
    m[SUM + j] = m[MIDDLE + j] = 0.0


@compiled_inline
def passed(was, now, v_s):
    """Return whether the relative velocity [m/s] passed v_s, either way, or turned over within a step."""
    return ((abs(was) <= v_s) != (abs(now) <= v_s)) | (was * now < 0.0)


@compiled
def _note_step(q, t, h, w, m, tally, pending):
    """Note what happened within the step from t to t + h; ``w`` is the part of the way between knots at its start."""
    for j in range(LANES):
        m[MU + j] = m[A_S + j] + w * m[D_S + j]
    x, v, before, mu_s = m[X : X + LANES], m[V : V + LANES], m[OLD_V : OLD_V + LANES], m[MU : MU + LANES]
    note_crossings(t, h, q.box.belt_velocity, q.stick_speed, x, v, before, mu_s, tally, pending, q.least_slip)
