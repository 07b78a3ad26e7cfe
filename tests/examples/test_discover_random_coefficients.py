"""The first example of discovery: random coefficients are named, and the spread of the phase portrait is explained."""

import dataclasses
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "discover_random_coefficients.py"


@pytest.mark.parametrize("engine", ["reference", "exudyn"])
def test_random_coefficients_are_named_and_the_portrait_spreads_as_measured(engine: str, tmp_path: Path) -> None:
    if engine != "reference":
        pytest.importorskip(engine, reason=f"{engine} is not installed")
    example = runpy.run_path(str(EXAMPLE))
    assert example["write_dataset"](tmp_path / "rig", duration=40.0, engine=engine) == engine

    from stochfric_mb.discovery import discover

    outcome = discover(tmp_path / "rig")
    assert [e.kind for e in outcome.result.effects] == ["random_coefficients"]
    assert outcome.result.gap is not None
    # knowing the distribution brings the CRPS of a normal error from sqrt(2/pi) to 1/sqrt(pi) of its deviation, 0.71 times; the
    # mean over 37 forecasts leaves 0.1 of uncertainty, so that no more than an improvement can be asked for
    assert outcome.result.gap.augmented < outcome.result.gap.recalibrated
    run = outcome.dataset.test[0]
    spread = example["loop_spread"]
    measured = spread(*example["measured_portrait"](run.time, run.channels["position"]))
    stated, result = (
        spread(*example["portrait"](dataclasses.replace(s, duration=40.0))[0])
        for s in (outcome.dataset.scenario, outcome.scenario)
    )
    assert stated < 0.2 * measured  # constant coefficients: one loop
    # about 38 slips each: a ratio of two standard deviations lies within 1 +- 0.5 in 999 cases of 1000
    assert result == pytest.approx(measured, rel=0.5)


def test_the_script_prints_and_plots(tmp_path: Path) -> None:
    command = [sys.executable, str(EXAMPLE), "--out", str(tmp_path / "rig"), "--duration", "30", "--engine", "reference"]
    done = subprocess.run(
        [*command, "--plot", str(tmp_path / "p.png")], capture_output=True, text=True, check=True, timeout=600
    )
    assert "missing from the model: random_coefficients" in done.stdout
    assert (tmp_path / "p.png").stat().st_size > 10_000
    assert {p.name for p in (tmp_path / "rig").iterdir()} == {"dataset.toml", "scenario.toml", "run_1.csv", "run_2.csv"}
