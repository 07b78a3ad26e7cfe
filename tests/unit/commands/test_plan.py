"""A plan says what runs could show before they are measured, and refuses runs that discovery would refuse."""

import json
import math
import re

import numpy as np
import pytest
from click.testing import CliRunner

from stochfric_mb.__main__ import main
from stochfric_mb.discovery.planning.planned_run import load_plan, run_from_text, usual_run
from stochfric_mb.discovery.planning.signature import Signature, separation
from stochfric_mb.scenario import load_any_scenario

JOINT = """\
schema = "stochfric.scenario/1"
[mechanism]
kind = "prismatic_joint"
mass = 95.0
normal_force = 932.0
[law]
kind = "coulomb"
mu_s = 0.03
mu_k = 0.02
[uncertainty]
mass = 0.05
mu_k = 0.5
[simulation]
duration = 20.0
output_step = 1.0e-3
"""
MOTION = "stroke=0.2,period=2,noise=5e-6,force_noise=1"


def invoke(*words):
    return CliRunner().invoke(main, [str(w) for w in words])


@pytest.fixture
def joint(tmp_path):
    file = tmp_path / "joint.toml"
    file.write_text(JOINT)
    return file


def _limits(folder):
    content = json.loads((folder / "plan.json").read_text())
    return content, {limit["kind"]: limit for limit in content["limits"]}


def test_a_belt_rig_is_planned(tmp_path):
    done = invoke("plan", "kang2015_table1", "--noise", "5e-6", "--run", "duration=30", "--out", tmp_path / "plan")
    assert done.exit_code == 0, done.output
    content, limits = _limits(tmp_path / "plan")
    assert content["schema"] == "stochfric.planned/1"
    assert content["runs"][0]["slips"] > 12
    # at one belt speed, one load and one direction these leave nothing, whatever their size
    assert {"dwell_ageing", "direction_asymmetry", "load_dependence"} <= set(content["unseen"])
    assert not set(limits) & set(content["unseen"])
    assert "random_coefficients" not in limits  # its scatter is believed
    best = content["extra"][0]
    assert best["shows"] or best["separates"]
    page = (tmp_path / "plan" / "report.html").read_text()
    for limit in content["limits"]:
        assert f'<data value="{limit["value"]}">' in page
    assert "viscous friction" in done.stdout
    assert not re.findall(r'(?:src|href)="(?!data:|#)|url\((?!#)|@import|<script ', page)


def test_limits_of_a_joint_shrink_with_quieter_sensors_and_longer_records(tmp_path, joint):
    sizes = []
    for i, change in enumerate((("force_noise=1", "force_noise=5"), ("", ""), ("period=2", "period=2,duration=80"))):
        done = invoke("plan", joint, "--run", MOTION.replace(*change), "--no-extra", "--out", tmp_path / f"{i}")
        assert done.exit_code == 0, done.output
        sizes.append(_limits(tmp_path / f"{i}")[1]["viscous_friction"]["value"])
    loud, plain, longer = sizes
    assert loud > 1.2 * plain  # not 5 times: wider windows are chosen against a louder drive
    assert longer < 0.7 * plain  # four times the strokes: half, were the score that is needed the same


def test_numbers_of_a_hinge_are_about_its_axis(tmp_path):
    scenario = tmp_path / "hinge.toml"
    scenario.write_text(
        JOINT.replace("prismatic_joint", "hinge_pendulum")
        .replace("mass = 95.0", "mass = 0.6\nlength = 0.3", 1)
        .replace("932.0", "0.4")
    )
    out = tmp_path / "plan"
    done = invoke("plan", scenario, "--run", "stroke=0.5,period=2,noise=1e-4,force_noise=1e-3", "--no-extra", "--out", out)
    assert done.exit_code == 0, done.output
    content = json.loads((out / "plan.json").read_text())
    limits = {limit["kind"]: limit for limit in content["limits"]}
    assert "load_dependence" in content["no_limit"]  # what a hinge transmits varies, but no number is this effect's size
    assert limits["viscous_friction"]["unit"] == "N m s/rad"
    assert limits["frictional_lag"]["unit"] == "rad"
    assert limits["velocity_weakening"]["units_beside"] == {"decay_velocity": "rad/s"}
    assert limits["distance_drift"]["unit"] == "1/rad"
    wave = limits["position_dependent_force"]
    # an overtone that a form has is a half of the wave, at the limit, too
    assert wave["beside"].get("amplitude_2", 0.5 * wave["value"]) == pytest.approx(0.5 * wave["value"])


