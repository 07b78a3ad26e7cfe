"""The closed share of a gap, and result.json's text."""

import json
import math

import pytest

from stochfric_mb.discovery.result import Gap, Interval, Result


def gap(recalibrated: float, augmented: float, floor: float) -> Gap:
    return Gap("crps_one_cycle", "m", True, 2.0 * recalibrated, recalibrated, augmented, floor)


@pytest.mark.parametrize(
    ("scores", "closed"),
    [((10.0, 2.0, 2.0), 1.0), ((10.0, 6.0, 2.0), 0.5), ((10.0, 10.0, 2.0), 0.0), ((10.0, 12.0, 2.0), -0.25)],
)
def test_closed_is_the_share_of_what_is_reducible(scores, closed):
    assert gap(*scores).closed == pytest.approx(closed, rel=1e-15)


def test_rounding_closes_nothing():
    """A page said that a delay closed -5.01e-11 % of the gap."""
    assert gap(10.0, 10.0 * (1.0 + 1.0e-12), 1.0).closed == 0.0
    assert gap(10.0, 10.0 * (1.0 + 1.0e-6), 1.0).closed < 0.0


@pytest.mark.parametrize("floor", [9.81, 10.0, 11.0])
def test_nothing_is_closed_where_hardly_anything_is_reducible(floor):
    assert gap(10.0, 9.9, floor).closed is None


def test_text_holds_null_for_what_is_not_finite_and_the_digits_that_matter():
    result = Result(
        verdict="none", effects=(), where=None, ranking=(("drift", -math.inf),), gap=gap(3.0, 3.0, 2.0), not_identifiable=(),
        next_experiment="", parameters={"mu_s": Interval(1.0 / 3.0, math.nan, 1.0, "-")},
    )  # fmt: skip
    read = json.loads(result.to_json())
    assert read["ranking"] == [{"kind": "drift", "score": None}]
    assert read["believed"]["mu_s"] == {"value": 0.33333333, "low": None, "high": 1.0, "unit": "-"}
    assert read["gap"]["closed"] == 0.0
    assert read["schema"] == "stochfric.discovery/1"
