"""The cross-engine suite itself: how it is called, what it skips, and that it catches adapters with a fault.

Its own cases run with the project's tests (``testpaths``), on every engine and on the example adapter.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import pytest

FAULTS = {
    # name of the faulty adapter -> (its code, tests that must notice)
    "heavy": (
        "m = dataclasses.replace(scenario.mechanism, mass=1.001 * scenario.mechanism.mass)\n"
        "    return reference.simulate(dataclasses.replace(scenario, mechanism=m), **options)",
        {"test_without_friction_it_swings_as_a_linear_oscillator", "test_a_sliding_box_decelerates"},
    ),
    "sticky": (
        "law = dataclasses.replace(scenario.law, mu_s=1.01 * scenario.law.mu_s)\n"
        "    return reference.simulate(dataclasses.replace(scenario, law=law), **options)",
        {"test_it_breaks_away_at_mu_s_n", "test_stick_slip_cycle_of_coulomb_friction"},
    ),
    "deaf": (
        "return reference.simulate(scenario, **(options | {'seed': 0, 'sample': 0}))",
        {"test_another_seed_or_sample_is_another_run", "test_a_path_in_time_is_equal_to_the_bit"},
    ),
    "backwards": (
        "run = reference.simulate(scenario, **options)\n"
        "    return dataclasses.replace(run, friction_force=-run.friction_force)",
        {"test_the_force_reported_is_the_one_that_moves_the_box", "test_a_trajectory_is_complete_and_within_its_bounds"},
    ),
    "creeping": (
        "run = reference.simulate(scenario, **options)\n"
        "    return dataclasses.replace(run, position=run.position + 1e-7 * run.time)",
        {"test_a_sliding_box_stops_and_stays", "test_a_load_below_mu_s_n_is_held"},
    ),
    "late": (
        "run = reference.simulate(scenario, **options)\n"
        "    x = np.concatenate([run.position[:1], run.position[:-1]])\n"
        "    return dataclasses.replace(run, position=x)",
        {"test_a_sliding_box_decelerates", "test_amplitude_falls_by_2_mu_n_over_k_each_half_swing"},
    ),
    "rounded": (
        "run = reference.simulate(scenario, **options)\n    return dataclasses.replace(run, mu_s=run.mu_s * (1.0 + 3e-16))",
        {"test_a_path_in_time_is_equal_to_the_bit", "test_a_path_along_the_belt_or_by_event_is_equal"},
    ),
    "lax": (
        "return reference.simulate(scenario, **options)",
        {"test_a_step_beyond_the_stability_limit_is_refused", "test_a_step_that_cannot_be_taken_is_refused"},
    ),
}
HEAD = """\
import dataclasses
import numpy as np
from stochfric_mb import reference
from stochfric_mb.testing import Accuracy

ACCURACY = Accuracy(order={order}, switch_order={order})


def simulate(scenario, **options):
    {body}
"""


def suite(folder: Path, *options: str) -> str:
    """Run the suite as somebody else would, in a folder of their own; return what pytest prints."""
    command = [sys.executable, "-m", "pytest", "--pyargs", "stochfric_mb.testing", "-q", "-rfs", "-p", "no:cacheprovider"]
    done = subprocess.run([*command, *options], cwd=folder, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def caught(tmp_path_factory: pytest.TempPathFactory) -> dict[str, set[str]]:
    """Name of a faulty adapter -> the tests that fail on it."""
    folder = tmp_path_factory.mktemp("faulty")
    options: list[str] = []
    for name, (body, _) in FAULTS.items():
        order = "2.0" if name in ("late", "lax") else "float('inf')"
        (folder / f"{name}.py").write_text(HEAD.format(order=order, body=body))
        options += ["--stochfric-engine", f"{name}.py"]
    needed = " or ".join(sorted(set.union(*(tests for _, tests in FAULTS.values()))))
    shown = suite(folder, *options, "-k", needed)
    failures: dict[str, set[str]] = defaultdict(set)
    for test, parameters in re.findall(r"^FAILED .*::(\w+)\[([^]]*)\]", shown, flags=re.MULTILINE):
        failures[parameters.partition("-")[0]].add(test)
    return failures


@pytest.mark.parametrize("fault", FAULTS)
def test_a_faulty_adapter_is_caught(caught: dict[str, set[str]], fault: str) -> None:
    assert FAULTS[fault][1] <= caught[fault]


def test_an_adapter_without_its_engine_is_skipped_with_the_remedy(tmp_path: Path) -> None:
    (tmp_path / "absent.py").write_text("import no_such_engine\n")
    shown = suite(tmp_path, "--stochfric-engine", "absent.py", "-k", "test_progress_is_reported or test_a_run_repeats")
    assert re.search(r"SKIPPED .* needs no_such_engine, which is not installed; run: pip install no_such_engine", shown)
    assert "4 skipped" in shown


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("mujocco", r"no engine and no module 'mujocco'; give a name of reference, mujoco"),
        ("nowhere.py", r"no adapter file .*nowhere\.py"),
        ("json", r"adapter 'json' has no function simulate"),
    ],
)
def test_a_wrong_name_is_an_error(tmp_path: Path, name: str, message: str) -> None:
    shown = suite(tmp_path, "--stochfric-engine", name, "-k", "test_progress_is_reported")
    assert re.search(message, shown)
    assert "1 error" in shown


def test_the_example_adapter_is_short_and_the_page_shows_it() -> None:
    root = Path(__file__).resolve().parents[2]
    example = (root / "examples" / "adapter_pybullet.py").read_text(encoding="utf-8")
    page = (root / "docs" / "adapters.md").read_text(encoding="utf-8")
    n_lines = len(example.splitlines())
    assert n_lines < 100
    assert f"```python\n{example}```\n" in page
    assert f"`examples/adapter_pybullet.py`, {n_lines} lines" in page


def test_the_page_states_the_classes_of_accuracy() -> None:
    from stochfric_mb.testing.accuracy import BUILT_IN

    page = (Path(__file__).resolve().parents[2] / "docs" / "adapters.md").read_text(encoding="utf-8")
    for name, a in BUILT_IN.items():
        numbers = "infinite | infinite | -" if a.stepless else f"{a.order:g} | {a.switch_order:g} | {a.factor:g}"
        assert f"| {name} | {numbers} |" in page
