"""The reference solver: its closed form, its interface."""

import dataclasses
import math

import numpy as np
import pytest

from stochfric_mb import (
    BeltBox,
    CoefficientPath,
    Coulomb,
    ElasticStick,
    InputError,
    Knots,
    Lugre,
    Matern,
    OrnsteinUhlenbeck,
    PerEvent,
    SimulationError,
    Spatial,
    load_scenario,
    make_law,
)
from stochfric_mb.laws import LAWS
from stochfric_mb.reference import simulate, solve

BOX = BeltBox(mass=6.08, damping=0.768, stiffness=3956.0, normal_force=13.0, belt_velocity=2.5e-3)
SHAKEN = dataclasses.replace(BOX, excitation_amplitude=0.5e-3, excitation_angular_frequency=18.7)
KNOTS = Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01)
ACCURACY = 1.0e-9  # m, what the reference claims


# --- closed form ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("process", [None, KNOTS, Matern(sigma_s=0.015, sigma_k=0.023, correlation_time=0.1)])
@pytest.mark.parametrize(
    "box",
    [
        BOX,
        SHAKEN,
        dataclasses.replace(BOX, initial_position=0.01, initial_velocity=0.3),
        dataclasses.replace(BOX, damping=400.0, initial_velocity=0.3),  # above the critical damping
        dataclasses.replace(SHAKEN, damping=0.0, excitation_angular_frequency=math.sqrt(3956.0 / 6.08)),  # at resonance
    ],
)
def test_adaptive_coulomb_is_the_closed_form(box, process):
    law = Coulomb(mu_s=0.8, mu_k=0.46)
    times = np.linspace(0.0, 10.0, 1234)
    closed, adaptive = (
        solve(box, law, CoefficientPath(process, law, seed=5), times, method=m) for m in ("closed_form", "adaptive")
    )
    np.testing.assert_allclose(adaptive.position, closed.position, rtol=0.0, atol=ACCURACY)
    np.testing.assert_array_equal(adaptive.events[:, 1], closed.events[:, 1])
    np.testing.assert_allclose(adaptive.events[:, 0], closed.events[:, 0], rtol=0.0, atol=1.0e-9)
    np.testing.assert_array_equal(adaptive.mu_s, closed.mu_s)
    # The holding force moves by k = 4e3 N/m times a difference of 1e-12 m in position.
    np.testing.assert_allclose(adaptive.friction_force, closed.friction_force, rtol=0.0, atol=1.0e-8)


def test_equal_coefficients_never_jump():
    # Without a fall from mu_s to mu_k the box swings about mu N/k, grazing the belt's velocity: amplitude v_b/omega.
    trajectory = solve(BOX, Coulomb(mu_s=0.5, mu_k=0.5), None, np.linspace(0.0, 60.0, 6001))
    swing = np.abs(trajectory.position[trajectory.time > 1.0] - 0.5 * 13.0 / 3956.0)
    assert swing.max() < 1.001 * 2.5e-3 / math.sqrt(3956.0 / 6.08)
    assert swing[-100:].max() < 0.1 * swing.max()


def test_what_the_closed_form_cannot_do():
    law = Coulomb(mu_s=0.8, mu_k=0.46)
    with pytest.raises(InputError, match=r"havsin, not coulomb.*adaptive"):
        solve(BOX, make_law("havsin", mu_s=0.8, mu_k=0.46), None, [1.0], method="closed_form")
    path = CoefficientPath(Spatial(sigma_s=0.01, sigma_k=0.01, spacing=1e-4), law)
    with pytest.raises(InputError, match="not linear in time"):
        solve(BOX, law, path, [1.0], method="closed_form")


# --- every law --------------------------------------------------------------------------------------------------------


@pytest.fixture(params=[k for k, (module, _) in LAWS.items() if module.startswith("stochfric_mb.")])
def law(request):
    return make_law(request.param, mu_s=0.8, mu_k=0.46)


