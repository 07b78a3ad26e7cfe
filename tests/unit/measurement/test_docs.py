"""What docs/datasets.md shows works as it stands there."""

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest

from stochfric_mb import load_scenario
from stochfric_mb.measurement import load_dataset
from stochfric_mb.measurement.quantities import KNOWN
from stochfric_mb.measurement.readers import READERS
from stochfric_mb.reference import simulate
from stochfric_mb.storage import write_trajectory

from .files import POSITION, TIME, csv

PAGE = (Path(__file__).parents[3] / "docs" / "datasets.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", PAGE, re.S)


def test_dataset_file(tmp_path):
    csv(tmp_path / "run_1.csv", time__s=TIME, position__mm=POSITION, humidity=TIME)
    csv(tmp_path / "run_2.csv", time__s=TIME, position__mm=POSITION, humidity=TIME)
    (tmp_path / "dataset.toml").write_text(blocks("toml")[0], encoding="utf-8")
    data = load_dataset(tmp_path, "kang2015_table1")
    assert [(r.name, r.role) for r in data.runs] == [("run_1", "fit"), ("run_2", "test")]
    assert data.test[0].mechanism(data.scenario).belt_velocity == 1e-3


def test_python(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("stochfric_mb.measurement.readers.READERS", dict(READERS))
    scenario = dataclasses.replace(load_scenario("kang2015_table1"), process=None, duration=1.0)
    write_trajectory(simulate(scenario), "run.csv")
    names = {}
    for block in blocks("python"):
        exec(compile(block, "docs/datasets.md", "exec"), names)
    said = capsys.readouterr().out
    assert "run (first two thirds) 0.001 ['friction_force', 'normal_force', 'position', 'velocity']" in said
    assert names["late"].low < 0.0123 < names["late"].high
    np.array([[0.0, 1.0], [1.0, 2.0]]).tofile("a.rig")
    assert list(names["read"](tmp_path / "a.rig", skip_rows=1).columns["position"]) == [2.0]


@pytest.mark.parametrize("known", [KNOWN, READERS], ids=["quantities", "endings"])
def test_tables_are_whole(known):
    rows = "\n".join(line for line in PAGE.splitlines() if line.startswith("| `"))
    assert set(re.findall(r"`([\w.]+)`", rows)) >= set(known)