ARM = """\
<mujoco><compiler angle="radian"/><worldbody><body><joint name="slide" type="slide" axis="1 0 0"/><geom size="0.1" mass="2"/>
<body><joint name="pin" axis="0 1 0"/><geom size="0.02" pos="0 0 -0.3" mass="0.5"/></body></body></worldbody></mujoco>
"""
CART = """\
schema = "stochfric.scenario/1"
[mechanism]
kind = "mjcf"
file = "cart.xml"
friction = { slide = 10.0 }
positions = { slide = "x", pin = "q" }
drives = { slide = "f" }
[law]
kind = "coulomb"
mu_s = 0.2
mu_k = 0.2
[uncertainty]
mass = 0.05
mu_k = 0.5
[simulation]
duration = 10.0
output_step = 2.0e-3
"""


def test_a_joint_of_a_model_is_planned_where_it_is_driven(tmp_path):
    pytest.importorskip("mujoco", reason="the model is one of MuJoCo's")
    (tmp_path / "cart.xml").write_text(ARM)
    scenario = tmp_path / "cart.toml"
    scenario.write_text(CART)
    words = ("--run", "stroke=0.2,period=2", "--no-extra", "--out")
    refused = invoke("plan", scenario, *words, tmp_path / "none")
    assert "joint 'pin' is not driven: its motion follows from that of the others" in refused.stderr
    scenario.write_text(CART.replace('drives = { slide = "f" }', 'drives = { slide = "f", pin = "u" }'))
    assert invoke("plan", scenario, *words, tmp_path / "plan").exit_code == 0
    content, limits = _limits(tmp_path / "plan")
    assert limits["viscous_friction"]["unit"] == "N s/m"
    assert content["rotational"] is False


def test_a_joint_of_several_is_planned_by_its_name(tmp_path):
    pytest.importorskip("mujoco", reason="the model is one of MuJoCo's")
    words = ("--run", "stroke=1,period=3,duration=9,noise=1e-5,force_noise=0.02", "--no-extra", "--out")
    assert invoke("plan", "two_joint_arm", "--joint", "elbow", *words, tmp_path / "plan").exit_code == 0
    content, limits = _limits(tmp_path / "plan")
    assert limits["viscous_friction"]["unit"] == "N m s/rad"
    assert content["rotational"] is True
    assert content["notes"] == ["the limits are those of joint elbow; --joint plans shoulder"]


def test_velocity_steps_are_planned(tmp_path):
    steps = "slow_speed=3e-6,fast_speed=1e-5,period=40,duration=120,sample_rate=50,force_noise="
    limits = {}
    for noise in ("2e-4", "1e-4"):
        done = invoke("plan", "rock_basalt", "--run", steps + noise, "--no-extra", "--out", tmp_path / noise)
        assert done.exit_code == 0, done.output
        limits[noise] = _limits(tmp_path / noise)[1]
    assert set(limits["2e-4"]) == {"distance_drift", "velocity_weakening", "viscous_friction", "frictional_lag"}
    # what a law adds is in proportion to its size, but for a memory that the spring shields
    for kind in ("distance_drift", "velocity_weakening"):
        assert limits["2e-4"][kind]["value"] == pytest.approx(2.0 * limits["1e-4"][kind]["value"], rel=0.05)
    assert limits["2e-4"]["frictional_lag"]["beside"] == {"distance": pytest.approx(0.1 * 20.0 * 3e-6)}


