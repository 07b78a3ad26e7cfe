"""Friction that is drawn anew for each stroke of a driven joint: named with its size, and not where there is none."""

import dataclasses

import numpy as np
import pytest
from scipy.signal import lfilter

from stochfric_mb.discovery.driven_joint import joint_outcome
from stochfric_mb.scenario import any_scenario_from_dict
from tests.discovery.joints.test_parts import coulomb, pair

SHARE = 0.2
"""Standard deviation of each stroke's friction, over its mean."""


def drawn(seed, share=SHARE, memory=0.0):
    """Friction with a factor for each stroke, independent or resembling that of two strokes before (same direction)."""
    rng = np.random.default_rng(seed)

    def friction(q, v):
        stroke = np.cumsum(np.r_[0, np.diff(np.sign(v)) != 0])
        draws = rng.standard_normal(stroke[-1] + 1)
        for i in range(2, len(draws)):
            draws[i] = memory * draws[i - 2] + np.sqrt(1.0 - memory**2) * draws[i]
        return (1.0 + share * draws)[stroke] * coulomb(q, v)

    return friction


def longer(data, others):
    """The runs of several datasets together, the fit runs first."""
    runs = [dataclasses.replace(r, name=f"{r.name} {i}") for i, d in enumerate((data, *others)) for r in d.runs]
    return dataclasses.replace(data, runs=tuple(runs))


@pytest.fixture(scope="module")
def data():
    return longer(pair(drawn(1)), [pair(drawn(2)), pair(drawn(3))])


@pytest.fixture(scope="module")
def outcome(data):
    return joint_outcome(data)


def test_it_is_named_with_its_size(outcome):
    effects = outcome.result.effects
    assert [e.kind for e in effects] == ["random_coefficients"]
    sigma = effects[0].parameters["sigma_k"]
    assert sigma.low < SHARE * 0.1 < sigma.high
    assert sigma.high < 2.0 * sigma.low
    assert effects[0].p_value < 1e-6
    assert "each stroke" in effects[0].where.text


def test_what_is_left_is_the_floor_then(outcome):
    place = outcome.places[0]
    # scatter cannot be foreseen: held-out runs are off by it, and by the noise
    assert place.scores["augmented"].sliding == pytest.approx(place.floor, rel=0.25)


def test_once_it_is_believed_nothing_is_missing(data, outcome):
    scenario = any_scenario_from_dict(outcome.scenario.to_dict())
    assert scenario == outcome.scenario
    assert [e.kind for e in scenario.effects] == ["random_coefficients"]
    assert joint_outcome(dataclasses.replace(data, scenario=scenario)).result.verdict == "none"


def test_strokes_that_resemble_those_before_are_not_drawn_anew():
    walks = [pair(drawn(s, memory=0.95)) for s in (4, 5, 6)]
    result = joint_outcome(longer(walks[0], walks[1:])).result
    assert "random_coefficients" not in [e.kind for e in result.effects]


@pytest.mark.parametrize("seed", [1017, 1111])
def test_slow_noise_of_the_force_is_no_friction(seed):
    rng = np.random.default_rng(seed)

    def noisy(run):
        slow = lfilter([np.sqrt(1.0 - 0.995**2)], [1.0, -0.995], rng.standard_normal(len(run.time)))  # 0.2 s, half a stroke
        return dataclasses.replace(run, channels={**run.channels, "force": run.channels["force"] + 0.2 * slow})

    plain = pair(coulomb)
    result = joint_outcome(dataclasses.replace(plain, runs=tuple(map(noisy, plain.runs)))).result
    assert result.verdict == "none"
