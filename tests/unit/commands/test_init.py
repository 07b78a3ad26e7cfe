"""``stochfric init`` writes files that load, and guesses columns from headers and says so; the page of keys is up to date."""

import importlib.util
import tomllib
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from stochfric_mb import InputError
from stochfric_mb.__main__ import main
from stochfric_mb.commands.init import CHANNELS
from stochfric_mb.commands.keys import dataset_tables, keys_of, scenario_tables
from stochfric_mb.measurement import load_dataset
from stochfric_mb.mechanisms import MECHANISMS
from stochfric_mb.scenario import any_scenario_from_dict, load_any_scenario

DOCS = Path(__file__).parents[3] / "docs"
TIME = np.arange(3000) * 2e-3


def invoke(*words):
    return CliRunner().invoke(main, [str(w) for w in words])


def _csv(path, head, *columns):
    np.savetxt(path, np.column_stack(columns), delimiter=",", header=head, comments="", fmt="%.9g")
    return path


def test_every_mechanism_can_be_begun():
    assert set(CHANNELS) == set(MECHANISMS)


@pytest.mark.parametrize("mechanism", list(CHANNELS))
def test_the_scenario_loads_and_says_what_to_replace(tmp_path, mechanism):
    done = invoke("init", mechanism, "--out", tmp_path / "rig")
    assert done.exit_code == 0, done.output
    text = (tmp_path / "rig" / "scenario.toml").read_text()
    scenario = load_any_scenario(tmp_path / "rig" / "scenario.toml")
    assert scenario.mechanism.kind == mechanism
    for key in keys_of(MECHANISMS[mechanism]):
        assert key.name in text
        if key.required:
            assert f"\n{key.name} = " in text
    assert "EXAMPLE" in text
    runs = tomllib.loads((tmp_path / "rig" / "dataset.toml").read_text())["runs"]
    assert [run["role"] for run in runs] == ["fit", "test"]


@pytest.mark.parametrize("mechanism", list(CHANNELS))
def test_the_keys_that_are_comments_are_keys(mechanism, tmp_path):
    """Every commented key with a plain number may be switched on."""
    invoke("init", mechanism, "--out", tmp_path / "rig")
    text = (tmp_path / "rig" / "scenario.toml").read_text()
    on = "\n".join(line.removeprefix("# ") if line.startswith("# ") else line for line in text.splitlines())
    assert any_scenario_from_dict(tomllib.loads(on), folder=tmp_path).mechanism.kind == mechanism


def test_columns_are_guessed_from_headers_and_marked(tmp_path):
    file = _csv(tmp_path / "log.csv", "t_ms,PosAct (mm),Temp", 1e3 * TIME, np.sin(7.0 * TIME), 20.0 + 0.0 * TIME)
    done = invoke("init", "prismatic_joint", "--from", file, "--out", tmp_path / "rig")
    assert done.exit_code == 0, done.output
    assert "position: column 'PosAct' [mm] (a guess, check it in dataset.toml)" in done.output
    text = (tmp_path / "rig" / "dataset.toml").read_text()
    assert 'columns = { time = "t_ms", position = "PosAct", temperature = "Temp" }  # GUESS' in text
    entry = tomllib.loads(text)["runs"][0]
    assert entry["file"] == "../log.csv"
    assert entry["units"] == {"time": "ms", "position": "mm", "temperature": "degC"}


def test_what_the_header_says_needs_no_guess(tmp_path):
    file = _csv(tmp_path / "log.csv", "time [s],position [m]", TIME, 1e-3 * np.sin(7.0 * TIME))
    invoke("init", "prismatic_joint", "--from", file, "--out", tmp_path / "rig")
    assert "GUESS" not in (tmp_path / "rig" / "dataset.toml").read_text()
    data = load_dataset(tmp_path / "rig")
    assert data.test[0].time[0] - data.fit[0].time[-1] == pytest.approx(2e-3)  # the next sample: none is in both


def test_a_file_without_a_time_is_refused(tmp_path):
    file = _csv(tmp_path / "log.csv", "a,b", TIME, TIME)
    done = invoke("init", "belt_box", "--from", file, "--out", tmp_path / "rig")
    assert done.exit_code == 2
    assert "none of its columns 'a', 'b' looks like a time" in done.stderr
    assert not (tmp_path / "rig").exists()


def test_a_folder_of_others_is_kept(tmp_path):
    (tmp_path / "thesis.tex").write_text("work")
    assert invoke("init", "belt_box", "--out", tmp_path, "--force").exit_code == 2
    assert (tmp_path / "thesis.tex").read_text() == "work"


