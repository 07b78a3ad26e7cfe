"""Where waves are sought and what imitates an effect: beliefs count as they do in the fits."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.fit.fitting import fit
from stochfric_mb.discovery.driven_joint.fit.gains import hidden_share
from stochfric_mb.discovery.driven_joint.fit.wave_scan import wave_starts, waves_left
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.effects import make_effect
from stochfric_mb.effects.contract import Scan
from stochfric_mb.measurement import Dataset
from tests.discovery.joints.test_parts import coulomb, pair, sine_run, wave

FREQUENCY, SPEED = 1.0, 0.5
"""Of a sine motion [Hz] and its largest speed [m/s]."""


def fitted(measured: Dataset):
    source = source_of(measured)
    balances, nuisances = source.balances("", "fit", 0.0), source.nuisances("")
    model = source.stated("")
    return balances, fit(model, balances, nuisances, noise=0.2)


def starts_of(scan, seen, balances):
    return wave_starts(scan, waves_left(scan, seen, balances), balances)


def test_a_force_at_the_frequency_of_the_motion_is_sought_where_the_mass_is_believed():
    measured = pair(coulomb)
    joint = dataclasses.replace(measured.scenario.mechanism, damping=1.0)
    believed = {"mass": 1.0e-4, "damping": 1.0e-4}
    scenario = dataclasses.replace(measured.scenario, mechanism=joint, uncertainty=believed)
    time = measured.runs[0].time - measured.runs[0].time[0]
    angle = 2.0 * np.pi * FREQUENCY * time
    noise = np.random.default_rng(2).standard_normal((2, time.size))
    friction = 2.0 * np.sign(np.cos(angle)) + np.cos(angle) * SPEED  # of which the mean is damping
    force = -2.0 * np.pi * FREQUENCY * joint.mass * SPEED * np.sin(angle) + friction + 3.0 * np.cos(angle + 1.0)
    reading = SPEED / (2.0 * np.pi * FREQUENCY) * np.sin(angle) + 1.0e-6 * noise[0]
    channels = {"position": reading, "force": force + 0.02 * noise[1]}
    runs = tuple(dataclasses.replace(r, channels=channels) for r in measured.runs)
    balances, seen = fitted(dataclasses.replace(measured, scenario=scenario, runs=runs))

    def begin(frequency: float, a: float, b: float):
        return make_effect("harmonic_force", amplitude=float(np.hypot(a, b)), frequency=frequency, phase=0.0)

    starts = starts_of(Scan("time", False, 0.5, 3.0, begin), seen, balances)
    assert starts[0].effect.frequency == pytest.approx(FREQUENCY, abs=1.0 / (time[-1]))  # as well as waves are told apart
    assert starts[0].effect.amplitude == pytest.approx(3.0, rel=0.2)  # friction takes some of it


def test_a_wave_is_sought_in_the_runs_that_slide():
    still = sine_run(wave, seed=3, gain=1.0e-9)
    balances, seen = fitted(dataclasses.replace(pair(wave), runs=(sine_run(wave, seed=1), still)))
    assert balances[0].sliding.any()
    assert not balances[1].sliding.any()

    def begin(number: float, a: float, b: float):
        return make_effect("position_dependent_friction", amplitude=float(np.hypot(a, b)), wavelength=1.0 / number, phase=0.0)

    starts = starts_of(Scan("position", True, 5.0, 20.0, begin), seen, balances)
    stroke = float(np.ptp(balances[0].position))
    assert 1.0 / starts[0].effect.wavelength == pytest.approx(1.0 / 0.08, abs=0.5 / stroke)  # the wave of 0.08 m


@pytest.mark.parametrize(("deviation", "imitates"), [(1.0e-3, False), (10.0, True)])
def test_a_number_that_is_believed_imitates_nothing(deviation, imitates):
    measured = pair(lambda q, v: coulomb(q, v) + v)
    joint = dataclasses.replace(measured.scenario.mechanism, damping=1.0)
    believed = {"mass": 0.05, "damping": deviation}
    measured = dataclasses.replace(
        measured, scenario=dataclasses.replace(measured.scenario, mechanism=joint, uncertainty=believed)
    )
    balances, seen = fitted(measured)
    share = hidden_share(make_effect("viscous_friction", coefficient=1.0), balances, seen)
    # friction of another size imitates the mean of it: mean over rms, squared, is 0.81 for one sine
    assert share > 0.99 if imitates else share < 0.81
