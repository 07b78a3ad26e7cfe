"""Robust spread: that of normal numbers, whatever a few of them are."""

import numpy as np
import pytest
from scipy import stats

from stochfric_mb.numerics.robust import PER_MEDIAN, deviation, noise


def test_factor_of_the_normal_law():
    assert pytest.approx(1.0 / stats.norm.ppf(0.75), abs=1.0e-4) == PER_MEDIAN  # four decimals, as everybody writes it


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


def test_noise_on_a_parabola():
    t = np.linspace(0.0, 1.0, 20_000)
    signal = 3.0 * t - 5.0 * t**2 + np.random.default_rng(3).normal(0.0, 0.01, len(t))
    # third differences are correlated: some 4 times fewer independent ones, taken as in the test above
    assert noise(signal) == pytest.approx(0.01, abs=4 * 1.17 * 0.01 / np.sqrt(20_000 / 4))
