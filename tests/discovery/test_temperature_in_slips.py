"""A measured temperature is an axis for slips: friction that follows it is named, and what has no name is a term along it."""

import dataclasses

import numpy as np
import pytest

from stochfric_mb.discovery import discover
from stochfric_mb.discovery.stick_slip.screening.smooth_term import axes_of
from stochfric_mb.effects import make_effect
from stochfric_mb.effects.shapes.splines import COURSE, PIECES, splines
from stochfric_mb.laws import make_law
from stochfric_mb.measurement.dataset import Dataset, Run
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference.augmented import Start, augmented_system
from stochfric_mb.reference.augmented_model import TEMPERATURES
from stochfric_mb.scenario import Scenario

BOX = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
LAW = make_law("coulomb", mu_s=0.8, mu_k=0.46)
RATE, NOISE, STEP, LONG = -0.01, 2.0e-6, 1.0e-3, 40.0


def warming(run: int):
    """Times and temperatures of a run: it warms up and cools down again, at another pace in each."""
    time = np.linspace(-5.0, LONG, TEMPERATURES)
    return time, 25.0 + 5.0 * np.sin(2.0 * np.pi * time / (17.0 + 6.0 * run) + run)


def drift(curvature: float = 0.0):
    return make_effect("temperature_drift", rate=RATE, reference_temperature=25.0, curvature=curvature)


def record(run: int, role: str, effect) -> Run:
    system = augmented_system(BOX, LAW, [effect], temperature=warming(run))
    settled = system.march(Start(-5.0, 0.0, BOX.belt_velocity, stick=True), STEP, round(5.0 / STEP)).end
    position = system.march(settled, STEP, round(LONG / STEP)).position
    rng = np.random.default_rng(run)
    time = STEP * np.arange(len(position))
    channels = {
        "position": position + NOISE * rng.standard_normal(len(position)),
        "temperature": np.interp(time, *warming(run)) + 0.05 * rng.standard_normal(len(position)),
    }
    return Run(name=f"run {run}", role=role, time=time, channels=channels, sample_interval=STEP)


def measured(effect=None) -> Dataset:
    runs = tuple(record(i, role, effect or drift()) for i, role in enumerate(("fit", "fit", "test")))
    scenario = Scenario(mechanism=BOX, law=LAW, duration=LONG, output_step=STEP)
    return Dataset(title="", scenario_path=None, scenario=scenario, runs=runs)


@pytest.fixture(scope="module")
def dataset() -> Dataset:
    return measured()


def test_a_curved_dependence_on_temperature_is_no_drift_in_time():
    curvature = 0.15 * RATE  # at the ends, 5 K off, three quarters of what the straight part does
    result = discover(measured(drift(curvature))).result
    assert [e.kind for e in result.effects] == ["temperature_drift"]
    numbers = result.effects[0].parameters
    rate, about, bend = (numbers[name].value for name in ("rate", "reference_temperature", "curvature"))
    level = 1.0 + RATE * (about - 25.0) + curvature * (about - 25.0) ** 2  # both are relative to friction there
    assert bend == pytest.approx(curvature / level, rel=0.05)
    assert rate == pytest.approx((RATE + 2.0 * curvature * (about - 25.0)) / level, rel=0.05)
    assert result.gap.closed > 0.9


def test_friction_that_falls_where_a_lubricant_melts_follows_the_temperature():
    table = 0.12 / (1.0 + np.exp(-(np.linspace(20.0, 30.0, 7) - 25.0) / 0.8))  # over 3 of 10 K
    steep = {f"change_{i}": -float(change) for i, change in enumerate(table) if i}
    melts = make_effect("unnamed", axis="temperature", low=20.0, high=30.0, static_share=1.0, reference_load=13.0, **steep)
    result = discover(measured(melts)).result
    assert [e.kind for e in result.effects] == ["temperature_drift"]
    assert result.gap.closed > 0.9
    assert "details.not_in_augmented" in " ".join(result.notes)
    (told,) = result.details["not_in_augmented"]  # the curve is nowhere else
    found = make_effect(told.pop("kind"), **told)
    place = (np.array([21.0, 25.0, 29.0]) - found.reference_temperature) / found.span
    along = 1.0 + found.change * splines(place, PIECES) @ [getattr(found, name) for name in COURSE]
    true = LAW.mu_k - np.interp([21.0, 25.0, 29.0], np.linspace(20.0, 30.0, 7), table)
    np.testing.assert_allclose(along / along[1], true / true[1], atol=0.01)  # 0.05 K of noise where it falls by 0.07/K


def test_friction_that_follows_a_measured_temperature_is_named(dataset):
    outcome = discover(dataset)
    result = outcome.result
    assert [e.kind for e in result.effects] == ["temperature_drift"]
    rate, reference = (result.effects[0].parameters[name] for name in ("rate", "reference_temperature"))
    true = RATE / (1.0 + RATE * (reference.value - 25.0))  # relative to friction at the reference temperature
    assert rate.low < true < rate.high
    assert rate.value == pytest.approx(true, rel=0.02)
    assert result.gap.closed > 0.9
    assert outcome.scenario.effects == ()  # a simulated belt-box has no measured temperature
    assert any("reads a measured temperature" in note for note in result.notes)
    assert "temperature" in [a.name for a in axes_of(outcome.study.pool)]


def test_without_a_temperature_nothing_is_said_of_it(dataset):
    runs = tuple(
        dataclasses.replace(r, channels={"position": r.channels["position"]}) for r in dataset.runs
    )  # fmt: skip
    result = discover(dataclasses.replace(dataset, runs=runs)).result
    assert "temperature_drift" not in [kind for kind, _ in result.ranking]
