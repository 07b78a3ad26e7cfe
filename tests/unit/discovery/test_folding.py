"""Slips that stand out are folded by the belt's travel: what comes back each turn is not taken for what comes at random."""

import numpy as np
import pytest

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.screening.folding import met, turn

SPACING = 2.6e-3
"""Belt travel from slip to slip [m]."""
LENGTH = 0.15
"""Belt travel in a run [m]: 57 slips."""


def _met(bumps, first):
    """The slips that meet bumps: a slip stands out at the place where it begins, not where the bump is."""
    slips = np.arange(first, LENGTH, SPACING)
    return slips[np.unique(np.searchsorted(slips, bumps[bumps < slips[-1]]))]


@pytest.mark.parametrize("length", [0.0113, 0.0163, 0.02])
def test_a_bump_that_comes_back_each_turn_is_found_with_its_travel(length):
    places = [_met(np.arange(start, LENGTH, length), first) for start, first in ((0.004, 0.0), (0.009, 1.0e-3))]
    result, chance = turn(places, [LENGTH, LENGTH], SPACING)
    assert result == pytest.approx(length, rel=0.05)  # half a slip's travel over the run's, and the grid
    assert chance < criteria.FOLDED_BY_CHANCE


@pytest.mark.parametrize("length", [0.0113, 0.0217])
def test_a_bump_that_two_slips_touch_is_met_once_a_turn(length):
    """Taken one by one, its slips would have half the turn between them."""
    slips = [np.arange(first, LENGTH, SPACING) for first in (0.0, 1.0e-3)]
    far = [
        np.abs((s - start + length / 2) % length - length / 2) < 0.9 * SPACING
        for s, start in zip(slips, (4e-3, 9e-3), strict=True)
    ]
    assert np.count_nonzero(far[0]) > 1.5 * LENGTH / length
    result, chance = turn([met(s, f) for s, f in zip(slips, far, strict=True)], [LENGTH, LENGTH], SPACING)
    assert result == pytest.approx(length, rel=0.05)
    assert chance < criteria.FOLDED_BY_CHANCE


def test_neighbours_that_stand_out_are_one_place():
    far = np.array([True, False, True, True, False, False, True])
    np.testing.assert_allclose(met(np.arange(7.0), far), [0.0, 2.5, 6.0])
    assert len(met(np.arange(7.0), np.zeros(7, dtype=bool))) == 0


def test_random_kicks_are_hardly_ever_taken_for_a_bump():
    generator = np.random.default_rng(7)
    taken = 0
    for _ in range(500):
        kicks = [np.sort(generator.uniform(0.0, LENGTH, 8)) for _ in range(2)]
        result = turn([_met(k, 0.0) for k in kicks], [LENGTH, LENGTH], SPACING)
        taken += result is not None and result[1] < criteria.FOLDED_BY_CHANCE
    # 10 are expected at most, since the bound counts every frequency as if it were independent; 4 standard errors more
    assert taken <= 10 + 4 * np.sqrt(10)


def test_a_turn_of_few_slips_is_not_looked_for():
    assert turn([np.arange(0.0, LENGTH, SPACING)], [LENGTH], SPACING) is None
    assert turn([np.array([0.1])], [LENGTH], SPACING) is None
