"""A stated controller: with what is added to its output, and believed only where it gives the recorded drive."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.discovery.driven_joint.simulation.controller_check import controller_misfit
from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.mechanisms import Cascade
from stochfric_mb.scenario import any_scenario_from_dict
from tests.discovery.joints.test_parts import H, scenario

STEPS = 20
"""Steps of the integration in one sample."""
POSITION_GAIN, VELOCITY_GAIN, LIMIT = 20.0, 60.0, 200.0
PULSE = 20.0
"""Force that is added, ten times friction [N]."""


def driven(number, role):
    """A mass of 2 kg with 2 N of friction that follows two sines, pulses of 0.1 s added to the force twice a second."""
    rng = np.random.default_rng(number)
    t = H * np.arange(6000)
    goal = 0.1 * np.sin(4.0 * t + number) + 0.03 * np.sin(9.0 * t)
    pulses = PULSE * np.where(np.mod(t, 0.5) < 0.1, np.sign(np.sin(7.0 * t + number)), 0.0)
    q, v = goal[0], 0.0
    position, force = np.empty(len(t)), np.empty(len(t))
    for i in range(len(t)):
        u = VELOCITY_GAIN * (POSITION_GAIN * (goal[i] - q) - v) + pulses[i]
        u = min(max(u, -LIMIT), LIMIT)
        position[i], force[i] = q, u
        for _ in range(STEPS):
            push = u - 2.0 * np.tanh(v / 1.0e-4)
            v += push / 2.0 * H / STEPS
            q += v * H / STEPS
    channels = {"position": position + 1.0e-6 * rng.standard_normal(len(t)), "force": force}
    return Run(
        name=f"{role} {number}", role=role, time=t, channels=channels, sample_interval=H,
        covariates={"goal": goal, "pulses": pulses},
    )  # fmt: skip


RUNS = driven(1, "fit"), driven(2, "test")


def data(**changes):
    keys = {
        "position_gain": POSITION_GAIN,
        "velocity_gain": VELOCITY_GAIN,
        "limit": LIMIT,
        "reference": "goal",
        "added": "pulses",
    }
    controller = Cascade(**(keys | changes))
    return Dataset(title="", scenario_path=None, scenario=scenario(controller=controller), runs=RUNS)


def test_the_right_controller_gives_the_recorded_drive_and_is_simulated():
    # 1e-6 m through 1200 N/m, and the velocity through eight samples: less than 1 % of 20 N
    assert controller_misfit(data()) < 0.02
    result = joint_outcome(data()).result
    assert result.gap.metric == "closed_loop_voltage"
    assert not any("stated controller" in note for note in result.notes)


def test_a_reference_in_another_unit_is_converted_as_positions_are():
    in_mm = tuple(
        dataclasses.replace(r, covariates=r.covariates | {"goal": 1e3 * r.covariates["goal"]}, units={"goal": "mm"})
        for r in RUNS
    )
    assert controller_misfit(dataclasses.replace(data(), runs=in_mm)) == pytest.approx(controller_misfit(data()), rel=1e-9)


def test_what_is_added_to_the_output_is_needed():
    without = controller_misfit(data(added=""))
    pulses = np.concatenate([r.covariates["pulses"] for r in RUNS if r.role == "test"])
    force = np.concatenate([r.channels["force"] for r in RUNS if r.role == "test"])
    assert without == pytest.approx(np.std(pulses) / np.sqrt(np.mean(force**2)), rel=0.1)


def test_a_controller_that_gives_another_drive_is_not_believed():
    result = joint_outcome(data(velocity_gain=6.0 * VELOCITY_GAIN)).result
    assert result.gap.metric == "inverse_dynamics_sliding"
    assert any("does not give the recorded drive" in note for note in result.notes)


def test_it_is_read_and_written():
    tables = data().scenario.to_dict()
    assert tables["controller"]["added"] == "pulses"
    assert any_scenario_from_dict(tables).controller == data().scenario.controller
    plain = dataclasses.replace(data().scenario, controller=data(added="").scenario.controller).to_dict()
    assert "added" not in plain["controller"]
