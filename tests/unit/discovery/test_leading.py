"""A result leads with the score in which its effects show."""

import dataclasses

from stochfric_mb.discovery.result import Gap
from stochfric_mb.discovery.stick_slip.validation.feature_skill import Gaps

FLAT = Gap("crps_one_cycle", "m", True, 9.0e-6, 4.15e-6, 4.12e-6, 4.12e-6)
FORCES = Gap("crps_slip_forces", "-", True, 3.0, 2.0, 0.6, 0.56)


def test_forces_lead_where_forecasts_hardly_show_the_effect():
    assert Gaps(FLAT, FORCES).leading == "slip_forces"
    assert Gaps(FLAT, FORCES).leads is FORCES


def test_forecasts_lead_where_they_show_it_and_where_forces_do_not():
    assert Gaps(dataclasses.replace(FLAT, recalibrated=8.0e-6), FORCES).leading == "gap"
    nearly = dataclasses.replace(FLAT, recalibrated=6.0e-6)  # 31 % to 72 % that can be made better
    assert Gaps(nearly, FORCES).leading == "slip_forces"
    assert Gaps(FLAT, dataclasses.replace(FORCES, recalibrated=0.56)).leading == "gap"
    assert Gaps(FLAT).leads is FLAT
    assert Gaps(None, FORCES).leading == "gap"
    assert Gaps(None).leads is None


def test_readings_lead_where_there_is_a_gap_in_them():
    readings = Gap("log_score_readings", "-", True, 3.0, 3.0, 1.2, 1.2)
    assert Gaps(FLAT, None, readings).leads is readings
    assert Gaps(FLAT, None, dataclasses.replace(readings, recalibrated=1.2)).leading == "gap"
