"""Noise as means over several samples see it: that of readings which were interpolated or smoothed shows in no difference."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.signal import butter, lfilter

from stochfric_mb.discovery.inference.noise import PIECE, noise_level, resolution, rounding_noise, white_noise

RATE = 2000.0
TIME = np.arange(20_000) / RATE
MOTIONS = {
    "sweep": 0.1 * np.sin(2.0 * np.pi * (0.5 * TIME + 0.2 * TIME**2)),
    "ramps": np.interp(TIME % 4.0, [0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 0.1, 0.1, 0.0, 0.0]),
    "jumps of the acceleration": np.cumsum(np.cumsum(np.sign(np.sin(2.0 * np.pi * 1.3 * TIME)))) / RATE**2,
}
NOISE = 1e-3 * np.random.default_rng(1).standard_normal(len(TIME))


def by_spline(x, every=4):
    return CubicSpline(TIME[::every], x[::every])(TIME)


@pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS)
@pytest.mark.parametrize("size", [0.0, 1e-4, 1e-2, 1.0])
def test_white_noise_and_motion_are_what_differences_say(motion, size):
    signal = motion + size * NOISE
    assert noise_level(signal) == white_noise(signal)


@pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS)
def test_means_of_interpolated_readings_err_by_what_was_read(motion):
    """One reading of four: a mean over a time holds a quarter as many, and errs as if each had twice the noise."""
    signal = by_spline(motion + NOISE)
    assert white_noise(signal) < 0.05e-3
    assert noise_level(signal) == pytest.approx(2e-3, rel=0.15)
    width = 200
    means = by_spline(NOISE)[: len(TIME) // width * width].reshape(-1, width).mean(axis=1)
    assert noise_level(signal) / np.sqrt(width) == pytest.approx(means.std(), rel=0.25)  # of 100 means


@pytest.mark.parametrize("size", [1e-2, 1.0])
def test_a_filter_hides_no_noise_of_slow_means(size):
    signal = lfilter(*butter(2, 0.1), MOTIONS["sweep"] + size * NOISE)
    assert white_noise(signal) < 0.02e-3
    assert noise_level(signal) == pytest.approx(size * 1e-3, rel=0.15)


def test_stray_readings_are_no_noise():
    signal = MOTIONS["sweep"] + 1e-2 * NOISE
    for first in (1000, 7000, 7900, 15_000):  # a wiper that lifts for a while
        signal[first : first + 60] = 0.3
    assert noise_level(signal) == white_noise(signal)


def test_jumps_after_repeated_readings_are_no_noise():
    signal = MOTIONS["sweep"] + 1e-2 * NOISE
    stale = np.random.default_rng(2).random(len(TIME)) < 0.02
    last = np.maximum.accumulate(np.where(stale, 0, np.arange(len(TIME))))
    assert noise_level(signal[last]) == white_noise(signal[last])


def test_motion_that_is_interpolated_is_no_noise():
    for motion in MOTIONS.values():
        signal = by_spline(motion)
        assert noise_level(signal) == white_noise(signal)


def test_a_short_record_has_no_spectrum():
    signal = by_spline(NOISE)[: 2 * PIECE - 1]
    assert noise_level(signal) == white_noise(signal)


def test_counts_of_a_clean_encoder_have_the_noise_of_their_rounding_though_it_rests_most_of_the_time():
    t = np.arange(8000) * 1.0e-3
    counts = np.round(0.05 * (1.0 - np.cos(2.0 * np.pi * np.clip(t % 4.0, 0.0, 1.0))) / 1.0e-5) * 1.0e-5
    assert white_noise(counts) == 0.0
    assert noise_level(counts) == pytest.approx(1.0e-5 / np.sqrt(12.0), rel=1.0e-6)
    printed = np.round(counts / 3.0, 7)  # the file rounds a count of 3.3e-6 to 1e-7
    assert rounding_noise(printed) == pytest.approx(1.0e-5 / 3.0 / np.sqrt(12.0), rel=0.05)


def test_the_resolution_shows_however_long_the_signal_rests():
    t = np.arange(100_000) * 1.0e-3
    counts = np.round(3.0e-5 * np.maximum(t - 99.0, 0.0) ** 2 / 1.0e-7) * 1.0e-7
    assert resolution(counts) == pytest.approx(1.0e-7, rel=1.0e-6)


def test_what_does_not_come_in_steps_has_no_rounding():
    t, rng = np.arange(8000) * 1.0e-3, np.random.default_rng(2)
    assert rounding_noise(np.sin(t)) == 0.0
    assert rounding_noise(np.sin(t) + 1.0e-4 * rng.standard_normal(t.size)) == 0.0
    assert rounding_noise(0.3 * t) == 0.0  # an even motion has one change, and no resolution
    assert rounding_noise(np.zeros(10)) == 0.0
