"""``stochfric discover``: what it writes, says and refuses."""

import json
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from stochfric_mb import load_scenario
from stochfric_mb.__main__ import main
from stochfric_mb.scenario import load_any_scenario

SCENARIO = """\
schema = "stochfric.scenario/1"
[mechanism]
kind = "belt_box"
mass = 6.08
damping = 0.768
stiffness = 3956.0
normal_force = 13.0
belt_velocity = 2.5e-3
[law]
kind = "coulomb"
mu_s = 0.8
mu_k = 0.46
[uncertainty]
mass = 0.003
stiffness = 0.01
damping = 0.2
mu_s = 0.05
mu_k = 0.05
[simulation]
duration = 10.0
output_step = 1.0e-3
"""
DATASET = """\
schema = "stochfric.dataset/1"
title = "rig"
scenario = "scenario.toml"
[[runs]]
file = "run_1.csv"
role = "fit"
[[runs]]
file = "run_2.csv"
role = "test"
"""


def invoke(*words):
    return CliRunner().invoke(main, ["discover", *map(str, words)])


def write_run(path, position):
    table = np.column_stack([1.0e-3 * np.arange(len(position)), position])
    np.savetxt(path, table, "%.9g", ",", header="time [s],position [m]", comments="")


@pytest.fixture
def rig(tmp_path):
    """Write a dataset whose box rides on the belt and never slips: quick to judge."""
    folder = tmp_path / "rig"
    folder.mkdir()
    (folder / "scenario.toml").write_text(SCENARIO, encoding="utf-8")
    (folder / "dataset.toml").write_text(DATASET, encoding="utf-8")
    for number in (1, 2):
        noise = 5.0e-6 * np.random.default_rng(number).standard_normal(2000)
        write_run(folder / f"run_{number}.csv", 2.5e-6 * np.arange(2000) + noise)
    return folder


def refused(result, *parts):
    """Check that a command failed with one line that says why, and exit code 2."""
    assert result.exit_code == 2, result.output
    assert isinstance(result.exception, SystemExit)
    assert result.stderr.startswith("Error: ")
    assert len(result.stderr.strip().splitlines()) == 1
    for part in parts:
        assert part in result.stderr


def test_it_writes_numbers_scenario_page_and_plots(rig, tmp_path):
    result = invoke(rig, "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    written = sorted(p.name for p in (tmp_path / "out").iterdir())
    assert written == ["augmented.toml", "parameters.csv", "plots", "report.html", "result.json"]
    content = json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8"))
    assert content["schema"] == "stochfric.discovery/1"
    assert content["verdict"] == "unknown"  # no verdict on friction without slips
    assert content["details"]["command"].startswith("stochfric discover ")
    assert "These data do not decide" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert load_any_scenario(tmp_path / "out" / "augmented.toml").law == load_any_scenario(rig / "scenario.toml").law
    assert "Verdict: unknown" in result.stdout
    assert "Next experiment: record at least 12 stick-slip cycles" in result.stdout
    assert sorted(p.name for p in tmp_path.iterdir()) == ["out", "rig"]


def test_one_file_and_a_scenario_are_enough(rig, tmp_path):
    result = invoke(rig / "run_1.csv", "--scenario", "kang2015_table1", "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    content = json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8"))
    assert [run["role"] for run in content["details"]["runs"]] == ["fit", "test"]


def test_what_was_found_is_shown_as_a_table(rig, tmp_path):
    from tests.unit.report.test_discovery_page import RESULTS, outcome_of

    outcome = outcome_of(RESULTS["two effects"])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("stochfric_mb.discovery.discover", lambda *_, **__: outcome)
        result = invoke(rig, "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    for part in (
        "Verdict: effect (velocity_weakening, random_coefficients)", "0.049 .. 0.0534", "not fitted", "in m", "91.7 %",
        "These data cannot distinguish velocity_weakening from viscous_friction", "Note: 8.3e-06",
        "Next experiment: a run at 2",
    ):  # fmt: skip
        assert part in result.stdout, part
    assert {p.name for p in (tmp_path / "out" / "plots").iterdir()} == {"ranking.svg", "gap.svg"}


def test_the_augmented_scenario_is_the_outcomes(rig, tmp_path):
    invoke(rig, "--out", tmp_path / "out")
    written = tomllib.loads((tmp_path / "out" / "augmented.toml").read_text(encoding="utf-8"))
    assert written["mechanism"]["mass"] == load_scenario("kang2015_table1").mechanism.mass