def test_mirror_image(law):
    """With belt, start and excitation reversed, everything is reversed: the laws are odd."""
    flipped = dataclasses.replace(
        SHAKEN, belt_velocity=-SHAKEN.belt_velocity, excitation_amplitude=-SHAKEN.excitation_amplitude, initial_position=-1e-3
    )
    box = dataclasses.replace(SHAKEN, initial_position=1e-3)
    times = np.linspace(0.0, 2.0, 41)
    one, other = (solve(b, law, CoefficientPath(KNOTS, law, seed=2), times) for b in (box, flipped))
    np.testing.assert_allclose(one.position, -other.position, rtol=0.0, atol=1.0e-15)
    np.testing.assert_allclose(one.friction_force, -other.friction_force, rtol=0.0, atol=1.0e-9)


def test_output_times_do_not_matter(law):
    path = CoefficientPath(KNOTS, law, seed=4)
    few = solve(BOX, law, path, [1.2345, 2.5])
    many = solve(BOX, law, path, np.union1d(np.linspace(0.0, 2.5, 3333), [1.2345]))
    at = np.searchsorted(many.time, few.time)
    np.testing.assert_allclose(few.position, many.position[at], rtol=0.0, atol=ACCURACY)
    assert len(few.events) == len(many.events)


def test_energy_balance(law):
    """What friction and damping do is what the box gains: the recorded force is the one that acted."""
    times = np.linspace(0.0, 1.6, 64001)
    r = solve(BOX, law, CoefficientPath(KNOTS, law, seed=1), times)
    energy = 0.5 * BOX.mass * r.velocity**2 + 0.5 * BOX.stiffness * r.position**2
    power = r.friction_force * r.velocity - BOX.damping * r.velocity**2
    work = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(times))])
    # The trapezoidal rule is off by half a step of the jump of power at each switch: 5 N times 0.1 m/s times 2.5e-5 s.
    np.testing.assert_allclose(energy, work, rtol=0.0, atol=2.0e-5)


def test_continues_from_its_own_end(law):
    path = CoefficientPath(KNOTS, law, seed=6)
    whole = solve(BOX, law, path, [1.3, 2.6], method="adaptive")
    first = solve(BOX, law, path, [1.3], method="adaptive")
    second = solve(
        BOX,
        law,
        path,
        [2.6],
        method="adaptive",
        start_time=1.3,
        initial_state=(first.position[-1], first.velocity[-1]),
        law_state=first.attributes["final_law_state"],
    )
    assert second.position[-1] == pytest.approx(whole.position[-1], abs=ACCURACY)


# --- coefficients -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "process",
    [
        KNOTS,
        OrnsteinUhlenbeck(sigma_s=0.015, sigma_k=0.023, correlation_time=0.1),
        Matern(sigma_s=0.015, sigma_k=0.023, correlation_time=0.1),
        Spatial(sigma_s=0.015, sigma_k=0.023, spacing=1.0e-4),
        PerEvent(sigma_s=0.015, sigma_k=0.023),
    ],
    ids=lambda p: p.kind,
)
@pytest.mark.parametrize("law", [Coulomb(mu_s=0.8, mu_k=0.46), ElasticStick(mu_s=0.8, mu_k=0.46)], ids=lambda law: law.kind)
def test_recorded_coefficients_are_the_path(process, law):
    times = np.linspace(0.0, 3.0, 301)
    r = solve(BOX, law, CoefficientPath(process, law, seed=9), times)
    path = CoefficientPath(process, law, seed=9)
    sticks = r.events[r.events[:, 1] == 0.0, 0]
    for i, t in enumerate(times):
        expected = path.at(t, BOX.belt_velocity * t - r.position[i], int(np.sum(sticks <= t)))
        assert (r.mu_s[i], r.mu_k[i]) == expected
    sliding = (r.stick == 0.0) & (np.abs(BOX.belt_velocity - r.velocity) > 0.02)
    assert sliding.sum() > 5
    # At 20 mm/s the elastic law is within exp(-20) of mu_k; reading between knots and the path round differently.
    np.testing.assert_allclose(np.abs(r.friction_force[sliding]), 13.0 * r.mu_k[sliding], rtol=1.0e-8)


