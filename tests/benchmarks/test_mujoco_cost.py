"""What friction by plugin costs in MuJoCo, against the same scene with native friction (run with --benchmark-only)."""

import time

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

from stochfric_mb.mujoco import belt_box  # noqa: E402
from stochfric_mb.scenario import load_scenario  # noqa: E402

STEPS, ROUNDS = 500, 25


def native_model(case):
    spec = belt_box.scene(case.mechanism)
    for name in ("box", "belt"):
        spec.geom(name).condim = 3
        spec.geom(name).friction = [0.8, 0.005, 0.0001]
    return spec.compile()


def started(model, integrator):
    model.opt.timestep, model.opt.integrator = 1e-4, integrator
    data = mujoco.MjData(model)
    data.qpos[1] = -2e-5  # in contact from the start
    mujoco.mj_step(model, data, nstep=STEPS)
    return model, data


def seconds_per_step(model, data):
    began = time.process_time()
    mujoco.mj_step(model, data, nstep=STEPS)
    return (time.process_time() - began) / STEPS


# One Euler step has one evaluation in which to pay for the commit (1.00 to 1.06 measured), a Runge-Kutta step has four
# (0.91 to 0.98); the limits leave room for what a shared machine scatters.
@pytest.mark.parametrize(("integrator", "limit"), [("RK4", 1.05), ("EULER", 1.15)])
@pytest.mark.parametrize("law", ["elastic_stick", "havsin"])
def test_cost_against_native_friction(benchmark, law, integrator, limit):
    kind = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator}")
    case = load_scenario("kang2015_table1", law=law)
    ours = started(belt_box.build(case, dt=2e-5), kind)
    native = started(native_model(case), kind)
    ratios = []

    def one_round():
        ratios.append(seconds_per_step(*ours) / seconds_per_step(*native))

    benchmark.pedantic(one_round, rounds=ROUNDS)
    benchmark.extra_info["ratio_to_native"] = float(np.median(ratios))
    assert np.median(ratios) <= limit
