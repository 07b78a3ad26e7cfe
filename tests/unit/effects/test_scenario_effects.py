import dataclasses

import numpy as np
import pytest

from stochfric_mb.coefficients import Knots, OrnsteinUhlenbeck, PerEvent
from stochfric_mb.effects import make_effect
from stochfric_mb.effects.combine import with_compliance
from stochfric_mb.errors import InputError
from stochfric_mb.laws import make_law
from stochfric_mb.reference import simulate
from stochfric_mb.scenario import load_scenario, scenario_from_dict
from stochfric_mb.storage import read_trajectory, write_trajectory
from tests.unit.effects.examples import example


def _scenario(*effects, law="coulomb", **changes):
    base = load_scenario("kang2015_table1", law=law)
    return dataclasses.replace(base, process=None, duration=1.2, output_step=1.0e-3, effects=effects, **changes)


def test_round_trip_and_overrides(tmp_path):
    import tomli_w

    scenario = _scenario(example("dwell_ageing"), example("friction_drift"), example("random_coefficients"))
    assert scenario_from_dict(scenario.to_dict()) == scenario
    file = tmp_path / "augmented.toml"
    file.write_text(tomli_w.dumps(scenario.to_dict()))
    assert load_scenario(file) == scenario
    changed = load_scenario(file, overrides=["effects.0.rate=0.05"])
    assert changed.effects == (example("dwell_ageing", rate=0.05), *scenario.effects[1:])
    with pytest.raises(InputError, match="has 3 effects, numbered from 0"):
        load_scenario(file, overrides=["effects.3.rate=0.05"])
    with pytest.raises(InputError, match=r"effects\.0\.rate=0\.02"):
        load_scenario(file, overrides=["effects.rate=0.05"])


def test_bad_tables():
    tables = _scenario().to_dict()
    for effects, message in (
        ({"kind": "dwell_ageing"}, r"write \[\[effects\]\]"),
        ([{"kind": "dwell_ageing", "rate": "x"}], "dwell_ageing.rate = 'x' is not a number"),
        ([{"kind": "stiction"}], "unknown effect 'stiction'"),
    ):
        with pytest.raises(InputError, match=message):
            scenario_from_dict(tables | {"effects": effects})


def test_effects_of_randomness_set_the_process():
    assert _scenario(example("random_coefficients")).coefficient_process == Knots(sigma_s=0.015, sigma_k=0.02, spacing=0.01)
    per_event = _scenario(example("random_coefficients", process="per_event")).coefficient_process
    assert per_event == PerEvent(sigma_s=0.015, sigma_k=0.02)
    correlated = _scenario(example("correlated_coefficients")).coefficient_process
    assert correlated == OrnsteinUhlenbeck(sigma_s=0.015, sigma_k=0.02, correlation_time=3.0)
    with pytest.raises(InputError, match="keep one of them"):
        _scenario(example("random_coefficients"), example("correlated_coefficients"))
    with pytest.raises(InputError, match=r"random_coefficients and \[coefficients\] process knots"):
        dataclasses.replace(load_scenario("kang2015_table1"), effects=(example("random_coefficients"),))


def test_random_effect_and_process_give_the_same_motion():
    scenario = _scenario(example("random_coefficients"))
    declared = _scenario(process_of := example("random_coefficients"))
    declared = dataclasses.replace(declared, effects=(), process=process_of.coefficient_process())
    np.testing.assert_array_equal(simulate(scenario, seed=4).position, simulate(declared, seed=4).position)


def test_compliance_is_an_elastic_law_once():
    coulomb = make_law("coulomb", mu_s=0.8, mu_k=0.46)
    elastic = with_compliance(coulomb, [example("presliding_compliance", damping_ratio=0.2)])
    assert (elastic.kind, elastic.e_lim, elastic.zeta) == ("elastic_stick", 1.0e-5, 0.2)
    assert with_compliance(coulomb, [example("presliding_compliance", elastic_limit=0.0)]) is coulomb
    with pytest.raises(InputError, match="makes law coulomb elastic, once"):
        with_compliance(elastic, [example("presliding_compliance")])
    with pytest.raises(InputError, match="makes law coulomb elastic, once"):
        with_compliance(coulomb, [example("presliding_compliance")] * 2)


def test_laws_that_cannot_carry_effects():
    with pytest.raises(InputError, match="'lugre' cannot carry effects here: its memory is a differential equation"):
        simulate(_scenario(example("dwell_ageing"), law="lugre"))
    with pytest.raises(InputError, match="'karnopp' cannot carry effects here"):
        simulate(_scenario(example("dwell_ageing"), law="karnopp"))


@pytest.mark.parametrize(("law", "says"), [("coulomb", "local error 1e-08"), ("elastic_stick", "effects within the law")])
def test_notes_say_what_computed_it(law, says):
    trajectory = simulate(_scenario(example("dwell_ageing"), law=law))
    assert any(says in note for note in trajectory.attributes["notes"])
    assert trajectory.attributes["law"] == law


@pytest.mark.parametrize("ending", ["nc", "csv", "parquet"])
def test_sensor_effects_keep_the_truth_beside_the_reading(tmp_path, ending):
    plain = simulate(_scenario())
    shown = simulate(_scenario(make_effect("sensor_step", size=1.0e-4, time=0.5)))
    np.testing.assert_array_equal(shown.true_position, plain.position)
    np.testing.assert_array_equal(shown.position, plain.position + 1.0e-4 * (plain.time >= 0.5))
    assert plain.true_position is None
    assert "sensor's reading (sensor_step)" in shown.attributes["notes"][-1]
    file = tmp_path / f"run.{ending}"
    write_trajectory(shown, file)
    again = read_trajectory(file)
    np.testing.assert_array_equal(again.true_position, shown.true_position)
    np.testing.assert_array_equal(again.position, shown.position)


def test_outliers_depend_on_the_address_alone():
    scenario = _scenario(example("sensor_outliers"))
    first, same, other = (simulate(scenario, seed=s).position for s in (1, 1, 2))
    np.testing.assert_array_equal(first, same)
    assert np.any(first != other)


@pytest.mark.parametrize("law", ["elastic_stick", "coulomb"])
def test_friction_is_reported_without_the_loads(law):
    """Well within a stick the box rides evenly: c x' + k x = F + load, so F must not hold the load."""
    scenario = _scenario(example("harmonic_force"), law=law)
    run = simulate(scenario)
    m = scenario.mechanism
    load = 0.3 * np.cos(2.0 * np.pi * 5.0 * run.time + 1.0)
    rest = m.damping * run.velocity + m.stiffness * run.position - run.friction_force
    around = np.convolve(run.stick, np.ones(201), mode="same")
    within = around > 200.5  # 0.1 s from the switches, where the ringing of the elastic stick has died away
    assert within.sum() > 100
    # the elastic box follows its spring: m omega^2 (load/k_stick) = 6.08 (31.4)^2 0.3/1.04e6 = 1.7 mN
    assert np.abs(rest - load)[within].max() < (2.5e-3 if law == "elastic_stick" else 1.0e-9)
