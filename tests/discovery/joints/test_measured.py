"""What the workflow says of measured data, and how far held-out parts are from its models."""

import dataclasses
import time

import pytest

from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.errors import InputError
from tests.discovery.joints.measured import dataset, kinds, outcome, repeated


def test_emps_viscous_friction_then_direction_asymmetry_then_position():
    result = outcome("emps")
    assert kinds(result) == ["viscous_friction", "direction_asymmetry", "position_dependent_friction"]
    scores = result.places[0].scores
    # a first look by other means: 2.34 N with Coulomb and viscous friction, 1.85 N with the asymmetry
    assert scores["with viscous_friction"].whole == pytest.approx(2.34, abs=0.05)
    assert scores["with direction_asymmetry"].whole <= 1.85
    assert scores["augmented"].whole <= 1.75
    viscous = result.result.effects[0].parameters["coefficient"]
    assert viscous.low < viscous.value < viscous.high


def test_emps_closed_loop_on_held_out_time():
    gap = outcome("emps").result.gap
    assert gap is not None
    assert gap.metric == "closed_loop_voltage"
    assert gap.held_out
    assert gap.recalibrated > 0.15  # Coulomb friction alone
    assert gap.augmented <= 0.039


@pytest.mark.parametrize("name", ["emps", "seal_o_ring", "swing_up_ddp"])
def test_the_augmented_scenario_alone_has_the_augmented_score(name):
    result = outcome(name)
    again = joint_outcome(dataclasses.replace(dataset(name), scenario=result.scenario))
    before, after = result.places[0].scores["augmented"], again.places[0].scores["baseline"]
    # the width of the window is chosen against the stated friction, which for the seal is less than before
    assert after.sliding == pytest.approx(before.sliding, rel=0.02 if name == "seal_o_ring" else 1e-9)
    if before.loop is not None:
        assert after.loop == pytest.approx(before.loop, rel=1e-9)
    assert "sensor_delay" not in kinds(again)


def test_emps_twice_gives_the_same():
    assert joint_outcome(dataset("emps")).result.to_json() == outcome("emps").result.to_json()


@pytest.mark.parametrize(("name", "recalibrated", "left"), [("seal_o_ring", 1.84, 0.91), ("seal_napn", 3.45, 1.17)])
def test_seals_load_dependence_and_what_is_confounded(name, recalibrated, left):
    result = outcome(name)
    assert kinds(result) == ["load_dependence"]
    gap = result.result.gap
    assert gap is not None
    # a first look in-sample: that much before and after; steady sliding held out is less than it
    assert gap.recalibrated <= recalibrated
    assert gap.augmented <= left
    assert any("direction and speed are confounded" in note for note in result.result.notes)
    assert "direction" in result.result.next_experiment
    assert "speed" in result.result.next_experiment


@pytest.mark.parametrize("name", ["seal_o_ring", "seal_napn"])
def test_a_repeat_of_a_seal_against_itself_names_nothing(name):
    again = joint_outcome(repeated(dataset(name), outcome(name)))
    assert again.result.verdict == "none"


def test_basalt_remembers():
    result = outcome("rock_basalt")
    assert kinds(result) == ["frictional_lag"]
    laws = result.result.details["laws"]
    assert laws["frictional_lag"]["held_out"] < 0.75 * laws["constant"]["held_out"]
    assert laws["frictional_lag"]["held_out"] < laws["velocity_weakening"]["held_out"]
    distance = result.result.effects[0].parameters["distance"]
    assert distance.unit == "m"
    assert 1.0e-6 < distance.low < distance.high < 1.0e-4  # microns to tens of microns, as laboratory rock has


def test_sepiolite_remembers():
    result = outcome("rock_sepiolite")
    assert kinds(result) == ["frictional_lag"]
    gap = result.result.gap
    assert gap is not None
    assert gap.augmented < 0.5 * gap.recalibrated


@pytest.mark.parametrize("name", ["swing_up_ddp", "swing_up_collocation"])
def test_swing_ups_are_a_matter_of_timing(name):
    result = outcome(name)
    assert kinds(result) == ["sensor_delay"]
    delay = result.result.effects[0].parameters["delay"]
    assert 0.010 <= delay.value <= 0.020  # the torque leads the motion by 10 to 20 ms
    assert delay.low > 0.0


def test_servo_load_dependence_and_temperature_with_gain():
    pytest.importorskip("mujoco", reason="the servo is an MJCF model")
    result = outcome("servo_pendulum")
    assert kinds(result)[0] == "load_dependence"
    gap = result.result.gap
    assert gap is not None
    # the firmware's controller in the loop, rest and reversals included
    assert gap.metric == "closed_loop_drive"
    assert gap.recalibrated > 0.2
    assert gap.augmented < 0.105  # half of what is left without; the firmware, which is not known, is part of the rest
    scores = result.places[0].scores
    assert scores["augmented"].sliding < 0.85 * scores["recalibrated"].sliding
    assert scores["augmented"].forward < 0.55 * scores["recalibrated"].forward
    assert any("temperature and kp are confounded" in note for note in result.result.notes)


def test_a_wrong_sign_stops_with_the_remedy():
    data = dataset("emps")
    turned = [{**r.channels, "voltage": -r.channels["voltage"]} for r in data.runs]
    runs = tuple(dataclasses.replace(r, channels=c) for r, c in zip(data.runs, turned, strict=True))
    scenario = dataclasses.replace(data.scenario, controller=None)
    with pytest.raises(InputError, match=r"brings in energy .* give sign = \{ voltage = -1 \}"):
        joint_outcome(dataclasses.replace(data, runs=runs, scenario=scenario))


def test_two_minutes_at_most():
    said: list[str] = []
    start = time.process_time()  # as other processes take nothing from it
    joint_outcome(dataset("seal_napn"), progress=said.append)
    assert time.process_time() - start < 120.0
    assert any("load_dependence" in text for text in said)
