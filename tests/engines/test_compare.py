"""The comparison itself, in every engine that is installed."""

import dataclasses
import math

import pytest

from stochfric_mb import InputError, PerEvent, Spatial, StabilityError, load_scenario
from stochfric_mb import comparison as compare
from stochfric_mb.engines import installed_engines

ENGINES = [name for name in installed_engines() if name != "reference"]
SLIP_SPEED = 0.035
"""Fastest slip of Table 1 [m/s]."""

pytestmark = pytest.mark.skipif(not ENGINES, reason="no engine is installed")


def table1(law, duration=3.0, **changes):
    scenario = load_scenario("kang2015_table1", law=law, overrides=[f"simulation.duration={duration}"])
    return dataclasses.replace(scenario, **changes)


@pytest.fixture(scope="module", params=["elastic_stick", "havsin"])
def compared(request):
    return compare.compare(table1(request.param), engines=ENGINES, seed=1, convergence=False)


def test_position_and_period_agree(compared):
    # a break-away that is found one step late shifts the slip by v dt; three slips in 3 s
    late = 3.0 * SLIP_SPEED * compared.dt
    for engine in compared.engines:
        assert 0.0 < engine.rms_position_error <= engine.max_abs_position_error < late
        assert abs(engine.period_relative_error) < 3.0 * compared.dt / compared.reference_period
        assert abs(engine.stick_fraction_error) < 3e-3  # one output sample of 1 ms at each of six switches, twice


def test_coefficients_are_equal_to_the_bit(compared):
    assert {e.name: e.coefficient_path_max_difference for e in compared.engines} == dict.fromkeys(ENGINES, 0.0)


def test_errors_shrink_with_the_step():
    result = compare.compare(table1("elastic_stick", 2.0), engines=ENGINES, seed=1)
    assert result.convergence_duration == 2.0
    for engine in result.engines:
        assert [p.dt for p in engine.convergence] == compare.convergence_steps(result.scenario)
        first, last = engine.convergence[0], engine.convergence[-1]
        assert last.rms_position_error < first.rms_position_error
        assert first.observed_order is None
        a, b = engine.convergence[1:3]
        order = math.log(a.rms_position_error / b.rms_position_error) / math.log(a.dt / b.dt)
        assert b.observed_order == pytest.approx(order, rel=1e-12)


def test_numbers_fit_the_published_format(compared):
    content = compared.to_dict()
    assert content["schema"] == "stochfric.comparison/1"
    assert set(content["engines"]) == set(ENGINES)
    for engine in content["engines"].values():
        assert engine["law"] == compared.scenario.law.kind
        assert engine["seconds_per_step"] > 0.0
        assert engine["notes"] == []


@pytest.mark.parametrize(
    "process",
    [Spatial(sigma_s=0.015, sigma_k=0.023, spacing=2e-4), PerEvent(sigma_s=0.015, sigma_k=0.023)],
    ids=lambda p: p.kind,
)
def test_fields_and_sequences_are_equal(process):
    result = compare.compare(table1("elastic_stick", process=process), engines=ENGINES, seed=2, convergence=False)
    for engine in result.engines:
        # draws are equal to the bit; a field is read at a position that was rounded: 1e-15 m of 2e-4 m, with margin
        assert engine.coefficient_path_max_difference <= (1e-10 if process.linear else 0.0)


def test_a_law_that_stands_in_is_noted():
    result = compare.compare(table1("coulomb", 1.2), engines=ENGINES, seed=1, convergence=False)
    for engine in result.engines:
        substituted = engine.trajectory.attributes["law"] != "coulomb"
        assert substituted == any("coulomb needs the holding force" in note for note in engine.notes)
        assert engine.to_dict()["law"] == engine.trajectory.attributes["law"]
        assert engine.max_abs_position_error < SLIP_SPEED * 5 * result.dt  # the stand-in breaks away a few steps late


def test_steps_of_a_convergence_study():
    assert compare.convergence_steps(table1("elastic_stick")) == [1e-3, 5e-4, 2e-4, 1e-4]
    assert compare.convergence_steps(table1("coulomb")) == [1e-3, 5e-4, 2e-4, 1e-4]
    stiff = table1("havsin")
    steps = compare.convergence_steps(stiff)
    assert steps == [1e-3 / 17, 4e-5, 2e-5, 1e-5]  # 6e-5 does not divide 1e-3
    assert steps[0] <= compare.LIMIT_SHARE * stiff.step_limit()
    for step in steps:
        assert stiff.output_step / step == pytest.approx(round(stiff.output_step / step), rel=1e-12)


def test_convergence_is_measured_over_two_seconds_at_most():
    assert compare.shortened(table1("coulomb", 10.0)).duration == 2.0
    assert compare.shortened(table1("coulomb", 0.5)).duration == 0.5
    assert compare.shortened(table1("coulomb", 6.0, output_step=1.5)).duration == 1.5
    assert compare.shortened(table1("coulomb", 6.0, output_step=3.0)).duration == 3.0


def test_runs_that_would_take_too_long_are_left_out_and_noted(monkeypatch):
    monkeypatch.setattr(compare, "CONVERGENCE_BUDGET", 0.0)
    result = compare.compare(table1("elastic_stick", 0.1), engines=ENGINES[:1])
    (engine,) = result.engines
    assert engine.convergence == ()
    assert len(engine.notes) == 4
    assert all("left out: it would take about" in note for note in engine.notes)


def test_every_run_is_announced():
    announced, reached = [], {}

    def stage(name, duration):
        announced.append((name, duration))
        return lambda t: reached.__setitem__(name, t)

    compare.compare(table1("elastic_stick", 0.3), engines=ENGINES, stage=stage, convergence=False)
    assert announced[0] == ("reference", 0.3)
    assert sorted(announced[1:]) == sorted((name, 0.3) for name in ENGINES)  # MuJoCo compiles meanwhile and runs last
    assert all(0.0 < t <= 0.3 + 1e-9 for t in reached.values())


def test_steps_that_cannot_be_used_are_refused():
    with pytest.raises(InputError, match="does not divide"):
        compare.compare(table1("elastic_stick", 0.1), engines=ENGINES[:1], dt=3e-4)
    with pytest.raises(StabilityError, match=rf"{ENGINES[0]}: dt = 0\.0001"):
        compare.compare(table1("havsin", 0.1), engines=ENGINES[:1], dt=1e-4)


def test_a_scenario_without_break_aways_has_no_period():
    result = compare.compare(table1("elastic_stick", 0.1), engines=ENGINES[:1], convergence=False)
    (engine,) = result.engines
    assert math.isnan(result.reference_period)
    assert math.isnan(engine.period_relative_error)
    assert engine.to_dict()["period_relative_error"] is None
