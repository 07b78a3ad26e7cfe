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
STEPPING_FAULTS = {
    # name of an adapter with steps of its own -> (what is faulty in its loop, as (right, wrong), tests that must notice)
    "trusting": (
        ('scenario.require_sane("stepping", t, x, step)', "pass"),
        {"test_a_run_that_breaks_down_is_an_error"},
    ),
    "doubled": (
        (
            "contact.commit(t, u, v_b - v, normal)",
            "contact.commit(t, u, v_b - v, normal), contact.commit(t, u, v_b - v, normal)",
        ),
        {"test_the_state_is_committed_once_a_step"},
    ),
    "half_late": (
        (
            "f = contact.force(t, u, v_b - v, normal)  # that acts",
            "f = contact.force(t, u - (v_b - half) * step / 2, v_b - half, normal)",
        ),
        {"test_a_stuck_box_rings_down_on_its_spring_and_damper"},
    ),
    "eager": (
        (
            "f = contact.force(t, u, v_b - v, normal)  # while",
            "contact.commit(t, u, v_b - v, normal); f = contact.force(t, u, v_b - v, normal)  # while",
        ),
        {"test_the_state_is_committed_once_a_step"},
    ),
}
STEPPING = """\
import numpy as np
from stochfric_mb.contact import Contact
from stochfric_mb.friction import Friction
from stochfric_mb.laws.substitute import elastic_substitute
from stochfric_mb.testing import Accuracy
from stochfric_mb.trajectory import Trajectory

ACCURACY = Accuracy(order=2, switch_order=1, factor=5)


def simulate(scenario, *, seed=0, sample=0, dt=None, progress=None):
    step, m = scenario.checked_step(dt), scenario.mechanism
    law, note = elastic_substitute(scenario.law, step, m.normal_force, m.mass)
    contact = Contact(Friction(law, scenario.process), effective_mass=m.mass, seed=seed, sample=sample, dt=step)
    x, v, v_b, normal = m.initial_position, m.initial_velocity, m.belt_velocity, m.normal_force
    contact.start(0.0, -x, v_b - v, normal)
    stride = round(scenario.output_step / step)
    rows, n_steps = np.empty((scenario.n_outputs, 7)), (scenario.n_outputs - 1) * stride
    half = v
    for n in range(n_steps + 1):
        t = n * step
        u = v_b * t - x
        if n > 0:
            v = half
            for _ in range(50):
                f = contact.force(t, u, v_b - v, normal)  # while the velocity is sought
                v = half + 0.5 * step * (f + m.excitation_force(t) - m.stiffness * x - m.damping * v) / m.mass
            contact.commit(t, u, v_b - v, normal)
        f = contact.force(t, u, v_b - v, normal)  # that acts
        if n % stride == 0:
            scenario.require_sane("stepping", t, x, step)
            rows[n // stride] = x, v, f, normal, contact.mu_s, contact.mu_k, contact.stick
            if progress is not None:
                progress(t)
        a = (f + m.excitation_force(t) - m.stiffness * x - m.damping * v) / m.mass
        half = v + 0.5 * step * a if n == 0 else half + step * a
        x += step * half
    about = {"engine": "stepping", "version": "1", "hook": "its own force", "law": law.kind, "notes": [note] if note else []}
    about |= {"dt": step, "seed": seed, "sample": sample, "n_steps": n_steps, "seconds_per_step": 1e-6}
    return Trajectory(np.array(scenario.output_times()), *np.ascontiguousarray(rows.T), attributes=about)
"""
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
    (folder / "sound.py").write_text(STEPPING)
    options += ["--stochfric-engine", "sound.py"]
    for name, ((right, wrong), _) in STEPPING_FAULTS.items():
        assert STEPPING.count(right) == 1
        (folder / f"{name}.py").write_text(STEPPING.replace(right, wrong))
        options += ["--stochfric-engine", f"{name}.py"]
    must_notice = {name: tests for name, (_, tests) in (FAULTS | STEPPING_FAULTS).items()}
    must_notice["sound"] = set.union(*must_notice.values())
    chosen = " or ".join(f"({name} and ({' or '.join(sorted(tests))}))" for name, tests in must_notice.items())
    shown = suite(folder, *options, "-k", chosen)
    failures: dict[str, set[str]] = defaultdict(set)
    for test, parameters in re.findall(r"^FAILED .*::(\w+)\[([^]]*)\]", shown, flags=re.MULTILINE):
        failures[parameters.partition("-")[0]].add(test)
    return failures


@pytest.mark.parametrize("fault", [*FAULTS, *STEPPING_FAULTS])
def test_a_faulty_adapter_is_caught(caught: dict[str, set[str]], fault: str) -> None:
    assert (FAULTS | STEPPING_FAULTS)[fault][1] <= caught[fault]


def test_twelve_faults_are_tried_and_the_sound_adapter_passes(caught: dict[str, set[str]]) -> None:
    assert len(FAULTS) + len(STEPPING_FAULTS) == 12
    assert not caught["sound"]


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
