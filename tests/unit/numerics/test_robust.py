"""Robust spread: that of normal numbers, whatever a few of them are."""

import numpy as np
import pytest
from scipy import stats

from stochfric_mb.numerics.robust import PER_MEDIAN, deviation


def test_factor_of_the_normal_law():
    assert pytest.approx(1.0 / stats.norm.ppf(0.75), rel=1.0e-15) == PER_MEDIAN


def test_normal_numbers_with_and_without_wild_ones():
    x = np.random.default_rng(2).normal(3.0, 0.5, 20_000)
    # standard error of the estimate: 1.17 sigma/sqrt(n) (its efficiency is 37 %), taken four times
    assert deviation(x) == pytest.approx(0.5, abs=4 * 1.17 * 0.5 / np.sqrt(20_000))
    x[:100] = 1.0e9
    # 0.5 % of wild numbers move the median of the distances by half of that over the density there, 1.2 %
    assert deviation(x) == pytest.approx(0.5, rel=0.05)


def test_centre_and_axis():
    x = np.array([[1.0, 2.0], [2.0, 4.0], [3.0, 9.0]])
    np.testing.assert_allclose(deviation(x, axis=0), PER_MEDIAN * np.array([1.0, 2.0]))
    assert deviation([1.0, -2.0, 3.0], about=0.0) == pytest.approx(2.0 * PER_MEDIAN)
