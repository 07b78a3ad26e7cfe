"""Cost of a step with friction over a step of the same system without, measured in one run."""

from __future__ import annotations

import dataclasses
import time

import pytest

pytest.importorskip("exudyn", reason="exudyn is not installed")

from stochfric_mb.exudyn.belt_box import build, without_friction
from stochfric_mb.exudyn.solve import SOLVERS, silent_settings, solve_dynamic
from stochfric_mb.scenario import Scenario, load_scenario

N_STEPS = 5000
ROUNDS = 9


def bare_seconds(scenario: Scenario, dt: float) -> float:
    """Processor time of a run of the mass, spring, damper and load alone."""
    mbs, *_ = without_friction(scenario.mechanism)
    mbs.Assemble()
    settings = silent_settings(dt, scenario.duration)
    before = time.process_time()
    mbs.SolveDynamic(settings, solverType=SOLVERS["rk44"], showHints=False)
    return time.process_time() - before


def friction_seconds(scenario: Scenario, dt: float, *, locate: bool) -> float:
    """Processor time of the same with friction, samples taken at the output times."""
    built = build(scenario, seed=1, dt=dt)
    built.contact.record(scenario.output_times())
    settings = silent_settings(dt, scenario.duration)
    before = time.process_time()
    solve_dynamic(built.mbs, settings, locate=locate)
    seconds = time.process_time() - before
    built.close()
    return seconds


@pytest.mark.parametrize(
    ("name", "law", "dt", "limit"),
    [
        # the goal is 4 times; measured 3.3 (elastic) and 3.1 (havsin)
        ("kang2015_table2_13_8", "elastic_stick", 1e-4, 4.0),
        ("kang2015_table2_13_8", "havsin", 2e-5, 4.0),
        # Table 1 has no load, so that its bare step costs 0.5 us, which is what two calls into Python cost; measured 4.6, 4.3
        ("kang2015_table1", "elastic_stick", 1e-4, 6.0),
        ("kang2015_table1", "havsin", 2e-5, 6.0),
    ],
)
def test_cost_of_friction_over_the_bare_step(name: str, law: str, dt: float, limit: float) -> None:
    scenario = load_scenario(name, law=law)
    scenario = dataclasses.replace(scenario, duration=round(N_STEPS * dt / scenario.output_step) * scenario.output_step)
    n = scenario.duration / dt
    rounds = [
        [bare_seconds(scenario, dt), *(friction_seconds(scenario, dt, locate=on) for on in (False, True))]
        for _ in range(ROUNDS)
    ]
    bare, plain, located = (min(r[i] for r in rounds) for i in range(3))
    print(f"{name} {law}: us/step bare {1e6 * bare / n:.2f}, friction {1e6 * plain / n:.2f}, located {1e6 * located / n:.2f}")
    assert plain < limit * bare
    assert located < 1.25 * plain  # switches are rare, and watched only when near: measured 1.02 to 1.05


@pytest.mark.benchmark(group="exudyn")
@pytest.mark.parametrize("law", ["elastic_stick", "havsin"])
def test_step_rate(benchmark, law: str) -> None:
    scenario = dataclasses.replace(load_scenario("kang2015_table1", law=law), duration=0.02)
    built = build(scenario, seed=1, dt=2e-5)
    benchmark(lambda: solve_dynamic(built.mbs, silent_settings(2e-5, scenario.duration)))
