"""Slips that stand out are folded by the belt's travel: what comes back each turn is not taken for what comes at random."""

import numpy as np
import pytest

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.screening.folding import turn

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
