"""Friction that creates energy is pointed out; friction as it should be is not."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb import InputError, load_scenario
from stochfric_mb.measurement import load_dataset, probable_sign_error
from stochfric_mb.measurement.signs import run_sign_error
from stochfric_mb.reference import simulate

from .files import csv, dataset


@pytest.fixture(scope="module")
def scenario():
    return dataclasses.replace(load_scenario("kang2015_table1"), process=None, duration=2.0)


@pytest.fixture(scope="module")
def trajectory(scenario):
    return simulate(scenario)


@pytest.mark.parametrize("columns", [("position",), ("position", "velocity")])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_simulated_stick_slip(tmp_path, scenario, trajectory, columns, sign):
    motion = {f"{name}__{'m' if name == 'position' else 'm/s'}": getattr(trajectory, name) for name in columns}
    csv(tmp_path / "run.csv", time__s=trajectory.time, **motion, friction_force__N=sign * trajectory.friction_force)
    runs = load_dataset(dataset(tmp_path, 'file = "run.csv"\nrole = "fit"', 'file = "run.csv"\nrole = "test"'), scenario).runs
    said = [note for note in runs[0].notes if "brings in energy" in note]
    assert len(said) == (1 if sign < 0.0 else 0)
    if said:
        assert "give sign = { friction_force = -1 }" in said[0]
        error = run_sign_error(runs[0], scenario)
        power = np.mean(trajectory.friction_force * (scenario.mechanism.belt_velocity - trajectory.velocity))
        assert error.mean_power == pytest.approx(power, rel=0.05)  # the window rounds the corners of the motion off
        assert error.created > 0.8


def test_a_sign_that_the_dataset_turns_wrongly_is_to_be_taken_out(tmp_path, scenario, trajectory):
    csv(tmp_path / "run.csv", time__s=trajectory.time, position__m=trajectory.position,
        friction_force__N=trajectory.friction_force)  # fmt: skip
    runs = ('file = "run.csv"\nrole = "fit"\nsign = { friction_force = -1 }', 'file = "run.csv"\nrole = "test"')
    wrong, right = load_dataset(dataset(tmp_path, *runs), scenario).runs
    assert any("is probably wrong; take out sign = { friction_force = -1 }" in note for note in wrong.notes)
    assert not any("sign" in note for note in right.notes)


def test_belt_velocity_as_measured_counts(tmp_path, scenario, trajectory):
    """The belt runs backwards in the file, so that the same force feeds the sliding."""
    n = trajectory.time.size
    csv(
        tmp_path / "run.csv",
        time__s=trajectory.time,
        position__m=trajectory.position,
        friction_force__N=trajectory.friction_force,
        **{"belt_velocity__m/s": np.full(n, -0.5)},
    )
    forwards = dataclasses.replace(scenario, mechanism=dataclasses.replace(scenario.mechanism, belt_velocity=0.5))
    run = load_dataset(tmp_path / "run.csv", forwards).fit[0]
    assert any("brings in energy" in note for note in run.notes)


def test_noise_is_no_sign_error():
    rng = np.random.default_rng(11)
    items = [probable_sign_error(*rng.normal(size=(2, 500))) for _ in range(500)]
    assert sum(f is not None for f in items) <= 4  # one in a thousand each: more than 4 in 500 has probability 2e-4


def test_friction_of_a_sliding_body():
    v = np.sin(np.arange(2000) * 0.02)
    noise = np.random.default_rng(2).normal(size=v.size)
    assert probable_sign_error(-np.sign(v) + noise, v) is None
    result = probable_sign_error(np.sign(v) + noise, v)
    assert result.low > 0.0
    assert result.mean_power == pytest.approx(2.0 / np.pi, abs=4.0 * np.sqrt(0.5 / v.size))  # mean |sin|, 4 standard errors
    assert 0.5 < result.created < 1.0


def test_what_cannot_be_judged_is_not(tmp_path, scenario):
    csv(tmp_path / "run.csv", time__s=np.arange(200) * 0.01, friction_force__N=np.ones(200))
    assert run_sign_error(load_dataset(tmp_path / "run.csv", scenario).fit[0], scenario) is None
    with pytest.raises(InputError, match="at least 40"):
        probable_sign_error(np.ones(39), np.ones(39))
    with pytest.raises(InputError, match="give equally many"):
        probable_sign_error(np.ones(99), np.ones(98))
