"""A result leads with the score in which its effects show."""

import dataclasses

from stochfric_mb.discovery.result import Gap
from stochfric_mb.discovery.stick_slip.validation.feature_skill import leading

FLAT = Gap("crps_one_cycle", "m", True, 9.0e-6, 4.15e-6, 4.12e-6, 4.12e-6)
FORCES = Gap("crps_slip_forces", "-", True, 3.0, 2.0, 0.6, 0.56)


def test_forces_lead_where_forecasts_hardly_show_the_effect():
    assert leading(FLAT, FORCES) == "slip_forces"


def test_forecasts_lead_where_they_show_it_and_where_forces_do_not():
    assert leading(dataclasses.replace(FLAT, recalibrated=8.0e-6), FORCES) == "gap"
    assert (
        leading(dataclasses.replace(FLAT, recalibrated=6.0e-6), FORCES) == "slip_forces"
    )  # 31 % to 72 % that can be made better
    assert leading(FLAT, dataclasses.replace(FORCES, recalibrated=0.56)) == "gap"
    assert leading(FLAT, None) == "gap"
    assert leading(None, FORCES) == "gap"
