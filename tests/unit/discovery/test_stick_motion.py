"""A wave in stick phases is found by its phase over the whole record; slow noise has none."""

import numpy as np
import pytest

from stochfric_mb.discovery.stick_slip.records.stick_motion import TONES, shapes, without_pattern, without_wave

RATE, PHASES, SAMPLES, PAUSE = 1000.0, 40, 600, 350
FREQUENCY = 2.13
NATURAL = 25.0


def phases(values: np.ndarray) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Stick phases of a record, less mean and line, and their times."""
    place = np.linspace(-1.0, 1.0, SAMPLES)
    parts, times = [], []
    for i in range(PHASES):
        begin = i * (SAMPLES + PAUSE)
        p = values[begin : begin + SAMPLES]
        parts.append(p - p.mean() - place * (place @ p) / (place @ place))
        times.append(np.arange(begin, begin + SAMPLES) / RATE)
    return parts, times


def slow_noise(deviation: float, memory: float = 50.0) -> np.ndarray:
    kept = np.exp(-1.0 / memory)
    shocks = deviation * (1.0 - kept**2) ** 0.5 * np.random.default_rng(1).standard_normal(PHASES * (SAMPLES + PAUSE))
    values = np.zeros_like(shocks)
    for i in range(1, len(shocks)):
        values[i] = kept * values[i - 1] + shocks[i]
    return values


def test_slow_noise_is_left_alone():
    assert without_wave(*phases(slow_noise(4e-6)), NATURAL) is None


def test_a_wave_is_taken_out_and_the_noise_stays():
    noise = 5e-6 * np.random.default_rng(2).standard_normal(PHASES * (SAMPLES + PAUSE))
    wave = 1e-5 * np.sin(2.0 * np.pi * FREQUENCY * np.arange(len(noise)) / RATE + 0.7)
    parts, times = phases(noise + wave)
    left = without_wave(parts, times, NATURAL)
    assert left is not None
    # at most a quarter of the grid's step, 1/(4 T), off: a phase error of pi/16 at the ends of the record leaves less than
    # 4 % of the wave's variance on average, 7e-12 m^2 at most of its 5e-11; the noise has 2.5e-11
    assert np.var(np.concatenate(left)) == pytest.approx(25e-12, rel=0.04 * 50.0 / 25.0)
    assert np.var(np.concatenate(parts)) > 2.0 * np.var(np.concatenate(left))


def test_a_wave_of_another_shape_is_taken_out_with_its_tones():
    """A drive that steps four times a turn was mostly noise of the sensor with a memory of a second."""
    noise = 5e-7 * np.random.default_rng(2).standard_normal(PHASES * (SAMPLES + PAUSE))
    turn = np.mod(FREQUENCY * np.arange(len(noise)) / RATE, 1.0) - 0.5
    parts, times = phases(noise + 1e-5 * np.where(np.abs(turn) < 0.2, np.cos(np.pi * turn / 0.4) ** 2, 0.0))
    left = without_wave(parts, times, NATURAL)
    assert left is not None
    # tones beyond the sixth have 0.1 % of its variance, the noise 3 %; rates are an eighth of a step off at most
    assert np.var(np.concatenate(left)) < 0.05 * np.var(np.concatenate(parts))


def test_the_slowest_wave_may_be_one_of_any_shape():
    """Its rate is the least that is looked for: of pink noise at several belt speeds nothing was left to look at."""
    ways = shapes(2.0 / 30.0, 30.0)
    assert {count for _, count in ways} == {1, TONES}
    rates = [rate for rate, count in ways if count == TONES]
    assert np.ptp(rates) < 1.0 / 30.0  # no slower one fits into the record twice
    assert sorted(rates) == sorted(rate for rate, count in ways if count == 1)


def test_what_every_phase_repeats_is_taken_out_and_slow_noise_is_left_alone():
    parts, _ = phases(slow_noise(4e-6))
    assert without_pattern(parts) is None
    creep = 2e-5 * np.clip(np.linspace(-4.0, 1.0, SAMPLES), 0.0, 1.0) ** 2
    left = without_pattern([p - creep for p in parts])
    assert left is not None
    # the mean of 40 phases takes a fortieth of the noise with it, twice
    assert np.var(np.concatenate(left)) == pytest.approx(np.var(np.concatenate(parts)), rel=2.0 / PHASES + 0.02)


def test_a_few_phases_tell_nothing():
    parts, times = phases(slow_noise(4e-6))
    assert without_wave(parts[:5], times[:5], NATURAL) is None


def test_a_record_too_short_for_two_slow_waves_is_left_alone():
    parts, times = phases(slow_noise(4e-6))
    assert without_wave(parts, [t / 100.0 for t in times], NATURAL) is None
