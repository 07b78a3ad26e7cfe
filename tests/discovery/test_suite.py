"""The suite with answers made up by hand: counting, resuming, failing."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from tests.discovery import judge, plan, suite
from tests.discovery.generator.case import Case
from tests.discovery.generator.design import DESIGNS


@pytest.fixture(autouse=True)
def short_runs(monkeypatch):
    for name, design in list(DESIGNS.items()):
        monkeypatch.setitem(DESIGNS, name, replace(design, runs=tuple(replace(run, duration=0.2) for run in design.runs)))
    monkeypatch.setattr("tests.discovery.generator.case._BURN_IN", (0.1, 0.2))


def says(verdict: str, kind: str | None = None, equivalent_to: tuple[str, ...] = ()):
    effects = [{"kind": kind, "equivalent_to": list(equivalent_to)}] if kind else []
    gap = {"recalibrated": 2.0, "augmented": 1.1, "floor": 1.0, "closed": 0.9}

    def discover(dataset: Path, out: Path) -> None:
        assert (dataset / "dataset.toml").exists()
        out.mkdir(parents=True)
        (out / "result.json").write_text(json.dumps({"verdict": verdict, "effects": effects, "gap": gap}))

    return discover


def fails(dataset: Path, out: Path) -> None:
    raise ValueError("nothing to see")


RIPPLE = Case("normal_load_ripple.square", "one_free", 0.5, 0)
LAG = Case("frictional_lag.relaxation", "belt_speeds", 1.0, 0)
NULL = Case("none.wrong_parameters", "one_free", 1.0, 0)
ODD = Case("unknown.alternating", "several", 1.0, 0)


def rows(verdicts, group):
    return {row: entry[group]["value"] for row, entry in judge.summary(verdicts).items()}


def test_equivalent_name_counts_as_top_1_but_not_as_the_very_name(tmp_path):
    verdicts = suite.run([RIPPLE], tmp_path, says("effect", "position_dependent_friction", ("normal_load_ripple",)))
    one = rows(verdicts, "one")
    assert (one["top-1 name right"], one["truth in the reported class"]) == (1.0, 1.0)
    assert one["the very name, not only one that cannot be distinguished"] == 0.0
    assert one["gap closed, median"] == 0.9


def test_wrong_name_counts_against_effects_nulls_and_unknowns(tmp_path):
    verdicts = suite.run([LAG, NULL, ODD], tmp_path, says("effect", "viscous_friction"))
    assert rows(verdicts, "several")["top-1 name right"] == 0.0
    assert rows(verdicts, "several")["forced into a wrong name"] == 1.0
    assert rows(verdicts, "several")["out-of-vocabulary effect answered unknown"] == 0.0
    assert rows(verdicts, "one")["false alarms when nothing is missing"] == 1.0


def test_right_unknown_and_none(tmp_path):
    assert (
        rows(suite.run([ODD], tmp_path / "a", says("unknown")), "several")["out-of-vocabulary effect answered unknown"] == 1.0
    )
    assert rows(suite.run([NULL], tmp_path / "b", says("none")), "one")["false alarms when nothing is missing"] == 0.0


def test_finished_cases_are_not_run_again(tmp_path):
    suite.run([NULL], tmp_path, says("none"))
    verdicts = suite.run([NULL, RIPPLE], tmp_path, fails)
    assert [verdict.answer for verdict in verdicts] == ["none", "failed"]
    assert not list((tmp_path / "datasets").iterdir())
    verdicts = suite.run([NULL, RIPPLE], tmp_path, says("unknown"), retry=True)
    assert [verdict.answer for verdict in verdicts] == ["none", "unknown"]


def test_slow_case_is_given_up(tmp_path):
    def endless(dataset: Path, out: Path) -> None:
        while True:
            pass

    (verdict,) = suite.run([NULL], tmp_path, endless, limit=0.2)
    assert verdict.answer == "failed"
    assert "TimeoutError" in json.loads((tmp_path / "cases" / f"{NULL.name}.json").read_text())["error"]


def test_summaries_are_written(tmp_path):
    suite.run([NULL, RIPPLE], tmp_path, says("none"))
    text = (tmp_path / "summary.md").read_text()
    assert "| normal_load_ripple | none 1 |" in text
    assert json.loads((tmp_path / "summary.json").read_text())["summary"]["effects answered none"]["one"]["value"] == 1.0


def test_plan_shows_each_effect_at_several_points_and_rotates():
    cases = list(plan.cases(range(12)))
    assert len({case.name for case in cases}) == len(cases)
    lag = {(case.design, case.strength) for case in cases if case.forms == "frictional_lag.relaxation"}
    assert {design for design, _ in lag} == set(DESIGNS)
    assert {strength for _, strength in lag} == {0.3, 0.5, 1.0}
    assert {case.design for case in cases if case.forms == "load_dependence.adhesion" and case.experiment.several_points} == {
        "normal_loads",
        "several",
    }


def test_seeds_for_tuning_and_for_reporting_stay_apart():
    assert not set(plan.TUNING) & set(plan.REPORTING)
