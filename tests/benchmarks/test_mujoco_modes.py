"""What the two modes cost in MuJoCo on the belt-box, against native friction (run with --benchmark-only)."""

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

import stochfric_mb.mujoco as engine  # noqa: E402
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
