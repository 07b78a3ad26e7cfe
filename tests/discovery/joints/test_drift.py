"""Friction that drifts with time, distance slid or a measured temperature: which of them, and whether the data can say."""

import dataclasses
import importlib.util

import numpy as np
import pytest

from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.discovery.driven_joint.balance.confounding import Confounded, by_state, one_curve
from stochfric_mb.effects import words_of
from stochfric_mb.errors import InputError
from stochfric_mb.measurement import Dataset, Run
from stochfric_mb.scenario import any_scenario_from_dict
from tests.discovery.joints.test_parts import balance_of, scenario

H = 1.0e-3
LONG = 8.0
"""Duration of a run [s]."""
GAINS = (0.5, 1.0, 0.7, 1.2)
"""Size of the motion in each run; the last two are held out."""


def run(number, friction, warmth, *, gain):
    """Strokes on two sines with a temperature; ``friction(t, s, T)`` against the motion, s being the distance slid."""
    rng = np.random.default_rng(100 + number)
    t = H * np.arange(round(LONG / H))
    phase = rng.uniform(0.0, 2.0 * np.pi, 2)
    slow, fast = 4.0 * t + phase[0], 9.0 * t + phase[1]
    q = gain * (0.1 * np.sin(slow) + 0.03 * np.sin(fast))
    v = gain * (0.4 * np.cos(slow) + 0.27 * np.cos(fast))
    a = -gain * (1.6 * np.sin(slow) + 2.43 * np.sin(fast))
    slid = np.cumsum(np.abs(v)) * H
    warm = warmth(number, t)
    force = 2.0 * a + np.sign(v) * friction(t, slid, warm) + 0.02 * rng.standard_normal(len(t))
    channels = {
        "position": q + 1.0e-6 * rng.standard_normal(len(t)),
        "force": force,
        "temperature": warm + 0.1 * rng.standard_normal(len(t)),
    }
    role = "fit" if number < 2 else "test"
    return Run(name=f"{role} {number}", role=role, time=t, channels=channels, sample_interval=H)


def data(friction, warmth, gains=GAINS):
    runs = tuple(run(i, friction, warmth, gain=g) for i, g in enumerate(gains))
    return Dataset(title="", scenario_path=None, scenario=scenario(), runs=runs)


def apart(number, t):
    """A temperature that goes up and down, otherwise in each run."""
    return 30.0 + 8.0 * np.sin(1.7 * t + 2.1 * number)


def with_time(number, t):
    """A temperature that rises through each run alike."""
    return 20.0 + 2.0 * t


def constant(t, s, warm):
    return 2.0 + 0.0 * t


def by_time(t, s, warm):
    return 2.0 * (1.0 - 0.04 * t)


def by_distance(t, s, warm):
    return 2.0 * (1.0 + 0.12 * s)


def by_temperature(t, s, warm):
    return 2.0 * (1.0 - 0.03 * (warm - 30.0))


def test_a_curved_dependence_on_temperature():
    """Friction that thins out as it warms, a parabola over the temperatures measured."""

    def thinning(t, s, warm):
        return 2.0 * (1.0 - 0.02 * (warm - 30.0) + 0.004 * (warm - 30.0) ** 2)

    effects = joint_outcome(data(thinning, apart)).result.effects
    assert [e.kind for e in effects] == ["temperature_drift"]
    numbers = effects[0].parameters
    rate, bend = numbers["rate"], numbers["curvature"]
    about = numbers["reference_temperature"].value - 30.0
    level = 1.0 - 0.02 * about + 0.004 * about**2
    # 0.02 N of noise leave a hundredth of the change
    assert bend.value == pytest.approx(0.004 / level, rel=0.05)
    assert rate.value == pytest.approx((-0.02 + 0.008 * about) / level, rel=0.05, abs=5.0e-4)


@pytest.mark.parametrize(
    ("friction", "kind", "rate", "unit"),
    [
        (by_time, "friction_drift", -0.04, "1/s"),
        (by_distance, "distance_drift", 0.12, "1/m"),
        (by_temperature, "temperature_drift", -0.03, "1/K"),
    ],
)
def test_each_is_told_from_the_others(friction, kind, rate, unit):
    outcome = joint_outcome(data(friction, apart))
    effects = outcome.result.effects
    assert [e.kind for e in effects] == [kind]
    assert effects[0].equivalent_to == ()
    number = effects[0].parameters["rate"]
    assert number.unit == unit
    # the sliding level about which the rate is relative is fitted, too; 0.02 N of noise leave a hundredth of the rate
    assert number.low - 0.02 * abs(rate) <= rate <= number.high + 0.02 * abs(rate)
    gap = outcome.result.gap
    assert gap is not None
    assert gap.closed is not None
    assert gap.closed > 0.9
    assert any_scenario_from_dict(outcome.scenario.to_dict()) == outcome.scenario
    if importlib.util.find_spec("mujoco"):  # the slide runs forward, too
        scores = outcome.places[0].scores
        assert scores["augmented"].forward < 0.5 * scores["recalibrated"].forward


