"""The fast simulator against the package's reference: without effects, and with effects inside an elastic law."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from stochfric_mb.coefficients import CoefficientPath, Knots, OrnsteinUhlenbeck, PerEvent, Process, Spatial
from stochfric_mb.effects import EFFECTS, effect_class
from stochfric_mb.reference import simulate, solve
from stochfric_mb.reference.augmented import Start, augmented_system
from stochfric_mb.scenario import load_scenario
from tests.unit.effects.examples import example

TOLERANCE = 2.0e-8
"""[m]. Some hundred steps of 1e-8 of the static deflection, 2.6e-11 m, between events."""
KINKED = 1.0e-7
"""[m]. A path along the belt has kinks at which steps do not end, where the order falls."""
ELASTIC = 2.5e-7
"""[m]. The same where a break-away is slow: a box on a stuck spring leaves it at some 10 um/s, so that its timing
magnifies the error of the velocity; below the 0.3 um between two samples that the belt moves in 0.1 ms."""
PROCESSES: dict[str, Process | None] = {
    "none": None,
    "knots": Knots(sigma_s=0.015, sigma_k=0.02, spacing=0.01),
    "ornstein_uhlenbeck": OrnsteinUhlenbeck(sigma_s=0.015, sigma_k=0.02, correlation_time=0.5),
    "per_event": PerEvent(sigma_s=0.015, sigma_k=0.02),
    "spatial": Spatial(sigma_s=0.015, sigma_k=0.02, spacing=1.0e-3),
}


@pytest.mark.parametrize("name", PROCESSES)
def test_coulomb_without_effects(name: str) -> None:
    scenario = load_scenario("kang2015_table1", law="coulomb")
    process = PROCESSES[name]
    motion = augmented_system(scenario.mechanism, scenario.law, process=process, seed=3).march(Start(), 1.0e-3, 6000)
    path = CoefficientPath(process, scenario.law, seed=3)
    reference = solve(scenario.mechanism, scenario.law, path, motion.time)
    tolerance = KINKED if name == "spatial" else TOLERANCE
    assert np.abs(motion.position - reference.position).max() < tolerance
    np.testing.assert_array_equal(motion.stick, reference.stick)
    assert len(motion.events) == len(reference.events)
    # an event is late by the error of the position over the least speed with which it is met, that of the belt
    assert np.abs(motion.events - reference.events).max() < tolerance / 2.5e-3
    # along the belt, mu_s differs by its slope, some 0.03 in 1 mm, times the difference of position
    np.testing.assert_allclose(motion.mu_s, reference.mu_s, atol=1.0e-5 if name == "spatial" else 1.0e-12)


@pytest.mark.parametrize("scenario_name", ["kang2015_table2_13_8", "kang2015_table2_18_7"])
def test_a_driven_box(scenario_name: str) -> None:
    scenario = dataclasses.replace(load_scenario(scenario_name, law="coulomb"), process=None)
    motion = augmented_system(scenario.mechanism, scenario.law).march(Start(), 1.0e-3, 6000)
    reference = solve(scenario.mechanism, scenario.law, None, motion.time)
    assert np.abs(motion.position - reference.position).max() < TOLERANCE


@pytest.mark.parametrize("form", ["exponential", "gaussian", "lorentzian"])
def test_stribeck_without_effects(form: str) -> None:
    scenario = load_scenario("kang2015_table1", law="stribeck")
    law = dataclasses.replace(scenario.law, form=form)
    motion = augmented_system(scenario.mechanism, law).march(Start(), 1.0e-3, 4000)
    reference = solve(scenario.mechanism, law, None, motion.time)
    assert np.abs(motion.position - reference.position).max() < TOLERANCE


@pytest.mark.parametrize(
    "kind",
    [
        None,
        *(
            k
            for k in EFFECTS
            if effect_class(k).group not in ("sensor", "randomness")
            and "presliding" not in k
            and not (effect_class(k).reads or example(k).moves_load)
        ),
    ],
)
def test_elastic_stick(kind: str | None) -> None:
    """With effects, the reference runs the law with effects in the adaptive solver: another code for the same model."""
    scenario = dataclasses.replace(load_scenario("kang2015_table1", law="elastic_stick"), process=None)
    effects = () if kind is None else (example(kind),)
    scenario = dataclasses.replace(scenario, effects=effects, duration=2.0, output_step=1.0e-3)
    reference = simulate(scenario)
    motion = augmented_system(scenario.mechanism, scenario.law, effects).march(Start(deflection=0.0), 1.0e-3, 2000)
    assert np.abs(motion.position - reference.position[1:]).max() < ELASTIC
    assert np.median(np.abs(motion.friction_force - reference.friction_force[1:])) < 1.0e-5
    np.testing.assert_allclose(motion.normal_force, reference.normal_force[1:], rtol=1.0e-12)
