"""Scenarios with effects in every engine against the reference."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from stochfric_mb.effects import EFFECTS, effect_class, make_effect
from stochfric_mb.effects.combine import on_sensor
from stochfric_mb.engines import adapter
from stochfric_mb.metrics import rms_difference
from stochfric_mb.scenario import Scenario, load_scenario
from stochfric_mb.trajectory import Trajectory
from tests.unit.effects.examples import example

ENGINES = ("mujoco", "exudyn", "pymunk")
RMS = 5.0e-6
"""[m]. What the comparison of an augmented model asks for: the noise of a displacement sensor."""


@pytest.fixture(scope="module")
def references() -> dict[str, Trajectory]:
    return {}


def _scenario(*kinds: str, law: str = "coulomb", duration: float = 2.2) -> Scenario:
    base = load_scenario("kang2015_table1", law=law)
    effects = tuple(example(kind) for kind in kinds)
    return dataclasses.replace(base, process=None, effects=effects, duration=duration, output_step=1.0e-3)


@pytest.mark.parametrize("engine", ENGINES)
# effects that read what a rig measures have no place in a simulated belt-box
@pytest.mark.parametrize(
    "kind", [k for k in EFFECTS if not (on_sensor([example(k)]) or effect_class(k).reads or example(k).moves_load)]
)
def test_each_effect_agrees_with_the_reference(kind: str, engine: str, references: dict[str, Trajectory]) -> None:
    pytest.importorskip(engine)
    scenario = _scenario(kind)
    if kind not in references:
        references[kind] = adapter("reference").simulate(scenario, seed=1)
    reference, run = references[kind], adapter(engine).simulate(scenario, seed=1)
    assert rms_difference(run.position, reference.position) < RMS
    # loads are not in the friction force: half the samples are within 1 % of the static friction
    assert np.median(np.abs(run.friction_force - reference.friction_force)) < 0.01 * 0.8 * 13.0
    # MuJoCo's solver leaves the normal force a residual of about 1e-4
    np.testing.assert_allclose(run.normal_force, reference.normal_force, rtol=1.0e-3)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("axis", "high"), [("position", 2.8e-3), ("slip", 3.0e-3), ("time", 2.2), ("load", 26.0)])
def test_an_unnamed_term_runs_along_each_axis(axis: str, high: float, engine: str) -> None:
    pytest.importorskip(engine)
    term = example("unnamed", axis=axis, high=high, static_share=1.0)
    plain, scenario = _scenario(), dataclasses.replace(_scenario(), effects=(term,))
    reference, run = adapter("reference").simulate(scenario, seed=1), adapter(engine).simulate(scenario, seed=1)
    assert rms_difference(run.position, reference.position) < RMS
    # the term does something here: without it the box is elsewhere by several times the tolerance
    assert rms_difference(adapter("reference").simulate(plain, seed=1).position, reference.position) > 5.0 * RMS


@pytest.mark.parametrize("engine", ENGINES)
def test_a_lag_in_time_agrees_with_the_reference(engine: str) -> None:
    pytest.importorskip(engine)
    scenario = dataclasses.replace(_scenario(), effects=(make_effect("frictional_lag", time_constant=0.02),))
    reference, run = adapter("reference").simulate(scenario, seed=1), adapter(engine).simulate(scenario, seed=1)
    assert rms_difference(run.position, reference.position) < RMS


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("law", ["elastic_stick", "havsin"])
def test_other_laws_carry_effects(law: str, engine: str) -> None:
    pytest.importorskip(engine)
    kinds = ("dwell_ageing", "position_dependent_friction", "second_mode", "harmonic_force", "belt_speed_ripple")
    scenario = _scenario(*kinds, law=law, duration=1.5)
    reference, run = (adapter(name).simulate(scenario, seed=1) for name in ("reference", engine))
    assert rms_difference(run.position, reference.position) < RMS


@pytest.mark.parametrize("engine", ENGINES)
def test_reversed_belt(engine: str) -> None:
    pytest.importorskip(engine)
    scenario = _scenario("direction_asymmetry", "harmonic_force", "backlash")
    backwards = dataclasses.replace(scenario, mechanism=dataclasses.replace(scenario.mechanism, belt_velocity=-2.5e-3))
    reference, run = (adapter(name).simulate(backwards, seed=1) for name in ("reference", engine))
    assert reference.position.min() < -2.5e-3
    assert rms_difference(run.position, reference.position) < RMS


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("kind", [k for k in EFFECTS if effect_class(k).group == "sensor"])
def test_sensors_show_the_same_errors(kind: str, engine: str) -> None:
    pytest.importorskip(engine)
    scenario = _scenario(kind, duration=0.2)
    plain = adapter(engine).simulate(dataclasses.replace(scenario, effects=()), seed=1)
    run = adapter(engine).simulate(scenario, seed=1)
    np.testing.assert_array_equal(run.true_position, plain.position)
    reference = adapter("reference").simulate(scenario, seed=1)
    errors = [t.position - t.true_position for t in (run, reference)]
    # the true motions differ by a micrometre, and a delay turns that into a difference of errors no larger
    np.testing.assert_allclose(errors[0], errors[1], atol=2.0e-6)


@pytest.mark.parametrize("engine", ENGINES)
def test_samples_have_impacts_of_their_own(engine: str) -> None:
    pytest.importorskip(engine)
    scenario = _scenario("impacts", duration=1.5)
    first, second, again = (adapter(engine).simulate(scenario, seed=1, sample=s).position for s in (0, 1, 0))
    assert np.abs(first - second).max() > 1.0e-6
    np.testing.assert_array_equal(first, again)


def test_comparison_of_an_augmented_scenario() -> None:
    from stochfric_mb.comparison import compare

    scenario = _scenario("dwell_ageing", "friction_drift", duration=1.5)
    done = compare(scenario, seed=1, convergence=False)
    for engine in done.engines:
        assert engine.rms_position_error < RMS, engine.name
        assert engine.coefficient_path_max_difference < 1.0e-12
    assert done.to_dict()["scenario"]["effects"][0]["kind"] == "dwell_ageing"


def test_ensemble_of_a_scenario_with_effects() -> None:
    from stochfric_mb.ensemble import run

    scenario = _scenario("random_coefficients", "dwell_ageing", duration=1.2)
    result = run(scenario, 3, seed=2, output_times=[0.5, 1.2])
    alone = [adapter("reference").simulate(scenario, seed=2, sample=i).position[[500, 1200]] for i in range(3)]
    np.testing.assert_allclose(result.position, alone, atol=1.0e-12)
