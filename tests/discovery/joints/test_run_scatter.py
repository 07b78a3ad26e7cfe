"""Friction that is drawn anew for each run: named with its size, scored by what it is good for, and not where there is none."""

import dataclasses

import numpy as np
import pytest
from scipy.stats import norm

from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.effects import make_effect
from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.reference import simulate
from stochfric_mb.scenario import any_scenario_from_dict, load_scenario
from tests.discovery.joints.test_parts import coulomb, scenario, sine_run

LEARNT, HELD_OUT = 6, 16
"""Fit runs, and as many held out that chance does not decide the score."""


def drawn(rng):
    """Standard normal numbers for all runs, evenly over the distribution in each role: no score is luck of the draw."""
    return np.r_[tuple(rng.permutation(norm.ppf((np.arange(n) + 0.5) / n)) for n in (LEARNT, HELD_OUT))]


def data(seed, share=0.0, zero=0.0):
    """Runs whose friction, and the zero of whose force, differ by these standard deviations [-, N]."""
    rng = np.random.default_rng(seed)
    count = LEARNT + HELD_OUT
    level, offset = 1.0 + share * drawn(rng), zero * drawn(rng)
    runs = [
        sine_run(
            lambda q, v, i=i: level[i] * coulomb(q, v) + offset[i],
            seed=100 * seed + i,
            role="fit" if i < LEARNT else "test",
            start=20.0 * i,
        )
        for i in range(count)
    ]
    runs = [dataclasses.replace(r, name=f"run {i}") for i, r in enumerate(runs)]
    return Dataset(title="", scenario_path=None, scenario=scenario(), runs=tuple(runs)), level


@pytest.fixture(scope="module")
def outcome():
    measured, _ = data(1, share=0.15)
    return joint_outcome(measured)


def test_it_is_named_with_its_size(outcome):
    effects = outcome.result.effects
    assert [e.kind for e in effects] == ["random_coefficients"]
    assert effects[0].where.axis == "run"
    sigma = effects[0].parameters["sigma_k"]
    _, level = data(1, share=0.15)
    size = 0.1 * float(np.std(level[:LEARNT], ddof=1))
    assert sigma.value == pytest.approx(size, rel=0.05)  # of these six runs; strokes add 0.01 N of 0.3 N
    assert sigma.low < 0.015 < sigma.high
    assert effects[0].p_value < 1e-6


def test_the_forecast_that_knows_of_it_is_better(outcome):
    gap = outcome.result.gap
    assert gap is not None
    assert gap.metric == "crps_friction"
    # for normal errors of a known size the ratio is 1/sqrt(2); the size is known from six runs, and sixteen are scored
    assert 0.5 < gap.augmented / gap.recalibrated < 0.9
    assert gap.floor == pytest.approx(gap.augmented, rel=0.5)


def test_the_augmented_scenario_draws_one_friction_a_run(outcome):
    effect = outcome.scenario.effects[-1]
    assert effect.to_dict()["process"] == "per_run"
    assert any_scenario_from_dict(outcome.scenario.to_dict()) == outcome.scenario
    box = dataclasses.replace(
        load_scenario("kang2015_table1"),
        process=None,
        effects=(make_effect("random_coefficients", process="per_run", sigma_s=0.015, sigma_k=0.02),),
        duration=1.0,
        output_step=1e-2,
    )
    drawn = [simulate(box, seed=1, sample=k).mu_k for k in range(40)]
    assert max(float(np.ptp(mu)) for mu in drawn) < 1e-9
    levels = np.array([mu[0] for mu in drawn])
    # 40 draws: a standard error of 1/sqrt(80) of the standard deviation
    assert np.std(levels, ddof=1) == pytest.approx(0.02, rel=4.0 / np.sqrt(80.0))


def test_once_it_is_believed_nothing_is_missing(outcome):
    measured, _ = data(1, share=0.15)
    again = joint_outcome(dataclasses.replace(measured, scenario=outcome.scenario))
    assert again.result.verdict == "none"
    assert again.places[0].forecasts.baseline == pytest.approx(outcome.places[0].forecasts.augmented, rel=0.1)


@pytest.mark.parametrize("seed", [2, 3])
def test_runs_alike_name_nothing(seed):
    measured, _ = data(seed)
    assert joint_outcome(measured).result.verdict == "none"


def test_a_zero_that_differs_is_no_friction():
    measured, _ = data(4, zero=0.3)
    result = joint_outcome(measured).result
    assert result.verdict == "none"
    assert any("a zero or a law" in note for note in result.notes)


def test_crps_of_a_normal_forecast_by_quadrature(outcome):
    """The closed form that scores forecasts, against the integral that defines it."""
    from stochfric_mb.discovery.driven_joint.scatter.run_scatter import crps_of

    place = outcome.places[0]
    model, balances = place.selected.final.model, place.test[:1]
    score, floor = crps_of(model, balances, place.nuisances, 0.2, 0.0)
    error = model.remainder(balances[0], place.nuisances)[balances[0].sliding]
    x = np.linspace(-6.0, 6.0, 24_001)
    integral = [np.trapezoid((norm.cdf(x / 0.2) - (x >= e)) ** 2, x) for e in error[::40]]
    exact = [0.2 * (z * (2 * norm.cdf(z) - 1) + 2 * norm.pdf(z) - 1 / np.sqrt(np.pi)) for z in error[::40] / 0.2]
    np.testing.assert_allclose(integral, exact, atol=3e-4)  # half a step of the grid
    assert floor == pytest.approx(0.2 / np.sqrt(np.pi))
    assert score > 0.0


def stroke(number, level, role):
    """One stroke one way, the same in every run, with friction of this level."""
    rng = np.random.default_rng(number)
    t = 1.0e-3 * np.arange(1500)
    v = 0.2 * np.sin(np.pi * t / t[-1]) ** 2 + 0.02
    q = np.cumsum(v) * 1.0e-3
    a = np.gradient(v, 1.0e-3)
    channels = {
        "position": q + 1.0e-6 * rng.standard_normal(len(t)),
        "force": 2.0 * a + level + 0.02 * rng.standard_normal(len(t)),
    }
    return Run(name=f"repeat {number}", role=role, time=t, channels=channels, sample_interval=1.0e-3)


def test_repeats_of_a_stroke_that_drift_from_run_to_run_are_not_none():
    runs = tuple(stroke(i, 2.0 * (1.0 + 0.05 * i), "test" if i == 5 else "fit") for i in range(6))
    result = joint_outcome(Dataset(title="", scenario_path=None, scenario=scenario(), runs=runs)).result
    where = [result.where.axis] if result.verdict == "unknown" else [e.where.axis for e in result.effects]
    assert where
    assert set(where) <= {"run", "run and direction"}
