"""Closed-form mechanics of one box on a belt: free, sliding, stopping, held and broken away."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from stochfric_mb.testing.candidates import Candidate
from stochfric_mb.testing.cases import BLOCK, MU_K, MU_S, STEP, case, natural_rate, stands_in, static_deflection
from stochfric_mb.testing.closed_form import coulomb_decay, linear_motion, load_time, sliding_stop

SLOW = 2.0 * math.pi
"""Angular frequency of the slow load [rad/s]; its period is 1 s."""


@pytest.mark.parametrize("foot", [0.0, 5.0e-3], ids=["free", "forced"])
def test_without_friction_it_swings_as_a_linear_oscillator(engine: Candidate, foot: float) -> None:
    s = case(
        "elastic_stick", 1.0, mechanism=BLOCK, parameters={"mu_s": 1.0e-10, "mu_k": 1.0e-10}, damping=4.0,
        initial_position=0.01, initial_velocity=0.1, excitation_amplitude=foot, excitation_angular_frequency=13.0,
    )  # fmt: skip
    run = engine.simulate(s, dt=STEP)
    x, v = linear_motion(s.mechanism, 0.01, 0.1)(run.time)
    tolerance = engine.accuracy.tolerance(0.01 + foot, natural_rate(s), STEP)
    assert np.max(np.abs(run.position - x)) <= tolerance
    assert np.max(np.abs(run.velocity - v)) <= natural_rate(s) * tolerance


@pytest.mark.parametrize("side", [1.0, -1.0], ids=["forwards", "backwards"])
def test_a_sliding_box_decelerates(engine: Candidate, side: float) -> None:
    s = case("coulomb", 0.06, mechanism=BLOCK, damping=4.0, initial_velocity=0.5 * side)
    run = engine.simulate(s, dt=STEP)
    x, v = linear_motion(s.mechanism, 0.0, 0.5 * side, force=-side * MU_K * s.mechanism.normal_force)(run.time)
    assert np.min(side * v) > 0.05  # the closed form has not stopped yet
    tolerance = engine.accuracy.tolerance(0.5 / natural_rate(s), natural_rate(s), STEP)
    assert np.max(np.abs(run.position - x)) <= tolerance
    assert np.max(np.abs(run.velocity - v)) <= natural_rate(s) * tolerance
    expected = -side * MU_K * s.mechanism.normal_force
    np.testing.assert_allclose(run.friction_force, expected, rtol=engine.accuracy.floor)
    assert not run.stick.any()


def test_a_sliding_box_stops_and_stays(engine: Candidate) -> None:
    s = case("coulomb", 1.0, mechanism=BLOCK, initial_velocity=0.1, output_step=STEP)
    run = engine.simulate(s, dt=STEP)
    when, where = sliding_stop(s.mechanism, MU_K)
    assert where < static_deflection(s)  # so that mu_s N can hold it there
    omega = natural_rate(s)
    tolerance = engine.accuracy.tolerance(0.1 / omega, omega, STEP, switches=True, stand_in=stands_in(run, s))
    late = run.time > when + 0.2  # an elastic stand-in has swung out by then
    assert np.max(np.abs(run.position[late] - where)) <= tolerance
    assert np.ptp(run.position[late]) <= engine.accuracy.floor * where  # it stays: 0.7 s
    assert np.all(run.stick[late] == 1.0)
    stop = run.time[np.argmax(run.stick)]
    assert stop == pytest.approx(when, abs=3.0 * STEP)  # a step to see it, one to commit, one between outputs
    np.testing.assert_allclose(run.friction_force[late], s.mechanism.stiffness * where, rtol=tolerance / where)


def test_a_stuck_box_rings_down_on_its_spring_and_damper(engine: Candidate) -> None:
    """The contact's own oscillation, 547 1/s with 30 % damping: a force that is half a step late takes h omega/4 off that."""
    dt = 2.0e-5
    s = case(
        "elastic_stick", 0.02, mechanism=BLOCK, parameters={"v_s": 5.0e-3}, initial_velocity=2.0e-3, output_step=1.0e-4
    )  # fmt: skip
    law, m = s.law, s.mechanism
    spring = law.mu_s * m.normal_force / law.e_lim  # type: ignore[attr-defined]
    damper = 2.0 * law.zeta * math.sqrt(spring * m.mass)  # type: ignore[attr-defined]
    run = engine.simulate(s, dt=dt)
    assert np.all(run.stick == 1.0)
    stuck = dataclasses.replace(m, stiffness=m.stiffness + spring, damping=damper)
    x, v = linear_motion(stuck, 0.0, 2.0e-3)(run.time)
    omega = math.sqrt(stuck.stiffness / m.mass)
    assert np.max(np.abs(x)) < law.e_lim  # type: ignore[attr-defined]
    tolerance = engine.accuracy.tolerance(2.0e-3 / omega, omega, dt)
    assert np.max(np.abs(run.position - x)) <= tolerance
    assert np.max(np.abs(run.velocity - v)) <= omega * tolerance


