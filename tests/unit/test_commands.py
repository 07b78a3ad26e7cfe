"""The command line, as a user meets it."""

import dataclasses
import json
import re
import runpy
import subprocess
import sys
import types
import warnings
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from stochfric_mb import Trajectory, engines, reproduction
from stochfric_mb.__main__ import COMMANDS, main
from stochfric_mb.errors import SimulationError
from stochfric_mb.storage import read_trajectory

SCENARIO = "kang2015_table1"
SHORT = ["--set", "simulation.duration=0.05"]
HEAVY = ("numba", "mujoco", "exudyn", "pymunk", "matplotlib", "xarray", "scipy")


def invoke(*words):
    return CliRunner().invoke(main, [str(w) for w in words])


def made_up(scenario, name, *, shift=0.0, dt=None):
    """Return a trajectory that no physics made: a box that rides on the belt."""
    times = np.array(scenario.output_times())
    full = np.ones_like(times)
    mu = scenario.path(0).at_times(times)
    velocity = scenario.mechanism.belt_velocity
    about = {"engine": name, "version": "1.2.3", "hook": "none", "dt": dt or 0.0, "seed": 0, "sample": 0, "n_steps": 7}
    return Trajectory(
        times, velocity * times + shift, velocity * full, 0.0 * full, 13.0 * full, mu[:, 0], mu[:, 1], full,
        attributes=about | {"law": scenario.law.kind, "notes": [], "seconds_per_step": 1e-6},
    )  # fmt: skip


@pytest.fixture
def fake(monkeypatch):
    """Replace every adapter by one that computes nothing; return what it was asked for."""
    asked = []

    def adapter(name, effects=()):
        real = engines.ENGINES[name]
        assert real.name == name

        def simulate(scenario, *, seed=0, sample=0, dt=None, progress=None):
            asked.append((name, scenario.law.kind, scenario.duration, seed, dt))
            if progress is not None:
                progress(scenario.duration)
            return made_up(scenario, name, shift=0.0 if name == "reference" else 1e-6, dt=dt)

        return types.SimpleNamespace(simulate=simulate)

    monkeypatch.setattr(engines, "adapter", adapter)
    monkeypatch.setattr("stochfric_mb.comparison.adapter", adapter)
    monkeypatch.setattr("stochfric_mb.comparison.installed_engines", lambda: ["reference", "mujoco", "exudyn"])
    return asked


