"""Ensembles of a user's own model, a world for each sample: the same files, resumed, and refused where it cannot run."""

import math

import numpy as np
import pytest
from click.testing import CliRunner

from stochfric_mb.__main__ import main
from stochfric_mb.ensemble.dataset import read_ensemble
from stochfric_mb.ensemble.job import job
from stochfric_mb.ensemble.produce import produce
from stochfric_mb.errors import InputError, SimulationError
from stochfric_mb.scenario import load_any_scenario
from stochfric_mb.warp.simulate import simulate, simulate_many
from tests.warp.scenes import same

GRAVITY = 9.81
STIFFNESS, SPEED = 100.0, 0.5  # of the spring that pulls the box of 1 kg at its foot [N/m], and of its other end [m/s]
MODEL = """<mujoco><option timestep="1e-3" cone="elliptic" integrator="Euler"/>
<worldbody><geom name="floor" type="plane" size="50 50 .1" condim="3"/>
<body pos="0 0 .0499"><freejoint/><geom name="box" type="box" size=".1 .1 .05" mass="1" condim="3"/>
<site name="mark" pos="0 0 -.05"/></body>
<body pos="0 3 1"><joint name="arm" type="hinge" axis="0 1 0" frictionloss="1"/>
<geom type="capsule" fromto="0 0 0 .5 0 0" size=".02" mass=".1" contype="0" conaffinity="0"/></body>
<body pos="1 0 0"><joint type="slide" axis="1 0 0"/><geom size=".05" mass="1000" contype="0" conaffinity="0"/>
<site name="end"/></body></worldbody>
<tendon><spatial stiffness="100" springlength="1"><site site="mark"/><site site="end"/></spatial></tendon>
<sensor><framepos name="where" objtype="site" objname="mark"/>
<framelinvel name="speed" objtype="site" objname="mark"/></sensor>
<keyframe><key qvel="0 0 0 0 0 0 0 .5"/></keyframe></mujoco>"""
SCENARIO = """schema = "stochfric.scenario/1"
title = "box on a spring"
[mechanism]
kind = "mjcf"
file = "model.xml"
friction = { foot = 1.0 }
positions = { "where.0" = "position", "speed.0" = "velocity" }
pairs = { foot = { geoms = ["box", "floor"] } }
[law]
kind = "coulomb"
mu_s = 0.8
mu_k = 0.5
[coefficients]
process = "knots"
sigma_s = 0.02
sigma_k = 0.0
spacing = 0.01
[simulation]
duration = 0.3
output_step = 0.002
"""


@pytest.fixture
def scenario_file(tmp_path):
    (tmp_path / "model.xml").write_text(MODEL)
    (tmp_path / "scenario.toml").write_text(SCENARIO)
    return tmp_path / "scenario.toml"


def changed(file, *pairs, name="scenario.toml"):
    text = (file.parent / name).read_text()
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    (file.parent / name).write_text(text)
    return load_any_scenario(file)


def test_runs_break_away_where_their_own_path_says_and_slide_as_they_should(scenario_file):
    scenario = load_any_scenario(scenario_file)
    steps = np.arange(300) * 1e-3
    begins = set()
    for w, run in enumerate(simulate_many(scenario, seed=3, n=16)):
        mu_s = scenario.path(3, w).at_times(steps)[:, 0]
        exact = steps[np.argmax(STIFFNESS * SPEED * steps > mu_s * GRAVITY)]
        broke = run.time[np.flatnonzero(run.stick[5:] == 0.0)[0] + 5]  # it is met at 0, and sticks from there
        # a step, .3 ms until it is fast enough to count, a sample of 2 ms; the box settles: N is within 1 %, 1.6 ms
        assert -0.002 <= broke - exact <= 0.006
        # stuck, it hangs on a spring with the time constant of two steps: mu_s N (2 dt)^2/m
        assert np.abs(run.position[run.time < exact - 0.005]).max() < 0.85 * GRAVITY * 2e-3**2
        # m x'' = k (v t - x) - mu_k N from rest; break-away is late by a step or two, at .6 m/s in the end: 2 %
        tau, omega = run.time[-1] - exact, math.sqrt(STIFFNESS)
        excess = (STIFFNESS * SPEED * exact - 0.5 * GRAVITY) / STIFFNESS
        slid = excess * (1.0 - math.cos(omega * tau)) + SPEED * (tau - math.sin(omega * tau) / omega)
        assert run.position[-1] == pytest.approx(slid, rel=0.03)
        begins.add(broke)
    assert len(begins) > 3