def test_list_scenarios():
    done = invoke("list", "scenarios")
    assert "kang2015_table1" in done.output
    assert "belt_box" in done.output


@pytest.mark.parametrize(("name", "keys"), list((scenario_tables() | dataset_tables()).items()))
def test_every_key_is_explained(name, keys):
    for key in keys:
        assert len(key.text) > 5, (name, key)
        assert key.type != "number" or key.unit, (name, key)


@pytest.mark.skipif(not DOCS.is_dir(), reason="installed without the documentation")
def test_the_page_of_keys_is_the_code():
    spec = importlib.util.spec_from_file_location("make_keys_page", DOCS / "make_keys_page.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert (DOCS / "keys.md").read_text(encoding="utf-8") == module.page(), "run python docs/make_keys_page.py"


def test_unknown_mechanisms_are_refused(tmp_path):
    tables = {"schema": "stochfric.scenario/1", "simulation": {"duration": 1.0, "output_step": 0.1}}
    with pytest.raises(InputError, match="unknown mechanism"):
        any_scenario_from_dict(tables | {"mechanism": {"kind": "belt"}}, folder=tmp_path)


def test_a_log_of_velocity_steps_brings_its_coefficient_of_friction(tmp_path):
    log = _csv(tmp_path / "log.csv", "TIME_s,Load point disp [um],mu", TIME, 10.0 * TIME, 0.6 + 0.0 * TIME)
    done = invoke("init", "spring_slider", "--from", log, "--out", tmp_path / "rig")
    assert "friction_coefficient: column 'mu' [-] (a guess" in done.output
    data = load_dataset(tmp_path / "rig")
    assert np.allclose(data.runs[0].covariates["friction_coefficient"], 0.6)


def test_a_column_is_guessed_as_what_its_name_says_and_what_is_missing_is_said(tmp_path):
    log = _csv(tmp_path / "log.csv", "time [s],position [m],friction_force [N]", TIME, 1e-6 * TIME, 7.0 + 0.0 * TIME)
    done = invoke("init", "spring_slider", "--from", log, "--out", tmp_path / "rig")
    assert "friction_force: column 'friction_force' [N]\n" in done.output
    assert "friction_coefficient" not in done.output
    done = invoke("init", "prismatic_joint", "--from", log, "--out", tmp_path / "joint")
    assert "force or voltage: none of " in done.output
    assert "column 'friction_force'" not in done.output  # what drives a joint is not its friction


@pytest.mark.parametrize(
    ("mechanism", "header", "units"),
    [
        ("belt_box", "t,pos_mm,v_mm_s,belt_mm_s", {"time": "s", "position": "mm", "velocity": "mm/s", "belt_velocity": "mm/s"}),
        ("belt_box", "t,x,u_V", {"time": "s", "position": "m"}),  # volts are no velocity
        ("hinge_pendulum", "t,phi_deg,tau_s,u_V", {"time": "s", "position": "deg", "torque": "N m", "voltage": "V"}),
    ],
)
def test_units_are_guessed_from_the_ends_of_names(tmp_path, mechanism, header, units):
    columns = [TIME, *(0.001 * i * np.sin(7.0 * TIME) for i in range(1, header.count(",") + 1))]
    file = _csv(tmp_path / "log.csv", header, *columns)
    invoke("init", mechanism, "--from", file, "--out", tmp_path / "rig")
    assert tomllib.loads((tmp_path / "rig" / "dataset.toml").read_text())["runs"][0]["units"] == units


def test_columns_are_listed_where_none_looks_like_what_is_needed(tmp_path):
    file = _csv(tmp_path / "log.csv", "time [s],position [m],Ch7", TIME, 1e-3 * np.sin(7.0 * TIME), TIME)
    done = invoke("init", "prismatic_joint", "--from", file, "--out", tmp_path / "rig")
    assert "force or voltage: none of 'time', 'position', 'Ch7' looks like it; if one is, add columns" in done.output


@pytest.mark.parametrize(
    ("mechanism", "header"),
    [
        ("spring_slider", "time [s],position [mm],friction_coefficient"),
        ("hinge_pendulum", "time [s],position [deg],torque [N m]"),
        ("belt_box", "time [s],position [mm]"),
    ],
)
def test_the_header_of_an_example_has_the_columns_that_its_mechanism_needs(tmp_path, mechanism, header):
    done = CliRunner().invoke(main, ["init", mechanism, "--out", str(tmp_path / "rig")])
    assert done.exit_code == 0
    assert f"# EXAMPLE: header such as {header}\n" in (tmp_path / "rig" / "dataset.toml").read_text(encoding="utf-8")
