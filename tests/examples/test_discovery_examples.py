"""The examples of discovery at joints run, and what they show is right."""

import importlib.util
import sys
from pathlib import Path

import pytest

from stochfric_mb.measurement.entries import data_folder

pytest.importorskip("mujoco", reason="mujoco is not installed")

EXAMPLES = Path(__file__).parents[2] / "examples"


def load(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def test_an_arm(capsys):
    load("discover_in_an_arm").main()
    said = capsys.readouterr().out
    assert "hidden: nothing; verdict: none" in said
    assert "viscous_friction" in said
    assert "in joint elbow" in said


def test_published_measurements(capsys, tmp_path):
    if data_folder() is None:
        pytest.skip("the measured data are not here: set STOCHFRIC_DATA to their folder")
    load("discover_measured").main(["emps", "--out", str(tmp_path)])
    assert "viscous_friction" in capsys.readouterr().out
    written = {p.name for p in tmp_path.iterdir()}
    assert written == {"parameters.csv", "augmented.toml", "augmented.xml", "exudyn_friction.py"}


def test_sysid_finds_friction_through_the_plugins_configuration():
    sysid = pytest.importorskip("mujoco.sysid", reason="mujoco.sysid is not installed")
    if not hasattr(sysid, "optimize"):
        pytest.skip("mujoco.sysid lacks what it needs; pip install 'mujoco[sysid]'")
    example = load("mujoco_sysid_friction")
    result = example.main()
    for name, truth in example.TRUTH.items():
        # 10 um of noise on 0.5 m leave 1e-5; sysid's interpolation of the pushes leaves 3e-3
        assert result[name] == pytest.approx(truth, rel=0.005)
