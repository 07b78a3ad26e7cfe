"""What every adapter owes its caller: a complete trajectory, honest attributes, and refusals that teach."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from stochfric_mb.coefficients import Knots
from stochfric_mb.errors import InputError, SimulationError, StabilityError
from stochfric_mb.laws import LAWS as REGISTRY
from stochfric_mb.testing.candidates import Candidate
from stochfric_mb.testing.cases import BLOCK, MU_K, STEP, case, table_1
from stochfric_mb.testing.counting_law import SHARE, Counting
from stochfric_mb.trajectory import COLUMNS

KNOTS = Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01)
LAWS = ("coulomb", "elastic_stick", "havsin", "karnopp", "stribeck", "tanh", "piecewise_linear", "smooth", "dahl", "lugre")


@pytest.mark.parametrize("law", LAWS)
def test_a_trajectory_is_complete_and_within_its_bounds(engine: Candidate, law: str) -> None:
    s = table_1(law, 0.2, process=KNOTS)
    run = engine.simulate(s, seed=1)
    m = s.mechanism
    for name in COLUMNS:
        column = getattr(run, name)
        assert column.shape == (s.n_outputs,), name
        assert column.dtype == np.float64, name
        assert np.all(np.isfinite(column)), name
    assert np.array_equal(run.time, s.output_times())
    assert (run.position[0], run.velocity[0]) == (m.initial_position, m.initial_velocity)
    np.testing.assert_allclose(run.normal_force, m.normal_force, rtol=engine.accuracy.floor)
    assert set(np.unique(run.stick)) <= {0.0, 1.0}
    if "bounded" not in s.law.exceptions:
        assert np.all(np.abs(run.friction_force) <= run.mu_s * run.normal_force * (1.0 + 1e-12))  # rounding
    v = m.belt_velocity - run.velocity
    if s.law.has_flow:  # a bristle pushes back until it has turned over
        return
    slides = (run.stick == 0.0) & (np.abs(v) > 10.0 * s.law.stick_speed)
    assert slides.any()  # the box starts at rest on a moving belt
    assert np.all(run.friction_force[slides] * v[slides] > 0.0)


@pytest.mark.parametrize("law", ["coulomb", "elastic_stick"])
def test_attributes_say_what_ran(engine: Candidate, law: str) -> None:
    s = table_1(law, 0.02, process=KNOTS)
    about = engine.simulate(s, seed=5, sample=2, dt=STEP).attributes
    for name in ("engine", "version", "hook", "law"):
        assert isinstance(about[name], str), name
        assert about[name], name
    assert (about["seed"], about["sample"]) == (5, 2)
    assert about["dt"] == (0.0 if engine.accuracy.stepless else STEP)
    assert about["n_steps"] > 0
    assert about["seconds_per_step"] > 0.0
    if about["law"] != law:  # a law that stands in for another must be announced
        assert any(law in note and about["law"] in note for note in about["notes"])


def test_progress_is_reported(engine: Candidate) -> None:
    seen: list[float] = []
    engine.simulate(table_1("elastic_stick", 1.0), dt=STEP, progress=seen.append)
    assert seen
    assert seen == sorted(seen)
    assert 0.0 <= seen[0] <= seen[-1] <= 1.0 + 1e-9  # rounding


@pytest.mark.parametrize("law", ["elastic_stick", "havsin"])
def test_a_step_beyond_the_stability_limit_is_refused(engine: Candidate, law: str) -> None:
    if engine.accuracy.stepless:
        pytest.skip(f"{engine.name} has no step")
    s = table_1(law, 0.1, output_step=0.1)
    dt = 0.1 / math.floor(0.1 / (1.5 * s.step_limit()))
    with pytest.raises(StabilityError) as refusal:
        engine.simulate(s, dt=dt)
    for text in (f"{dt:g}", f"{s.step_limit():.3g}", s.law.step_limit_formula):
        assert text in str(refusal.value)


def test_a_run_that_breaks_down_is_an_error(engine: Candidate) -> None:
    """A spring of 1e4 1/s at steps of 1 ms: an explicit engine grows it a hundredfold a step and may still call it success."""
    mechanism = {"mass": 1.0, "damping": 0.0, "stiffness": 1.0e8, "normal_force": 1.0e-3, "belt_velocity": 0.0}
    s = case("elastic_stick", 0.02, mechanism=mechanism, initial_position=1.0e-3)
    try:
        run = engine.simulate(s, dt=1.0e-3)
    except (SimulationError, StabilityError):
        return
    for name in COLUMNS:
        assert np.all(np.isfinite(getattr(run, name))), name
    assert np.max(np.abs(run.position)) <= 1.0e-3 * (1.0 + engine.accuracy.floor)  # friction adds no energy


def test_the_state_is_committed_once_a_step(engine: Candidate, monkeypatch: pytest.MonkeyPatch) -> None:
    if engine.accuracy.stepless:
        pytest.skip(f"{engine.name} has no step")
    monkeypatch.setitem(REGISTRY, Counting.kind, Counting)
    s = case(Counting.kind, 0.02, mechanism=BLOCK, initial_velocity=1.0, output_step=STEP)
    run = engine.simulate(s, dt=STEP)
    assert np.all(run.velocity > 0.5)  # it slides one way
    commits = (1.0 - np.abs(run.friction_force) / (MU_K * BLOCK["normal_force"])) / SHARE
    steps = np.arange(len(commits)) * (run.attributes["n_steps"] / (len(commits) - 1))
    # a force that is reported before the commit of its step is one behind, one that took a half step first one ahead
    assert np.max(np.abs(commits - steps)) <= 1.0 + 1.0e-6


@pytest.mark.parametrize("dt", [3e-4, 0.0, -1e-4, 2e-3, math.nan])
def test_a_step_that_cannot_be_taken_is_refused(engine: Candidate, dt: float) -> None:
    if engine.accuracy.stepless:
        pytest.skip(f"{engine.name} has no step")
    with pytest.raises(InputError, match=re.escape(f"dt = {dt:g}")):
        engine.simulate(table_1("elastic_stick", 0.1), dt=dt)


@pytest.mark.parametrize("address", [{"seed": -1}, {"seed": 2**32}, {"sample": -1}])
def test_an_address_out_of_range_is_refused(engine: Candidate, address: dict[str, int]) -> None:
    with pytest.raises(InputError, match=next(iter(address))):
        engine.simulate(table_1("elastic_stick", 0.1, process=KNOTS), **address)
