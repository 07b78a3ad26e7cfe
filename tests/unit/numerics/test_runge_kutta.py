"""The tables fulfil the conditions of their orders, and steps made of them have those orders."""

import functools
import math

import numpy as np
import pytest

from stochfric_mb.numerics.runge_kutta import DOP853, DOPRI5, RK4, advance, interpolate, weighted

ROUNDING = 1.0e-13
"""Sums of a dozen products of numbers up to 60, rounded."""
TABLES = {"RK4": (RK4, 4), "DOPRI5": (DOPRI5, 5), "DOP853": (DOP853, 8)}


@functools.cache
def trees(order):
    """Return all rooted trees with ``order`` nodes, each the sorted tuple of its branches."""
    return sorted({tuple(sorted(branches)) for branches in _forests(order - 1, order - 1)})


def _forests(nodes, largest):
    if nodes == 0:
        return [()]
    return [
        (tree, *rest)
        for size in range(min(nodes, largest), 0, -1)
        for tree in trees(size)
        for rest in _forests(nodes - size, size)
    ]


def size(tree):
    return 1 + sum(size(branch) for branch in tree)


def density(tree):
    return size(tree) * math.prod(density(branch) for branch in tree)


def stage_weights(a, tree):
    return functools.reduce(np.multiply, (a @ stage_weights(a, branch) for branch in tree), np.ones(len(a)))


def defect(f, tree):
    """Return by how much a formula misses the condition of a tree (Hairer, Norsett and Wanner, II.2)."""
    return abs(f.b @ stage_weights(f.a, tree) - 1.0 / density(tree))


def test_all_rooted_trees():
    assert [len(trees(order)) for order in range(1, 9)] == [1, 1, 2, 4, 9, 20, 48, 115]


@pytest.mark.parametrize("name", TABLES)
def test_all_order_conditions_and_no_more(name):
    f, order = TABLES[name]
    np.testing.assert_allclose(f.a.sum(axis=1), f.c, rtol=0, atol=ROUNDING)
    assert all(defect(f, tree) < ROUNDING for k in range(1, order + 1) for tree in trees(k))
    assert max(defect(f, tree) for tree in trees(order + 1)) > 1.0e-7


@pytest.mark.parametrize("name", ["DOPRI5", "DOP853"])
def test_error_estimates_vanish_for_what_both_formulas_solve(name):
    f, _ = TABLES[name]
    c = f.c if name == "DOPRI5" else np.append(f.c, 1.0)
    for weights, order in zip(f.errors, (4,) if name == "DOPRI5" else (5, 3), strict=True):
        for k in range(order):
            assert weights @ c**k == pytest.approx(0.0, abs=ROUNDING)
        assert abs(weights @ c**order) > 1.0e-6  # and not for the next power


def test_dense_output_ends_on_the_step():
    np.testing.assert_allclose(DOPRI5.dense.sum(axis=1), DOPRI5.b, rtol=0, atol=ROUNDING)
    for part in (0.3, 0.8):  # t^k to the fourth power
        weights = DOPRI5.dense @ part ** np.arange(1, 5)
        for k in range(4):
            assert weights @ DOPRI5.c**k == pytest.approx(part ** (k + 1) / (k + 1), abs=ROUNDING)


def rates(t, y):
    """A driven oscillator: y'' = -y + cos 3 t."""
    return np.array([y[1], -y[0] + math.cos(3.0 * t)])


def solution(t):
    """Return what follows from y(0) = 1, y'(0) = 0: particular part -cos(3 t)/8."""
    return np.array([1.125 * math.cos(t) - 0.125 * math.cos(3.0 * t), -1.125 * math.sin(t) + 0.375 * math.sin(3.0 * t)])


def step(f, t, y, h):
    k, probe, end = np.zeros((len(f.b), 2)), np.empty(2), np.empty(2)
    for i in range(len(f.b)):
        advance(f.a[i], i, h, y, k, 0, 2, probe)
        k[i] = rates(t + f.c[i] * h, probe)
    advance(f.b, len(f.b), h, y, k, 0, 2, end)
    return end, k


@pytest.mark.parametrize(("name", "n"), [("RK4", 50), ("DOPRI5", 20), ("DOP853", 5)])
def test_observed_order(name, n):
    f, order = TABLES[name]

    def error(steps):
        y = np.array([1.0, 0.0])
        for i in range(steps):
            y, _ = step(f, i * 2.0 / steps, y, 2.0 / steps)
        return np.linalg.norm(y - solution(2.0))

    assert math.log2(error(n) / error(2 * n)) == pytest.approx(order, abs=0.5)  # next order's share at these steps


def test_error_estimate_and_dense_output_of_a_step():
    y, h, out = np.array([1.0, 0.0]), 0.1, np.empty(2)
    end, k = step(DOPRI5, 0.0, y, h)
    estimate = abs(h * weighted(DOPRI5.errors[0], 7, k, 0))
    assert np.abs(end - solution(h))[0] < estimate < 1.0e-6  # it is that of the lower order
    interpolate(DOPRI5.dense, 0.4, h, y, k, 0, 2, out)
    np.testing.assert_allclose(out, solution(0.04), rtol=0, atol=1.0e-7)  # h^5 times a derivative of order 3^5/120
    out[:] = -1.0
    advance(RK4.b, 1, h, y, k, 1, 2, out)
    assert out[0] == -1.0
