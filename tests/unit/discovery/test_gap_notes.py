"""A model that gets worse on held-out runs must be said to."""

import dataclasses

import pytest

from stochfric_mb.discovery.result import Gap

GAP = Gap("crps_one_cycle", "m", True, 3.0e-5, 2.0e-5, 1.0e-5, 5.0e-6)


def test_nothing_is_said_of_a_model_that_gets_better():
    assert GAP.notes == ()


@pytest.mark.parametrize(("unit", "said"), [("m", "(2.5e-05 m)"), ("-", "(2.5e-05)")])
def test_it_is_said_that_a_model_gets_worse(unit, said):
    (note,) = dataclasses.replace(GAP, augmented=2.5e-5, unit=unit).notes
    assert said in note
    assert "off by more" in note