def test_a_file_of_planned_runs_says_the_same_as_the_options(tmp_path, joint):
    file = tmp_path / "runs.toml"
    file.write_text(
        'schema = "stochfric.plan/1"\nscenario = "joint.toml"\n'
        "[[runs]]\nstroke = 0.2\nperiod = 2\nnoise = 5e-6\nforce_noise = 1\n"
    )
    scenario, runs = load_plan(file)
    assert runs == [run_from_text(MOTION, usual_run(load_any_scenario(joint)), 1)]
    assert scenario == load_any_scenario(joint)
    assert invoke("plan", file, "--no-extra", "--out", tmp_path / "plan", "-q").exit_code == 0
    assert "write --run and --noise into it" in invoke("plan", file, "--noise", "1", "--out", tmp_path / "other").stderr


@pytest.mark.parametrize(
    ("scenario", "words", "message"),
    [
        ("kang2015_table1", (), "10 slips in 10 s; at least 12 are needed: plan 15 s or more"),
        ("kang2015_table1", ("--run", "belt_velocty=1"), "did you mean 'belt_velocity'"),
        ("kang2015_table1", ("--run", "belt_velocity=0"), "plan a belt that runs"),
        ("kang2015_table1", ("--run", "fast"), "'fast' is not KEY=NUMBER"),
        ("kang2015_table1", ("--run", "duration=-1"), "duration"),
        ("kang2015_table1", ("--run", "sample_rate=50"), "sample at 163 Hz or faster"),
        ("emps", (), "plan stroke and period"),
        ("emps", ("--joint", "slide"), "has one joint; leave it out"),
        ("rock_basalt", (), "plan two speeds, and the time of a step up and one down"),
        ("rock_basalt", ("--run", "slow_speed=1e-6,fast_speed=1e-5,period=90"), "1.11 steps up and down; plan 180 s or more"),
        ("rock_basalt", ("--run", "slow_speed=1e-6,fast_speed=1e-5,period=9,stroke=1"), "at a spring slider plan slow_speed"),
        ("two_joint_arm", (), "plan stroke and period"),
        ("two_joint_arm", ("--joint", "elbo"), "did you mean 'elbow'"),
    ],
)
def test_runs_that_would_show_nothing_are_refused_with_what_would(tmp_path, scenario, words, message):
    done = invoke("plan", scenario, *words, "--out", tmp_path / "plan")
    assert done.exit_code == 2
    assert message in done.stderr
    assert not (tmp_path / "plan").exists()


def _signature(kind, *columns):
    columns = np.stack(columns, axis=1)
    return Signature(kind, "amplitude", "-", 1.0, {}, (columns[:, 0],), columns)


def test_effects_are_told_apart_by_what_one_leaves_of_the_other():
    one, two = np.eye(8)[:2] * 6.0  # 36 of evidence at the limit
    straight = _signature("viscous_friction", one)
    assert separation(straight, [_signature("frictional_lag", one)]) == math.inf
    assert separation(straight, [_signature("frictional_lag", two)]) == 1.0
    # half the evidence is left: 18 s^2 = 12 at s = 0.82, below the limit itself
    assert separation(straight, [_signature("frictional_lag", one + two)]) == 1.0
    # a twentieth is left: 1.8 s^2 = 12
    near = _signature("frictional_lag", math.sqrt(0.95) * one + math.sqrt(0.05) * two)
    assert separation(straight, [near]) == pytest.approx(math.sqrt(12.0 / 1.8))
    # what would have to be negative cannot stand in
    assert separation(straight, [_signature("frictional_lag", -one)]) == 1.0
    assert separation(straight, [_signature("nonlinear_stiffness", -one)]) == math.inf