@pytest.mark.parametrize(
    "words", [[], ["--help"], ["run", "--help"], ["compare", "--help"], ["list", "--help"], ["discover", "--help"]]
)
def test_help_and_import_load_nothing_heavy(words):
    code = (
        "import sys, stochfric_mb\n"
        "from stochfric_mb.__main__ import main\n"
        f"words = {words!r}\n"
        "if words: main(words, standalone_mode=False)\n"
        f"print('LOADED', [m for m in {HEAVY!r} if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "LOADED []" in done.stdout


def test_python_m_runs_the_command_line():
    done = subprocess.run([sys.executable, "-m", "stochfric_mb", "--version"], capture_output=True, text=True, check=True)
    assert re.fullmatch(r"stochfric, version \d+\.\d+\.\d+\S*\n", done.stdout)


@pytest.mark.parametrize("name", COMMANDS)
def test_help_ends_with_an_example(name):
    lines = invoke(name, "--help").output.rstrip().splitlines()
    example = lines[[line.strip() for line in lines].index("Example:") + 1 :]
    assert 1 <= len(example) <= 2
    assert example[-1].strip().startswith(f"stochfric {name} ")


@pytest.mark.parametrize("name", COMMANDS)
def test_examples_are_valid_commands(fake, tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    few = dataclasses.replace(
        reproduction.QUICK, n_many=100, steps=(0.01, 0.001), resamples=9, n_grid=1, n_pairs=10_000, n_paths=100, n_portrait=2,
        discarded=dict.fromkeys(reproduction.QUICK.discarded, 10.0), portrait_time=5.0, n_sensitivity=2, n_cost=2,
    )  # fmt: skip
    monkeypatch.setattr(reproduction, "QUICK", few)
    before, words = (line.split() for line in invoke(name, "--help").output.rstrip().splitlines()[-2:])
    if before[0] == "python":
        monkeypatch.setattr(sys, "argv", before[1:])
        runpy.run_path(str(Path(__file__).parents[2] / before[1]), run_name="__main__")
    if before[0] == "stochfric":
        assert invoke(*before[1:]).exit_code == 0
    result = invoke(*words[1:])
    assert result.exit_code == 0, result.output


def test_run_writes_the_file_that_was_asked_for(fake, tmp_path):
    out = tmp_path / "new" / "run.csv"
    result = invoke("run", SCENARIO, "--engine", "exudyn", "--seed", 4, "--dt", 1e-4, "--law", "havsin", *SHORT, "--out", out)
    assert result.exit_code == 0, result.output
    assert fake == [("exudyn", "havsin", 0.05, 4, 1e-4)]
    assert len(read_trajectory(out).time) == 51
    assert "51 samples" in result.stdout


def test_run_defaults_to_the_reference_and_seed_0(fake, tmp_path):
    assert invoke("run", SCENARIO, "--out", tmp_path / "run.csv").exit_code == 0
    assert fake == [("reference", "elastic_stick", 10.0, 0, None)]


def failing(result, *parts):
    """Check that a command failed as it should: one message on stderr, exit code 2, no traceback."""
    assert result.exit_code == 2, result.output
    assert isinstance(result.exception, SystemExit)
    assert "Error: " in result.stderr
    assert "Traceback" not in result.stderr
    for part in parts:
        assert part in result.stderr


@pytest.mark.parametrize(
    ("setting", "parts"),
    [
        ("mechanism.mas=1", ["'mas'", "did you mean 'mass'"]),
        ("law.mu_k=0.9", ["mu_k = 0.9 is above mu_s = 0.8", "lower mu_k"]),
        ("mechanism.mass=-1", ["mass = -1", "> 0"]),
        ("law.mu_s", ["table.key=value"]),
        ("coefficients.process=knot", ["did you mean 'knots'"]),
        ("simulation.output_step=0.3", ["does not divide"]),
    ],
)
def test_wrong_settings_are_explained(fake, tmp_path, setting, parts):
    failing(invoke("run", SCENARIO, "--set", setting, "--out", tmp_path / "run.nc"), *parts)
    failing(invoke("compare", SCENARIO, "--set", setting, "--out", tmp_path / "out"), *parts)
    assert fake == []
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "parts"),
    [
        (["--engine", "mujocoo"], ["did you mean 'mujoco'", "reference"]),
        (["--law", "coulom"], ["did you mean 'coulomb'"]),
        (["--dt", "3e-4"], ["does not divide", "0.00025"]),
        (["--dt", "-1"], ["dt = -1"]),
        (["--seed", "-1"], ["--seed"]),
    ],
)
def test_wrong_options_are_explained(tmp_path, words, parts):
    failing(invoke("run", SCENARIO, *words, "--out", tmp_path / "run.nc"), *parts)
    assert list(tmp_path.iterdir()) == []


def test_unknown_scenario_lists_the_bundled_ones(tmp_path):
    failing(invoke("run", "kang", "--out", tmp_path / "run.nc"), SCENARIO)


def test_bad_ending_is_found_before_simulating(fake, tmp_path):
    failing(invoke("run", SCENARIO, "--out", tmp_path / "run.txt"), ".nc, .csv, .parquet")
    assert fake == []


def test_existing_file_is_found_before_simulating(fake, tmp_path):
    out = tmp_path / "run.csv"
    out.write_text("mine")
    failing(invoke("run", SCENARIO, "--out", out), "exists", "--force")
    assert fake == []
    assert out.read_text() == "mine"
    assert invoke("run", SCENARIO, "--out", out, "--force").exit_code == 0
    assert len(read_trajectory(out).time) == 10_001


