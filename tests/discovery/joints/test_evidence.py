"""Evidence with two variances, against closed forms; which parts of records are left out."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.decision import cross_validation
from stochfric_mb.discovery.driven_joint.decision.cross_validation import blocks, compared, strokes
from stochfric_mb.discovery.driven_joint.fit.evidence import scatter, settings_of, whitened
from stochfric_mb.discovery.driven_joint.fit.fitting import stroke_count
from stochfric_mb.discovery.driven_joint.fit.joint_model import JointModel
from stochfric_mb.effects import make_effect
from stochfric_mb.laws import make_law
from tests.discovery.joints.test_parts import balance_of, coulomb, scenario, sine_run


def grouped(between, within, *, groups=200, size=20, seed=0):
    rng = np.random.default_rng(seed)
    labels = np.repeat(np.arange(groups), size)
    return between * rng.standard_normal(groups)[labels] + within * rng.standard_normal(groups * size), labels


def test_one_setting_has_the_deviance_of_its_mean_square():
    rest = np.array([1.0, -2.0, 3.0])
    seen = scatter(rest, np.zeros(3, dtype=np.int64), 2.5)
    # about zero, not about the mean: what a model leaves has no mean of its own
    assert seen.deviance == pytest.approx(2.5 * np.log(np.mean(rest**2)))
    assert seen.ratio == 0.0


def test_two_variances_are_told_apart():
    rest, labels = grouped(0.5, 1.0)
    seen = scatter(rest, labels, float(len(rest)))
    # 1/sqrt(2 (groups - 1)) of the standard deviation of the groups' means, 0.55, is 0.03; ratios are tried in steps of 33 %
    assert seen.between == pytest.approx(0.5, abs=0.09)
    assert seen.within == pytest.approx(1.0, abs=0.05)


def test_without_scatter_between_settings_none_is_found():
    rest, labels = grouped(0.0, 1.0, seed=1)
    assert scatter(rest, labels, float(len(rest))).between < 0.1


def test_whitening_takes_out_means_where_settings_scatter_without_limit():
    rest, labels = grouped(2.0, 1.0, groups=5)
    inside = whitened(rest[:, None], labels, float(len(rest)), 1.0e12)[:, 0]
    means = np.bincount(labels, rest) / np.bincount(labels)
    np.testing.assert_allclose(inside, rest - means[labels], atol=1e-5)  # means are left by 1/sqrt(ratio size) of their size
    np.testing.assert_allclose(whitened(rest[:, None], labels, float(len(rest)), 0.0)[:, 0], rest)


@pytest.fixture(scope="module")
def balances():
    return [balance_of(sine_run(coulomb, seed=s), scenario()) for s in (1, 2)]


def test_blocks_and_strokes_are_all_of_the_sliding_once(balances):
    for parts in (blocks(balances), strokes(balances), strokes(balances[:1])):
        for i, balance in enumerate(balances[: len(parts[0])]):
            times = np.sum([part[i] for part in parts], axis=0)
            np.testing.assert_array_equal(times, balance.sliding.astype(int))


def test_one_run_is_left_out_by_strokes_and_several_by_their_directions(balances):
    assert len(strokes(balances[:1])) == stroke_count([balances[0].sliding])
    assert len(strokes(balances)) == 4
    assert len(np.unique(settings_of(balances))) == 4
    assert len(np.unique(settings_of(balances[:1]))) == 1


def test_many_parts_are_left_out_together(balances, monkeypatch):
    plain = JointModel(make_law("coulomb", mu_s=0.1, mu_k=0.1), (), {}, 20.0)
    richer = dataclasses.replace(plain, effects=(make_effect("viscous_friction", coefficient=0.05),))
    parts, fits = blocks(balances, 60), []
    fitted = cross_validation.fit
    monkeypatch.setattr(cross_validation, "fit", lambda *a, **k: fits.append(1) or fitted(*a, **k))
    seen = compared(plain, richer, balances, [], 0.05, parts)
    assert (len(fits), seen.parts) == (2 * cross_validation.MOST_FITS, 60)
    monkeypatch.setattr(cross_validation, "MOST_FITS", 60)
    single = compared(plain, richer, balances, [], 0.05, parts)
    assert len(fits) == 2 * 24 + 2 * 60
    # three parts of 60 are missing in place of one: numbers that 57 blocks tell are a hundredth of the noise in a block off
    assert seen.without == pytest.approx(single.without, rel=1e-3)
    assert seen.with_ == pytest.approx(single.with_, rel=1e-3)
