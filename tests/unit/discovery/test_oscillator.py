"""A light oscillator on the box: driven by what was measured it moves as it does in the simulation."""

import math

import numpy as np
import pytest

from stochfric_mb.discovery.stick_slip.records.calibration import calibrate
from stochfric_mb.discovery.stick_slip.records.pool import make_pool
from stochfric_mb.discovery.stick_slip.records.record import make_record
from stochfric_mb.discovery.stick_slip.records.slips import extract
from stochfric_mb.discovery.stick_slip.simulation.auxiliary_state import auxiliary_state
from stochfric_mb.effects import make_effect
from stochfric_mb.effects.oscillator import oscillator_pull
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference.augmented import Start, augmented_system

BOX = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
FREQUENCY, RATIO = 9.0, 0.02
W = 2.0 * math.pi * FREQUENCY
NOISE = 5e-6


@pytest.fixture(scope="module")
def rig():
    """System, record of 20 s, and the oscillator's position and velocity at every sample; it is light: no back-action."""
    effect = make_effect("second_mode", mass_ratio=1e-9, frequency=FREQUENCY, damping_ratio=RATIO)
    system = augmented_system(BOX, make_law("coulomb", mu_s=0.8, mu_k=0.46), [effect])
    state = system.march(Start(-10.0, 0.0, BOX.belt_velocity, stick=True), 1e-3, 10_000).end
    begin, states = state, []
    for _ in range(20_000):
        state = system.march(state, 1e-3, 1).end
        states.append((state.position, state.velocity, *state.memory))
    table = np.array(states)
    time = begin.time + 1e-3 * np.arange(1, 20_001)
    noise = NOISE * np.random.default_rng(3).standard_normal(len(time))
    return system, make_record("run", time, table[:, 0] + noise, BOX), table


def test_the_memory_is_recalled_from_the_record(rig):
    system, record, table = rig
    at = np.array([8_000, 12_345, 19_000])
    result = auxiliary_state(system, record, record.time[at], table[at, 0])
    ringing = np.abs(table[:, 2] - table[:, 0]).max()
    # begun at rest 8 s before, or 8 s of e^(-z w t): 1e-4 is left; the noise of the record, narrow-banded, gives the rest
    assert np.abs(result[:, 0] - table[at, 2]).max() < 0.03 * ringing
    assert np.abs(result[:, 1] - table[at, 3]).max() < 0.03 * ringing * W


def test_a_recalled_memory_makes_a_forecast_go_on(rig):
    _, record, _ = rig
    heavy = make_effect("second_mode", mass_ratio=0.05, frequency=FREQUENCY, damping_ratio=RATIO)
    system = augmented_system(BOX, make_law("coulomb", mu_s=0.8, mu_k=0.46), [heavy])
    begin = system.march(Start(-10.0, 0.0, BOX.belt_velocity, stick=True), 1e-3, 10_000).end
    motion = system.march(begin, 1e-3, 12_000)
    record = make_record("run", motion.time, motion.position + NOISE * np.random.default_rng(3).standard_normal(12_000), BOX)
    stuck = np.flatnonzero(motion.stick > 0.5)
    first = int(stuck[stuck > 8_000][300])
    start = [(motion.time[first], motion.position[first], BOX.belt_velocity, 1.0, 0.3)]
    memory = auxiliary_state(system, record, motion.time[[first]], motion.position[[first]])
    known, rest = (system.forecasts(start, 1e-3, 1200, m)[0] for m in (memory, None))
    truth = motion.position[first + 1 : first + 1201]
    assert np.abs(known - truth).mean() < 0.1 * np.abs(rest - truth).mean()


def test_an_effect_without_memory_has_nothing_to_recall(rig):
    _, record, _ = rig
    system = augmented_system(
        BOX, make_law("coulomb", mu_s=0.8, mu_k=0.46), [make_effect("quadratic_damping", coefficient=1.0)]
    )
    assert auxiliary_state(system, record, record.time[[5_000]], record.position[[5_000]]) is None


def test_pull_in_the_slips_is_that_of_the_simulation(rig):
    _, record, table = rig
    slips = extract(record)
    pool = make_pool([slips], [calibrate(slips)])
    onset, nodes = oscillator_pull(pool, FREQUENCY, RATIO)
    pull = W**2 * (table[:, 2] - table[:, 0]) + 2.0 * RATIO * W * (table[:, 3] - table[:, 1])
    true_onset, true_nodes = (np.interp(t, record.time, pull) for t in (pool.onset_time, pool.node_time))
    # the acceleration is that of a polynomial of order 9 that meets the belt, off where it jumps
    settled = slice(3, None)
    assert np.abs(nodes - true_nodes)[settled].mean() < 0.05 * np.abs(pull).max()
    assert np.abs(onset - true_onset)[settled].mean() < 0.05 * np.abs(pull).max()
