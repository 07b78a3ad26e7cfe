"""The table of what is believed: as stated, how sure, as fitted."""

import pytest

from stochfric_mb.report.discovery import _beliefs


@pytest.mark.parametrize(
    ("name", "stated", "sure", "absolute"),
    [
        ("elbow.mass_factor", None, 0.03, False),
        ("elbow.damping_factor", None, 0.1, False),
        ("elbow.drive_factor", None, 0.02, False),
        ("elbow.drive_offset", None, 0.05, True),
        ("elbow.mu_k", 1.0, 0.3, False),
        ("elbow.payload_end", None, None, False),
        ("offset", None, 0.05, True),
        ("mu_k", 1.0, 0.3, False),
    ],
)
def test_a_number_of_a_joint_is_as_sure_as_stated(name, stated, sure, absolute):
    uncertainty = {"mass": 0.03, "damping": 0.1, "gain": 0.02, "offset": 0.05, "mu_k": 0.3}
    about = {"law": {"mu_k": 1.0}, "mechanism": {"damping": {"elbow": 2.0}}, "uncertainty": uncertainty}
    fitted = {"value": 1.0, "low": 0.9, "high": 1.1, "unit": "-"}
    (row,) = _beliefs({"details": {"stated": about}, "believed": {name: fitted}})
    assert (row["stated"], row["sure"], row["absolute"]) == (stated, sure, absolute)


def test_a_factor_of_a_slide_has_a_key_of_its_own():
    about = {"law": {}, "mechanism": {"drive_factor": 1.2}, "uncertainty": {"drive_factor": 0.1}}
    (row,) = _beliefs({"details": {"stated": about}, "believed": {"drive_factor": {"value": 1.0}}})
    assert (row["stated"], row["sure"]) == (1.2, 0.1)
