"""The belt-box oscillator in MuJoCo: a box on a plane with a surface velocity, integrated by MuJoCo's Runge-Kutta."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from stochfric_mb.effects.carry import reported, running_law
from stochfric_mb.errors import InputError, SimulationError
from stochfric_mb.friction import Friction
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.mujoco.attach import add_friction
from stochfric_mb.mujoco.march import COLUMNS, march
from stochfric_mb.mujoco.memory.state import header_of
from stochfric_mb.mujoco.reading import diverged, state_of
from stochfric_mb.scenario import Scenario, scenario_folders
from stochfric_mb.trajectory import Trajectory

CARRIES_EFFECTS = True
HOOK = "engine plugin (passive), RK4"
DEEPEST = -0.04
"""Lowest vertical coordinate at which rest is looked for [m]; the box is 0.1 m high."""
FRICTION = 0
"""Number of the plugin instance: the scene has no other."""
CHUNK = 200
"""Outputs between two progress reports."""

Array = npt.NDArray[np.float64]


def simulate(
    scenario: Scenario,
    *,
    seed: int = 0,
    sample: int = 0,
    dt: float | None = None,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Return the trajectory of a belt-box scenario in MuJoCo, sampled at the scenario's output times.

    Args:
        scenario: the scenario.
        seed: first part of the address of the coefficient path.
        sample: second part.
        dt: step [s], dividing the output step; `Scenario.default_dt` if not given.
        progress: called with the simulated time [s] now and then.

    Raises:
        StabilityError: ``dt`` is beyond the law's stability limit.
        InputError: ``dt`` does not divide the output step.
        SimulationError: MuJoCo met a state that is not finite or beyond reason.
    """
    model = build(scenario, seed=seed, sample=sample, dt=dt)
    return integrate(model, scenario, progress=progress)


def simulate_many(
    scenario: Scenario, *, seed: int = 0, first_sample: int = 0, n: int, dt: float | None = None, threads: int = 1
) -> list[Trajectory]:
    """Return samples ``first_sample`` .. ``first_sample + n - 1``, each what `simulate` returns, to the bit.

    Compiled steps hold no lock, so that threads step beside each other. Arguments and errors are those of `simulate`.
    """
    with ThreadPoolExecutor(min(threads, n)) as pool:
        samples = range(first_sample, first_sample + n)
        return list(pool.map(lambda sample: simulate(scenario, seed=seed, sample=sample, dt=dt), samples))


def build(scenario: Scenario, *, seed: int = 0, sample: int = 0, dt: float | None = None) -> mujoco.MjModel:
    """Return the scenario as a MuJoCo model with its friction, from ``models/belt_box/belt_box.xml``.

    Raises:
        StabilityError: ``dt`` is beyond the law's stability limit.
        InputError: ``dt`` does not divide the output step, or a seed is out of range.
    """
    step = scenario.checked_step(dt)
    mechanism = scenario.mechanism
    spec = scene(mechanism)
    spec.option.timestep = step
    law, _ = running_law(scenario.law, mechanism, scenario.effects, step, substitute=True, seed=seed, sample=sample)
    add_friction(spec, ("box", "belt"), Friction(law, scenario.coefficient_process), seed=seed, sample=sample, mode="explicit")
    return spec.compile()


def scene(mechanism: BeltBox) -> mujoco.MjSpec:
    """Return the belt-box scene with the mechanism's numbers, still without friction."""
    spec = mujoco.MjSpec.from_file(str(scene_file()))
    spec.option.gravity = [0.0, 0.0, -mechanism.normal_force / mechanism.mass]
    spec.geom("box").mass = mechanism.mass
    spec.geom("belt").surfacevel = [mechanism.belt_velocity, 0.0, 0.0, 0.0, 0.0, 0.0]
    slide: Any = spec.joint("x")
    slide.stiffness = [mechanism.stiffness, 0.0, 0.0]
    slide.damping = [mechanism.damping, 0.0, 0.0]
    foot: Any = spec.actuator("foot")
    foot.gainprm[0] = mechanism.stiffness
    return spec


def scene_file() -> Path:
    """Return the MJCF file of the belt-box scene.

    Raises:
        InputError: the package was installed without its models.
    """
    for folder in scenario_folders():
        if (path := folder / "belt_box" / "belt_box.xml").is_file():
            return path
    raise InputError("models/belt_box/belt_box.xml is missing; install the package anew")


