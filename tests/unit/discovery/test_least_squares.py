"""Least squares in columns of unit length, against the normal equations and by hand."""

import numpy as np
import pytest

from stochfric_mb.discovery.inference.least_squares import beyond, left_by, lengths, solved

TIME = np.linspace(0.0, 1.0, 50)
DESIGN = np.column_stack([np.ones(50), 1.0e9 * TIME, 1.0e-9 * TIME**2])
"""Columns of very different units."""
NUMBERS = np.array([2.0, -3.0e-9, 5.0e9])


def test_numbers_of_any_units_come_back():
    np.testing.assert_allclose(solved(DESIGN, DESIGN @ NUMBERS), NUMBERS, rtol=1e-9)


def test_what_is_left_is_at_right_angles_to_the_columns_however_it_is_found():
    values = np.cos(7.0 * TIME)
    left = left_by(DESIGN, values)
    np.testing.assert_allclose(left @ (DESIGN / lengths(DESIGN)), 0.0, atol=1e-12)
    np.testing.assert_allclose(left, values - DESIGN @ solved(DESIGN, values), atol=1e-12)
    np.testing.assert_allclose(left, beyond(DESIGN, values[:, None])[:, 0], atol=1e-12)


@pytest.mark.parametrize("more", [DESIGN[:, 1], np.zeros(50)])
def test_a_column_twice_and_one_of_zeros_change_nothing(more):
    values = np.cos(7.0 * TIME)
    redundant = np.column_stack([DESIGN, more])
    np.testing.assert_allclose(left_by(redundant, values), left_by(DESIGN, values), atol=1e-12)
    assert np.isfinite(solved(redundant, values)).all()


def test_lengths_of_other_rows_change_no_answer():
    values = DESIGN @ NUMBERS
    np.testing.assert_allclose(solved(DESIGN[:20], values[:20], lengths(DESIGN)), NUMBERS, rtol=1e-9)
