"""Scatter from stroke to stroke: when strokes are drawn anew, and when they go on from those before."""

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.scatter.memory import Memory, memory_of
from stochfric_mb.discovery.driven_joint.scatter.stroke_scatter import StrokeScatter


@pytest.mark.parametrize(
    ("memory", "anew", "may_wander"),
    [
        (Memory(0.0, 0.0, 0.4), True, False),
        (Memory(0.2, 0.0, 0.8), True, True),  # few strokes do not say
        (Memory(0.6, 0.3, 0.7), True, True),  # the one before says something, but less than half
        (Memory(0.78, 0.53, 0.98), True, True),  # may say less than half: that of 46 strokes whose true one is 0.67
        (Memory(0.9, 0.75, 0.98), False, True),
    ],
)
def test_strokes_are_drawn_anew_where_the_one_before_says_less_than_half(memory, anew, may_wander):
    seen = StrokeScatter(
        sigma=0.1, low=0.08, high=0.12, share=0.2, score=100.0, p_value=0.0, believed=0.0, gain=0.5,
        memory=memory, across=0.0, strokes=40, level=1.0, inside=0.1, floor=0.1,
    )  # fmt: skip
    assert seen.wanders is not anew
    assert seen.named is anew
    assert seen.may_wander is may_wander


@pytest.mark.parametrize(("inside", "named"), [(0.14, True), (0.2, True), (0.3, False)])
def test_scatter_is_a_finding_where_no_material_part_of_the_squared_error_is_left_within_strokes(inside, named):
    """24 % from stroke to stroke had no name for what 1 % more left within them."""
    seen = StrokeScatter(
        sigma=0.1, low=0.08, high=0.12, share=0.2, score=100.0, p_value=0.0, believed=0.0, gain=0.5,
        memory=Memory(0.0, 0.0, 0.4), across=0.0, strokes=40, level=1.0, inside=inside, floor=0.1,
    )  # fmt: skip
    assert seen.named is named
    assert seen.all_of_it is (inside < 0.15)


def strokes(rng, rho, runs, each):
    """Return strokes there and back, with a mean for each run and direction, and the scatter of a reading."""
    n = runs * each
    run = np.repeat(np.arange(runs), each)
    setting = 2 * run + np.tile(np.arange(each) % 2, runs)
    values = np.empty((runs, each))
    values[:, 0] = rng.standard_normal(runs)
    for k in range(1, each):
        values[:, k] = rho * values[:, k - 1] + np.sqrt(1.0 - rho**2) * rng.standard_normal(runs)
    mean = rng.standard_normal(2 * runs)[setting]
    return 0.1 * values.ravel() + mean + 0.03 * rng.standard_normal(n), np.full(n, 0.03**2), setting, run


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.8])
def test_intervals_of_the_memory_hold_the_true_one_as_often_as_they_say(rho):
    """95 % of 60: between 51 and 60 with a chance of 0.999 (binomial)."""
    rng = np.random.default_rng(5)
    seen = [memory_of(*strokes(rng, rho, 4, 12)) for _ in range(60)]
    step = 0.041  # of the values that are tried
    assert 51 <= sum(m.low - step <= rho <= m.high + step for m in seen) <= 60
    assert abs(np.mean([m.correlation for m in seen]) - rho) < 0.15  # not below zero, where the mean of many is above none


def test_strokes_without_a_next_one_tell_nothing_of_a_memory():
    runs = np.arange(12)
    memory = memory_of(np.random.default_rng(3).standard_normal(12), np.full(12, 0.1), runs, runs)
    assert (memory.low, memory.high) == (0.0, 0.98)
