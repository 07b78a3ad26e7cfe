"""The belt-box oscillator in MuJoCo Warp: all samples of an ensemble at once, a world each."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import math
import time
from typing import Any

import mujoco
import mujoco_warp as mjw
import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from stochfric_mb.errors import InputError
from stochfric_mb.friction import Friction
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.mujoco.belt_box import scene
from stochfric_mb.scenario import Scenario, fitting_step
from stochfric_mb.trajectory import Trajectory
from stochfric_mb.warp.attach import add_friction
from stochfric_mb.warp.kinds import ContactFriction

HOOK = "steers MuJoCo Warp's constraint solver, Euler"
STEP = 1.0e-3
"""Step that is taken unless stated otherwise [s]: the solver has no stability limit."""
DEEPEST = -0.04
"""Lowest vertical coordinate at which rest is looked for [m]; the box is 0.1 m high."""
Array = npt.NDArray[np.float64]


def run_worlds(scenario: Scenario[BeltBox], *, seed: int, first_sample: int, n: int, dt: float | None) -> list[Trajectory]:
    """Return samples ``first_sample`` .. ``first_sample + n - 1``, a world each.

    Args:
        scenario: the scenario.
        seed: first part of the address of the coefficient paths.
        first_sample: second part of the first one.
        n: number of samples.
        dt: step [s], dividing the output step; `STEP` or the largest that fits below it if None.

    Raises:
        InputError: ``dt`` does not divide the output step, or the law cannot run there.
        SimulationError: a state is beyond reason.
    """
    step = _step(scenario, dt)
    model, data = _start(scenario.mechanism, step)
    m, d = mjw.put_model(model), mjw.put_data(model, data, nworld=n)
    law = Friction(scenario.law, scenario.coefficient_process)
    friction = add_friction(model, m, d, ("box", "belt"), law, seed=seed, first_sample=first_sample)
    assert isinstance(friction, ContactFriction)
    friction.worlds.origin = -scenario.mechanism.initial_position
    began = time.perf_counter()
    rows = _march(m, d, friction, scenario, step)
    n_steps = (scenario.n_outputs - 1) * round(scenario.output_step / step)
    seconds = (time.perf_counter() - began) / n / max(n_steps, 1)
    for x in rows[:, -1, 0]:
        scenario.require_sane("warp", scenario.duration, float(x), step)
    about = {
        "engine": "warp", "version": mjw.__version__, "hook": HOOK, "dt": step, "seed": seed, "law": scenario.law.kind,
        "notes": [], "seconds_per_step": seconds, "n_steps": n_steps,
    }  # fmt: skip
    return [_trajectory(scenario, rows[w], about | {"sample": first_sample + w}) for w in range(n)]


def _step(scenario: Scenario[BeltBox], dt: float | None) -> float:
    if dt is None:
        return fitting_step(STEP, scenario.output_step)
    number = scenario.output_step / dt if dt > 0.0 else 0.0
    if number < 0.5 or abs(number - round(number)) > 1.0e-6 * number:
        raise InputError(
            f"dt = {dt:g} s does not divide simulation.output_step = {scenario.output_step:g} s; choose one that does"
        )
    return scenario.output_step / round(number)


def _start(mechanism: BeltBox, step: float) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return model and data at the initial state, the box resting on the belt."""
    spec = scene(mechanism)
    spec.option.timestep = step
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    for name in ("belt", "box"):
        spec.geom(name).condim = 3
    model = spec.compile()
    data = mujoco.MjData(model)
    data.joint("x").qpos = mechanism.initial_position
    data.joint("x").qvel = mechanism.initial_velocity

    def acceleration(height: float) -> float:
        data.joint("z").qpos = height
        mujoco.mj_forward(model, data)
        return float(data.joint("z").qacc[0])

    rest: Any = brentq(acceleration, DEEPEST, 1.0e-6, xtol=1.0e-12)
    acceleration(rest)
    return model, data


def _march(m: mjw.Model, d: mjw.Data, friction: ContactFriction, scenario: Scenario[BeltBox], step: float) -> Array:
    """Return position, velocity, friction force, normal force, mu_s, mu_k and stick, shape (n, n_outputs, 7)."""
    mechanism = scenario.mechanism
    per_output = round(scenario.output_step / step)
    rows = np.empty((d.nworld, scenario.n_outputs, 7))
    for i in range(scenario.n_outputs):
        rows[:, i, 0], rows[:, i, 1] = d.qpos.numpy()[:, 0], d.qvel.numpy()[:, 0]
        last = i + 1 == scenario.n_outputs
        for k in range(1 if last else per_output):
            middle = (i * per_output + k + 0.5) * step
            if mechanism.excitation_amplitude:
                foot = mechanism.excitation_amplitude * math.cos(mechanism.excitation_angular_frequency * middle)
                d.ctrl.fill_(foot)
            (mjw.forward if last else mjw.step)(m, d)
            if k == 0:
                _read(d, friction, rows[:, i])
    return rows


def _read(d: mjw.Data, friction: ContactFriction, rows: Array) -> None:
    friction.observe(d)
    rows[:, 2] = friction.friction_force.numpy()[:, 0]
    rows[:, 3] = friction.normal_force.numpy()
    rows[:, 4], rows[:, 5] = friction.mu_s.numpy(), friction.mu_k.numpy()
    rows[:, 6] = friction.stick.numpy()


def _trajectory(scenario: Scenario[BeltBox], rows: Array, about: dict[str, Any]) -> Trajectory:
    names = ("position", "velocity", "friction_force", "normal_force", "mu_s", "mu_k", "stick")
    columns = {name: rows[:, i].copy() for i, name in enumerate(names)}
    return Trajectory(time=scenario.output_times(), **columns, attributes=about)
