"""Mechanisms beyond the belt-box in scenario files: what is read back, and what is refused with which words."""

import tomllib
from pathlib import Path

import pytest

from stochfric_mb.errors import InputError
from stochfric_mb.scenario import any_scenario_from_dict, bundled_scenarios, load_any_scenario, load_scenario

MODELS = Path(__file__).parents[3] / "models"
NAMES = ("emps", "seal_o_ring", "swing_up_ddp", "rock_basalt", "servo_pendulum", "two_joint_arm")


@pytest.mark.parametrize("name", NAMES)
def test_scenarios_of_measured_rigs_round_trip(name):
    scenario = load_any_scenario(MODELS / name / "scenario.toml")
    assert any_scenario_from_dict(scenario.to_dict()) == scenario
    assert name in bundled_scenarios()


def test_engines_refuse_what_they_cannot_simulate():
    with pytest.raises(InputError, match=r"the engines simulate the belt_box.*stochfric discover"):
        load_scenario("emps")


def tables(name, **changes):
    content = tomllib.loads((MODELS / name / "scenario.toml").read_text())
    for key, value in changes.items():
        table, _, entry = key.partition("__")
        content[table] = {**content[table], entry: value}
    return content


@pytest.mark.parametrize(
    ("name", "changes", "words"),
    [
        ("emps", {"mechanism__mass": -1.0}, "mass = -1 kg is out of range"),
        ("emps", {"mechanism__mas": 1.0}, "did you mean 'mass'"),
        ("emps", {"controller__kind": "pid"}, "Known: cascade"),
        ("emps", {"controller__gain": 1.0}, "unknown key controller."),
        ("emps", {"controller__limit": 0.0}, "controller.limit must be > 0"),
        ("swing_up_ddp", {"mechanism__length": 0.0}, "length must be > 0"),
        ("rock_basalt", {"mechanism__stiffness": -2.0}, "stiffness must be > 0"),
        ("two_joint_arm", {"mechanism__friction": {}}, "names no joint"),
        ("two_joint_arm", {"mechanism__friction": {"elbo": 1.0}}, "did you mean 'elbow'"),
        ("two_joint_arm", {"mechanism__drives": {"elbow": {"columns": []}}}, "give a channel"),
        ("two_joint_arm", {"mechanism__factors": {"size": 1.0}}, "Known: armature, mass"),
        ("two_joint_arm", {"mechanism__files": "x"}, "did you mean 'file'"),
        ("two_joint_arm", {"mechanism__pairs": {"foot": 1.0}}, "names no two geoms"),
        ("two_joint_arm", {"mechanism__tendons": "cable"}, "is not a list of names"),
        ("two_joint_arm", {"controller__joints": {}}, "controller.joints names no joint"),
        ("two_joint_arm", {"controller__joints": {"elbow": {"position_gain": 1.0}}}, "reference is missing"),
        ("two_joint_arm", {"controller__joints": {"elbow": {"position_gain": 0.0, "reference": "x"}}}, "must be > 0"),
        ("two_joint_arm", {"controller__period": -1.0}, "period must be >= 0"),
        ("two_joint_arm", {"controller__joints": {"elbow": {"gain": 1.0}}}, r"unknown key controller\.joints\.elbow\."),
    ],
)
def test_bad_content(name, changes, words):
    with pytest.raises(InputError, match=words):
        any_scenario_from_dict(tables(name, **changes), folder=MODELS / name)


def test_a_missing_key_is_named():
    content = tables("emps")
    del content["controller"]["reference"]
    with pytest.raises(InputError, match=r"controller\.reference is missing"):
        any_scenario_from_dict(content)
