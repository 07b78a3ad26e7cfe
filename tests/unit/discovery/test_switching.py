"""Levels and jumps in made-up slips: what switches at random, what changes in its own way, what repeats."""

from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
import pytest

from stochfric_mb.discovery.stick_slip.screening.switching import JUMPS, SWITCHES, switching

N, RUNS, CYCLE = 50, 2, 1.1
NOISE = 0.003


@dataclass
class Pool:
    """Slips at a regular pace, as many as the tests need of a pool."""

    run: np.ndarray = field(default_factory=lambda: np.repeat(np.arange(RUNS), N))
    n_runs: int = RUNS
    duration: float = N * CYCLE
    typical_onset: float = 0.0
    kept: np.ndarray = field(default_factory=lambda: np.ones(N * RUNS, dtype=bool))
    onset_time: np.ndarray = field(default_factory=lambda: np.tile(CYCLE * np.arange(N), RUNS))
    belt_velocity: np.ndarray = field(default_factory=lambda: np.full(N * RUNS, 2.5e-3))

    @property
    def rows(self):
        return [np.flatnonzero(self.kept & (self.run == r)) for r in range(RUNS)]

    @property
    def calibrations(self):
        return [SimpleNamespace(covariance=NOISE**2 * np.eye(8))] * RUNS

    @property
    def slips(self):
        box = SimpleNamespace(belt_velocity=2.5e-3)
        one = SimpleNamespace(cycle=CYCLE, record=SimpleNamespace(mechanism=box))
        return [one] * RUNS


def pattern(onset: np.ndarray, slip: np.ndarray | None = None):
    generator = np.random.default_rng(1)
    residuals = NOISE * generator.standard_normal((N * RUNS, 8))
    residuals[:, 0] += onset
    residuals[:, 1] += onset if slip is None else slip
    return switching(Pool(), residuals)


def draws(seed: int = 3) -> np.random.Generator:
    return np.random.default_rng(seed)


def time() -> np.ndarray:
    return Pool().onset_time


def test_random_levels_are_told_from_everything_else():
    state = np.cumsum(draws().random(N * RUNS) < 0.3) % 2
    assert pattern(0.2 * state).where is SWITCHES


def test_levels_that_stay_for_long_are_jumps():
    levels = np.repeat([0.0, 0.9, 0.3, 1.4, 0.6, -0.5, 0.1, 1.1, -0.2, 0.7], N * RUNS // 10)
    assert pattern(np.zeros(N * RUNS), 0.3 * levels).where is JUMPS


@pytest.mark.parametrize("period", [4.3, 9.7])
def test_square_ripple_switches_regularly(period):
    run = Pool().run
    square = np.sign(np.sin(2.0 * np.pi * (time() / period + 0.37 * run)))
    assert pattern(0.2 * square).where is None


@pytest.mark.parametrize(
    "scatter",
    [
        draws().standard_normal(N * RUNS),
        draws().uniform(-1.7, 1.7, N * RUNS),
        np.sin(2.0 * np.pi * time() / 7.3),
        np.cumsum(draws().standard_normal(N * RUNS)) / 5.0,
        time() / 20.0,
    ],
    ids=["normal draws", "even draws", "sine", "wander", "drift"],
)
def test_what_changes_from_every_slip_to_the_next_does_not_switch(scatter):
    assert pattern(0.1 * scatter).where is None


def test_one_step_of_a_sensor_is_no_switching():
    assert pattern(0.3 * (time() > 20.0)).where is None


def test_noise_alone_does_not_switch():
    assert pattern(np.zeros(N * RUNS)).where is None


def test_single_slips_that_stand_out_are_no_levels():
    onset = np.zeros(N * RUNS)
    onset[[7, 23, 61]] = 0.9
    shown = pattern(onset)
    assert (shown.rarer, shown.jumps, shown.where) == (3, 0, None)
