"""The first ten minutes with a rig of one's own: init from an independent log, fill in, rehearse, discover, read."""

import json
import re
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from stochfric_mb.__main__ import main
from tests.discovery.generator import case as belt
from tests.discovery.joint_generator import case as joint

CASES = {
    "belt_box": (belt.write, belt.Case("random_coefficients.per_slip", "one_free", 1.0, 4)),
    "prismatic_joint": (joint.write, joint.Case("viscous_friction.proportional", "slide", 1.0, 4)),
}
"""Mechanism -> what writes the log, and what it hides."""


def invoke(*words):
    done = CliRunner().invoke(main, [str(w) for w in words])
    assert done.exit_code == 0, done.output
    return done.stdout


def _fill_in(file: Path, known: dict) -> None:
    """Do what a person does: replace the examples by the rig's numbers, switch on the keys that apply."""
    lines = file.read_text(encoding="utf-8").splitlines()
    table = ""
    for i, line in enumerate(lines):
        table = line.partition("]")[0].lstrip("[") if line.startswith("[") else table
        match = re.match(r"(?:# )?(\w+) = ", line)
        if match and match.group(1) in known.get(table, {}) and match.group(1) != "kind":
            lines[i] = f"{match.group(1)} = {known[table][match.group(1)]!r}"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _add_the_other_logs(file: Path, made: Path) -> None:
    """Take all logs, as a person does who has recorded more than one: two thirds of the first alone say little of a joint."""
    head = file.read_text(encoding="utf-8").partition("[[runs]]")[0]
    runs = tomllib.loads((made / "dataset.toml").read_text(encoding="utf-8"))["runs"]
    entries = [f'[[runs]]\nfile = "../made/{run["file"]}"\nrole = "{run["role"]}"\n' for run in runs]
    file.write_text(head + "\n".join(entries), encoding="utf-8")


@pytest.mark.parametrize("mechanism", list(CASES))
def test_from_a_log_to_the_page(mechanism, tmp_path):
    write, hidden = CASES[mechanism]
    write(hidden, tmp_path / "made", tmp_path / "truth.json")
    rig, log = tmp_path / "rig", tmp_path / "made" / "run_1.csv"

    said = invoke("init", mechanism, "--from", log, "--out", rig)
    assert "position: column 'position' [m]" in said
    _fill_in(rig / "scenario.toml", tomllib.loads((tmp_path / "made" / "scenario.toml").read_text(encoding="utf-8")))
    filled = tomllib.loads((rig / "scenario.toml").read_text(encoding="utf-8"))
    stated = tomllib.loads((tmp_path / "made" / "scenario.toml").read_text(encoding="utf-8"))
    assert filled["mechanism"].items() >= stated["mechanism"].items() or mechanism == "belt_box"

    _add_the_other_logs(rig / "dataset.toml", tmp_path / "made")

    assert "Would search" in invoke("discover", rig, "--dry-run", "--out", tmp_path / "raw")
    invoke("discover", rig, "--out", tmp_path / "result", "-q")
    result = json.loads((tmp_path / "result" / "result.json").read_text(encoding="utf-8"))
    named = [effect["kind"] for effect in result["effects"]]
    assert result["verdict"] == "effect"
    assert set(named) & set(json.loads((tmp_path / "truth.json").read_text(encoding="utf-8"))["acceptable"][0])
    page = (tmp_path / "result" / "report.html").read_text(encoding="utf-8")
    assert page.count("position as measured") == 2 * 3  # as text for those who cannot see it, and below
    assert named[0].replace("_", " ") in page
    assert tomllib.loads((tmp_path / "result" / "augmented.toml").read_text(encoding="utf-8"))["effects"]
