"""MuJoCo: friction of this package at the floor contacts and in the joints of the robots that come with gymnasium."""

from pathlib import Path

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")
gymnasium = pytest.importorskip("gymnasium")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402
from stochfric_mb.laws.havsin import Havsin  # noqa: E402

ASSETS = Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets"
ELASTIC = ElasticStick(0.8, 0.6)
ROBOTS = ("ant", "half_cheetah", "hopper", "walker2d_v5", "humanoid", "humanoidstandup")


def run(robot, law, seconds, settled=3.0):
    """Return the drift [m] of the centre of mass once it has settled [s], with the warnings that MuJoCo gave."""
    spec = mujoco.MjSpec.from_file(str(ASSETS / f"{robot}.xml"))
    if law is not None:
        engine.add_friction(spec, ("*", "floor"), law)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=round(settled / model.opt.timestep))
    start = data.subtree_com[0].copy()
    mujoco.mj_step(model, data, nstep=round((seconds - settled) / model.opt.timestep))
    return float(np.linalg.norm((data.subtree_com[0] - start)[:2])), sum(w.number for w in data.warning), data


@pytest.mark.parametrize("law", [ELASTIC, Coulomb(0.8, 0.6)])
def test_a_robot_stands_on_friction(law):
    drift, warnings, data = run("walker2d_v5", law, 4.0)
    assert warnings == 0
    assert drift < 1e-6  # native friction: 5e-4 m in 7 s
    assert np.all(np.isfinite(data.qpos))


@pytest.mark.parametrize("law", [ELASTIC, Havsin(0.8, 0.6), Coulomb(0.8, 0.6)])
@pytest.mark.parametrize("angle", [0.0, 0.02])
def test_a_falling_robot_gains_no_energy(law, angle):
    """RK4, at a step beyond the explicit limit: impacts begin within steps."""
    spec = mujoco.MjSpec.from_file(str(ASSETS / "walker2d_v5.xml"))
    engine.add_friction(spec, ("*", "floor"), law)
    model = spec.compile()
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    data = mujoco.MjData(model)
    data.qpos[2] = angle
    mujoco.mj_forward(model, data)
    energies = []
    for _ in range(1000):
        mujoco.mj_step(model, data)
        energies.append(float(data.energy.sum()))
    assert max(np.diff(energies)) < 0.5  # [J]; MuJoCo's soft contacts give back 0.23 J in a step with native friction


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:compiler attribute 'settotalmass'")  # in half_cheetah.xml
@pytest.mark.parametrize("robot", ROBOTS)
def test_robots_are_stable_for_ten_seconds(robot):
    drift, warnings, data = run(robot, ELASTIC, 10.0)
    assert warnings == 0
    assert np.abs(data.qvel).max() < 1.0  # at rest on the floor, one way or other
    assert np.isfinite(drift)


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:compiler attribute 'settotalmass'")
@pytest.mark.parametrize("law", [ELASTIC, Coulomb(0.8, 0.6)])
@pytest.mark.parametrize("robot", ROBOTS)
def test_robots_at_rest_drift_no_more_than_with_native_friction(robot, law):
    """In 5 s from the time when all of them have come to rest: before, they sway on feet that stick."""
    native, ours = run(robot, None, 25.0, 20.0)[0], run(robot, law, 25.0, 20.0)[0]
    assert ours <= max(native, 1e-6)  # native friction stands to 1e-11 m or creeps by 1e-4 m; ours shakes with the solver


@pytest.mark.parametrize("law", [ELASTIC, Havsin(0.8, 0.6)])
def test_an_arm_turns_as_fast_as_friction_and_damping_let_it(law):
    spec = mujoco.MjSpec.from_file(str(ASSETS / "reacher.xml"))
    for joint in ("joint0", "joint1"):
        engine.add_friction(spec, engine.Joint(joint), law, normal_force=10.0)
    model = spec.compile()
    model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_EULER, 2e-3
    data = mujoco.MjData(model)
    for torque in np.linspace(0.0, 7.5, 500):  # of mu_s N = 8 N m; at once, it would swing beyond that
        data.ctrl[0] = torque / 200.0
        mujoco.mj_step(model, data)
    mujoco.mj_step(model, data, nstep=500)
    held = float(data.qpos[0])
    mujoco.mj_step(model, data, nstep=1000)
    assert abs(data.qpos[0] - held) < (1e-9 if law is ELASTIC else 2.0 * law.v_s)  # havsin creeps, slower than v_s
    data.ctrl[0] = 10.0 / 200.0
    mujoco.mj_step(model, data, nstep=10000)
    assert data.qvel[0] == pytest.approx((10.0 - 0.6 * 10.0) / model.dof_damping[0], rel=1e-3)
    assert abs(data.qvel[1]) < 1e-3  # the forearm's friction holds it against nothing but the start


def test_an_arm_of_seven_joints_holds_its_motors():
    spec = mujoco.MjSpec.from_file(str(ASSETS / "pusher_v5.xml"))
    names = [j.name for j in spec.joints if j.name.startswith("r_")]
    for k, joint in enumerate(names):
        engine.add_friction(spec, engine.Joint(joint), ELASTIC, normal_force=2.0, contact=k)
    model = spec.compile()
    data = mujoco.MjData(model)
    places = [model.joint(name).qposadr[0] for name in names]
    data.qpos[places] = model.jnt_range[[model.joint(name).id for name in names]].mean(axis=1)  # away from the stops
    for torque in np.linspace(0.0, 1.5, 200):  # of mu_s N = 1.6 N m
        data.ctrl[:] = torque * np.array([1, -1, 1, -1, 1, -1, 1])
        mujoco.mj_step(model, data)
    mujoco.mj_step(model, data, nstep=100)
    held = data.qpos[places].copy()
    mujoco.mj_step(model, data, nstep=500)
    assert np.abs(data.qpos[places] - held).max() < 1e-9
    data.ctrl[:] *= 1.8 / 1.5
    mujoco.mj_step(model, data, nstep=50)
    assert np.abs(data.qpos[places] - held).min() > 1e-2
