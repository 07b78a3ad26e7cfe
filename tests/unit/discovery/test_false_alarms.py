"""What speaks for a name: chances are counts of simulated records, and no smaller one than their number allows is stated."""

import numpy as np
import pytest

from stochfric_mb.discovery.inference.false_alarms import chance, detected, likely, null_scores


@pytest.mark.parametrize("statistic", ["slips", "stick", "scatter", "wander", "clipped", "outliers", "kicks"])
def test_chances_count_the_records_that_reach_as_far(statistic):
    nulls = null_scores()[statistic]
    assert list(nulls) == sorted(nulls, reverse=True)
    assert chance(statistic, np.inf) == pytest.approx(1.0 / (1 + len(nulls)))
    assert chance(statistic, nulls[-1]) == 1.0
    assert chance(statistic, nulls[0] + 1.0) < chance(statistic, nulls[len(nulls) // 2])


def test_what_a_detector_says_has_no_score():
    assert detected("kicks", 0.3).score is None
    assert detected("kicks", 0.3).p_value < 0.05
    assert likely("slips", 500.0).score == 500.0
