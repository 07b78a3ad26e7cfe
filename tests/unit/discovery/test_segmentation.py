"""Noise of the velocity that slips are told by, on a box that rides on the belt."""

import numpy as np
import pytest
from scipy.signal import lfilter

from stochfric_mb.discovery.stick_slip.records.record import Noise, make_record
from stochfric_mb.discovery.stick_slip.records.segmentation import relative_velocity
from stochfric_mb.mechanisms import BeltBox

BOX = BeltBox(mass=6.08, damping=0.0, stiffness=3956.0, normal_force=13.0, belt_velocity=1.0e-3)
SIZE = 5.0e-6


@pytest.mark.parametrize("memory", [0.0, 0.6, 0.8, 0.95])
def test_noise_of_the_velocity_is_that_of_the_positions_colour(memory: float):
    time = np.arange(60001) * 1e-3
    steps = SIZE * np.sqrt(1.0 - memory**2) * np.random.default_rng(3).standard_normal(time.size)
    position = BOX.belt_velocity * time + lfilter([1.0], [1.0, -memory], steps)
    record = make_record("run", time, position, BOX)
    noise = Noise(SIZE, SIZE if memory else 0.0, memory)
    velocity, deviation = relative_velocity(record, noise)
    # 2000 independent values: four standard errors, and what the filter's memory leaves of them
    assert np.std(velocity) == pytest.approx(deviation, rel=0.1)
    if memory in (0.6, 0.8):
        # third differences see less of the noise, and white noise less of it in the velocity
        assert relative_velocity(record)[1] < 0.6 * deviation
