"""Forward simulation of slides under the load and the pressure that were measured, not under one that stays."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.discovery.driven_joint.simulation.closed_loop import closed_loop
from stochfric_mb.discovery.driven_joint.simulation.resimulation import as_mjcf
from stochfric_mb.effects import make_effect
from stochfric_mb.laws import make_law
from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.mechanisms import Cascade, PrismaticJoint
from tests.discovery.joints.test_parts import scenario

H, STEPS, COUNT = 1.0e-3, 20, 6000
MASS, MU, PRELOAD, AREA = 2.0, 0.1, 20.0, 1.0e-3
LOOP = Cascade(position_gain=20.0, velocity_gain=60.0, limit=200.0, reference="goal")


def driven(pressed, pushed):
    """A mass behind a cascade, friction MU (PRELOAD + pressed) [N] and a force ``pushed`` against it [N], shape (n,) each."""
    t = H * np.arange(COUNT)
    goal = 0.1 * np.sin(4.0 * t) + 0.03 * np.sin(9.0 * t)
    q, v = 0.0, 0.67
    position, force = np.empty(COUNT), np.empty(COUNT)
    for i in range(COUNT):
        u = LOOP.velocity_gain * (LOOP.position_gain * (goal[i] - q) - v)
        position[i], force[i] = q, u
        for _ in range(STEPS):
            v += (u - pushed[i] - MU * (PRELOAD + pressed[i]) * np.tanh(v / 1.0e-4)) / MASS * H / STEPS
            q += v * H / STEPS
    return t, {"position": position, "force": force}, {"goal": goal}


WAVING = 60.0 * (1.0 + np.sin(1.3 * H * np.arange(COUNT)))
"""A load that varies from 0 to 120 N."""
GROWING = JointModel(
    make_law("coulomb", mu_s=MU, mu_k=MU), (make_effect("load_dependence", reference_load=PRELOAD, exponent=1.0),), {}, PRELOAD
)


@pytest.mark.parametrize("channel", ["normal_force", "pressure"])
def test_a_closed_loop_is_simulated_under_the_measured_load(channel):
    area = AREA if channel == "pressure" else 0.0
    t, channels, covariates = driven(WAVING, WAVING if area else 0.0 * WAVING)
    measured = {channel: WAVING / AREA if area else WAVING}
    run = Run(name="test", role="test", time=t, channels=channels | measured, sample_interval=H, covariates=covariates)
    joint = PrismaticJoint(mass=MASS, normal_force=PRELOAD, piston_area=area)
    force, position = closed_loop(run, joint, GROWING, LOOP)
    settled = slice(500, None)
    size = np.sqrt(np.mean(channels["force"][settled] ** 2))
    # Euler's steps of a tenth of a sample, and friction that turns at once: of the drive less than 2 %
    assert np.sqrt(np.mean((force - channels["force"])[settled] ** 2)) < 0.02 * size
    plain = dataclasses.replace(GROWING, effects=())
    without, _ = closed_loop(run, joint, plain, LOOP)
    assert np.sqrt(np.mean((without - channels["force"])[settled] ** 2)) > 0.1 * size
    assert np.abs(position - channels["position"])[settled].max() < 2e-4


def test_a_slide_in_mujoco_is_simulated_under_the_measured_load():
    pytest.importorskip("mujoco", reason="the slide runs in MuJoCo")
    from stochfric_mb.discovery.driven_joint.mjcf.forward import forward

    t, channels, _ = driven(WAVING, 0.0 * WAVING)
    run = Run(name="test", role="test", time=t, channels=channels | {"normal_force": WAVING}, sample_interval=H)
    stated = scenario(mechanism=PrismaticJoint(mass=MASS, normal_force=PRELOAD))
    data = Dataset(title="", scenario_path=None, scenario=stated, runs=(dataclasses.replace(run, role="fit"), run))
    plain = dataclasses.replace(GROWING, effects=())
    right, without = (forward(*as_mjcf(data, model), 0.0).position for model in (GROWING, plain))
    assert right < 0.1 * without
