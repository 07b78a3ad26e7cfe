"""The mechanism that forces are taken with: what a regression estimates of it, within what a mechanism can be."""

import numpy as np
import pytest

from stochfric_mb.discovery.stick_slip.records.record import CORRECTED, LEAST_CORRECTION, corrections_of, make_record
from stochfric_mb.mechanisms import BeltBox


def test_damping_below_zero_is_no_mechanism():
    corrections = corrections_of(np.array([0.02, -0.01, -1.7]))
    assert corrections == {"stiffness": 0.02, "mass": -0.01, "damping": LEAST_CORRECTION}
    box = BeltBox(mass=2.0, stiffness=1000.0, damping=3.0, belt_velocity=0.1, normal_force=20.0)
    time = np.arange(200) * 1e-3
    taken = make_record("a", time, 1e-4 * np.sin(time), box).corrected(corrections)
    assert taken.mechanism.damping == pytest.approx(0.15)
    assert taken.mechanism.mass == pytest.approx(1.98)
    assert tuple(taken.corrections) == CORRECTED
    assert list(taken.corrections.values()) == pytest.approx(list(corrections.values()))
