"""The belt-box oscillator in pymunk: a box that cannot turn, on a segment whose surface moves, held by a damped spring."""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pymunk
from pymunk.constraints import DampedSpring

from stochfric_mb.effects.carry import reported, running_law
from stochfric_mb.errors import InputError
from stochfric_mb.friction import Friction
from stochfric_mb.pymunk import records as r
from stochfric_mb.pymunk import stepping
from stochfric_mb.pymunk.attach import ContactFriction, add_friction
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import Trajectory

CARRIES_EFFECTS = True
HOOK_FORCE = "compiled pre_solve callback: the law's force, pymunk's own friction off"
HOOK_CAP = "compiled pre_solve callback: the law's cap on pymunk's own friction"
HALF_SIDE = 0.05
"""Half the side of the box [m]."""
SPRING_LENGTH = 1.0
"""Length of the unloaded spring [m]."""
SLOP = 1.0e-5
"""Overlap that pymunk leaves alone [m]; the box starts with half of it, in contact from the first step on."""
SUBSTEPS = {"elastic_stick": 2}
"""Law -> steps of pymunk in one step of a run, where it is not one: near an unstable balance (Table 2 at 18.7 rad/s) one
step of elastic stick misses 10 um by far (45 um with seed 1), two hold it (4.1 um); they cost twice as much."""


@dataclasses.dataclass
class Model:
    """A belt-box scenario as a pymunk space, ready to integrate."""

    space: pymunk.Space
    """The space."""
    box: pymunk.Body
    """The box."""
    spring: DampedSpring
    """Spring and damper between the box and the frame."""
    belt: pymunk.Segment
    """The belt, on the static body."""
    friction: ContactFriction | None
    """The friction between box and belt; None: none, for comparison."""
    scenario: Scenario
    """What was built."""
    notes: list[str] = dataclasses.field(default_factory=list[str])
    """What stands in for what."""