def test_a_lower_pair_at_restick_lets_go_at_once():
    # With sigma_s = 0.2 one new mu_s in fifteen cannot hold the 1 to 3 N at which the box comes to rest.
    law = Coulomb(mu_s=0.5, mu_k=0.1)
    path = CoefficientPath(PerEvent(sigma_s=0.2, sigma_k=0.0), law, seed=1)
    r = solve(BOX, law, path, np.linspace(0.0, 60.0, 6001))
    same = np.flatnonzero(np.diff(r.events[:, 0]) == 0.0)
    assert len(same) >= 1
    np.testing.assert_array_equal(r.events[same, 1], 0.0)
    held = r.stick == 1.0
    assert np.all(np.abs(r.friction_force[held]) <= r.mu_s[held] * 13.0 * (1.0 + 1.0e-12))


# --- interface --------------------------------------------------------------------------------------------------------


def test_simulate_is_solve_on_the_scenario():
    scenario = load_scenario("kang2015_table1", overrides=["simulation.duration=1.0"])
    seen = []
    r = simulate(scenario, seed=3, sample=2, dt=1.0e-4, progress=seen.append)
    again = solve(scenario.mechanism, scenario.law, scenario.path(3, 2), scenario.output_times())
    np.testing.assert_array_equal(r.position, again.position)
    np.testing.assert_array_equal(r.time, scenario.output_times())
    assert r.attributes["engine"] == "reference"
    assert (r.attributes["seed"], r.attributes["sample"], r.attributes["law"]) == (3, 2, "elastic_stick")
    assert seen == [pytest.approx(0.999), pytest.approx(1.0)]
    assert np.all(r.normal_force == 13.0)


def test_events_alternate_and_match_the_stick_flag():
    scenario = load_scenario("kang2015_table1")
    r = simulate(scenario, seed=1)
    kinds = r.events[:, 1]
    assert np.all(np.diff(r.events[:, 0]) > 0.0)
    assert np.all(np.abs(np.diff(kinds)) == 1.0)
    last = np.searchsorted(r.events[:, 0], r.time, side="right") - 1
    after = last >= 0
    np.testing.assert_array_equal(r.stick[after], 1.0 - kinds[last[after]])


def test_negative_belt_and_no_belt():
    law = Coulomb(mu_s=0.8, mu_k=0.46)
    still = dataclasses.replace(BOX, belt_velocity=0.0, initial_position=5.0e-3)
    r = solve(still, law, None, np.linspace(0.0, 2.0, 201))
    # Free slides of half a period lose 2 mu_k N/k each; the box stops inside the dead band mu_s N/k and stays.
    assert r.velocity[-1] == 0.0
    assert r.stick[-1] == 1.0
    assert abs(r.position[-1]) < 0.8 * 13.0 / 3956.0
    loss = 2.0 * 0.46 * 13.0 / 3956.0
    assert r.position[-1] == pytest.approx(-(5.0e-3 - loss), abs=0.02 * 5.0e-3)  # damping ratio 0.0025: 1.6 % a cycle


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"times": []}, "not finite numbers"),
        ({"times": [0.0, math.nan]}, "not finite numbers"),
        ({"times": [1.0, 0.5]}, r"times\[1\] = 0.5 s is not after 1 s"),
        ({"times": [-1.0]}, "before start_time = 0 s"),
        ({"rtol": 1.0}, "rtol = 1"),
        ({"method": "magic"}, "unknown method 'magic'"),
        ({"initial_state": (1.0,)}, "initial_state has 1 entries"),
        ({"law_state": (1.0,)}, "law_state has 1 entries; elastic_stick has 5: mode"),
    ],
)
def test_bad_input(options, message):
    options = {"times": [1.0]} | options
    times = options.pop("times")
    with pytest.raises(InputError, match=message):
        solve(BOX, ElasticStick(mu_s=0.8, mu_k=0.46), None, times, **options)


def test_breakdown_is_an_error():
    law = Lugre(mu_s=0.8, mu_k=0.46)
    with pytest.raises(SimulationError, match="not finite after t = 0 s"):
        solve(BOX, law, None, [1.0], law_state=(0.0, 0.0, 0.0, math.inf, 0.0))
