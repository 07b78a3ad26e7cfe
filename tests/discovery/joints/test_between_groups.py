"""Scatter from group to group: found with its size, and nothing beyond what is believed already."""

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.scatter.between_groups import CoefficientScatter, estimated, means_of

MU_K, SIGMA, ERROR = 0.2, 0.02, 0.005
"""mu_k, its scatter from group to group, and how well each group is known [-]."""
TRIED = np.logspace(-2.0, 2.5, 200)


def groups(scatter):
    rng = np.random.default_rng(3)
    settings = np.repeat([0, 1], 100)
    delta = np.array([0.01, -0.02])[settings] + np.hypot(scatter, ERROR) * rng.standard_normal(200)
    return delta, np.full(200, ERROR**2), settings


def seen(scatter, believed=0.0):
    return CoefficientScatter(**estimated(*groups(scatter), TRIED, believed=believed, mu_k=MU_K), gain=0.5)


def test_it_is_named_with_its_size():
    found = seen(SIGMA)
    assert found.named
    assert found.low < SIGMA < found.high
    # the variance of 198 free numbers is known to sqrt(2/198) = 10 %, the deviation to 5 %; four standard errors
    assert found.sigma == pytest.approx(SIGMA, rel=0.2)
    assert found.share == found.sigma / MU_K


def test_none_is_none_and_what_is_believed_is_no_finding():
    assert not seen(0.0).named
    stated = seen(SIGMA, believed=SIGMA)
    assert not stated.named
    assert stated.accounted


def test_means_are_those_of_settings():
    mean, weight = means_of(np.array([1.0, 3.0, 5.0]), np.array([1.0, 1.0, 4.0]), np.array([0, 0, 1]))
    np.testing.assert_allclose(mean, [2.0, 2.0, 5.0])
    np.testing.assert_allclose(weight, [2.0, 0.25])
