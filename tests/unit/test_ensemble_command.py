"""``stochfric ensemble`` as a user meets it."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from click.testing import CliRunner

from stochfric_mb import ensemble, load_scenario
from stochfric_mb.__main__ import main
from stochfric_mb.commands.progress import display
from stochfric_mb.ensemble.dataset import open_dataset, read_ensemble
from stochfric_mb.ensemble.parts import parts_folder
from stochfric_mb.report.ensemble import at_times, chosen, figures

SHORT = ["kang2015_table1", "--law", "coulomb", "--set", "simulation.duration=1.5", "--seed", "3"]


def invoke(*words):
    return CliRunner().invoke(main, ["ensemble", *map(str, words)])


def test_runs_summary_and_plots(tmp_path):
    out = tmp_path / "new" / "ens.nc"
    done = invoke(*SHORT, "--n-runs", 80, "--output-times", "0.5,1.1,1.5", "--workers", 2, "--out", out, "--plot")
    assert done.exit_code == 0, done.output
    assert "80 runs at 3 times, event-driven, samples side by side" in done.output
    assert "1 block of 80 runs on 2 threads; at most 0.0 MiB of memory for runs and blocks" in done.output
    result, scenario = read_ensemble(out)
    wanted = ensemble.run(scenario, 80, seed=3, output_times=[0.5, 1.1, 1.5])
    assert np.array_equal(result.position, wanted.position)
    row = next(line for line in done.output.splitlines() if "position [mm]" in line and " 1.1 " in line)
    assert f"{1e3 * wanted.position[:, 1].mean():.4g}" in row.split()
    assert f"{1e3 * wanted.position[:, 1].std(ddof=1):.4g}" in row.split()
    assert "first break-away [s]" in done.output
    names = {f"{name}.svg" for name in ("break_aways", "distributions", "fan_chart", "phase_portrait", "stick")}
    assert {p.name for p in (out.parent / "ens_plots").iterdir()} == {*names, "report.html", "ensemble.json"}
    page = (out.parent / "ens_plots" / "report.html").read_text(encoding="utf-8")
    assert page.count("<svg ") == 5
    assert '<data value="80">80</data> runs' in page
    assert f'<data value="{float(wanted.position[:, 1].mean())!r}">' in page
    assert sorted(p.name for p in out.parent.iterdir()) == ["ens.nc", "ens_plots"]


def test_statistics_only(tmp_path):
    out = tmp_path / "ens.nc"
    words = [*SHORT, "--n-runs", 80, "--statistics-only", "--out", out]
    done = invoke(*words, "--plot")
    assert done.exit_code == 0, done.output
    with open_dataset(out) as dataset:
        assert "position" not in dataset
        assert dataset["position_quantile"].sizes == {"level": 9, "time": 1501}
        assert dataset["position_mean"].attrs == {
            "units": "m", "long_name": "mean of the position of the body", "cell_methods": "run: mean",
        }  # fmt: skip
    assert not (tmp_path / "ens_plots" / "phase_portrait.svg").exists()
    again = invoke(*words)
    assert again.exit_code == 2
    assert "ens.nc exists; give another name, or --force" in again.output


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--n-runs", 0], "n_runs = 0"),
        (["--n-runs", 5, "--output-times", "1,two"], "--output-times '1,two' is no list of times"),
        (["--n-runs", 5, "--output-times", "1,99"], "within 0 .. duration"),
        (["--n-runs", 5, "--engine", "adams"], "unknown engine 'adams'"),
        (["--n-runs", 5, "--workers", 0], "workers = 0"),
        (["--n-runs", 5, "--workers", 1, "--scheduler", "tcp://x:1"], "give one of them"),
        (["--n-runs", 10**6], "ask for fewer output times, for statistics only, or write to a folder that ends in .zarr"),
        (["--n-runs", 5, "--law", "elastic_stick", "--dt", 0.01], "beyond the stability limit"),
    ],
)
def test_what_cannot_be_used(tmp_path, words, message):
    done = invoke(*SHORT, *words, "--out", tmp_path / "ens.nc")
    assert done.exit_code == 2
    assert message in done.output
    assert list(tmp_path.iterdir()) == []


def test_other_endings_are_refused(tmp_path):
    done = invoke(*SHORT, "--n-runs", 5, "--out", tmp_path / "ens.csv")
    assert done.exit_code == 2
    assert "an ensemble is written as .nc (NetCDF), or .zarr if it is large" in done.output


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT for one process")
def test_an_interrupt_keeps_the_parts_and_says_how_to_go_on(tmp_path):
    out = tmp_path / "ens.nc"
    words = ["kang2015_table1", "--n-runs", "20000", "--output-times", "5,10", "--workers", "1", "--out", str(out)]
    heard = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"  # a parent in the background ignores it
    code = f"{heard}; from stochfric_mb.__main__ import main; main()"
    process = subprocess.Popen(
        [sys.executable, "-c", code, "ensemble", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    first = parts_folder(out) / "block-0000000.npz"
    while not first.exists() and process.poll() is None:  # however long a busy machine takes to compile
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate()
    assert process.returncode == 130, errors
    assert "Interrupted" in errors
    assert "The same command goes on from there" in errors
    assert not out.exists()
    other = invoke(*words[:2], 3000, *words[3:])
    assert other.exit_code == 2
    assert "ens.nc.parts holds parts of another ensemble (other n_runs)" in other.output


def test_resumed_command_says_so(tmp_path):
    out = tmp_path / "ens.nc"
    from stochfric_mb.ensemble.job import compute, job
    from stochfric_mb.ensemble.parts import open_parts

    scenario = load_scenario(SHORT[0], law="coulomb", overrides=[SHORT[4]])
    task = job(scenario, 5000, seed=3, output_times=[1.0, 1.5])
    assert task.n_blocks == 3
    open_parts(out, task).add(1, compute(task, 1))
    done = invoke(*SHORT, "--n-runs", 5000, "--output-times", "1,1.5", "--out", out)
    assert done.exit_code == 0, done.output
    assert "1 blocks from an interrupted run" in done.output
    assert np.array_equal(
        read_ensemble(out)[0].position, ensemble.run(scenario, 5000, seed=3, output_times=[1.0, 1.5]).position
    )


def test_figures_of_odd_ensembles():
    scenario = load_scenario(SHORT[0], law="coulomb")
    for n, times in ((1, [0.5]), (2, [0.0, 0.4, 1.2])):
        for statistics_only in (False, True):
            result = ensemble.run(scenario, n, output_times=times, statistics_only=statistics_only)
            drawn = figures(result, scenario)
            assert ("phase_portrait" in drawn) != statistics_only
            assert all(content.startswith("<svg ") for content in drawn.values())


def test_times_on_the_screen():
    scenario = load_scenario(SHORT[0], law="coulomb")
    for statistics_only in (False, True):
        result = ensemble.run(scenario, 30, statistics_only=statistics_only)
        assert result.time[chosen(result)].tolist() == [2.5, 5.0, 7.5, 10.0]
        assert result.time[chosen(result, [2.0004, 99.0])].tolist() == [2.0, 10.0]
        few = at_times(result, [2500, 10000])
        # 1e-14: NumPy adds in another order
        np.testing.assert_allclose(few.mean("position"), result.mean("position")[[2500, 10000]], rtol=1e-14)
        assert np.array_equal(few.quantiles("velocity", 0.5)[0], result.quantiles("velocity", 0.5)[0][[2500, 10000]])


def test_progress_counts_without_a_terminal():
    with display() as shown:
        count = shown.count("runs", 10)
        for done in (4, 7, 10):
            count(done)
