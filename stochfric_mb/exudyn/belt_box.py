"""The belt-box oscillator in Exudyn."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from typing import Any

import exudyn
import numpy as np
from exudyn.advancedUtilities import CreateSymbolicUserFunction
from exudyn.itemInterface import CoordinateSpringDamper, LoadCoordinate, MarkerNodeCoordinate, Mass1D, Node1D, NodePointGround

from stochfric_mb.effects.carry import reported, running_law
from stochfric_mb.errors import InputError, SimulationError, StabilityError, require_number
from stochfric_mb.exudyn.attach import add_friction
from stochfric_mb.exudyn.contact import FrictionContact
from stochfric_mb.exudyn.hooks import installed, symbolic
from stochfric_mb.exudyn.solve import EXPLICIT, silent_settings, solve_dynamic
from stochfric_mb.friction import Friction
from stochfric_mb.laws import Law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import Trajectory

CARRIES_EFFECTS = True
HOOK = "{} user function, PostStep commit"
CHUNK, STEPS = 200, 20_000
"""Outputs and steps between two progress reports, at most."""


@dataclasses.dataclass
class BuiltBeltBox:
    """A belt-box as an Exudyn system, ready to run."""

    mbs: Any
    """The system."""
    mass: Any
    """Index of the object that is the box."""
    contact: FrictionContact
    """The friction between belt and box."""
    scenario: Scenario
    """What was built."""
    law: Law
    """The law that really runs."""
    dt: float
    """Step [s]."""
    notes: list[str]
    """What differs from the scenario."""

    def close(self) -> None:
        """Free the system: it and its callbacks refer to each other, which Python cannot collect."""
        self.mbs.variables.clear()
        self.mbs.sys.clear()
        self.mbs.Reset()


def simulate(
    scenario: Scenario,
    *,
    seed: int = 0,
    sample: int = 0,
    dt: float | None = None,
    progress: Callable[[float], None] | None = None,
    solver: str = "rk44",
    locate: bool = True,
) -> Trajectory:
    """Return the trajectory of a scenario in Exudyn.

    Args:
        scenario: what to simulate.
        seed: seed of the path of coefficients.
        sample: number of the sample.
        dt: step [s], dividing the output step; the scenario's default if not given.
        progress: called with the simulated time [s] now and then.
        solver: "rk44", "dopri5", "velocity_verlet" (explicit) or "generalized_alpha".
        locate: whether steps end where the law switches.

    Raises:
        InputError: dt does not divide the output step, or spans more than one knot of the coefficients.
        StabilityError: dt is beyond the law's limit for an explicit solver.
        SimulationError: the run failed, or its outcome makes no sense.
    """
    dt = scenario.default_dt() if dt is None else dt
    built = build(scenario, seed=seed, sample=sample, dt=dt, solver=solver)
    try:
        return integrate(built, progress=progress, solver=solver, locate=locate)
    finally:
        built.close()


def build(scenario: Scenario, *, seed: int = 0, sample: int = 0, dt: float, solver: str = "rk44") -> BuiltBeltBox:
    """Return the scenario as an Exudyn system: a mass on a spring and a damper, a load, and the friction.

    Raises:
        InputError, StabilityError: as `simulate`.
    """
    box = scenario.mechanism
    dt = require_number("dt", dt, above=0.0, unit="s")
    law, notes = running_law(scenario.law, box, scenario.effects, dt, substitute=True, seed=seed, sample=sample)
    _check_step(scenario, law, dt, explicit=solver in EXPLICIT)
    mbs, mass, ground, slide = without_friction(box)
    contact = add_friction(
        mbs,
        ground,
        slide,
        Friction(law, scenario.coefficient_process),
        normal_force=box.normal_force,
        effective_mass=box.mass,
        surface_velocity=box.belt_velocity,
        seed=seed,
        sample=sample,
    )
    mbs.Assemble()
    return BuiltBeltBox(mbs, mass, contact, scenario, law, dt, notes)


def integrate(
    built: BuiltBeltBox,
    *,
    solver: str = "rk44",
    locate: bool = True,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Return the trajectory of a built system.

    Raises:
        SimulationError: the run failed, or its outcome makes no sense.
    """
    scenario, mbs = built.scenario, built.mbs
    times = scenario.output_times()
    rows = built.contact.record(times)
    if progress is not None:
        mbs.SetPreStepUserFunction(_reporter(progress, scenario, built.dt, installed(mbs, "PreStep")))
    begin = time.perf_counter()
    solve_dynamic(mbs, silent_settings(built.dt, scenario.duration), solver=solver, locate=locate)
    seconds = time.perf_counter() - begin
    n_steps = int(mbs.sys["dynamicSolver"].it.currentStepIndex) - 1
    attributes = {
        "engine": "exudyn",
        "version": exudyn.__version__,
        "hook": HOOK.format(built.contact.route),
        "solver": solver,
        "located": locate,
        "dt": built.dt,
        "seed": int(built.contact.address[0]),
        "sample": int(built.contact.address[1]),
        "law": getattr(built.law, "inner", built.law).kind,
        "notes": built.notes,
        "seconds_per_step": seconds / max(n_steps, 1),
        "n_steps": n_steps,
    }
    trajectory = _trajectory(scenario, times, rows, attributes)
    address = {"seed": attributes["seed"], "sample": attributes["sample"]}
    return reported(trajectory, scenario.mechanism, scenario.effects, **address)


