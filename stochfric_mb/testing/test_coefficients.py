"""Random coefficients: the same path in every engine to the bit, addressed by seed and sample."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from stochfric_mb import metrics, reference
from stochfric_mb.coefficients import Knots, Matern, OrnsteinUhlenbeck, OutputStep, PerEvent, Process, Spatial
from stochfric_mb.testing.candidates import Candidate
from stochfric_mb.testing.cases import STEP, table_1

SIGMA: dict[str, Any] = {"sigma_s": 0.015, "sigma_k": 0.023}
IN_TIME = (
    Knots(**SIGMA, spacing=0.003),
    OutputStep(**SIGMA, spacing=1.0e-3),
    OrnsteinUhlenbeck(**SIGMA, correlation_time=0.05),
    Matern(**SIGMA, correlation_time=0.05),
)
ELSEWHERE = (Spatial(**SIGMA, spacing=1.0e-4), PerEvent(**SIGMA))


@pytest.mark.parametrize("process", IN_TIME, ids=lambda p: p.kind)
def test_a_path_in_time_is_equal_to_the_bit(engine: Candidate, process: Process) -> None:
    s = table_1("elastic_stick", 0.3, process=process)
    run = engine.simulate(s, seed=7, sample=3, dt=STEP)
    path = s.path(7, 3).at_times(s.output_times())
    assert np.ptp(path[:, 0]) > 0.0
    assert np.array_equal(run.mu_s, path[:, 0])
    assert np.array_equal(run.mu_k, path[:, 1])


def test_coefficients_that_scatter_together_are_equal_to_the_bit(engine: Candidate) -> None:
    s = table_1("elastic_stick", 0.1, process=Knots(**SIGMA, spacing=0.003, cross_correlation=0.7))
    run, path = engine.simulate(s, seed=7, dt=STEP), s.path(7).at_times(s.output_times())
    assert np.array_equal(run.mu_s, path[:, 0])
    assert np.array_equal(run.mu_k, path[:, 1])


@pytest.mark.parametrize("process", ELSEWHERE, ids=lambda p: p.kind)
def test_a_path_along_the_belt_or_by_event_is_equal(engine: Candidate, process: Process) -> None:
    s = table_1("elastic_stick", 1.3, process=process)
    run, exact = engine.simulate(s, seed=7, dt=STEP), reference.simulate(s, seed=7)
    assert len(np.unique(run.mu_s)) > 1
    difference = metrics.coefficient_path_difference(run, exact, s, seed=7)
    # by event the draws are equal to the bit; along the belt the place is known to 1e-15 m, on a field of slope 0.1/spacing
    assert difference <= (0.0 if process.kind == PerEvent.kind else 1e-15 / 1.0e-4)


def test_without_a_process_coefficients_are_the_means(engine: Candidate) -> None:
    run = engine.simulate(table_1("havsin", 0.01))
    assert np.all(run.mu_s == 0.8)
    assert np.all(run.mu_k == 0.46)


@pytest.mark.parametrize("law", ["elastic_stick", "havsin", "coulomb"])
def test_a_run_repeats_to_the_bit(engine: Candidate, law: str) -> None:
    s = table_1(law, 0.1, process=Knots(**SIGMA, spacing=0.01))
    first, again = engine.simulate(s, seed=1), engine.simulate(s, seed=1)
    for name, column in first.columns().items():
        assert np.array_equal(column, again.columns()[name]), name


@pytest.mark.parametrize("other", [{"seed": 2}, {"seed": 1, "sample": 1}], ids=["seed", "sample"])
def test_another_seed_or_sample_is_another_run(engine: Candidate, other: dict[str, int]) -> None:
    s = table_1("elastic_stick", 0.2, process=Knots(**SIGMA, spacing=0.01))
    one, two = engine.simulate(s, seed=1, dt=STEP), engine.simulate(s, dt=STEP, **other)
    assert not np.array_equal(one.mu_s, two.mu_s)
    assert not np.array_equal(one.position, two.position)
