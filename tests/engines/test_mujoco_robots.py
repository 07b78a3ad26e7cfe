"""MuJoCo: friction of this package at all floor contacts of the robots that come with gymnasium."""

from pathlib import Path

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")
gymnasium = pytest.importorskip("gymnasium")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402

ASSETS = Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets"
ELASTIC = ElasticStick(0.8, 0.6)
ROBOTS = ("ant", "half_cheetah", "hopper", "walker2d_v5")


def run(robot, law, seconds):
    """Return the drift [m] of the centre of mass after the first 3 s, with the warnings that MuJoCo gave."""
    spec = mujoco.MjSpec.from_file(str(ASSETS / f"{robot}.xml"))
    if law is not None:
        engine.add_friction(spec, ("*", "floor"), law)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=round(3.0 / model.opt.timestep))
    start = data.subtree_com[0].copy()
    mujoco.mj_step(model, data, nstep=round((seconds - 3.0) / model.opt.timestep))
    return float(np.linalg.norm((data.subtree_com[0] - start)[:2])), sum(w.number for w in data.warning), data


@pytest.mark.parametrize("law", [ELASTIC, Coulomb(0.8, 0.6)])
def test_a_robot_stands_on_friction(law):
    drift, warnings, data = run("walker2d_v5", law, 4.0)
    assert warnings == 0
    assert drift < 1e-6  # native friction: 5e-4 m in 7 s
    assert np.all(np.isfinite(data.qpos))


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:compiler attribute 'settotalmass'")  # in half_cheetah.xml
@pytest.mark.parametrize("robot", ROBOTS)
def test_robots_are_stable_for_ten_seconds(robot):
    drift, warnings, data = run(robot, ELASTIC, 10.0)
    assert warnings == 0
    assert np.abs(data.qvel).max() < 1.0  # at rest on the floor, one way or other
    assert np.isfinite(drift)