def test_missing_engine_says_what_to_install(monkeypatch, tmp_path):
    absent = dataclasses.replace(engines.ENGINES["mujoco"], package="no_such_engine_package")
    monkeypatch.setitem(engines.ENGINES, "mujoco", absent)
    ran = []
    monkeypatch.setattr("stochfric_mb.reference.simulate", lambda *a, **k: ran.append(a))
    remedy = "pip install '.[mujoco]'"
    failing(invoke("run", SCENARIO, "--engine", "mujoco", "--out", tmp_path / "run.nc"), remedy)
    failing(invoke("compare", SCENARIO, "--engines", "mujoco", "--out", tmp_path / "out"), remedy)
    assert ran == []
    assert list(tmp_path.iterdir()) == []
    assert "mujoco" not in engines.installed_engines()
    assert remedy in invoke("list", "engines").output


def test_ctrl_c_leaves_nothing_behind(fake, monkeypatch, tmp_path):
    def interrupted(name, effects=()):
        def simulate(scenario, *, progress, **_):
            progress(0.01)
            raise KeyboardInterrupt

        return types.SimpleNamespace(simulate=simulate)

    monkeypatch.setattr(engines, "adapter", interrupted)
    monkeypatch.setattr("stochfric_mb.comparison.adapter", interrupted)
    for words in (["run", SCENARIO, "--out", tmp_path / "run.nc"], ["compare", SCENARIO, "--out", tmp_path / "out"]):
        result = invoke(*words)
        assert result.exit_code == 130
        assert "Interrupted; nothing was written" in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_while_the_report_is_drawn_leaves_nothing_behind(fake, monkeypatch, tmp_path):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("stochfric_mb.report.comparison.page", interrupted)
    assert invoke("compare", SCENARIO, *SHORT, "--out", tmp_path / "out").exit_code == 130
    assert list(tmp_path.iterdir()) == []


def test_an_engine_that_fails_is_named(fake, monkeypatch, tmp_path):
    def broken(name, effects=()):
        def simulate(scenario, **_):
            if name == "exudyn":
                raise SimulationError("x = nan at t = 1 s; lower dt")
            return made_up(scenario, name)

        return types.SimpleNamespace(simulate=simulate)

    monkeypatch.setattr("stochfric_mb.comparison.adapter", broken)
    failing(invoke("compare", SCENARIO, *SHORT, "--out", tmp_path / "out"), "exudyn: x = nan at t = 1 s")
    assert list(tmp_path.iterdir()) == []


def test_disk_errors_are_one_line(fake, monkeypatch, tmp_path):
    def full(*_):
        raise OSError(28, "No space left on device", "run.csv")

    from stochfric_mb.storage import FORMATS

    monkeypatch.setitem(FORMATS, ".csv", (full, FORMATS[".csv"][1]))
    failing(invoke("run", SCENARIO, "--out", tmp_path / "run.csv"), "run.csv: No space left on device")
    assert list(tmp_path.iterdir()) == []