def simulate(
    scenario: Scenario,
    *,
    seed: int = 0,
    sample: int = 0,
    dt: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Return the trajectory of a belt-box scenario in pymunk, sampled at the scenario's output times.

    Args:
        scenario: the scenario.
        seed: first part of the address of the coefficient path.
        sample: second part.
        dt: step [s], dividing the output step; `Scenario.default_dt` if not given.
            pymunk takes as many for each as `SUBSTEPS` says.
        progress: called with the simulated time [s] now and then.

    Raises:
        StabilityError: ``dt`` is beyond the law's stability limit.
        InputError: ``dt`` does not divide the output step.
        SimulationError: a state that is not finite or beyond reason.
    """
    dt = scenario.checked_step(dt)
    substeps = SUBSTEPS.get(scenario.law.kind, 1)
    model = build(scenario, seed=seed, sample=sample, dt=dt / substeps)
    try:
        trajectory = integrate(model, dt=dt / substeps, progress=progress)
        return _per_step(trajectory, dt, substeps)
    finally:
        assert model.friction is not None
        model.friction.remove()


def _per_step(trajectory: Trajectory, dt: float, substeps: int) -> Trajectory:
    """Return a trajectory of sub-steps with what it says about steps put in steps of ``dt`` [s]."""
    about = trajectory.attributes
    steps = {"n_steps": about["n_steps"] // substeps, "seconds_per_step": substeps * about["seconds_per_step"]}
    return dataclasses.replace(trajectory, attributes=about | {"dt": dt, "substeps": substeps} | steps)


def build(scenario: Scenario, *, seed: int = 0, sample: int = 0, dt: float | None = None, with_friction: bool = True) -> Model:
    """Return the scenario as a pymunk space with the friction added, at rest in contact, before its first step.

    ``dt`` is the step that will be taken [s], `Scenario.default_dt` if not given; only effects depend on it.
    """
    mechanism = scenario.mechanism
    space = pymunk.Space()
    space.gravity = (0.0, -mechanism.normal_force / mechanism.mass)
    space.collision_slop = SLOP
    reach = scenario.reach + 2.0 * HALF_SIDE
    belt = pymunk.Segment(space.static_body, (-reach, 0.0), (reach, 0.0), 0.0)
    belt.surface_velocity = (mechanism.belt_velocity, 0.0)
    box = pymunk.Body(mechanism.mass, math.inf)
    height = HALF_SIDE - 0.5 * SLOP
    box.position = (mechanism.initial_position, height)
    box.velocity = (mechanism.initial_velocity, 0.0)
    shape = pymunk.Poly.create_box(box, (2.0 * HALF_SIDE, 2.0 * HALF_SIDE))
    frame = (-SPRING_LENGTH, height)
    spring = DampedSpring(space.static_body, box, frame, (0.0, 0.0), SPRING_LENGTH, mechanism.stiffness, mechanism.damping)
    space.add(belt, box, shape, spring)
    friction, notes = None, list[str]()
    if with_friction:
        address: dict[str, Any] = {"seed": seed, "sample": sample}
        step = scenario.checked_step(dt)
        law, notes = running_law(scenario.law, mechanism, scenario.effects, step, substitute=False, **address)
        friction = add_friction(space, shape, belt, Friction(law, scenario.coefficient_process), **address)
        friction.initial_displacement = -mechanism.initial_position
    return Model(space, box, spring, belt, friction, scenario, notes)


def integrate(model: Model, *, dt: float, progress: Callable[[float], None] | None = None) -> Trajectory:
    """Return the trajectory of a built model from t = 0.

    pymunk drifts and then kicks, so half a step with the position set back by as much puts positions on whole steps and
    velocities on half steps (leap-frog); velocities are sampled as the mean before and after the kick.
    """
    scenario, friction = model.scenario, model.friction
    if friction is None:
        raise InputError("this model was built without friction; build(scenario) adds it")
    mechanism = scenario.mechanism
    box, slot = model.box, friction.slot()
    times = scenario.output_times()
    stride = round(scenario.output_step / dt)
    rows = np.empty((len(times), 8))
    reach = scenario.reach
    begin = time.perf_counter()
    start(model, dt)
    rows[0] = _sample(times[0], mechanism.initial_position, mechanism.initial_velocity, slot)
    for i in range(1, len(times)):
        advance(model, dt, (i - 1) * stride + 1, stride - 1)
        before = box.velocity.x
        advance(model, dt, i * stride, 1)
        rows[i] = _sample(times[i], box.position.x, 0.5 * (before + box.velocity.x), slot)
        if not abs(rows[i, 1]) <= reach:
            scenario.require_sane("pymunk", times[i], rows[i, 1], dt)
        if progress is not None and i % 100 == 0:
            progress(times[i])
    friction.check()
    n_steps = (len(times) - 1) * stride
    seconds = (time.perf_counter() - begin) / n_steps
    attributes = {
        "engine": "pymunk",
        "version": pymunk.version,
        "hook": HOOK_CAP if friction.friction.law.needs_holding_force else HOOK_FORCE,
        "dt": dt,
        "seed": friction.path.seed,
        "sample": friction.path.sample,
        "law": scenario.law.kind,
        "notes": list(model.notes),
        "seconds_per_step": seconds,
        "n_steps": n_steps,
    }
    trajectory = Trajectory(*np.ascontiguousarray(rows.T), attributes=attributes)
    path = friction.path
    return reported(trajectory, mechanism, scenario.effects, seed=path.seed, sample=path.sample)


def start(model: Model, dt: float) -> None:
    """Take the half step that puts velocities on half steps; positions are at t = 0 after it."""
    model.box.force = (model.scenario.mechanism.excitation_force(0.0), 0.0)
    stepping.start(model.space, dt)


def advance(model: Model, dt: float, first: int, n: int) -> None:
    """Take the ``n`` steps of ``dt`` [s] whose numbers start at ``first``; step i applies the forces of t = i dt."""
    step, box, mechanism = model.space.step, model.box, model.scenario.mechanism
    if mechanism.excitation_amplitude == 0.0:
        for _ in range(n):
            step(dt)
        return
    for i in range(first, first + n):
        box.force = (mechanism.excitation_force(i * dt), 0.0)
        step(dt)


def _sample(t: float, x: float, v: float, slot: npt.NDArray[np.float64]) -> tuple[float, ...]:
    return (t, x, v, slot[r.FORCE], slot[r.NORMAL], slot[r.MU_S], slot[r.MU_K], slot[r.STICK])
