"""What the modes cost in MuJoCo, on the belt-box and on standing robots, over native friction (--benchmark-only)."""

from pathlib import Path

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

import stochfric_mb.mujoco as engine  # noqa: E402
from stochfric_mb.laws.coulomb import Coulomb  # noqa: E402
from stochfric_mb.laws.elastic_stick import ElasticStick  # noqa: E402
from stochfric_mb.laws.havsin import Havsin  # noqa: E402
from stochfric_mb.mujoco import belt_box  # noqa: E402
from stochfric_mb.scenario import load_scenario  # noqa: E402
from tests.benchmarks.test_mujoco_cost import ROUNDS, native_model, seconds_per_step, started  # noqa: E402


# Rate over the native rate; the implicit mode repeats the solution of the step, so the engine's own part counts twice.
@pytest.mark.parametrize(("mode", "law", "least"), [
    ("explicit", "elastic_stick", 0.75),
    ("explicit", "havsin", 0.75),
    ("implicit", "elastic_stick", 0.25),
    ("implicit", "havsin", 0.2),
])  # fmt: skip
def test_rate_against_native_friction(benchmark, mode, law, least):
    case = load_scenario("kang2015_table1", law=law)
    spec = belt_box.scene(case.mechanism)
    engine.add_friction(spec, ("box", "belt"), case.law, mode=mode)
    ours = started(spec.compile(), mujoco.mjtIntegrator.mjINT_EULER)
    native = started(native_model(case), mujoco.mjtIntegrator.mjINT_EULER)
    ratios = []

    def one_round():
        ratios.append(seconds_per_step(*native) / seconds_per_step(*ours))

    benchmark.pedantic(one_round, rounds=ROUNDS)
    benchmark.extra_info["rate_to_native"] = float(np.median(ratios))
    assert np.median(ratios) >= least


# Robots that stand, at their own step with Euler: one solution of MuJoCo's own, one of the contacts together.
@pytest.mark.parametrize(("robot", "law", "least"), [
    ("ant", ElasticStick(0.8, 0.6), 0.25),
    ("ant", Havsin(0.8, 0.6), 0.25),
    ("ant", Coulomb(0.8, 0.6), 0.14),
    ("walker2d_v5", ElasticStick(0.8, 0.6), 0.35),
    ("walker2d_v5", Havsin(0.8, 0.6), 0.35),
    ("walker2d_v5", Coulomb(0.8, 0.6), 0.25),
])  # fmt: skip
def test_rate_of_a_standing_robot(benchmark, robot, law, least):
    gymnasium = pytest.importorskip("gymnasium")
    path = Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets" / f"{robot}.xml"
    ours, native = mujoco.MjSpec.from_file(str(path)), mujoco.MjSpec.from_file(str(path))
    engine.add_friction(ours, ("*", "floor"), law)
    models = [spec.compile() for spec in (native, ours)]
    runs = []
    for model in models:
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
        data = mujoco.MjData(model)
        mujoco.mj_step(model, data, nstep=round(4.0 / model.opt.timestep))  # it stands by then
        runs.append((model, data))
    ratios = []

    def one_round():
        ratios.append(seconds_per_step(*runs[0]) / seconds_per_step(*runs[1]))

    benchmark.pedantic(one_round, rounds=5)
    benchmark.extra_info["rate_to_native"] = float(np.median(ratios))
    assert np.median(ratios) >= least
