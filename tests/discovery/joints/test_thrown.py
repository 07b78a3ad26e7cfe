"""Short slides one way: a block that was thrown and comes to rest, a few dozen samples each."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.laws import make_law
from stochfric_mb.measurement import Dataset, load_dataset
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import PrismaticJoint
from stochfric_mb.scenario import Scenario

MASS, GRAVITY, MU, RATE = 0.2, 9.81, 0.25, 100.0
NOISE = 1.0e-4
"""Of the position [m]: 0.04 of mu for a slide of 45 samples would hide a scatter of 0.05; this is an eighth of it."""


def thrown(rng, name, role, share):
    """A slide from 1 to 1.3 m/s until it rests, recorded by a camera; nothing drives it."""
    speed, slow = rng.uniform(1.0, 1.3), GRAVITY * MU * (1.0 + share * rng.standard_normal())
    t = np.arange(int(0.95 * speed / slow * RATE)) / RATE
    x = speed * t - 0.5 * slow * t**2 + NOISE * rng.standard_normal(len(t))
    return Run(
        name=name, role=role, time=t, channels={"position": x, "force": np.zeros(len(t))}, settings={},
        sample_interval=1.0 / RATE,
    )  # fmt: skip


def data(share, count=40):
    rng = np.random.default_rng(5)
    runs = [thrown(rng, f"throw {i}", "test" if i % 4 == 3 else "fit", share) for i in range(count)]
    scenario = Scenario(
        mechanism=PrismaticJoint(mass=MASS, normal_force=MASS * GRAVITY),
        law=make_law("coulomb", mu_s=0.3, mu_k=0.3),
        uncertainty={"mass": 0.001, "mu_k": 0.5},
        duration=1.0,
        output_step=0.01,
    )
    return Dataset(title="", scenario_path=None, scenario=scenario, runs=tuple(runs))


def test_friction_that_is_drawn_for_each_slide_is_named_with_its_size():
    measured = data(0.05)
    assert min(len(r.time) for r in measured.runs) >= 30
    assert max(len(r.time) for r in measured.runs) <= 60  # samples
    (result,) = joint_outcome(measured).result.effects
    assert result.kind == "random_coefficients"
    assert result.where.axis == "run"
    share = result.parameters["sigma_k"].value / MU
    assert share == pytest.approx(0.05, rel=4.0 / np.sqrt(2.0 * 30))  # four standard errors of 30 slides


def test_slides_alike_name_nothing():
    assert joint_outcome(data(0.0)).result.verdict == "none"


def test_the_first_slide_says_as_much_as_its_repeats():
    measured = data(0.05, count=12)
    runs = tuple(dataclasses.replace(r, role="fit" if i < 8 else "test") for i, r in enumerate(measured.runs))
    assert [e.kind for e in joint_outcome(dataclasses.replace(measured, runs=runs)).result.effects] == ["random_coefficients"]


def test_slides_of_thirty_samples_are_read_from_files(tmp_path):
    measured = data(0.05)
    short = [r.between(0.0, 0.36, name=r.name, role=r.role) for r in measured.runs]
    assert {len(r.time) for r in short} <= set(range(30, 38))
    entries = []
    for i, run in enumerate(short):
        rows = np.column_stack([run.time, run.channels["position"], run.channels["force"]])
        np.savetxt(tmp_path / f"{i}.csv", rows, delimiter=",", header="time [s],position [m],force [N]", comments="")
        entries.append(f'[[runs]]\nfile = "{i}.csv"\nname = "{run.name}"\nrole = "{run.role}"\n')
    (tmp_path / "dataset.toml").write_text('schema = "stochfric.dataset/1"\n' + "\n".join(entries))
    result = joint_outcome(load_dataset(tmp_path, measured.scenario)).result
    assert [e.kind for e in result.effects] == ["random_coefficients"]