def without_friction(box: BeltBox) -> tuple[Any, Any, Any, Any]:
    """Return the system, the box, and the markers of ground and of the box's coordinate."""
    mbs = _new_system()
    node = mbs.AddNode(
        Node1D(referenceCoordinates=[0.0], initialCoordinates=[box.initial_position], initialVelocities=[box.initial_velocity])
    )
    mass = mbs.AddObject(Mass1D(nodeNumber=node, mass=box.mass))
    ground = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=mbs.AddNode(NodePointGround()), coordinate=0))
    slide = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    mbs.AddObject(CoordinateSpringDamper(markerNumbers=[ground, slide], stiffness=box.stiffness, damping=box.damping))
    if box.excitation_amplitude != 0.0:
        mbs.variables["load"] = CreateSymbolicUserFunction(
            mbs,
            function=lambda mbs, t, load: load * symbolic.cos(box.excitation_angular_frequency * t),
            userFunctionName="loadUserFunction",
            itemTypeName="LoadCoordinate",
        )
        amplitude = box.stiffness * box.excitation_amplitude
        mbs.AddLoad(LoadCoordinate(markerNumber=slide, load=amplitude, loadUserFunction=mbs.variables["load"]))
    return mbs, mass, ground, slide


def _new_system() -> Any:
    return exudyn.SystemContainer().AddSystem()


def _check_step(scenario: Scenario, law: Law, dt: float, *, explicit: bool) -> None:
    scenario.dividing_step(dt)
    limit = law.step_limit(scenario.mechanism.normal_force, scenario.mechanism.mass)
    if explicit and dt > limit:
        raise StabilityError(
            f"dt = {dt:g} s is beyond the stability limit {limit:.3g} s of law {law.kind} ({law.step_limit_formula}) for an "
            f"explicit solver; use dt <= {0.5 * limit:.2g} s or solver='generalized_alpha'"
        )
    process = scenario.coefficient_process
    if process is None:
        return
    if process.clock == 0.0 and dt > process.knot_spacing:
        raise InputError(
            f"dt = {dt:g} s is above the knot spacing {process.knot_spacing:g} s of process {process.kind}; use a step below it"
        )


def _reporter(
    progress: Callable[[float], None], scenario: Scenario, dt: float, other: Callable[..., bool] | None
) -> Callable[[Any, float], bool]:
    """Return a PreStep function that reports at least a hundred times, and calls the one that was there."""
    due, interval = [0.0], min(0.01 * scenario.duration, CHUNK * scenario.output_step, STEPS * dt)

    def report(mbs: Any, t: float) -> bool:
        if t >= due[0]:
            due[0] = t + interval
            progress(t)
        return True if other is None else other(mbs, t)

    return report


def _trajectory(scenario: Scenario, times: Any, rows: Any, attributes: dict[str, Any]) -> Trajectory:
    """Return the recorded rows as a trajectory.

    Raises:
        SimulationError: rows are missing, not finite, or far beyond what the spring and the load allow.
    """
    box = scenario.mechanism
    where = f"Exudyn ({attributes['solver']}, dt = {attributes['dt']:g} s)"
    bad = ~np.all(np.isfinite(rows), axis=1)
    if bad.any():
        raise SimulationError(f"{where}: the motion is not finite from t = {rows[bad][0, 0]:g} s on; use a smaller step")
    if np.any(np.abs(rows[:, 0] - times) > 1.0e-3 * attributes["dt"]):
        raise SimulationError(f"{where}: steps do not end at the output times; use a step that divides the output step")
    position = box.belt_velocity * times - rows[:, 1]
    worst = int(np.argmax(np.abs(position)))
    scenario.require_sane(where, times[worst], float(position[worst]), attributes["dt"])
    return Trajectory(
        time=times,
        position=position,
        velocity=box.belt_velocity - rows[:, 2],
        friction_force=rows[:, 3].copy(),
        normal_force=np.full(len(times), box.normal_force),
        mu_s=rows[:, 4].copy(),
        mu_k=rows[:, 5].copy(),
        stick=rows[:, 6].copy(),
        attributes=attributes,
    )
