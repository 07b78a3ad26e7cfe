"""The noise that a ripple in stick is held against is that at its own frequency."""

import numpy as np
import pytest
from scipy.signal import periodogram

from stochfric_mb.discovery.stick_slip.records.record import Noise
from stochfric_mb.discovery.stick_slip.records.stick_phases import noise_ratio


def test_white_noise_is_as_loud_at_all_frequencies():
    assert noise_ratio(Noise(2.0), np.array([0.0, 0.1, 0.5])) == pytest.approx(1.0)


def test_slow_noise_is_quieter_at_a_ripple():
    noise = Noise(1.0, 0.95, 0.9)
    samples = noise.draw(2**18, np.random.default_rng(1))
    frequency, power = periodogram(samples)
    levels = [power[(frequency > low) & (frequency < high)].mean() for low, high in ((1e-4, 2e-3), (0.14, 0.16), (0.44, 0.46))]
    # means of 500 and more values of a periodogram err by 4 %
    assert noise_ratio(noise, np.array([0.0, 0.15, 0.45])) == pytest.approx(levels[0] / np.array(levels), rel=0.1)
