"""Where balances come from: places with their loads, runs by role, the stated model."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.simulation.scores import APART, floor_from, noise_floor, white_floor
from stochfric_mb.discovery.driven_joint.source import source_of
from stochfric_mb.effects import make_effect
from stochfric_mb.errors import InputError
from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.scenario import any_scenario_from_dict
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


def test_a_stated_delay_in_milliseconds_is_refused():
    """It ended in an error that asked for swapped columns: friction brought in energy."""
    dataset = pair(coulomb)
    late = dataclasses.replace(dataset.scenario, effects=(make_effect("sensor_delay", delay=8.0),))
    with pytest.raises(InputError, match=r"sensor_delay is late by 8 s, more than 12\.5 % of the shortest run \(7\.999 s\)"):
        source_of(dataclasses.replace(dataset, scenario=late))


def test_the_conditions_of_a_balance_are_those_at_its_centres():
    balance = source_of(pair(coulomb)).balances("", "fit", 0.0)[0]
    assert set(balance.factors) == {"direction", "speed", "position", "load", "time", "distance"}
    np.testing.assert_array_equal(balance.factors["speed"], np.abs(balance.velocity[balance.window.centres]))


def test_another_length_of_a_pendulum_is_what_its_column_and_bend_say():
    t = np.arange(4000) / 500.0
    angle = 0.6 * np.sin(2.0 * t) + 0.2 * np.sin(5.0 * t)

    def driven(length):
        tables = {
            "schema": "stochfric.scenario/1",
            "mechanism": {"kind": "hinge_pendulum", "mass": 1.2, "length": length, "inertia": 0.03, "normal_force": 1.0},
            "law": {"kind": "coulomb", "mu_s": 0.5, "mu_k": 0.5},
            "simulation": {"duration": 8.0, "output_step": 2.0e-3},
        }
        channels = {"position": angle, "torque": np.sin(3.0 * t)}
        runs = tuple(Run(name=r, role=r, time=t, channels=channels, sample_interval=1.0 / 500.0) for r in ("fit", "test"))
        source = source_of(Dataset(title="", scenario=any_scenario_from_dict(tables), runs=runs))
        return source.balances("", "fit", 0.0)[0]

    stated, longer, off = driven(0.3), driven(0.345), 0.045
    change = off * (stated.columns["length"] + off * stated.bends["length"])
    np.testing.assert_allclose(stated.driven - change, longer.driven, atol=1e-12)  # of 2.8 N m, exact but for rounding


def test_windows_without_neighbours_leave_the_white_noise_of_the_channels_as_the_noise():
    """A free pole with a coarse encoder asks for windows so wide that nothing is known of its noise; it was `unknown`."""
    source = source_of(pair(coulomb))
    (balance,) = source.balances("", "fit", 0.0)
    model, nuisances = source.stated(""), source.nuisances("")
    plain = noise_floor(model, [balance], nuisances)
    few = np.zeros_like(balance.sliding)
    for start in range(0, len(few) - APART, 4 * APART):
        few[start : start + APART] = True
    alone = dataclasses.replace(balance, sliding=balance.sliding & few)
    seen = noise_floor(model, [alone], nuisances)
    assert seen == white_floor([alone])
    # both channels have white noise alone, of which the differences tell as much
    assert seen == pytest.approx(plain, rel=0.1)
    assert floor_from([alone]).startswith("white noise")
    assert floor_from([balance]).startswith("differences")
