"""Intervals of parameters: where they end, and how much they hold."""

import numpy as np
import pytest
from scipy.stats import norm, truncnorm

from stochfric_mb.discovery.inference.intervals import confidence_interval


def test_far_from_the_bounds_it_is_the_usual_one():
    result = confidence_interval(1.0, 0.1, "N", low=0.0)
    assert (result.low, result.high) == pytest.approx((1.0 - 0.1 * norm.ppf(0.975), 1.0 + 0.1 * norm.ppf(0.975)), abs=1e-9)


@pytest.mark.parametrize("value", [0.0, 0.3, 1.0, 2.0, 9.7, 10.0])
def test_it_stays_within_the_physical_range_and_holds_95_percent_of_what_is_possible(value):
    result = confidence_interval(value, 1.0, "kg", low=0.0, high=10.0)
    possible = truncnorm(-value, 10.0 - value, loc=value)
    assert 0.0 <= result.low <= value <= result.high <= 10.0
    assert possible.cdf(result.high) - possible.cdf(result.low) == pytest.approx(0.95, abs=1e-9)


def test_it_is_the_narrowest_one_that_does():
    result = confidence_interval(0.5, 1.0, "-", low=0.0)
    possible = truncnorm(-0.5, np.inf, loc=0.5)
    others = [possible.ppf(p + 0.95) - possible.ppf(p) for p in np.linspace(0.001, 0.049, 49)]
    assert result.high - result.low < min(others)


def test_at_a_bound_it_is_one_sided():
    result = confidence_interval(0.0, 2.0, "-", low=0.0)
    assert (result.low, result.high) == pytest.approx((0.0, 2.0 * norm.ppf(0.975)), abs=1e-9)


@pytest.mark.parametrize("deviation", [0.0, np.inf, np.nan])
def test_what_was_not_fitted_has_no_interval(deviation):
    result = confidence_interval(3.0, deviation, "s")
    assert (result.value, result.low, result.high) == (3.0, 3.0, 3.0)