def integrate(model: mujoco.MjModel, scenario: Scenario, *, progress: Callable[[float], None] | None = None) -> Trajectory:
    """Return the trajectory of a model made by `build`, as MuJoCo integrates it.

    Args:
        model: the model; whatever it holds is what moves (its step too).
        scenario: initial state, excitation and output times.
        progress: called with the simulated time [s] now and then.

    Raises:
        InputError: the model's step does not divide the output step.
        SimulationError: MuJoCo met a state that is not finite or beyond reason.
    """
    mechanism = scenario.mechanism
    per_output = round(scenario.output_step / model.opt.timestep)
    if abs(per_output * model.opt.timestep - scenario.output_step) > 1.0e-9 * scenario.output_step:
        raise InputError(f"model.opt.timestep = {model.opt.timestep:g} s does not divide {scenario.output_step:g} s")
    data = start(model, mechanism)
    state = state_of(model, data, FRICTION)
    rows = np.empty((scenario.n_outputs, COLUMNS))
    began = time.perf_counter()
    for first in range(0, scenario.n_outputs, CHUNK):
        part = rows[first : first + CHUNK]
        done = march(
            model._address, data._address, state.ctypes.data, model.joint("x").qposadr[0], model.actuator("foot").id,
            mechanism.excitation_amplitude, mechanism.excitation_angular_frequency, model.opt.timestep,
            first * per_output, (scenario.n_outputs - 1) * per_output, per_output, part,
        )  # fmt: skip
        _require_sane(data, part, done, scenario, (first + done) * scenario.output_step, model.opt.timestep)
        if progress is not None:
            progress((first + len(part) - 1) * scenario.output_step)
    seconds = time.perf_counter() - began
    return trajectory_of(model, state, rows, scenario, seconds)


def start(model: mujoco.MjModel, mechanism: BeltBox) -> mujoco.MjData:
    """Return data at the initial state, the box resting on the belt where its vertical acceleration is zero."""
    trial, data = mujoco.MjData(model), mujoco.MjData(model)
    for made in (trial, data):
        made.joint("x").qpos[0], made.joint("x").qvel[0] = mechanism.initial_position, mechanism.initial_velocity
    data.joint("z").qpos[0] = _resting_height(model, trial)
    header_of(state_of(model, data, FRICTION)).origin = -mechanism.initial_position
    return data


def _resting_height(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Return the vertical coordinate [m] at which the box rests: the root of its vertical acceleration."""
    z = data.joint("z")

    def acceleration(height: float) -> float:
        z.qpos[0] = height
        mujoco.mj_forward(model, data)
        return float(z.qacc[0])

    if not acceleration(1.0e-6) < 0.0:
        raise SimulationError("mujoco: the box does not fall onto the belt; check the model's gravity, mass and stiffness")
    if not acceleration(DEEPEST) > 0.0:
        raise SimulationError(
            f"mujoco: the box sinks deeper than {-DEEPEST:g} m into the belt; lower normal_force/mass or stiffen it"
        )
    root: Any = brentq(acceleration, DEEPEST, 1.0e-6, xtol=1.0e-16)
    return root


def _require_sane(data: mujoco.MjData, rows: Array, done: int, scenario: Scenario, t: float, dt: float) -> None:
    scenario.require_sane("mujoco", t, float(np.max(np.abs(rows[:done, 0]), initial=0.0)), dt)
    if done < len(rows) or diverged(data):
        raise SimulationError(f"mujoco: a state is not finite before t = {t:g} s; lower dt = {dt:g} s or check the scenario")


def trajectory_of(model: mujoco.MjModel, state: Array, rows: Array, scenario: Scenario, seconds: float) -> Trajectory:
    """Return the rows of `march` and the law instance's own state as a trajectory."""
    header, dt = header_of(state), float(model.opt.timestep)
    address: dict[str, int] = {"seed": int(header.seed), "sample": int(header.sample)}
    law, notes = running_law(scenario.law, scenario.mechanism, scenario.effects, dt, substitute=True, **address)
    n_steps = (scenario.n_outputs - 1) * round(scenario.output_step / dt)
    trajectory = Trajectory(
        scenario.output_times(), *rows.T.copy(),
        attributes={
            "engine": "mujoco", "version": mujoco.__version__, "hook": HOOK, "dt": dt, **address,
            "law": getattr(law, "inner", law).kind, "notes": notes,
            "seconds_per_step": seconds / n_steps, "n_steps": n_steps,
        },
    )  # fmt: skip
    return reported(trajectory, scenario.mechanism, scenario.effects, **address)
