"""Many samples of one belt-box scenario at once: MuJoCo's own Batch, one simulation a sample, on its threads."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import math
import time
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt
from mujoco.batch import Batch

from stochfric_mb.effects.combine import any_but_random
from stochfric_mb.errors import InputError, SimulationError
from stochfric_mb.mujoco.belt_box import build, start, trajectory_of
from stochfric_mb.mujoco.march import COLUMNS
from stochfric_mb.mujoco.memory.state import slots_of
from stochfric_mb.mujoco.reading import friction_instances
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import Trajectory

Array = npt.NDArray[np.float64]


def simulate_many(
    scenario: Scenario, *, seed: int = 0, first_sample: int = 0, n: int, dt: float | None = None, threads: int = 1
) -> list[Trajectory]:
    """Return samples ``first_sample`` .. ``first_sample + n - 1``, each to the bit what `belt_box.simulate` returns.

    The normal force alone is another: the one that the law was given, which agrees with the contact's to its residual.

    Args:
        scenario: the scenario.
        seed: first part of the address of the coefficient paths.
        first_sample: second part of the first one.
        n: number of samples.
        dt: step [s], dividing the output step; `Scenario.default_dt` if not given.
        threads: threads that step the samples.

    Raises:
        StabilityError: ``dt`` is beyond the law's stability limit.
        InputError: ``dt`` does not divide the output step, or the scenario has effects.
        SimulationError: MuJoCo met a state that is not finite or beyond reason.
    """
    if any_but_random(scenario.effects):
        raise InputError(
            "samples with effects run one by one, since a law with effects has its own random numbers: use simulate"
        )
    batch = _started(scenario, dt, seed, range(first_sample, first_sample + n), threads)
    began = time.perf_counter()
    rows = _march(batch, scenario)
    seconds = (time.perf_counter() - began) / n
    _require_sane(batch, rows, scenario)
    pairs = zip(own_state(batch), rows, strict=True)
    return [trajectory_of(batch.model, state, row, scenario, seconds) for state, row in pairs]


def own_state(batch: Batch) -> Array:
    """Return the state of the model's (first) friction instance in each simulation, a view laid out as `slots` says."""
    instance = friction_instances(batch.model)[0]
    first = int(batch.model.plugin_stateadr[instance])
    return batch.bind("plugin_state")[:, first : first + int(batch.model.plugin_statenum[instance])]


def _started(scenario: Scenario, dt: float | None, seed: int, samples: range, threads: int) -> Batch:
    """Return a batch whose simulations are at the initial state, each at the resting height of its own sample."""
    models = [build(scenario, seed=seed, sample=sample, dt=dt) for sample in samples]
    batch = Batch(models[0], len(samples), min(threads, len(samples)))
    batch.reset(stage=mujoco.mjtStage.mjSTAGE_NONE.value)
    for j, model in enumerate(models):
        data = start(model, scenario.mechanism)
        for name in ("qpos", "qvel", "plugin_state"):
            batch.bind(name)[j] = getattr(data, name)
    return batch


def _march(batch: Batch, scenario: Scenario) -> Array:
    """Return position, velocity, friction force, normal force, mu_s, mu_k and stick, shape (n, n_outputs, COLUMNS)."""
    mechanism, model = scenario.mechanism, batch.model
    dt = float(model.opt.timestep)
    per_output = round(scenario.output_step / dt)
    joint, foot = model.joint("x").qposadr[0], model.actuator("foot").id
    control: Any = batch.bind("ctrl")
    qpos, qvel, state = batch.bind("qpos"), batch.bind("qvel"), own_state(batch)
    rows = np.empty((batch.nsim, scenario.n_outputs, COLUMNS))
    wave = mechanism.excitation_amplitude, mechanism.excitation_angular_frequency
    for i in range(scenario.n_outputs):
        number = i * per_output
        control[:, foot] = wave[0] * math.cos(wave[1] * (number * dt))
        batch.forward()
        rows[:, i, 0], rows[:, i, 1] = qpos[:, joint], qvel[:, joint]
        _contacts(state, rows[:, i])
        if i + 1 < scenario.n_outputs:
            _steps(batch, foot, wave, number, per_output, dt)
    return rows


def _steps(batch: Batch, foot: int, wave: tuple[float, float], first: int, n: int, dt: float) -> None:
    """Take ``n`` steps, the foot of the spring where it is in the middle of each."""
    if wave[0] == 0.0:
        batch.step(nstep=n)
        return
    control = np.zeros((n, batch.model.nu))
    control[:, foot] = [wave[0] * math.cos(wave[1] * ((number + 0.5) * dt)) for number in range(first, first + n)]
    batch.rollout(n, control, record=())


def _contacts(states: Array, rows: Array) -> None:
    """Write columns 2 .. 6 from the current slots of the contacts."""
    rows[:, 2:] = 0.0
    for state, row in zip(states, rows, strict=True):
        for k, slot in enumerate(slots_of(state, committed=False)):
            row[2] += slot.fx * slot.axis_1[0] + slot.fy * slot.axis_2[0]
            row[3] += slot.normal
            if k == 0:
                row[4:] = slot.mu_s, slot.mu_k, slot.stick


def _require_sane(batch: Batch, rows: Array, scenario: Scenario) -> None:
    dt, end = float(batch.model.opt.timestep), scenario.duration
    for position in np.nanmax(np.abs(rows[:, :, 0]), axis=1, initial=0.0), rows[:, -1, 0]:
        for x in position:
            scenario.require_sane("mujoco", end, float(x), dt)
    bad = [getattr(mujoco.mjtWarning, f"mjWARN_BAD{name}").value for name in ("QPOS", "QVEL", "QACC")]
    if np.any(batch.warning[:, bad]):
        raise SimulationError(f"mujoco: a state is not finite (dt = {dt:g} s); use a smaller dt, or check the scenario")
