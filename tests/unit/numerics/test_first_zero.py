"""The first zero of polynomials and curves in closed form, at starts on a zero, dips and misses."""

import math

import numpy as np
import pytest

from stochfric_mb.reference.coulomb import first_zero

ACCURACY = 1.0e-13
"""Ten times the part of the interval to which zeros are found; over the slope where that is small."""


def zero(roots, low=0.0, high=1.0):
    """Return the first zero after low of the monic polynomial with these roots, positive just before the first of them."""
    c = np.polynomial.polynomial.polyfromroots(roots)
    c *= (-1.0) ** len(roots)
    return first_zero((c, len(c)), low, high)


def test_a_line_a_dip_and_a_miss():
    assert zero([0.25]) == pytest.approx(0.25, abs=ACCURACY)
    assert zero([0.5, 0.6]) == pytest.approx(0.5, abs=ACCURACY)  # negative between 0.5 and 0.6: within the interval
    assert zero([0.5, 0.5 + 1.0e-5]) == pytest.approx(0.5, abs=ACCURACY / 1.0e-5)  # the slope there is 1e-5
    assert zero([1.5]) == math.inf
    assert zero([1.2, 1.3]) == math.inf


def test_a_curve_that_starts_on_a_zero():
    assert zero([0.0]) == 0.0  # falls at once
    rising = np.array([0.0, 0.3, -1.0])  # t (0.3 - t)
    assert first_zero((rising, 3), 0.0, 1.0) == pytest.approx(0.3, abs=ACCURACY)
    brief = np.array([0.0, 1.0e-4, -1.0])  # back before the point looked at ahead
    assert first_zero((brief, 3), 0.0, 1.0) == pytest.approx(1.0e-4, abs=ACCURACY / 1.0e-4)


def test_it_is_on_the_later_side():
    for root in (0.1, 1.0 / 3.0, 0.7):
        assert np.polynomial.polynomial.polyval(zero([root]), [root, -1.0]) <= 0.0
