"""Metrics, against motions whose break-aways are known from elsewhere."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from stochfric_mb import Trajectory, load_scenario, make_law, metrics

SCENARIO = dataclasses.replace(load_scenario("kang2015_table1", law="coulomb"), process=None)
M = SCENARIO.mechanism
LAW = SCENARIO.law


def coulomb_cycle(times):
    """Return position, velocity, friction force and break-away times of stick-slip in closed form, started in stick."""
    omega = math.sqrt(M.stiffness / M.mass - (M.damping / (2.0 * M.mass)) ** 2)
    decay = M.damping / (2.0 * M.mass)
    centre = LAW.mu_k * M.normal_force / M.stiffness
    top = (LAW.mu_s * M.normal_force - M.damping * M.belt_velocity) / M.stiffness

    def slip(t):
        a = top - centre
        b = (M.belt_velocity + decay * a) / omega
        e, c, s = np.exp(-decay * t), np.cos(omega * t), np.sin(omega * t)
        return centre + e * (a * c + b * s), e * ((omega * b - decay * a) * c - (omega * a + decay * b) * s)

    ahead = brentq(lambda t: slip(t)[1] - M.belt_velocity, math.pi / omega, 1.5 * math.pi / omega, xtol=1e-15)
    bottom = slip(ahead)[0]
    period = ahead + (top - bottom) / M.belt_velocity
    first = (top - bottom) / M.belt_velocity
    phase = np.mod(times - first, period)
    slips = (phase < ahead) & (times >= first)
    x, v = slip(phase)
    x = np.where(slips, x, bottom + M.belt_velocity * np.where(times < first, times, phase - ahead))
    v = np.where(slips, v, M.belt_velocity)
    friction = np.where(slips, LAW.mu_k * M.normal_force, M.stiffness * x + M.damping * v)
    return x, v, friction, first + period * np.arange(int((times[-1] - first) / period) + 1), ahead / period


def trajectory(times, x, v, friction, mu_s=LAW.mu_s, mu_k=LAW.mu_k):
    full = np.ones_like(times)
    return Trajectory(times, x, v, friction, M.normal_force * full, mu_s * full, mu_k * full, 0.0 * full)


@pytest.mark.parametrize("step", [1e-3, 2.3e-4])
def test_period_of_the_coulomb_cycle(step):
    times = np.arange(0.0, 10.0, step)
    x, v, friction, breaks, _ = coulomb_cycle(times)
    run = trajectory(times, x, v, friction)
    result = metrics.break_aways(run, LAW, M)
    # v_rel grows at (mu_s - mu_k) N/m = 0.73 m/s^2 from 0, so it passes the stick speed 1e-4 m/s 0.1376 ms later; the
    # tangent is off by a third derivative times step^2, about 1e-6 s
    late = LAW.stick_speed * M.mass / ((LAW.mu_s - LAW.mu_k) * M.normal_force)
    np.testing.assert_allclose(result, breaks + late, atol=2e-6)
    assert metrics.period(run, LAW, M) == pytest.approx(1.020006308, abs=5e-7)  # two such errors over nine intervals


def test_stick_fraction_of_the_coulomb_cycle():
    times = np.linspace(0.0, 5 * 1.020006308, 50_001)[:-1]
    x, v, friction, _, slip_share = coulomb_cycle(times)
    share = metrics.stick_fraction(trajectory(times, x, v, friction), LAW, M)
    # the stick speed is passed 0.14 ms after each break-away and reached 0.14 ms before each stick, 2.7e-4 of a period
    assert share == pytest.approx(1.0 - slip_share, abs=5e-4)
    assert 1.0 - slip_share == pytest.approx(0.872499, abs=1e-6)  # the published limit cycle, six digits


def test_period_of_havsin_by_another_integrator():
    law = make_law("havsin", mu_s=0.8, mu_k=0.46)

    def mu(v):
        s = abs(v)
        lo, up, a, b = (0.0, 0.8, 0.0, law.v_s) if s <= law.v_s else (0.8, 0.46, law.v_s, law.v_d)
        r = min((s - a) / (b - a), 1.0)
        return math.copysign(lo + (up - lo) * 0.5 * (1.0 - math.cos(math.pi * r)), v)

    def rhs(_t, y):
        f = mu(M.belt_velocity - y[1]) * M.normal_force
        return [y[1], (f - M.damping * y[1] - M.stiffness * y[0]) / M.mass]

    times = np.arange(0.0, 5.5, 1e-3)
    y = solve_ivp(rhs, (0.0, 5.5), [0.0, 0.0], t_eval=times, method="LSODA", rtol=1e-8, atol=1e-11).y
    friction = np.array([mu(M.belt_velocity - v) for v in y[1]]) * M.normal_force
    run = trajectory(times, y[0], y[1], friction)
    assert metrics.period(run, law, M) == pytest.approx(1.0631, abs=1e-4)  # published to four decimals; location 2e-4/3


def test_ringing_after_a_slip_is_no_break_away():
    times = np.arange(0.0, 10.0, 1e-3)
    x, v, friction, breaks, _ = coulomb_cycle(times)
    since = times - breaks[np.maximum(np.searchsorted(breaks, times) - 1, 0)] - 0.1301
    rings = (since > 0.0) & (since < 0.05)
    shaken = np.where(rings, v + 2e-3 * np.exp(-since / 0.01) * np.sin(413.0 * since), v)
    run = trajectory(times, x, shaken, friction)
    assert np.abs(metrics.relative_velocity(run, M))[rings].max() > 10 * LAW.stick_speed
    assert len(metrics.break_aways(run, LAW, M)) == len(breaks)


def test_reversed_belt_has_the_same_period():
    times = np.arange(0.0, 10.0, 1e-3)
    x, v, friction, _, _ = coulomb_cycle(times)
    backward = dataclasses.replace(M, belt_velocity=-M.belt_velocity)
    run = trajectory(times, -x, -v, -friction)
    forward = metrics.period(trajectory(times, x, v, friction), LAW, M)
    assert metrics.period(run, LAW, backward) == pytest.approx(forward, rel=1e-12)  # the same arithmetic, mirrored


def test_no_break_away_no_period():
    times = np.arange(0.0, 0.5, 1e-3)
    x, v, friction, _, _ = coulomb_cycle(times)
    run = trajectory(times, x, v, friction)
    assert len(metrics.break_aways(run, LAW, M)) == 0
    assert math.isnan(metrics.period(run, LAW, M))


def test_differences():
    assert metrics.max_abs_difference([1.0, 2.0], [1.5, -1.0]) == 3.0
    assert metrics.rms_difference([0.0, 0.0], [3.0, 4.0]) == pytest.approx(math.sqrt(12.5), rel=1e-15)


def _used(scenario, pairs, x=None):
    times = np.array(scenario.output_times())[: len(pairs)]
    x = np.zeros(len(pairs)) if x is None else x
    zero = np.zeros(len(pairs))
    return Trajectory(times, x, zero, zero, zero, pairs[:, 0].copy(), pairs[:, 1].copy(), zero)


def test_path_difference_along_time():
    scenario = load_scenario("kang2015_table1")
    pairs = scenario.path(1).at_times(scenario.output_times()[:200])
    reference, other = _used(scenario, pairs), _used(scenario, pairs + np.array([0.0, 1e-3]))
    assert metrics.coefficient_path_difference(reference, reference, scenario, seed=1) == 0.0
    assert metrics.coefficient_path_difference(other, reference, scenario, seed=1) == pytest.approx(1e-3, rel=1e-9)


def test_path_difference_along_the_belt_is_taken_at_the_runs_own_position():
    from stochfric_mb import Spatial

    scenario = dataclasses.replace(
        load_scenario("kang2015_table1"), process=Spatial(sigma_s=0.015, sigma_k=0.023, spacing=1e-4)
    )
    times = np.array(scenario.output_times()[:300])
    path = scenario.path(1)

    def run(x):
        places = M.belt_velocity * times - x
        return _used(scenario, np.array([path.at(t, u) for t, u in zip(times, places, strict=True)]), x)

    reference, early = run(np.zeros(300)), run(np.linspace(0.0, 2e-4, 300))
    assert metrics.max_abs_difference(early.mu_s, reference.mu_s) > 1e-3
    assert metrics.coefficient_path_difference(early, reference, scenario, seed=1) == 0.0
    assert metrics.coefficient_path_difference(early, reference, scenario, seed=2) > 1e-3


def test_path_difference_by_event_follows_the_sequence_of_draws():
    from stochfric_mb import PerEvent

    scenario = dataclasses.replace(load_scenario("kang2015_table1"), process=PerEvent(sigma_s=0.015, sigma_k=0.023))
    draws = scenario.path(1).pairs(4)
    reference = _used(scenario, draws[[0, 0, 1, 1, 2]])
    for order in ([0, 0, 0, 1, 1], [0, 0, 2, 3, 3]):  # late; one stick phase between two samples
        run = _used(scenario, draws[order])
        assert metrics.coefficient_path_difference(run, reference, scenario, seed=1) == 0.0
        assert metrics.draws_used(run, scenario, seed=1).tolist() == sorted(set(order))
    wrong = _used(scenario, draws[[0, 0, 2, 2, 1]])
    assert metrics.coefficient_path_difference(wrong, reference, scenario, seed=1) > 1e-4  # out of order: no draw fits
    assert metrics.coefficient_path_difference(reference, reference, scenario, seed=2) > 1e-4
