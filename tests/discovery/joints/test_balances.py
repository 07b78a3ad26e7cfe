"""Where balances come from: places with their loads, runs by role, the stated model."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.effects import make_effect
from tests.discovery.joints.test_parts import coulomb, pair


def test_a_slide_is_one_place_without_a_name():
    source = source_of(pair(coulomb))
    assert isinstance(source, Balances)
    assert list(source.places) == [""]
    assert not source.coupled("")
    assert not source.rotates("")
    assert [b.run for b in source.balances("", "test", 0.0)] == [r.name for r in source.dataset.test]


def test_the_stated_model_has_the_effects_of_the_mean_friction_alone():
    dataset = pair(coulomb)
    effects = (make_effect("viscous_friction", coefficient=1.0), make_effect("sensor_delay", delay=0.002))
    source = source_of(dataclasses.replace(dataset, scenario=dataclasses.replace(dataset.scenario, effects=effects)))
    model = source.stated("")
    assert [e.kind for e in model.effects] == ["viscous_friction"]
    assert source.stated_delay == pytest.approx(0.002)
    assert (model.law, model.load) == (dataset.scenario.law, source.places[""])
    assert model.level == (dataset.scenario.law.mu_k, np.inf)  # nothing is said of how well it is known


def test_the_conditions_of_a_balance_are_those_at_its_centres():
    balance = source_of(pair(coulomb)).balances("", "fit", 0.0)[0]
    assert set(balance.factors) == {"direction", "speed", "position", "load", "time", "distance"}
    np.testing.assert_array_equal(balance.factors["speed"], np.abs(balance.velocity[balance.window.centres]))
