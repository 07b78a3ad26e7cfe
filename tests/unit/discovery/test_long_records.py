"""Long records: waves are found without looking at every frequency of all of it, and a stretch stands for it in simulations."""

import numpy as np
import pytest

from stochfric_mb import load_scenario
from stochfric_mb.discovery.inference.frequency_search import worth_a_look
from stochfric_mb.discovery.stick_slip.records.long_records import FORECAST, SIMULATED, middle
from stochfric_mb.discovery.stick_slip.records.record import make_record
from stochfric_mb.discovery.stick_slip.records.slips import extract
from stochfric_mb.discovery.stick_slip.records.stick_waves import wave_gains
from stochfric_mb.discovery.stick_slip.simulation.forecast import windows_of
from stochfric_mb.laws import make_law
from stochfric_mb.reference.augmented import Start, augmented_system

DURATION, STRETCH, FINENESS = 2000.0, 100.0, 4.0


@pytest.mark.parametrize("frequency", [0.003, 0.0571, 0.7123, 1.9042])
def test_a_wave_is_found_in_a_long_record_by_a_small_part_of_its_frequencies(frequency):
    generator = np.random.default_rng(4)
    time = np.sort(generator.uniform(0.0, DURATION, 4000))
    values = 0.4 * np.cos(2.0 * np.pi * frequency * time + 1.0) + generator.standard_normal(len(time))
    looked_at = 0

    def gains(grid, stretch):
        nonlocal looked_at
        inside = time <= stretch
        looked_at += len(grid) * int(inside.sum())
        wave = np.exp(2.0j * np.pi * grid[:, None] * time[inside])
        return np.abs(wave @ values[inside]) ** 2 / inside.sum()

    whole = np.arange(2.0 / DURATION, 2.0, 1.0 / (FINENESS * DURATION))
    near = worth_a_look(gains, whole, duration=DURATION, stretch=STRETCH, fineness=FINENESS)
    best = near[np.argmax(gains(near, DURATION))]
    assert abs(best - frequency) < 1.0 / DURATION
    assert looked_at < 0.05 * len(whole) * len(time)


def test_all_frequencies_of_a_short_record_are_looked_at():
    whole = np.arange(0.02, 2.0, 0.0025)
    assert worth_a_look(lambda grid, stretch: grid, whole, duration=100.0, stretch=100.0, fineness=4.0) is whole


@pytest.mark.parametrize("samples", ["anywhere", "even", "some left out"])
def test_gains_of_waves_in_stick_are_those_of_least_squares(samples):
    generator = np.random.default_rng(2)
    segment = np.repeat(np.arange(6), (20, 31, 25, 40, 22, 18))
    time = np.sort(generator.uniform(0.0, 10.0, len(segment)))
    if samples != "anywhere":  # pauses between the phases
        time = 0.05 * np.arange(len(segment)) + 0.618 * segment
    if samples == "some left out":
        kept = generator.uniform(size=len(segment)) > 0.1
        segment, time = segment[kept], time[kept]

    def centred(column):
        means = np.bincount(segment, column) / np.bincount(segment)
        return column - means[segment]

    line, values = centred(time), centred(generator.standard_normal(len(time)))
    line = line / np.linalg.norm(line)
    rest = values - line * (line @ values)
    grid = np.array([0.31, 0.9, 2.2])
    result = wave_gains(grid, time, segment, line, rest)
    for frequency, gain in zip(grid, result, strict=True):
        waves = [centred(f(2.0 * np.pi * frequency * time)) for f in (np.cos, np.sin)]
        design = np.stack([line, *waves], axis=1)
        left = rest - design @ np.linalg.lstsq(design, rest)[0]
        assert gain == pytest.approx(rest @ rest - left @ left, rel=1e-9)


@pytest.mark.slow
def test_a_stretch_in_the_middle_stands_for_a_long_record():
    box = load_scenario("kang2015_table1").mechanism
    system = augmented_system(box, make_law("coulomb", mu_s=0.8, mu_k=0.46))
    motion = system.march(Start(0.0, 0.0, box.belt_velocity, stick=True), 1.0e-3, 450_000)
    noise = 5.0e-6 * np.random.default_rng(1).standard_normal(len(motion.position))
    slips = extract(make_record("run", 1.0e-3 * np.arange(len(noise)), motion.position + noise, box))
    assert len(slips) > FORECAST
    stretch = middle(slips)
    assert len(stretch) == SIMULATED
    again = extract(stretch.record, ridge=slips.ridge)
    # the first and the last slip are too near to the ends to be located
    assert SIMULATED - 2 <= len(again) <= SIMULATED
    inner = np.searchsorted(stretch.onset_time, again.onset_time[0] - 0.1)
    np.testing.assert_allclose(again.onset_time, stretch.onset_time[inner : inner + len(again)], atol=1.0e-9)
    assert middle(stretch) is stretch
    windows = windows_of(slips)
    assert FORECAST - 5 <= len(windows) <= FORECAST
    assert np.ptp(windows.starts[:, 0]) > 0.95 * np.ptp(slips.onset_time)