@pytest.mark.parametrize("law", ["coulomb", "elastic_stick"])
def test_a_load_below_mu_s_n_is_held(engine: Candidate, law: str) -> None:
    foot = 0.5 * 0.95 * MU_S * BLOCK["normal_force"] / BLOCK["stiffness"]  # the load k foot (1 - cos W t) reaches 95 %
    s = case(
        law, 3.0, mechanism=BLOCK, initial_position=foot, excitation_amplitude=foot, excitation_angular_frequency=SLOW
    )  # fmt: skip
    run = engine.simulate(s, dt=STEP)
    m = s.mechanism
    load = m.stiffness * foot * (1.0 - np.cos(SLOW * run.time))
    spring = s.law.mu_s * m.normal_force / s.law.e_lim if law == "elastic_stick" else math.inf  # type: ignore[attr-defined]
    give = load / (m.stiffness + spring)
    # the contact's spring lags behind the load by 2 zeta W/omega_stick = 0.7 % of its deflection and swings as little
    lag = 0.02 * float(np.max(give)) + engine.accuracy.tolerance(
        static_deflection(s), natural_rate(s), STEP, switches=True, stand_in=stands_in(run, s)
    )
    assert np.max(np.abs(run.position - (foot - give))) <= lag
    period = round(1.0 / s.output_step)
    assert abs(run.position[-1] - run.position[-1 - period]) <= 1e-6 * foot + engine.accuracy.floor * foot  # no creep
    assert np.all(run.stick == 1.0)


@pytest.mark.parametrize("law", ["coulomb", "elastic_stick"])
def test_it_breaks_away_at_mu_s_n(engine: Candidate, law: str) -> None:
    foot = 0.5 * 1.5 * MU_S * BLOCK["normal_force"] / BLOCK["stiffness"]
    s = case(
        law, 0.4, mechanism=BLOCK, initial_position=foot, excitation_amplitude=foot, excitation_angular_frequency=SLOW,
        output_step=STEP,
    )  # fmt: skip
    run = engine.simulate(s, dt=STEP)
    m = s.mechanism
    limit = MU_S * m.normal_force
    # an elastic contact gives way by e_lim, which takes k e_lim off the load
    give = m.stiffness * s.law.e_lim if law == "elastic_stick" else 0.0  # type: ignore[attr-defined]
    when = load_time(m, limit + give)
    # the contact's damper makes the deflection follow a growing load late by 2 zeta/omega_stick = c/k
    if law == "elastic_stick":
        when += 2.0 * s.law.zeta * math.sqrt(s.law.e_lim * m.mass / limit)  # type: ignore[attr-defined]
    first = run.time[np.argmin(run.stick)]
    assert run.stick.min() == 0.0
    assert first == pytest.approx(when, abs=3.0 * STEP)  # a step to see it, one to commit, one between outputs
    before = run.friction_force[: np.argmin(run.stick)]
    rate = m.stiffness * foot * SLOW  # of the load, at most [N/s]
    assert np.max(before) == pytest.approx(limit, abs=3.0 * STEP * rate)


def test_amplitude_falls_by_2_mu_n_over_k_each_half_swing(engine: Candidate) -> None:
    s = case("coulomb", 1.0, mechanism=BLOCK, parameters={"mu_s": 0.4, "mu_k": 0.4}, initial_position=0.0325)
    run = engine.simulate(s, dt=STEP)
    exact = coulomb_decay(s.mechanism, 0.4, run.time)
    turns = round(0.0325 / (2.0 * 0.4 * 10.0 / 800.0))  # 3 half swings of 10 mm, then at rest at -2.5 mm
    assert exact[-1] == pytest.approx(0.0325 * (-1) ** turns + 0.01 * turns, abs=1e-12)
    tolerance = engine.accuracy.tolerance(0.0325, natural_rate(s), STEP, switches=True, stand_in=stands_in(run, s))
    assert np.max(np.abs(run.position - exact)) <= tolerance
