"""Noise level, colour and lines of synthetic noise; outliers; mirrored runs."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.noise import white_noise
from stochfric_mb.discovery.stick_slip.records.record import LINE_WINDOW, line_in, make_record, noise_of
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference.augmented import Start, augmented_system

RATE = 1000.0
DEVIATION = 5e-6
BOX = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)


def white(n: int, seed: int = 1) -> np.ndarray:
    return DEVIATION * np.random.default_rng(seed).standard_normal(n)


def pieces(values: np.ndarray, size: int = 800) -> list[np.ndarray]:
    return [values[i : i + size] for i in range(0, len(values), size)]


def autoregression(n: int, deviation: float, memory: float) -> np.ndarray:
    steps = deviation * (1.0 - memory**2) ** 0.5 * np.random.default_rng(2).standard_normal(n)
    values = np.zeros(n)
    for i in range(1, n):
        values[i] = memory * values[i - 1] + steps[i]
    return values


def test_level_of_white_noise_on_a_smooth_motion():
    time = np.arange(20000) / RATE
    motion = 1e-3 * np.sin(25.0 * time)  # third differences of 1e-3 (25e-3)^3 = 1.6e-8, nothing beside 5e-6
    # a median deviation scatters by 1.17/sqrt(n); third differences are correlated, which makes n 2.3 times smaller
    assert white_noise(motion + white(20000)) == pytest.approx(DEVIATION, rel=4.0 * 1.17 * (2.3 / 20000) ** 0.5)


def test_white_noise_has_no_colour():
    result = noise_of(pieces(white(16000)), DEVIATION)
    assert result.coloured == 0.0
    assert result.deviation == pytest.approx(DEVIATION, rel=4.0 / (2.0 * 16000) ** 0.5)


def test_colour_is_found_with_its_memory():
    coloured, memory = 4e-6, 0.8
    result = noise_of(pieces(white(32000) + autoregression(32000, coloured, memory)), DEVIATION)
    # an autocovariance scatters by c_0 sqrt(sum of squared correlations / n) = 0.9 % of c_0, here 2.9 % of c_1; half of
    # that in the amplitude; two of them decide on the memory
    assert result.coloured == pytest.approx(coloured, rel=4.0 * 0.029)
    assert result.memory == pytest.approx(memory, abs=4.0 * 0.029 * memory)
    assert result.white == pytest.approx(DEVIATION, rel=4.0 * 0.029)


def test_noise_as_slow_as_a_tenth_of_a_phase_keeps_its_size():
    memory = np.exp(-1.0 / 50.0)
    levelled = [
        p - np.polyval(np.polyfit(range(500), p, 1), range(500)) for p in pieces(autoregression(40000, 4e-6, memory), 500)
    ]
    result = noise_of(levelled, 1e-6)
    # 40000 samples hold 400 independent ones of a memory of 50: 3.5 % of the deviation; a line takes 6 % of it away
    assert result.deviation == pytest.approx(4e-6, rel=4.0 * 0.035 + 0.06)
    assert -1.0 / np.log(result.memory) == pytest.approx(50.0, rel=0.4)


def test_phases_with_a_motion_in_them_are_no_noise():
    quiet = pieces(white(16000))
    moved = [*quiet[:-2], *(p + 4e-5 * (np.arange(len(p)) > 400) for p in quiet[-2:])]
    result = noise_of(moved, DEVIATION)
    assert result.coloured == 0.0
    assert result.deviation == pytest.approx(DEVIATION, rel=4.0 / (2.0 * 16000) ** 0.5)


def test_too_little_quiet_gives_the_level_alone():
    result = noise_of([white(100)], 3e-6)
    assert (result.deviation, result.coloured) == (3e-6, 0.0)


def test_drawn_noise_has_the_stated_moments():
    result = noise_of(pieces(white(16000) + autoregression(16000, 4e-6, 0.8)), DEVIATION)
    drawn = result.draw(200000, np.random.default_rng(3))
    one_on = float(np.mean(drawn[1:] * drawn[:-1]))
    # correlated samples: about 200000 (1 - m)/(1 + m) independent ones, and sqrt(2/n) of a variance
    scatter = 4.0 * (2.0 * (1.0 + result.memory) / (1.0 - result.memory) / 200000) ** 0.5
    assert np.var(drawn) == pytest.approx(result.deviation**2, rel=scatter)
    assert one_on == pytest.approx(result.coloured**2 * result.memory, abs=scatter * result.deviation**2)


def test_line_in_noise_is_found_with_frequency_and_amplitude():
    n, amplitude = 100 * LINE_WINDOW, 5e-6
    frequency = 12 * RATE / LINE_WINDOW  # in the middle of a line of the spectrum
    hum = amplitude * np.sin(2.0 * np.pi * frequency * np.arange(n) / RATE)
    result, size, strength = line_in(pieces(white(n) + hum, LINE_WINDOW), RATE)
    window = np.hanning(LINE_WINDOW)
    noise = 4.0 * DEVIATION**2 * np.sum(window**2) / window.sum() ** 2  # what white noise adds to amplitude squared
    assert result == frequency
    # the product of line and noise scatters by sqrt(2 noise/line) in power, half of that in amplitude, 100 pieces
    scatter = 0.5 * (2.0 * noise / amplitude**2 / 100) ** 0.5
    assert size == pytest.approx((amplitude**2 + noise) ** 0.5, rel=4.0 * scatter)
    assert strength > 60.0


def test_no_line_in_white_noise_and_none_in_too_little():
    _, _, strength = line_in(pieces(white(100 * LINE_WINDOW), LINE_WINDOW), RATE)
    # the largest of 61 normal numbers exceeds 5 once in 50000 times; the tail of a mean of 100 squares is a little longer
    assert strength < 6.0
    assert line_in(pieces(white(7 * LINE_WINDOW), LINE_WINDOW), RATE) == (0.0, 0.0, 0.0)


def test_single_spikes_are_outliers_and_nothing_else_is():
    n = 20000
    truth = BOX.belt_velocity * np.arange(n) / RATE
    spikes = np.arange(50, n, 500)
    raw = truth + white(n)
    raw[spikes] += 100e-6 * (-1.0) ** np.arange(spikes.size)
    raw[10203:10210] += 100e-6  # seven samples together are motion
    record = make_record("run", np.arange(n) / RATE, raw, BOX)
    assert np.flatnonzero(record.outlier).tolist() == spikes.tolist()
    np.testing.assert_array_equal(record.raw, raw)
    # the median of seven scatters by half as much as a sample; the belt moves 2.5 um a sample besides
    np.testing.assert_allclose(record.position[spikes], truth[spikes], atol=4.0 * 0.5 * DEVIATION + 2.5e-6)


def test_clicks_that_ring_over_four_samples_are_outliers():
    n = 20000
    truth = BOX.belt_velocity * np.arange(n) / RATE
    raw = truth + white(n)
    clicks = np.arange(50, n, 500)
    for later, part in enumerate((1.0, -0.7, 0.45, -0.25)):
        raw[clicks + later] += 200e-6 * part
    record = make_record("run", np.arange(n) / RATE, raw, BOX)
    found, loud = set(np.flatnonzero(record.outlier).tolist()), np.concatenate([clicks, clicks + 1, clicks + 2])
    assert set(loud.tolist()) <= found <= {*loud.tolist(), *(clicks + 3).tolist()}  # the last one is near what noise does
    # a cubic through eight readings on either side errs by half of what one does; a last one that is not seen pulls it as far
    np.testing.assert_allclose(record.position[loud], truth[loud], atol=4.0 * DEVIATION)


def test_backward_belt_is_mirrored():
    time, position = np.arange(2000) / RATE, white(2000)
    backward = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=-2.5e-3)
    record = make_record("run", time, position, backward)
    np.testing.assert_array_equal(record.raw, -position)
    assert (record.direction, record.mechanism.belt_velocity, record.stated) == (-1, 2.5e-3, backward)


@pytest.mark.parametrize(
    ("rate", "mass", "deviation"),
    [(1000.0, 6.08, 5e-6), (1000.0, 6.08, 2e-7), (250.0, 6.08, 5e-6), (125.0, 12.0, 5e-6), (125.0, 60.8, 5e-6)],
)
def test_corners_of_slips_are_no_outliers_at_any_rate_and_noise_that_is_taken(rate, mass, deviation):
    """At 125 Hz a slip is some ten samples: a running median of seven cuts its corners, which stand out where noise is low."""
    box = dataclasses.replace(BOX, mass=mass)
    system = augmented_system(box, make_law("coulomb", mu_s=0.8, mu_k=0.46))
    motion = system.march(Start(0.0, 0.0, box.belt_velocity, stick=True), 1.0 / rate, round(60.0 * rate))
    noise = deviation * np.random.default_rng(3).standard_normal(len(motion.position))
    record = make_record("run", np.arange(len(noise)) / rate, motion.position + noise, box)
    assert record.outlier.mean() < criteria.LEAST_OUTLIERS