def test_warnings_are_one_line_on_stderr(fake, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        words = ["--set", "coefficients.sigma_k=0.2", "--set", "coefficients.sigma_s=0.1", *SHORT]
        result = invoke("run", SCENARIO, *words, "--out", tmp_path / "run.csv")
    assert result.exit_code == 0, result.output
    assert re.search(r"^Warning: mu_s = 0\.8 .* redrawn", result.stderr, re.MULTILINE)
    assert ".py" not in result.stderr


def test_compare_writes_numbers_page_and_plots(fake, tmp_path):
    out = tmp_path / "out"
    words = ["compare", SCENARIO, *SHORT, "--engines", "exudyn, mujoco", "--seed", 0, "--out", out]
    result = invoke(*words)
    assert result.exit_code == 0, result.output
    numbers = json.loads((out / "compare.json").read_text(encoding="utf-8"))
    assert numbers["schema"] == "stochfric.comparison/1"
    assert (numbers["seed"], numbers["dt"]) == (0, 1e-4)
    assert list(numbers["engines"]) == ["exudyn", "mujoco"]
    required = {
        "version", "hook", "max_abs_position_error", "rms_position_error", "period_relative_error",
        "stick_fraction_error", "coefficient_path_max_difference", "seconds_per_step",
    }  # fmt: skip
    for engine in numbers["engines"].values():
        assert required <= set(engine)
        assert engine["max_abs_position_error"] == pytest.approx(1e-6, rel=1e-9)  # what the fake engine adds
        assert engine["period_relative_error"] is None  # no break-away in 0.05 s
        assert len(engine["convergence"]) == 4
    plots = {p.name for p in (out / "plots").iterdir()}
    assert plots == {f"{n}.svg" for n in ("position", "phase_portrait", "friction", "error", "convergence")}
    page = (out / "report.html").read_text(encoding="utf-8")
    assert page.count("<svg ") == len(plots)
    assert not re.findall(r'(?:src|href)="(?!data:|#)|url\((?!#)|@import|<script ', page)
    assert "Kang 2015, Table 1" in page
    assert f"stochfric compare {SCENARIO} --seed 0 --set simulation.duration=0.05 --engines" in page
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_compare_defaults_to_what_is_installed_and_can_skip_convergence(fake, tmp_path):
    result = invoke("compare", SCENARIO, *SHORT, "--no-convergence", "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert [name for name, *_ in fake] == ["reference", "exudyn", "mujoco"]
    numbers = json.loads((tmp_path / "out" / "compare.json").read_text(encoding="utf-8"))
    assert numbers["convergence_duration"] is None
    assert not (tmp_path / "out" / "plots" / "convergence.svg").exists()


def test_compare_replaces_its_own_folder_only(fake, tmp_path):
    out = tmp_path / "out"
    words = ["compare", SCENARIO, *SHORT, "--no-convergence", "--out", out]
    assert invoke(*words).exit_code == 0
    (out / "left_over.txt").write_text("old")
    asked = len(fake)
    failing(invoke(*words), "exists", "--force")
    assert len(fake) == asked
    assert invoke(*words, "--force").exit_code == 0
    assert not (out / "left_over.txt").exists()
    (out / "compare.json").unlink()
    failing(invoke(*words, "--force"), "was not written by this command")


def test_compare_needs_an_engine(fake, tmp_path):
    failing(invoke("compare", SCENARIO, "--engines", "reference", "--out", tmp_path / "out"), "at least one of mujoco")
    failing(invoke("compare", SCENARIO, "--engines", ",", "--out", tmp_path / "out"), "names no engine")
    failing(invoke("compare", SCENARIO, "--engines", "pymonk", "--out", tmp_path / "out"), "did you mean 'pymunk'")


def test_list_laws_shows_parameters_and_what_does_not_hold():
    from stochfric_mb.laws import LAWS, law_class

    text = re.sub(r"\s+", " ", invoke("list", "laws").output)
    for kind in LAWS:
        assert kind in text
        assert law_class(kind).source.split(",")[0] in text
        for axiom in law_class(kind).exceptions:
            assert f"not {axiom}" in text
    assert "e_lim = 1e-05" in text


def test_list_processes_and_engines_and_effects():
    from stochfric_mb.coefficients import PROCESSES

    processes = invoke("list", "processes").output
    assert all(kind in processes for kind in PROCESSES)
    shown = invoke("list", "engines").output
    assert all(name in shown for name in engines.ENGINES)
    effects = invoke("list", "effects").output
    assert "dwell_ageing" in effects
    assert "rate [-], time_constant [s] = 0.1" in effects
    assert "axis (belt or position)" in " ".join(effects.split())
    failing(invoke("list", "colours"), "laws")


def test_progress_shows_life_then_simulated_time(monkeypatch):
    import io

    from rich.console import Console

    from stochfric_mb.commands import progress

    console = Console(file=io.StringIO(), force_terminal=True, width=120)
    monkeypatch.setattr(progress, "Console", lambda **_: console)
    with progress.display() as shown:
        advance = shown.stage("mujoco", 10.0)
        shown._progress.refresh()
        advance(2.5)
        shown._progress.refresh()
        shown.note("writing run.nc")
        shown._progress.refresh()
    text = console.file.getvalue()
    parts = ["loading and compiling", "2.5 / 10 s simulated", "left", "writing run.nc"]
    assert [text.index(p) for p in parts] == sorted(text.index(p) for p in parts)
