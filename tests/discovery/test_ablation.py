"""The comparison with answers made up by hand, and the plain way on forces that it can and cannot read."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from stochfric_mb.measurement.dataset import load_dataset
from tests.discovery import ablation
from tests.discovery.generator.case import Case, make, write
from tests.discovery.generator.design import DESIGNS
from tests.discovery.pointwise import Term, by_points, samples, selected

RIPPLE = Case("normal_load_ripple.square", "one_free", 0.5, 0)
NULL = Case("none.wrong_parameters", "several", 1.0, 0)
NULL_FREE = Case("none.wrong_parameters", "one_free", 1.0, 0)
ODD = Case("unknown.alternating", "one_free", 1.0, 0)


def says(verdict: str, kind: str | None = None):
    effects = [{"kind": kind, "equivalent_to": []}] if kind else []
    gap = {"recalibrated": 2.0, "augmented": 1.1, "floor": 1.0, "closed": 0.9}

    def discover(dataset: Path, out: Path) -> None:
        assert (dataset / "dataset.toml").exists()
        out.mkdir(parents=True)
        (out / "result.json").write_text(json.dumps({"verdict": verdict, "effects": effects, "gap": gap}))

    return discover


def fails(dataset: Path, out: Path) -> None:
    raise ValueError("asked again")


@pytest.fixture
def short_runs(monkeypatch):
    for name, design in list(DESIGNS.items()):
        monkeypatch.setitem(DESIGNS, name, replace(design, runs=tuple(replace(run, duration=0.2) for run in design.runs)))
    monkeypatch.setattr("tests.discovery.generator.case._BURN_IN", (0.1, 0.2))


@pytest.mark.usefixtures("short_runs")
def test_table_counts_each_method_by_itself(tmp_path):
    methods = {"all names": says("effect", "normal_load_ripple"), "no name": says("none")}
    numbers = ablation.run([RIPPLE, NULL, ODD], tmp_path, methods)
    values = {name: [cell["value"] for cell in cells.values()] for name, cells in numbers.items()}
    assert values == {"all names": [1.0, 1.0, 1.0, 0.0, 1.0, 0.9], "no name": [0.0, 0.0, 0.0, 0.0, 0.0, 0.9]}
    text = (tmp_path / "ablation.md").read_text()
    assert "| no name | 0 (n = 1) | 0 (n = 1) | 0 (n = 1) | 0 (n = 1) | 0 (n = 1) | 0.9 (n = 1) |" in text


@pytest.mark.usefixtures("short_runs")
def test_answers_that_are_there_are_not_asked_for_again(tmp_path):
    ablation.run([NULL], tmp_path, {"first": says("none")})
    ablation.run([NULL, ODD], tmp_path, {"first": fails, "second": says("unknown")})
    answers = json.loads((tmp_path / "ablation.json").read_text())["answers"]
    assert answers["first"] == {NULL.name: "none", ODD.name: "failed"}
    assert answers["second"] == {NULL.name: "unknown", ODD.name: "unknown"}


def test_methods_are_the_whole_two_cut_down_and_the_plain_way():
    assert list(ablation.METHODS) == [
        "whole method", "without confirmation", "without kinematic channel", "pointwise regression",
    ]  # fmt: skip


def library(generator: np.random.Generator) -> list[Term]:
    kinds = ("coulomb", "viscous_friction", "friction_drift", "nonlinear_stiffness")
    return [Term(kind, generator.standard_normal((2000, 1))) for kind in kinds]


def test_selection_keeps_what_is_there_and_says_how_large():
    generator = np.random.default_rng(3)
    terms = library(generator)
    force = 6.0 * terms[0].columns[:, 0] + 0.5 * terms[2].columns[:, 0] + 0.1 * generator.standard_normal(2000)
    ((kind, size),) = selected(force, terms)
    assert kind == "friction_drift"
    # coefficient: 0.1/sqrt(2000), and a column's standard deviation: 1/sqrt(2 * 2000); four of both
    assert size == pytest.approx(0.5, abs=4.0 * (0.1 / 2000**0.5 + 0.5 / 4000**0.5))


def test_selection_keeps_nothing_where_errors_are_independent():
    """With independent errors BIC is right: what fails in a record is that its errors are not."""
    generator = np.random.default_rng(4)
    terms = library(generator)
    assert selected(6.0 * terms[0].columns[:, 0] + 0.1 * generator.standard_normal(2000), terms) == []


def test_the_plain_way_reads_the_friction_force_of_a_slip(tmp_path, monkeypatch):
    design = DESIGNS["one_free"]
    monkeypatch.setitem(DESIGNS, design.name, replace(design, runs=tuple(replace(run, duration=20.0) for run in design.runs)))
    made = make(NULL_FREE)
    write(NULL_FREE, tmp_path / "dataset", tmp_path / "truth.json")
    data = load_dataset(tmp_path / "dataset")
    force, terms = samples(data.fit[0], data.scenario)
    box = data.scenario.mechanism
    mechanism_columns = {term.kind: term.columns[:, 0] for term in terms}
    expected = (
        made.true.mu_k * made.load_factor * mechanism_columns["coulomb"]
        + (box.mass - made.true.mass) * mechanism_columns["mass"]
        + (box.damping - made.true.damping) * mechanism_columns["damping"]
        + (box.stiffness - made.true.stiffness) * mechanism_columns["stiffness"]
    )
    # a cubic over 31 samples leaves of 5 um noise an acceleration of sqrt(720/31^5) 5e-6/1e-6 m/s^2, times the mass
    noise = box.mass * (720.0 / 31**5) ** 0.5 * 5e-6 / 1e-6
    assert np.std(force - expected) == pytest.approx(noise, rel=4.0 / (2.0 * force.size) ** 0.5)
    assert np.mean(force - expected) == pytest.approx(0.0, abs=4.0 * noise / force.size**0.5)


def test_the_plain_way_leaves_a_result(tmp_path, monkeypatch):
    design = DESIGNS["one_free"]
    monkeypatch.setitem(DESIGNS, design.name, replace(design, runs=tuple(replace(run, duration=20.0) for run in design.runs)))
    write(NULL_FREE, tmp_path / "dataset", tmp_path / "truth.json")
    by_points(tmp_path / "dataset", tmp_path / "out")
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    assert result["verdict"] == ("effect" if result["effects"] else "none")