def break_(rig, what):
    """Make a data set unusable in one way."""
    if what == "no folder":
        for file in rig.iterdir():
            file.unlink()
        rig.rmdir()
    elif what == "no dataset.toml":
        (rig / "dataset.toml").unlink()
    elif what == "unknown key":
        (rig / "dataset.toml").write_text(DATASET.replace("role =", "rol =", 1), encoding="utf-8")
    elif what == "nothing held out":
        (rig / "dataset.toml").write_text(DATASET.replace('"test"', '"fit"'), encoding="utf-8")
    elif what == "no unit":
        text = (rig / "run_1.csv").read_text(encoding="utf-8")
        (rig / "run_1.csv").write_text(text.replace("position [m]", "position"), encoding="utf-8")
    elif what == "missing value":
        lines = (rig / "run_2.csv").read_text(encoding="utf-8").splitlines()
        lines[100] = lines[100].partition(",")[0] + ",nan"
        (rig / "run_2.csv").write_text("\n".join(lines), encoding="utf-8")
    elif what == "no position":
        text = (rig / "run_1.csv").read_text(encoding="utf-8")
        (rig / "run_1.csv").write_text(text.replace("position [m]", "force [N]"), encoding="utf-8")
    else:
        text = (rig / "scenario.toml").read_text(encoding="utf-8")
        (rig / "scenario.toml").write_text(text.replace('"coulomb"', '"coulom"'), encoding="utf-8")


@pytest.mark.parametrize(
    ("what", "parts"),
    [
        ("no folder", ["rig", "no such file"]),
        ("no dataset.toml", ["dataset.toml", "write one"]),
        ("unknown key", ["dataset.toml", "'rol'", "role"]),
        ("nothing held out", ["held out", 'role = "test"']),
        ("no unit", ["run_1", "position", "unit"]),
        ("missing value", ["run_2"]),
        ("no position", ["run_1", "position"]),
        ("unknown law", ["scenario.toml", "did you mean 'coulomb'"]),
    ],
)
def test_unusable_input_is_one_line_and_leaves_nothing(rig, tmp_path, what, parts):
    break_(rig, what)
    refused(invoke(rig, "--out", tmp_path / "new" / "out"), *parts)
    if what == "no position":  # it can be read: then what was read is drawn
        assert [p.name for p in (tmp_path / "new" / "out").iterdir()] == ["records.html"]
    else:
        assert {p.name for p in tmp_path.iterdir()} <= {"rig"}


def test_a_file_alone_needs_a_scenario(rig, tmp_path):
    refused(invoke(rig / "run_1.csv", "--out", tmp_path / "out"), "--scenario")


def test_what_exists_is_not_overwritten_unasked(rig, tmp_path):
    out = tmp_path / "out"
    assert invoke(rig, "--out", out).exit_code == 0
    (out / "mine.txt").write_text("mine", encoding="utf-8")
    refused(invoke(rig, "--out", out), "exists", "--force")
    assert (out / "mine.txt").exists()
    assert invoke(rig, "--out", out, "--force").exit_code == 0
    assert not (out / "mine.txt").exists()


def test_a_folder_of_something_else_is_never_replaced(rig, tmp_path):
    refused(invoke(rig, "--out", rig, "--force"), "was not written by this command")
    assert (rig / "dataset.toml").exists()


@pytest.mark.parametrize(
    "where", ["stochfric_mb.discovery.discover", "stochfric_mb.report.discovery.page", "stochfric_mb.outputs._swap"]
)
def test_ctrl_c_leaves_nothing(rig, tmp_path, monkeypatch, where):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(where, interrupted)
    result = invoke(rig, "--out", tmp_path / "out")
    assert result.exit_code == 130
    assert "Interrupted; nothing was written" in result.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["rig"]


PAGE = (Path(__file__).parents[3] / "docs" / "discovery.md").read_text(encoding="utf-8")


def test_the_documentation_names_every_key(rig, tmp_path):
    invoke(rig, "--out", tmp_path / "out")
    content = json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8"))
    table = PAGE.partition("## Reading `result.json`")[2].partition("\n\n`")[0]
    assert set(re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE)) == set(content) - {"schema"}


def test_the_example_in_python(rig, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    code, _ = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(compile(code, "docs/discovery.md", "exec"), {})
    assert capsys.readouterr().out == "unknown []\nNone\n"


def test_two_output_folders_get_the_same_bytes(rig, tmp_path):
    for out in ("here", "there"):
        result = invoke(rig, "--out", tmp_path / out, "--force")
        assert result.exit_code == 0, result.output
    for file in ("result.json", "augmented.toml", "report.html"):
        assert (tmp_path / "here" / file).read_bytes() == (tmp_path / "there" / file).read_bytes(), file
