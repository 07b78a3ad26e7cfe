"""The gap in the forces of held-out slips: an effect shows there, and faults of the sensor are left out."""

import numpy as np
import pytest

from stochfric_mb.discovery import discover
from tests.discovery.generator.case import Case
from tests.discovery.net.rigs import belt_box

SEED = 21
"""A tuning seed."""


@pytest.mark.parametrize(
    ("form", "design", "strength"),
    [("velocity_weakening.rational", "one_free", 1.0), ("viscous_friction.proportional", "normal_loads", 0.5)],
)
def test_an_effect_shows_in_the_forces_of_held_out_slips(form, design, strength):
    gap = discover(belt_box(Case(form, design, strength, SEED))).result.slip_forces
    assert gap is not None
    assert gap.recalibrated > 3.0 * gap.floor  # what position forecasts miss by a fifth
    assert gap.closed is not None
    assert gap.closed > 0.85  # what a named effect must close in nine of ten cases
    # a true model scores 1/sqrt(pi) of the noise; a lower score that is reached bounds the floor, and is below by no more than
    # the noise is known to: 10 % from 48 slips, 1/sqrt(2 n)
    truth = 1.0 / np.sqrt(np.pi)
    assert gap.floor == pytest.approx(min(truth, gap.augmented), rel=0.02)
    assert gap.floor > 0.9 * truth


def test_stray_readings_are_judged_by_readings_and_not_by_forces():
    result = discover(belt_box(Case("sensor_outliers.spikes", "one_free", 1.0, SEED))).result
    assert [e.kind for e in result.effects] == ["sensor_outliers"]
    assert result.slip_forces is None
    assert result.to_dict()["slip_forces"] is None
    assert result.leading == "readings"
    assert result.leads is result.readings
    assert result.leads.closed > 0.95  # as many stray in the held-out runs, and as far
