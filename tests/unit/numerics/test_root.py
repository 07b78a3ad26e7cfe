"""The search ends on both sides of the change of sign, in few trials where the function is smooth, in halvings where not."""

import math

import pytest

from stochfric_mb.numerics.root import bracket, is_wide, least_armed, narrowed, trial


def search(f, positive, negative, resolution):
    b = bracket(positive, f(positive), negative, f(negative))
    tried = 0
    while is_wide(b, resolution):
        x = trial(b, resolution)
        assert min(b.positive, b.negative) < x < max(b.positive, b.negative)
        b = narrowed(b, x, f(x))
        tried += 1
    return b, tried


@pytest.mark.parametrize(
    ("f", "root", "most"),
    [
        (lambda t: 1.0 - 3.0 * t, 1.0 / 3.0, 3),
        (lambda t: math.cos(t) - 0.9, math.acos(0.9), 12),
        (lambda t: 0.25 - t**9, 0.25 ** (1.0 / 9.0), 20),  # flat at the start: false position alone would take hundreds
        (lambda t: math.exp(-30.0 * t) - 1.0e-3, -math.log(1.0e-3) / 30.0, 20),
        (lambda t: 1.0 if t < 0.123 else -1e-9, 0.123, 4 * 53),  # a jump: each halving after three trials in vain
    ],
)
@pytest.mark.parametrize("resolution", [1.0e-6, 0.0])
def test_both_sides_of_the_root(f, root, most, resolution):
    b, tried = search(f, 0.0, 1.0, resolution)
    assert f(b.positive) > 0.0 >= f(b.negative)
    assert abs(b.negative - b.positive) <= max(resolution, 2.3e-16)  # down to neighbouring numbers
    # rounding of f moves its change of sign by eps/abs(f'), at most 5e-15 for the exponential
    assert abs(b.negative - root) <= resolution + 5.0e-15
    assert tried <= most


def test_the_ends_may_stand_either_way():
    b, _ = search(lambda t: t - 0.7, 1.0, 0.0, 1.0e-12)
    assert b.negative <= 0.7 < b.positive
    assert b.positive - b.negative <= 1.0e-12


def test_a_search_that_starts_on_a_zero_finds_the_other_one():
    b, _ = search(lambda t: t * (0.4 - t), 0.0, 1.0, 1.0e-12)
    assert b.negative == pytest.approx(0.4, abs=1.0e-12)


def test_numbers_next_to_each_other_end_the_search():
    assert not is_wide(bracket(1.0, 1.0, math.nextafter(1.0, 2.0), -1.0), 0.0)


def test_infinite_values_are_halved():
    b, _ = search(lambda t: math.inf if t < 0.3 else 0.5 - t, 0.0, 1.0, 1.0e-9)
    assert b.negative == pytest.approx(0.5, abs=1.0e-9)


def test_the_least_of_the_armed_guards():
    assert least_armed((1.0, 0.0, 2.0), (0.5, -3.0, -0.25)) == -0.25
    assert least_armed((0.0, -1.0), (-1.0, -1.0)) == math.inf
