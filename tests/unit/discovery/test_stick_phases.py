"""What stands out while the box sticks: a step of the reading against a reading that drifts."""

from types import SimpleNamespace

import numpy as np
import pytest

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.records.stick_phases import _alike, _creep, _gain, _Phases, _ringing, _step

PHASES, SAMPLES = 12, 40


def stick_phases(course):
    """Return the one run, and what is left in its phases, each less its mean: noise of 1 and a course in time."""
    time = np.arange(PHASES * SAMPLES) / SAMPLES
    segment = np.repeat(np.arange(PHASES), SAMPLES)
    shown = course(time) + np.random.default_rng(4).standard_normal(len(time))
    rest = shown - np.array([shown[segment == s].mean() for s in range(PHASES)])[segment]
    return [SimpleNamespace(samples=SimpleNamespace(time=time, segment=segment))], [rest]


@pytest.mark.parametrize("course", [lambda t: 0.0 * t, lambda t: 8.0 * t, lambda t: 20.0 * np.tanh((t - 6.0) / 5.0)])
def test_a_drift_is_no_step(course):
    """An S in time is steepest in the middle: one phase shows more of it than the others."""
    fall, _, jumps = _step(*stick_phases(course))
    assert jumps == 0
    assert fall < criteria.PHASE_JUMPED


@pytest.mark.parametrize("slope", [0.0, 8.0])
def test_a_step_is_found_on_a_drift(slope):
    fall, times, jumps = _step(*stick_phases(lambda t: slope * t + 6.0 * (t > 4.4)))
    assert jumps == 1
    assert times[0] == pytest.approx(4.4, abs=0.06)
    # of 36 times n/4 that a step in the middle has, the phase's own slope takes three quarters
    assert fall == pytest.approx(36.0 * SAMPLES / 16.0, rel=0.4)


@pytest.mark.parametrize(("rate", "least", "most"), [(1.0, 0.95, 1.0), (1.37, 0.0, 0.2)])
def test_only_a_wave_that_keeps_to_the_phases_is_the_same_in_all_of_them(rate, least, most):
    """Ten waves of 1.37 cycles a phase meet the phases elsewhere each: what they share explains a fifth at most."""
    time = np.arange(PHASES * SAMPLES) / SAMPLES
    segment = np.repeat(np.arange(PHASES), SAMPLES)
    since = time % 1.0
    samples = SimpleNamespace(time=time, segment=segment, since_restick=since, to_onset=1.0 - since)
    wave = np.sin(2.0 * np.pi * rate * time)
    values = wave - np.array([wave[segment == s].mean() for s in range(PHASES)])[segment]
    line = since - since.mean()
    run = _Phases(SimpleNamespace(), samples, values, line, 1.0)
    rest = run.rest([])
    share = _gain([run], [rest], _alike) / float(rest @ rest)
    assert least <= share <= most


def test_what_creeps_and_rings_at_once_is_counted_once():
    """Scores of either were added up: together they explained 1.8 times what was there."""
    time = np.arange(PHASES * SAMPLES) / SAMPLES
    segment = np.repeat(np.arange(PHASES), SAMPLES)
    since = time % 1.0
    samples = SimpleNamespace(time=time, segment=segment, since_restick=since, to_onset=1.0 - since)
    rig = SimpleNamespace(record=SimpleNamespace(angular_frequency=6.0))
    shown = 30.0 * np.exp(-8.0 * since) + np.random.default_rng(2).standard_normal(len(time))
    values = shown - np.array([shown[segment == s].mean() for s in range(PHASES)])[segment]
    run = _Phases(rig, samples, values, since - since.mean(), 1.0)
    rest, log_n, ring = run.rest([]), float(np.log(len(time))), (9.0, 0.2)
    there = float(rest @ rest)
    creeps = _creep([run], [rest], log_n)["creep_after"]
    rings = _gain([run], [rest], lambda one: _ringing(one, *ring)) - 2.0 * log_n
    both = _creep([run], [rest], log_n, ring)["creep_after"]
    assert max(creeps, rings) - 2.0 * log_n < both < there < creeps + rings
