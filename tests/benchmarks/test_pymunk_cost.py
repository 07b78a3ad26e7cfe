"""Cost of a step with friction over a step of the same scene without any, measured in one run."""

from __future__ import annotations

import time

import pytest

pytest.importorskip("pymunk", reason="pymunk is not installed")

from stochfric_mb.pymunk.belt_box import Model, advance, build, start
from stochfric_mb.scenario import load_scenario

N_STEPS = 5000
ROUNDS = 9
RATIO_LIMIT = 2.0
"""The goal; 1.1 to 1.3 is measured, the rest is room for a machine that is busy with other things."""


def seconds(model: Model, dt: float, first: int) -> float:
    before = time.perf_counter()
    advance(model, dt, first, N_STEPS)
    return time.perf_counter() - before


@pytest.mark.parametrize(
    ("scenario", "law", "dt"),
    [
        ("kang2015_table1", "elastic_stick", 1e-4),
        ("kang2015_table1", "havsin", 2e-5),
        ("kang2015_table1", "coulomb", 1e-4),
        ("kang2015_table2_13_8", "elastic_stick", 1e-4),
    ],
)
def test_friction_costs_at_most_as_much_as_the_bare_step(scenario: str, law: str, dt: float) -> None:
    chosen = load_scenario(scenario, law=law)
    models = [build(chosen, seed=1, with_friction=w) for w in (True, False)]
    for model in models:
        start(model, dt)
    rounds = [[seconds(m, dt, 1 + i * N_STEPS) for m in models] for i in range(ROUNDS)]
    with_friction, bare = (min(r[i] for r in rounds) for i in (0, 1))
    print(f"{scenario} {law}: {1e6 * with_friction / N_STEPS:.2f} us/step, bare {1e6 * bare / N_STEPS:.2f} us/step")
    assert with_friction < RATIO_LIMIT * bare


@pytest.mark.benchmark(group="pymunk")
@pytest.mark.parametrize("law", ["elastic_stick", "havsin", "coulomb", None])
def test_step_rate(benchmark, law: str | None) -> None:
    model = build(load_scenario("kang2015_table1", law=law), seed=1, with_friction=law is not None)
    start(model, 1e-5)
    benchmark(advance, model, 1e-5, 1, 1000)
