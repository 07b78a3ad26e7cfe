"""What the modes cost in MuJoCo, on the belt-box and on robots, over native friction (--benchmark-only)."""

import time
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
    ("explicit", "elastic_stick", 0.87),
    ("explicit", "havsin", 0.87),
    ("implicit", "elastic_stick", 0.3),
    ("implicit", "havsin", 0.3),
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


ELASTIC, HAVSIN, COULOMB = ElasticStick(0.8, 0.6), Havsin(0.8, 0.6), Coulomb(0.8, 0.6)
HOLD = 0.05
"""Time for which a moving robot keeps its controls [s]."""


def robots(name, law, integrator=None):
    """Return the model with native friction and with ours, at all contacts of the floor."""
    gymnasium = pytest.importorskip("gymnasium")
    path = Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets" / f"{name}.xml"
    ours, native = mujoco.MjSpec.from_file(str(path)), mujoco.MjSpec.from_file(str(path))
    engine.add_friction(ours, ("*", "floor"), law)
    models = [spec.compile() for spec in (native, ours)]
    for model in models:
        model.opt.integrator = model.opt.integrator if integrator is None else integrator
    return models


def measure(benchmark, one_round, rounds):
    ratios = []
    benchmark.pedantic(lambda: ratios.append(one_round()), rounds=rounds)
    benchmark.extra_info["rate_to_native"] = float(np.median(ratios))
    return float(np.median(ratios))


# Robots that stand, at their own step with Euler: one solution of MuJoCo's own, one of the contacts together.
@pytest.mark.filterwarnings("ignore:compiler attribute 'settotalmass'")  # in half_cheetah.xml
@pytest.mark.parametrize("law", [ELASTIC, HAVSIN, COULOMB], ids=lambda law: law.kind)
@pytest.mark.parametrize("robot", ["ant", "half_cheetah", "hopper", "humanoid", "walker2d_v5"])
def test_rate_of_a_standing_robot(benchmark, robot, law):
    runs = []
    for model in robots(robot, law, mujoco.mjtIntegrator.mjINT_EULER):
        data = mujoco.MjData(model)
        mujoco.mj_step(model, data, nstep=round(4.0 / model.opt.timestep))  # it stands by then
        runs.append((model, data))
    rate = measure(benchmark, lambda: seconds_per_step(*runs[0]) / seconds_per_step(*runs[1]), 5)
    assert rate >= 0.35  # 0.48 to 0.63, on a machine with nothing else to do


# Robots in motion, with the same random controls: contacts begin, end, stick and slip in most steps.
@pytest.mark.filterwarnings("ignore:compiler attribute 'settotalmass'")
@pytest.mark.parametrize("law", [ELASTIC, HAVSIN, COULOMB], ids=lambda law: law.kind)
@pytest.mark.parametrize("robot", ["ant", "half_cheetah", "hopper", "humanoid", "walker2d_v5"])
def test_rate_of_a_moving_robot(benchmark, robot, law):
    models = robots(robot, law)
    datas = [mujoco.MjData(model) for model in models]
    rng = np.random.default_rng(1)
    steps = max(1, round(HOLD / models[0].opt.timestep))
    largest = 0.5 * np.abs(models[0].actuator_ctrlrange).max(axis=1)

    def one_round():
        seconds = [0.0, 0.0]
        for _ in range(10):
            controls = largest * rng.uniform(-1.0, 1.0, models[0].nu)
            for k in range(2):
                datas[k].ctrl[:] = controls
                began = time.process_time()
                mujoco.mj_step(models[k], datas[k], nstep=steps)
                seconds[k] += time.process_time() - began
        return seconds[0] / seconds[1]

    assert measure(benchmark, one_round, 15) >= 0.2  # 0.35 to 0.62, on a machine with nothing else to do
