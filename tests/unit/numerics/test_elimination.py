"""Elimination solves what numpy solves, with pivots where the diagonal vanishes."""

import numpy as np

from stochfric_mb.numerics.elimination import eliminate


def test_known_solution_that_needs_a_pivot():
    a = np.array([[0.0, 2.0, 1.0], [1.0, 1.0, 0.0], [3.0, 0.0, -1.0]])
    x = np.array([[1.0, -1.0], [2.0, 0.5], [-3.0, 4.0]])
    np.testing.assert_allclose(eliminate(a.copy(), a @ x), x, rtol=0, atol=1.0e-14)


def test_random_systems_against_their_residual():
    rng = np.random.default_rng(1)
    for n in (1, 2, 7, 20):
        a, b = rng.normal(size=(n, n)), rng.normal(size=(n, 2))
        x = eliminate(a.copy(), b.copy())
        # backward stable: residual of some roundings of norm(a) norm(x), n^2 of them at most
        assert np.abs(a @ x - b).max() <= 2.3e-16 * n**2 * np.abs(a).max() * max(np.abs(x).max(), 1.0) * 4
