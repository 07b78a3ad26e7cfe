"""The gap in single readings: strays by a proper score, a late position against a velocity, and nothing for other effects."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import norm

from stochfric_mb.discovery.stick_slip.records.record import make_record
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.validation.reading_skill import reading_gap
from stochfric_mb.effects import make_effect
from stochfric_mb.laws.coulomb import Coulomb
from stochfric_mb.mechanisms import BeltBox

BOX = BeltBox(mass=1.0, stiffness=400.0, damping=0.5, normal_force=10.0, belt_velocity=0.1)
NOISE = 2.0e-6
SIZE, SHARE = 4.0e-5, 0.004


def moving(seed, share=0.0, size=SIZE, late=0.0, count=60000):
    """A smooth motion sampled at 2 kHz with noise, some readings off, and its velocity with noise."""
    rng, time = np.random.default_rng(seed), np.arange(count) / 2000.0
    position = 2e-3 * np.sin(5.0 * (time - late)) + 1e-3 * np.sin(11.3 * (time - late) + 1.0)
    velocity = 1e-2 * np.cos(5.0 * time) + 1.13e-2 * np.cos(11.3 * time + 1.0) + 1e-4 * rng.standard_normal(count)
    stray = rng.random(count) < share
    reading = position + NOISE * rng.standard_normal(count) + stray * size * rng.standard_normal(count)
    return make_record(f"run {seed}", time, reading, BOX), velocity


def model(kind, measured=(), **numbers):
    effects = (make_effect(kind, **numbers),)
    return Model(Coulomb(mu_s=0.5, mu_k=0.4), {}, effects, measured=dict.fromkeys(measured, 1e-5))


def study(records, runs=()):
    return SimpleNamespace(records=tuple(records), dataset=SimpleNamespace(test=tuple(runs)))


STRAYS = model("sensor_outliers", fraction=SHARE, size=SIZE)


def test_strays_as_in_the_fit_runs_score_what_their_mixture_does():
    fit, held = moving(1, SHARE)[0], moving(2, SHARE)[0]
    gap = reading_gap(STRAYS, study([fit]), [held])
    noise = NOISE * np.sqrt(1.0 + 34.0 / 36.0)  # of a reading less a cubic through four others, 1, 4, 4 and 1 sixths of them
    # scipy's normal distribution, readings drawn anew: strays are seen from around them alone
    rng = np.random.default_rng(3)
    drawn = noise * rng.standard_normal(400000) + (rng.random(400000) < SHARE) * SIZE * rng.standard_normal(400000)
    calm, wide = norm.pdf(drawn, scale=noise), norm.pdf(drawn, scale=np.hypot(noise, SIZE))
    before = -np.mean(norm.logpdf(drawn, scale=noise)) - np.log(noise)
    floor = -np.mean(np.log((1.0 - SHARE) * calm + SHARE * wide)) - np.log(noise)
    assert gap.baseline == gap.recalibrated == pytest.approx(before, rel=0.1)  # 240 strays, squares of normal numbers: 9 %
    assert gap.floor == pytest.approx(floor, rel=0.01)
    assert gap.augmented == pytest.approx(floor, rel=0.01)
    assert gap.closed == pytest.approx(1.0, abs=0.05)


def test_strays_that_do_not_come_again_close_nothing():
    gap = reading_gap(STRAYS, study([moving(1, SHARE)[0]]), [moving(2)[0]])
    assert gap.augmented > gap.recalibrated
    assert gap.closed is None or gap.closed <= 0.0


def test_strays_of_another_size_close_less():
    fit, farther = moving(1, SHARE)[0], moving(2, SHARE, size=10.0 * SIZE)[0]
    gap = reading_gap(STRAYS, study([fit]), [farther])
    right = reading_gap(model("sensor_outliers", fraction=SHARE, size=10.0 * SIZE), study([fit]), [farther])
    assert right.augmented < gap.augmented < gap.recalibrated


@pytest.mark.parametrize("late", [0.004, -0.0021])
def test_a_late_position_against_a_velocity(late):
    record, velocity = moving(4, late=late)
    run = SimpleNamespace(name=record.name, channels={"velocity": velocity})
    gap = reading_gap(model("sensor_delay", ("delay",), delay=abs(late)), study([record], [run]), [record])
    # of x' = sum of a w cos(wt): each rms a w/sqrt(2), shifted by T: times 2 sin(w T/2); and the noise beside it
    moved = [1e-2 * 2.0 * np.sin(2.5 * abs(late)), 1.13e-2 * 2.0 * np.sin(5.65 * abs(late))]
    assert gap.recalibrated == pytest.approx(np.hypot(np.hypot(*moved) / np.sqrt(2.0), gap.floor), rel=0.01)
    assert (gap.closed > 0.98) == (late > 0.0)  # moved the wrong way it is off by more
    if late < 0.0:
        assert gap.augmented > 1.9 * gap.recalibrated


def test_a_late_position_without_a_velocity_and_other_effects_have_none():
    record, velocity = moving(5, late=0.004)
    plain = SimpleNamespace(name=record.name, channels={})
    both = SimpleNamespace(name=record.name, channels={"velocity": velocity})
    late = model("sensor_delay", ("delay",), delay=0.004)
    assert reading_gap(late, study([record], [plain]), [record]) is None
    assert reading_gap(dataclasses.replace(late, measured={}), study([record], [both]), [record]) is None
    assert reading_gap(late, study([record], [both]), []) is None
    assert reading_gap(model("viscous_friction", coefficient=1.0), study([record], [both]), [record]) is None
