"""Statistics: against closed forms, and by the share of intervals and p-values that should come out."""

import math

import numpy as np
import pytest
from scipy.stats import norm

from stochfric_mb import ensemble, statistics
from stochfric_mb.errors import InputError
from stochfric_mb.scenario import load_scenario

RNG = np.random.default_rng


def normal_energy_distance(shift: float) -> float:
    """Return the energy distance of two unit normals: its square is 2 E abs(X - Y) - E abs(X - X') - E abs(Y - Y')."""

    def mean_abs(d: float) -> float:  # of a normal of mean d and variance 2
        return 2.0 / math.sqrt(math.pi) * math.exp(-d * d / 4.0) + d * (1.0 - 2.0 * norm.cdf(-d / math.sqrt(2.0)))

    return math.sqrt(2.0 * mean_abs(shift) - 2.0 * mean_abs(0.0))


def test_ks_statistic_by_hand():
    # after 2 the first sample has 2/4 below, the second 0/3: no larger gap follows
    assert statistics.ks_test([1.0, 2.0, 4.0, 6.0], [3.0, 5.0, 7.0]).statistic == pytest.approx(0.5, abs=1e-15)
    assert statistics.ks_distance([1.0, 2.0, 4.0, 6.0], [3.0, 5.0, 7.0], n_resamples=9).value == pytest.approx(0.5, abs=1e-15)


@pytest.mark.parametrize("test", [statistics.ks_test, statistics.anderson_darling_test, statistics.energy_test])
def test_p_values_under_the_hypothesis_and_against_it(test):
    options = {} if test is statistics.ks_test else {"n_resamples": 99}
    n = 60
    p = np.array([test(RNG(i).normal(size=40), RNG(1000 + i).normal(size=50), **options).p_value for i in range(n)])
    # p <= 0.2 in a fifth of the cases (KS a little less, it is discrete): 4 standard errors
    assert abs(np.mean(p <= 0.2) - 0.2) < 4.0 * math.sqrt(0.2 * 0.8 / n)
    assert test(RNG(0).normal(size=200), RNG(1).normal(0.7, 1.0, size=200), **options).p_value <= 0.01


def test_energy_distance_of_two_points():
    # F - G = 1 on the unit interval between them
    assert statistics.energy_distance([0.0] * 5, [1.0] * 7, n_resamples=9).value == pytest.approx(math.sqrt(2.0), rel=1e-12)


def test_energy_distance_interval_holds_the_true_distance():
    true = normal_energy_distance(1.0)
    inside = 0
    for i in range(30):
        e = statistics.energy_distance(
            RNG(i).normal(size=200), RNG(500 + i).normal(1.0, 1.0, 200), confidence=0.9, n_resamples=99, seed=i
        )
        inside += e.low <= true <= e.high
        assert e.low < e.value < e.high
    assert abs(inside / 30 - 0.9) < 4.0 * math.sqrt(0.9 * 0.1 / 30)  # 4 standard errors


def test_mean_interval_covers_and_leaves_out_nan():
    n = 400
    covered = 0
    for i in range(n):
        e = statistics.mean(RNG(i).normal(3.0, 2.0, size=8), confidence=0.9)
        covered += e.low <= 3.0 <= e.high
    assert abs(covered / n - 0.9) < 4.0 * math.sqrt(0.9 * 0.1 / n)  # 4 standard errors
    assert statistics.mean([1.0, math.nan, 3.0]).value == 2.0


def test_proportion_interval_is_wilson():
    # E. B. Wilson 1927: centre (p + z^2/2n)/(1 + z^2/n), here worked out for 8 of 10 and z = 1.959964
    e = statistics.proportion(8, 10)
    z2 = norm.ppf(0.975) ** 2
    centre = (0.8 + z2 / 20.0) / (1.0 + z2 / 10.0)
    half = math.sqrt(z2) * math.sqrt(0.8 * 0.2 / 10.0 + z2 / 400.0) / (1.0 + z2 / 10.0)
    assert (e.low, e.high) == pytest.approx((centre - half, centre + half), rel=1e-12)


def test_crps_by_hand_and_of_a_normal():
    # E abs(X - y) - E abs(X - X')/2 with X' another member: (1 + 3)/2 - 2/2
    assert statistics.crps(0.0, [1.0, 3.0]) == pytest.approx(1.0, rel=1e-12)
    x = RNG(0).normal(size=50)
    pairs = np.abs(x[:, None] - x[None, :]).sum() / (50 * 49)
    assert statistics.crps(0.2, x) == pytest.approx(np.mean(np.abs(x - 0.2)) - 0.5 * pairs, rel=1e-12)
    y = 0.7
    members = RNG(3).normal(size=(20_000, 1))
    exact = y * (2.0 * norm.cdf(y) - 1.0) + 2.0 * norm.pdf(y) - 1.0 / math.sqrt(math.pi)
    # 4 standard errors: the members' abs(X - y) has a deviation below 1
    assert statistics.crps([y], members)[0] == pytest.approx(exact, abs=4.0 / math.sqrt(20_000))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: statistics.ks_test([1.0], [1.0, 2.0]), "sample a has 1 values"),
        (lambda: statistics.ks_test([1.0, 2.0], [1.0, math.nan]), "value 1 of sample b is not finite"),
        (lambda: statistics.anderson_darling_test([1.0, 1.0], [1.0, 1.0]), "distinct values"),
        (lambda: statistics.mean([1.0, math.nan]), "give at least 2"),
        (lambda: statistics.mean([1.0, 2.0], confidence=1.5), "confidence = 1.5"),
        (lambda: statistics.proportion(3, 2), "count = 3 of n = 2"),
    ],
)
def test_errors_name_the_value(call, message):
    with pytest.raises(InputError, match=message):
        call()


def test_crps_of_normal_forecasts():
    grid = np.linspace(-30.0, 30.0, 600_001)
    for error, deviation in ((0.0, 1.0), (1.3, 0.5), (-4.0, 2.0)):
        exact = np.trapezoid((norm.cdf(grid, scale=deviation) - (grid >= error)) ** 2, grid)  # by its definition
        assert statistics.crps_normal(error, deviation) == pytest.approx(exact, abs=2e-4)
    drawn = np.random.default_rng(1).normal(scale=0.3, size=200_000)
    assert statistics.crps_normal(drawn, 0.3).mean() == pytest.approx(0.3 / math.sqrt(math.pi), rel=5e-3)


def test_crps_checks_shapes():
    with pytest.raises(InputError, match="shape"):
        statistics.crps([0.0, 1.0], [[1.0, 2.0, 3.0]] * 4)


def test_event_statistics_of_an_ensemble():
    scenario = load_scenario("kang2015_table1", law="coulomb")
    result = ensemble.run(scenario, 64, output_times=[10.0])
    events = statistics.event_statistics(result)
    assert events.period is not None
    assert events.break_away_mu_s is not None
    assert events.stick_fraction is not None
    assert events.period.low < np.nanmean(result.period) == events.period.value < events.period.high
    assert 0.76 < events.break_away_mu_s.value < 0.8  # below the mean 0.8: the first draw that lets go
    assert 0.8 < events.stick_fraction.value < 0.9
    short = statistics.event_statistics(ensemble.run(scenario, 4, output_times=[0.5]))
    assert short.period is None  # nothing breaks away within 0.5 s
    assert short.n_break_aways is not None
    assert short.n_break_aways.value == 0.0