def test_command_resumes_and_one_sample_is_the_same_as_among_others(scenario_file, tmp_path):
    out = tmp_path / "ens.nc"
    task = job(load_any_scenario(scenario_file), 5, engine="warp", seed=3, output_times=[0.1, 0.3], block=2)

    def interrupt(done):
        if done >= 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        produce(task, tmp_path / "parts.nc", progress=interrupt)
    assert produce(task, tmp_path / "parts.nc").n_resumed == 1
    words = ["ensemble", str(scenario_file), "--engine", "warp", "--n-runs", "5", "--seed", "3", "--output-times", "0.1,0.3"]
    result = CliRunner().invoke(main, [*words, "--out", str(out), "--plot"])
    assert result.exit_code == 0, result.output
    whole, scenario = read_ensemble(out)
    resumed, _ = read_ensemble(tmp_path / "parts.nc")
    assert same(whole.position, resumed.position)
    assert np.array_equal(whole.tallies, resumed.tallies, equal_nan=True)
    assert scenario.mechanism.kind == "mjcf"
    assert whole.attributes["dt"] == 1e-3
    alone = simulate(scenario, seed=3, sample=3)
    assert same(alone.position[[50, 150]], whole.position[3])
    assert (alone.velocity[[50, 150]] == whole.velocity[3]).all()
    assert whole.position[:, -1].std() > 1e-4  # they are not one run


def test_parts_of_another_model_are_not_mixed(scenario_file, tmp_path):
    task = job(load_any_scenario(scenario_file), 2, engine="warp", output_times=[0.01], block=1)
    assert task.fingerprint() == task.fingerprint()
    before = task.fingerprint()["model"]
    changed(scenario_file, ('mass="1"', 'mass="1.1"'), name="model.xml")
    assert task.fingerprint()["model"] != before


def test_hinge_sticks_and_is_recorded_in_radians(scenario_file, tmp_path):
    changed(
        scenario_file,
        ("friction = { foot = 1.0 }", "friction = { arm = 1.0 }"),
        ('{ "where.0" = "position", "speed.0" = "velocity" }', '{ arm = "position" }'),
        ('pairs = { foot = { geoms = ["box", "floor"] } }\n', ""),
    )  # the arm's weight needs .1 kg 9.8 m/s^2 .25 m = .2 N m of the .8 N m that friction can hold
    out = tmp_path / "ens.nc"
    words = ["ensemble", str(scenario_file), "--engine", "warp", "--n-runs", "3", "--out", str(out)]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, result.output
    assert "mrad" in result.output
    whole, _ = read_ensemble(out)
    assert whole.attributes["position_unit"] == "rad"
    alpha = 1.5 * GRAVITY / 0.5  # a rod that falls [rad/s^2]: in its first step friction is not there yet
    assert np.abs(whole.position).max() < alpha * 1e-3**2
    assert np.ptp(whole.position[:, 50:], axis=1).max() < 1e-8  # float32 of the angle itself is finer
    assert whole.stick[:, 2:].all()


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("scenario.toml", "model.xml", "modell.xml", "no such file"),
        ("scenario.toml", '["box", "floor"]', '["box", "flor"]', "floor"),
        ("scenario.toml", "where.0", "were.0", "where"),
        ("scenario.toml", "where.0", "where", "has 3 numbers"),
        ("scenario.toml", "where.0", "where.3", "has 3 numbers"),
        ("scenario.toml", ', "speed.0" = "velocity"', "", "velocity"),
        ("scenario.toml", "output_step = 0.002", "output_step = 0.0025", "does not divide"),
        ("scenario.toml", 'kind = "coulomb"', 'kind = "dahl"', "is a bristle"),
        ("model.xml", 'cone="elliptic"', 'cone="pyramidal"', "elliptic"),
        ("model.xml", 'condim="3"', 'condim="1"', "condim 1"),
        ("model.xml", "<worldbody>", "<wordbody>", "MuJoCo does not read it"),
        ("model.xml", "Euler", "RK4", "integrator"),
    ],
)
def test_what_cannot_run_is_refused(scenario_file, name, old, new, message):
    scenario = changed(scenario_file, (old, new), name=name)
    with pytest.raises(InputError, match=message):
        simulate(scenario)


def test_too_many_contacts_are_an_error(scenario_file):
    boxes = "".join(
        f'<body pos="{3 + 0.3 * i} 0 .2"><freejoint/><geom type="box" size=".1 .1 .05" condim="3"/></body>' for i in range(8)
    )
    scenario = changed(scenario_file, ("</worldbody>", boxes + "</worldbody>"), name="model.xml")
    with pytest.raises(SimulationError, match="room"):
        simulate(scenario)


def test_other_engines_say_who_can(scenario_file):
    result = CliRunner().invoke(main, ["ensemble", str(scenario_file), "--n-runs", "2", "--out", "x.nc"])
    assert result.exit_code == 2
    assert "--engine warp" in result.output
