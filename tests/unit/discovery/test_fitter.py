"""Least squares on rough errors, and within bounds."""

import numpy as np
import pytest
from scipy.optimize import least_squares

from stochfric_mb.discovery.inference.fitter import minimised

GOAL = np.array([0.7, -1.3])
FINENESS = 1e-6
"""Errors are known to this step, as those of a simulation are."""


def rough(at: np.ndarray) -> np.ndarray:
    """Errors that rise in steps: differences below the steps' size see nothing or a cliff."""
    away = at - GOAL
    smooth = np.array([away[0] + 0.2 * away[1] ** 2, 2.0 * away[1], away[0] * away[1]])
    return np.round(smooth / FINENESS) * FINENESS


def test_a_stated_step_finds_its_way_where_the_smallest_one_does_not():
    low, high = np.full(2, -5.0), np.full(2, 5.0)
    minimum = minimised(rough, np.zeros(2), low, high, difference=0.01, evaluations=30, tolerance=1e-12)
    lost = least_squares(rough, np.zeros(2), bounds=(low, high), diff_step=0.01, xtol=1e-8)
    # the slopes are known to the step times the curvature, so that the end is reached to the errors' own fineness
    np.testing.assert_allclose(minimum.x, GOAL, atol=10.0 * FINENESS)
    assert np.abs(lost.x - GOAL).max() > 0.1  # SciPy's own step at zero is 1e-8, whatever step is asked for


@pytest.mark.parametrize("first", [(0.0, 0.0), (9.0, -9.0)])
def test_bounds_hold_for_the_derivatives_too(first):
    asked: list[np.ndarray] = []

    def errors(at):
        asked.append(at.copy())
        return at - GOAL

    low, high = np.array([-0.5, -1.0]), np.array([0.2, -0.995])  # the second range is smaller than the step
    minimum = minimised(errors, np.array(first), low, high, difference=0.01, evaluations=30, tolerance=1e-12)
    assert all(np.all(low <= at) and np.all(at <= high) for at in asked)
    np.testing.assert_allclose(minimum.x, (0.2, -1.0), atol=1e-12)


@pytest.mark.parametrize("outlying", [np.inf, 0.5])
def test_the_minimum_is_that_of_scipy(outlying):
    place = np.linspace(0.0, 3.0, 60)
    truth = 2.0 * np.exp(-1.3 * place) + np.where(np.arange(60) % 9 == 4, 1.5, 0.0)

    def errors(at):
        return at[0] * np.exp(-at[1] * place) - truth

    low, high = np.full(2, -10.0), np.full(2, 10.0)
    loss = {} if np.isinf(outlying) else {"loss": "soft_l1", "f_scale": outlying}
    exact = least_squares(errors, np.ones(2), bounds=(low, high), xtol=1e-14, ftol=1e-14, gtol=1e-14, **loss)
    minimum = minimised(errors, np.ones(2), low, high, difference=1e-6, evaluations=60, tolerance=1e-14, outlying=outlying)
    assert minimum.cost == pytest.approx(exact.cost, rel=1e-9)  # of second order in the distance from the minimum
    np.testing.assert_allclose(minimum.x, exact.x, rtol=1e-4)  # slopes are differences: off by the step times the curvature
    np.testing.assert_allclose(np.abs(minimum.jacobian), np.abs(exact.jac), rtol=1e-2, atol=1e-4)


def test_a_step_over_a_cliff_is_shortened_until_it_falls():
    def errors(at):  # a simulation that slips no more beyond a twentieth, on the way to a minimum at ten
        return np.where(np.abs(at) < 0.05, at - 10.0, 100.0)

    low, high = np.full(1, -20.0), np.full(1, 20.0)
    minimum = minimised(errors, np.zeros(1), low, high, difference=1e-3, evaluations=30, tolerance=1e-4)
    assert 0.03 < minimum.x[0] < 0.05


def test_threads_change_nothing():
    low, high = np.full(2, -5.0), np.full(2, 5.0)
    one, several = (
        minimised(rough, np.zeros(2), low, high, difference=0.01, evaluations=30, tolerance=1e-12, threads=threads)
        for threads in (False, True)
    )
    assert one.x.tobytes() == several.x.tobytes()
    assert one.jacobian.tobytes() == several.jacobian.tobytes()


def fitted(errors, first):
    low, high = np.full(2, -5.0), np.full(2, 5.0)
    return minimised(errors, np.array(first), low, high, difference=0.01, evaluations=30, tolerance=1e-9)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_cost_that_is_no_number_ends_the_fit_where_it_began(bad):
    minimum = fitted(lambda at: np.array([bad, at[1] - 2.0]), [0.0, 0.0])
    assert minimum.x.tolist() == [0.0, 0.0]
    assert not np.isfinite(minimum.cost)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_slopes_that_are_no_numbers_end_it_too(bad):
    def errors(x):
        return np.array([x[0] - 3.0, x[1] - 2.0 if x[1] == 0.0 else bad])

    assert fitted(errors, [0.0, 0.0]).x.tolist() == [0.0, 0.0]


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_steps_to_where_the_cost_is_no_number_are_shortened(bad):
    def errors(x):  # the first step, to 3.5, is too long
        return np.array([np.sqrt(x[0]) - 1.5 if x[0] < 3.0 else bad, x[1] - 2.0])

    minimum = fitted(errors, [1.0, 0.0])
    assert minimum.x == pytest.approx([2.25, 2.0], abs=1e-3)