def test_what_rose_together_is_said_by_itself():
    result = joint_outcome(data(by_temperature, with_time, gains=(1.0,) * 4)).result
    drift = {"friction_drift", "distance_drift", "temperature_drift"}
    assert len(result.effects) == 1
    assert {result.effects[0].kind, *result.effects[0].equivalent_to} == drift
    said = " ".join(result.notes)
    assert "time and temperature are confounded here: one explains 100 %" in said
    # they hide behind each other, not behind a mass
    assert not any(f"{words_of(kind)} cannot be distinguished from a correction" in said for kind in drift)


@pytest.mark.parametrize("warmth", [apart, with_time])
def test_a_curve_that_takes_two_of_them_is_neither(warmth):
    # by time and by the distance slid, which grew together in each run: a curve along both, drawn by two effects
    result = joint_outcome(data(lambda t, s, warm: 2.0 * (1.0 - 0.04 * t) * (1.0 + 0.1 * s), warmth)).result
    assert result.verdict == "unknown"
    assert result.where.axis == "time"
    assert "friction drift and distance drift are candidates" in result.where.text
    assert any("went together" in note for note in result.notes)


def test_effects_of_conditions_that_did_not_go_together_are_no_curve():
    kinds = ["friction_drift", "viscous_friction", "temperature_drift"]
    clocks, others = Confounded("time", "temperature", 0.9), Confounded("time", "speed", 0.7)
    assert one_curve(kinds, [clocks, others]) == ("friction_drift", "temperature_drift")
    assert one_curve(kinds, [others, dataclasses.replace(clocks, explained=0.7)]) == ()
    assert one_curve(["friction_drift", "payload"], [clocks]) == ()


def test_a_state_stands_before_the_clock_that_went_together_with_it():
    """Slides that are thrown slow down alike in each run: a law of speed holds in all of them, a clock would begin anew."""
    thrown, others = Confounded("speed", "time", 0.98), Confounded("position", "time", 0.7)
    rivals = ["velocity_weakening", "position_dependent_friction", "distance_drift", "drive_gain_change"]
    assert by_state("friction_drift", rivals, [thrown, others]) == ["velocity_weakening"]
    assert by_state("friction_drift", rivals, [others]) == []
    assert by_state("velocity_weakening", ["friction_drift"], [thrown]) == []


def test_nothing_hidden_nothing_found():
    result = joint_outcome(data(constant, with_time)).result
    assert result.verdict == "none"
    assert not any("time and distance" in note for note in result.notes)


def test_distance_goes_on_in_the_pieces_of_one_record():
    whole = data(by_distance, apart).runs[1]
    kept = dataclasses.replace(whole, source="rig.csv")
    runs = (kept.between(0.0, 5.0, name="first", role="fit"), kept.between(5.0, 9.0, name="last", role="test"))
    outcome = joint_outcome(Dataset(title="", scenario_path=None, scenario=scenario(), runs=runs))
    first, last = outcome.places[0].fit[0], outcome.places[0].test[0]
    # at the ends of a piece the velocity is held over 8 ms of 5 s
    assert last.travelled[0] == pytest.approx(first.travelled[-1], rel=0.002)


def test_a_simulated_belt_has_no_temperature():
    tables = {
        "schema": "stochfric.scenario/1",
        "mechanism": {
            "kind": "belt_box",
            "mass": 1.0,
            "stiffness": 1e3,
            "normal_force": 10.0,
            "damping": 0.0,
            "belt_velocity": 1e-3,
        },
        "law": {"kind": "coulomb", "mu_s": 0.4, "mu_k": 0.3},
        "effects": [{"kind": "temperature_drift", "rate": 0.01}],
        "simulation": {"duration": 1.0, "output_step": 1e-3},
    }
    with pytest.raises(InputError, match="reads a measured temperature"):
        any_scenario_from_dict(tables)


def test_kelvin_and_degrees_give_the_same():
    one = run(0, by_temperature, apart, gain=1.0)
    kelvin = dataclasses.replace(
        one,
        channels={**one.channels, "temperature": one.channels["temperature"] + 273.15},
        units={"temperature": "K"},
    )
    seen = [balance_of(r, scenario()).temperature for r in (one, kelvin)]
    np.testing.assert_allclose(seen[0], seen[1], atol=1e-9)
