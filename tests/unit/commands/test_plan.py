"""A plan says what runs could show before they are measured, and refuses runs that discovery would refuse."""

import json
import math

import numpy as np
import pytest
from click.testing import CliRunner

from stochfric_mb.__main__ import main
from stochfric_mb.discovery.planning.planned_run import load_plan, run_from_text, usual_run
from stochfric_mb.discovery.planning.signature import Signature, told_apart_from
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
    assert "http" not in page


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
        ("rock_basalt", (), "at least two steps up and two down"),
        ("two_joint_arm", (), "Plan one of its joints by itself"),
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
    assert told_apart_from(straight, [_signature("frictional_lag", one)]) == math.inf
    assert told_apart_from(straight, [_signature("frictional_lag", two)]) == 1.0
    # half the evidence is left: 18 s^2 = 12 at s = 0.82, below the limit itself
    assert told_apart_from(straight, [_signature("frictional_lag", one + two)]) == 1.0
    # a twentieth is left: 1.8 s^2 = 12
    near = _signature("frictional_lag", math.sqrt(0.95) * one + math.sqrt(0.05) * two)
    assert told_apart_from(straight, [near]) == pytest.approx(math.sqrt(12.0 / 1.8))
    # what would have to be negative cannot stand in
    assert told_apart_from(straight, [_signature("frictional_lag", -one)]) == 1.0
    assert told_apart_from(straight, [_signature("nonlinear_stiffness", -one)]) == math.inf
