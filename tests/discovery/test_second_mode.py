"""A second mode that rings on through stick is found at its own frequency, and not at one that agrees now and then."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb import discover, load_scenario
from stochfric_mb.effects import make_effect
from stochfric_mb.laws import make_law
from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.reference import simulate

FREQUENCY, RATIO = 106.8, 0.0167
"""Of a pad carrier of 1.2 kg on 4.5e5 N/m, behind the pad's 9e4 N/m [Hz, -]: 25 turns of its ring pass in a stick."""
NOISE = 1.5e-6
"""Of the sensor [m]."""
SPEEDS = (("fit", 5.0e-3), ("fit", 9.0e-3), ("test", 5.0e-3))
"""Of the belt in each run [m/s]."""


@pytest.fixture(scope="module")
def answer():
    overrides = (
        "mechanism.mass=2.0", "mechanism.damping=5.0", "mechanism.stiffness=75000.0", "mechanism.normal_force=300.0",
        "simulation.duration=10.0", "simulation.output_step=2e-4",
    )  # fmt: skip
    base = load_scenario("kang2015_table1", overrides=overrides)
    stated = dataclasses.replace(
        base,
        law=make_law("coulomb", mu_s=0.45, mu_k=0.3),
        process=None,
        effects=(),
        uncertainty={"mass": 0.02, "stiffness": 0.03, "damping": 0.5, "mu_s": 0.2, "mu_k": 0.2},
    )
    mode = make_effect("second_mode", mass_ratio=RATIO, frequency=FREQUENCY, damping_ratio=0.0093)
    runs = []
    for number, (role, speed) in enumerate(SPEEDS):
        mechanism = dataclasses.replace(stated.mechanism, belt_velocity=speed)
        motion = simulate(dataclasses.replace(stated, mechanism=mechanism, effects=(mode,)), seed=number)
        noise = NOISE * np.random.default_rng(number).standard_normal(motion.time.size)
        runs.append(
            Run(
                name=f"{role} {number}",
                role=role,
                time=motion.time,
                channels={"position": motion.position + noise},
                sample_interval=2.0e-4,
                settings={"belt_velocity": speed},
            )
        )
    return discover(Dataset(title="", scenario_path=None, scenario=stated, runs=tuple(runs))).result


def test_it_is_named_with_its_frequency_and_its_mass(answer):
    assert [e.kind for e in answer.effects] == ["second_mode"]
    found = answer.effects[0].parameters
    # the half-power bandwidth is 2 %
    assert found["frequency"].value == pytest.approx(FREQUENCY, rel=0.005)
    assert found["mass_ratio"].low < RATIO < found["mass_ratio"].high


def test_forecasts_are_those_of_a_true_model(answer):
    assert answer.gap.closed > 0.95
