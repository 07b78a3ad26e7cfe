"""What an ensemble with friction costs in MuJoCo's Batch, against the same Batch with native friction (--benchmark-only)."""

import time

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")
batch = pytest.importorskip("mujoco.batch")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb.mujoco import belt_box  # noqa: E402
from stochfric_mb.scenario import load_scenario  # noqa: E402

RUNS, THREADS, DT, SECONDS, CHUNKS = 100, 2, 1e-3, 10.0, 20


def native_model(case):
    spec = belt_box.scene(case.mechanism)
    for name in ("box", "belt"):
        spec.geom(name).condim = 3
        spec.geom(name).friction = [0.8, 0.005, 0.0001]
    return spec.compile()


def started(model, integrator):
    model.opt.timestep, model.opt.integrator = DT, integrator
    many = batch.Batch(model, RUNS, THREADS)
    many.bind("qpos")[:, 1] = -2e-5  # in contact from the start
    return many


# A Runge-Kutta step has four evaluations in which to pay for the commit, an Euler step has one.
@pytest.mark.parametrize(("integrator", "limit"), [("RK4", 1.1), ("EULER", 1.1)])
def test_ensemble_against_native_friction(benchmark, integrator, limit):
    kind = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator}")
    case = load_scenario("kang2015_table1")
    model = belt_box.build(case, dt=DT)
    ours, native = started(model, kind), started(native_model(case), kind)
    engine.set_friction(ours.bind("plugin_state"), model, "friction_box_belt", sample=np.arange(RUNS))
    ratios = []

    def one_chunk():
        seconds = []
        for many in (ours, native):
            began = time.perf_counter()
            many.step(nstep=round(SECONDS / DT / CHUNKS))
            seconds.append(time.perf_counter() - began)
        ratios.append(seconds[0] / seconds[1])

    benchmark.pedantic(one_chunk, rounds=CHUNKS)
    benchmark.extra_info["ratio_to_native"] = float(np.median(ratios))
    assert len(np.unique(ours.bind("qpos")[:, 0])) == RUNS
    assert np.median(ratios) <= limit
