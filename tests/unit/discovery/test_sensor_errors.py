"""Noise makes other errors in the features of slips that begin slowly than in those that begin at once."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.stick_slip.records.record import Noise, make_record
from stochfric_mb.discovery.stick_slip.records.slips import extract
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.scatter import shown_by
from stochfric_mb.discovery.stick_slip.simulation.sensor_errors import errors_by_noise
from stochfric_mb.effects import make_effect
from stochfric_mb.laws import make_law
from stochfric_mb.mechanisms import BeltBox

BOX = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
NOISE = 5e-6
PLAIN = Model(make_law("coulomb", mu_s=0.8, mu_k=0.46), {})
SLOW = PLAIN.plus(make_effect("frictional_lag", distance=1e-4))


def recorded(model: Model, noise: float, seed: int):
    """Slips of 40 s of the model, with white noise."""
    time = np.arange(40001) * 1e-3
    blank = make_record("run", time, BOX.belt_velocity * time, BOX)
    shown = shown_by(model, extract(blank, noise=Noise(NOISE)), np.random.default_rng(0))
    return extract(make_record("run", time, shown + noise * np.random.default_rng(seed).standard_normal(time.size), BOX))


@pytest.fixture(scope="module")
def slow():
    return recorded(SLOW, NOISE, 1)


def test_covariance_is_what_the_features_of_a_record_scatter_by(slow):
    """All slips of the model are alike, so that what they scatter by is the noise."""
    records = [slow, *(recorded(SLOW, NOISE, seed) for seed in (2, 3, 4))]
    ratios = [np.std(r.features, axis=0) / np.sqrt(np.diag(errors_by_noise(SLOW, r).covariance)) for r in records]
    # deviations of some 37 slips are known to 1/sqrt(74) each; an edge missed by far in one slip makes that 0.25, of four
    # records 0.13, and three of those
    np.testing.assert_allclose(np.exp(np.mean(np.log(ratios), axis=0)), 1.0, atol=0.4)


def test_a_slow_beginning_costs_more(slow):
    errors = {model: errors_by_noise(m, slow) for model, m in (("slow", SLOW), ("plain", PLAIN))}
    onset = {name: np.sqrt(e.covariance[0, 0]) for name, e in errors.items()}
    assert onset["slow"] > 3.0 * onset["plain"]
    # the mean of 90 errors is known to a tenth of their deviation
    assert abs(errors["plain"].bias[0]) < 0.4 * onset["plain"]


def test_too_few_slips_tell_nothing(slow):
    short = dataclasses.replace(slow.record, time=slow.record.time[:3000])
    assert errors_by_noise(SLOW, dataclasses.replace(slow, record=short)) is None


def test_no_noise_no_errors():
    quiet = recorded(PLAIN, 1e-12, 1)
    errors = errors_by_noise(PLAIN, quiet)
    np.testing.assert_allclose(errors.bias, 0.0, atol=1e-4)  # N
    np.testing.assert_allclose(errors.covariance, 0.0, atol=1e-8)  # N^2
