"""The ensembles' kernels against the event-located reference and against known limit cycles."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from stochfric_mb import Knots, Matern, OrnsteinUhlenbeck, OutputStep, ensemble, make_law
from stochfric_mb.reference import solve
from stochfric_mb.scenario import load_scenario

SIGMAS = {"sigma_s": 0.015, "sigma_k": 0.023}
TABLES = ["kang2015_table1", "kang2015_table2_13_8", "kang2015_table2_18_7"]


def worst(scenario, result, samples, times, seed):
    """Return the largest difference of position [m] and velocity [m/s] to the reference, and of the stick flags."""
    dx = dv = 0.0
    wrong = 0
    for j in samples:
        t = solve(scenario.mechanism, scenario.law, scenario.path(seed, j), times)
        dx = max(dx, np.max(np.abs(t.position - result.position[j])))
        dv = max(dv, np.max(np.abs(t.velocity - result.velocity[j])))
        wrong += int(np.sum(t.stick != result.stick[j]))
    return dx, dv, wrong


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize("spacing", [0.01, 0.001, 0.0037])
def test_coulomb_is_the_reference(name, spacing):
    s = load_scenario(name, law="coulomb", overrides=[f"coefficients.spacing={spacing}"])
    times = np.arange(1, 101) / 10
    result = ensemble.run(s, 12, seed=4, output_times=times)
    dx, dv, wrong = worst(s, result, range(12), times, 4)
    # two closed forms, each with a rounding of 1e-18 m a leg and 1e-17 s an event; 1e-9 m is the promise
    assert dx < 1e-13
    assert dv < 1e-12
    assert wrong == 0


@pytest.mark.parametrize(
    "process",
    [
        None,
        OutputStep(**SIGMAS, spacing=1e-3),
        OrnsteinUhlenbeck(**SIGMAS, correlation_time=0.05),
        Matern(**SIGMAS, correlation_time=0.2),
        Knots(**SIGMAS, spacing=0.7),
    ],
    ids=lambda p: "none" if p is None else p.kind,
)
def test_coulomb_is_the_reference_for_every_process_in_time(process):
    s = dataclasses.replace(load_scenario("kang2015_table1", law="coulomb"), process=process)
    times = np.arange(1, 11) / 2
    result = ensemble.run(s, 8, seed=4, output_times=times)
    dx, dv, wrong = worst(s, result, range(8), times, 4)
    assert dx < 1e-13  # as above
    assert dv < 1e-12
    assert wrong == 0


@given(
    mass=st.floats(1.0, 20.0),
    ratio=st.floats(0.0, 0.9),
    stiffness=st.floats(500.0, 2e4),
    v_b=st.floats(-0.02, 0.02),
    u_0=st.sampled_from([0.0, 5e-4, 2e-3]),
    w=st.floats(1.0, 60.0),
    x=st.floats(-5e-3, 5e-3),
    v=st.floats(-0.1, 0.1),
)
@example(2.0, 0.1484375, 19905.0, 0.009143624419330993, 0.0, 1.0, 0.0, 0.0).via("a slip that grazes rest within a leg")
@settings(max_examples=30, deadline=None)
def test_coulomb_is_the_reference_for_any_belt_box(mass, ratio, stiffness, v_b, u_0, w, x, v):
    s = load_scenario("kang2015_table1", law="coulomb")
    m = dataclasses.replace(
        s.mechanism,
        mass=mass,
        stiffness=stiffness,
        damping=ratio * 2.0 * math.sqrt(mass * stiffness),
        belt_velocity=v_b,
        excitation_amplitude=u_0,
        excitation_angular_frequency=w,
        initial_position=x,
        initial_velocity=v,
    )
    s = dataclasses.replace(s, mechanism=m)
    times = np.arange(1, 9) / 4
    result = ensemble.run(s, 4, seed=1, output_times=times)
    dx, _, wrong = worst(s, result, range(4), times, 1)
    # 1e-9 m: the promise; a slip that just grazes rest magnifies roundings
    assert dx < 1e-9
    assert wrong == 0


def test_coulomb_with_more_than_critical_damping():
    """No closed form of the reference covers it: here against its adaptive integration (local error 1e-12)."""
    s = load_scenario("kang2015_table1", law="coulomb")
    m = dataclasses.replace(s.mechanism, damping=2.5 * math.sqrt(s.mechanism.mass * s.mechanism.stiffness))
    s = dataclasses.replace(s, mechanism=dataclasses.replace(m, initial_velocity=0.2))
    times = np.arange(1, 9) / 4
    dx, _, wrong = worst(s, ensemble.run(s, 4, output_times=times), range(4), times, 0)
    assert dx < 1e-9
    assert wrong == 0


def test_coulomb_driven_at_resonance_without_damping():
    s = load_scenario("kang2015_table2_13_8", law="coulomb")
    w = math.sqrt(s.mechanism.stiffness / s.mechanism.mass)
    m = dataclasses.replace(s.mechanism, damping=0.0, excitation_angular_frequency=w)
    s = dataclasses.replace(s, mechanism=m)
    times = np.arange(1, 9) / 4
    dx, _, wrong = worst(s, ensemble.run(s, 4, output_times=times), range(4), times, 0)
    assert dx < 1e-9
    assert wrong == 0


@pytest.mark.parametrize(
    ("name", "x_2", "x_10"),
    [
        ("kang2015_table1", 2.446805516646e-3, 2.046679350891e-3),
        ("kang2015_table2_13_8", 5.961716603614e-4, 3.523870806925e-4),
        ("kang2015_table2_18_7", 9.220033851736e-4, 4.901865000750e-4),
    ],
)
def test_deterministic_coulomb_passes_the_known_positions(name, x_2, x_10):
    s = dataclasses.replace(load_scenario(name, law="coulomb"), process=None)
    result = ensemble.run(s, 1, output_times=[2.0, 10.0])
    # the closed form and the event-located formula that these numbers come from agreed to 9e-12 m
    assert result.position[0] == pytest.approx([x_2, x_10], abs=1e-11)


@pytest.mark.parametrize(
    ("name", "period", "fraction", "span"),
    [
        ("kang2015_table1", 1.020006308, 0.872499, 40.0),
        ("kang2015_table2_13_8", 1.821213133, 0.940082, 400.0),
        ("kang2015_table2_18_7", 1.679996071, 0.939335, 800.0),
    ],
)
def test_deterministic_coulomb_limit_cycles(name, period, fraction, span):
    s = dataclasses.replace(load_scenario(name, law="coulomb"), process=None, duration=2.0 * span)
    short, long = (ensemble.run(s, 1, output_times=[t]) for t in (span, 2.0 * span))
    n = long.n_break_aways[0] - short.n_break_aways[0]
    between = (long.tallies[0, 2] - short.tallies[0, 2]) / n  # between the last break-aways before span and 2 span
    assert between == pytest.approx(period, abs=1e-8)  # printed to 1e-9 s, settled to 1e-9 m
    stuck = (long.tallies[0, 4] - short.tallies[0, 4]) / span
    # the two ends cut a cycle each: at most one slip, 0.13 s
    assert stuck == pytest.approx(fraction, abs=0.13 / span)


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize(("law", "bound_x", "bound_v"), [("havsin", 2e-9, 1e-7), ("elastic_stick", 3e-10, 1e-8)])
def test_smoothed_laws_follow_the_reference(name, law, bound_x, bound_v):
    """Measured at the default step, Table 1: 2e-10 m (havsin) and 3e-11 m (elastic); bounds leave a factor of ten."""
    s = load_scenario(name, law=law)
    times = np.arange(1, 21) / 10
    result = ensemble.run(s, 6, seed=4, output_times=times)
    dx, dv, wrong = worst(s, result, range(6), times, 4)
    assert dx < bound_x
    assert dv < bound_v
    assert wrong == 0


@pytest.mark.parametrize("law", ["havsin", "elastic_stick"])
def test_smoothed_laws_for_other_processes(law):
    for process in (None, OrnsteinUhlenbeck(**SIGMAS, correlation_time=0.05), Knots(**SIGMAS, spacing=0.0037)):
        s = dataclasses.replace(load_scenario("kang2015_table1", law=law), process=process)
        times = np.arange(1, 13) / 10
        dx, _, wrong = worst(s, ensemble.run(s, 3, output_times=times), range(3), times, 0)
        assert dx < 2e-9  # as above
        assert wrong == 0


def test_elastic_stick_with_sudden_fall_and_with_a_slow_belt():
    s = load_scenario("kang2015_table1")
    times = np.arange(1, 13) / 10
    for change in ({"decay_velocity": 0.0}, {"zeta": 0.1}, {"e_lim": 1e-4, "v_s": 3e-3}):
        law = make_law("elastic_stick", mu_s=0.8, mu_k=0.46, **change)
        for v_b in (2.5e-3, -2.5e-3, 0.02):
            case = dataclasses.replace(s, law=law, mechanism=dataclasses.replace(s.mechanism, belt_velocity=v_b))
            dx, _, _ = worst(case, ensemble.run(case, 2, output_times=times, dt=5e-5), range(2), times, 0)
            # a chain of switches magnifies the local error of the step; 1e-7 m is 4e-5 of the stroke
            assert dx < 1e-7, (change, v_b)


def orders(law, steps, end):
    """Return the order of convergence of the velocity between successive steps, over the runs of three samples."""
    s = load_scenario("kang2015_table1", law=law)
    times = np.arange(1, 61) * (end / 60)
    errors = [worst(s, ensemble.run(s, 3, output_times=times, dt=dt), range(3), times, 0)[1] for dt in steps]
    return np.diff(np.log(errors)) / np.diff(np.log(steps))


def test_elastic_stick_converges_with_the_fourth_order():
    """Through break-away, slip and re-stick: every kink and switch is located."""
    # over a factor of four in dt; single halvings scatter with where the switches fall within a step
    assert orders("elastic_stick", [2e-4, 5e-5], 1.2)[0] == pytest.approx(4.0, abs=0.6)


def test_havsin_converges_with_the_third_order_at_least():
    """Fourth between the kinks of its curvature, which are stepped over: each leaves dt^3."""
    assert np.all(orders("havsin", [7e-5, 1.75e-5], 1.2) > 2.5)


def test_break_aways_and_stick_time_are_those_of_the_reference():
    s = load_scenario("kang2015_table1", law="coulomb")
    times = np.arange(0, 10_001) / 1000
    result = ensemble.run(s, 6, seed=4, output_times=[10.0])
    for j in range(6):
        t = solve(s.mechanism, s.law, s.path(4, j), times)
        breaks = t.events[t.events[:, 1] == 1.0, 0]
        sticks = t.events[t.events[:, 1] == 0.0, 0]
        assert result.n_break_aways[j] == len(breaks)
        assert result.first_break_away[j] == pytest.approx(breaks[0], abs=1e-12)  # both to 1e-15 s
        assert result.period[j] == pytest.approx(np.diff(breaks).mean(), abs=1e-12)
        ends = np.append(breaks, 10.0)[: len(sticks)]
        assert result.stick_fraction[j] == pytest.approx(np.sum(ends - sticks) / 10.0, abs=1e-12)
        mu = np.mean([s.path(4, j).at(b)[0] for b in breaks])
        assert result.break_away_mu_s[j] == pytest.approx(mu, abs=1e-10)  # slope of mu_s, up to 10/s, times 1e-12 s


@pytest.mark.parametrize("law", ["havsin", "elastic_stick"])
def test_period_of_smoothed_laws(law):
    from stochfric_mb import metrics

    s = dataclasses.replace(load_scenario("kang2015_table1", law=law), duration=5.0)
    result = ensemble.run(s, 3, seed=4, output_times=[5.0])
    for j in range(3):
        t = solve(s.mechanism, s.law, s.path(4, j), s.output_times())
        # 1e-4 s: metrics locate between samples 1 ms apart
        assert result.period[j] == pytest.approx(metrics.period(t, s.law, s.mechanism), abs=1e-4)
        # each of some 40 passages of v_s in 5 s, ringing included, is located to 1 ms by the samples, either way
        assert result.stick_fraction[j] == pytest.approx(metrics.stick_fraction(t, s.law, s.mechanism), abs=3e-3)


def test_havsin_limit_cycle():
    s = dataclasses.replace(load_scenario("kang2015_table1", law="havsin"), process=None)
    result = ensemble.run(s, 1)
    x = result.position[0][2000:]
    # extremes and period as printed; samples 1 ms apart miss an extreme by up to a (0.5 ms)^2/2 = 2e-7 m
    assert (x.min(), x.max()) == pytest.approx((0.371981e-3, 2.660174e-3), abs=3e-7)
    assert result.period[0] == pytest.approx(1.063097, abs=1e-5)


@pytest.mark.parametrize(("spacing", "mean"), [(0.01, 0.7932), (0.001, 0.7777)])
def test_finer_knots_break_away_earlier(spacing, mean):
    """The knot spacing is a physical parameter: more draws near break-away find a lower mu_s."""
    s = load_scenario("kang2015_table1", law="coulomb", overrides=[f"coefficients.spacing={spacing}"])
    result = ensemble.run(s, 600, output_times=[3.5])
    mu = result.break_away_mu_s
    assert np.nanmean(mu) == pytest.approx(mean, abs=5e-5 + 4.0 * np.nanstd(mu) / math.sqrt(600))  # 4 standard errors


def test_invariance_to_the_step_holds_for_every_path():
    """Same path, half the step: the runs agree, because the path does not know the step."""
    s = load_scenario("kang2015_table1", law="havsin")
    times = np.arange(1, 21) / 10
    coarse, fine = (ensemble.run(s, 64, output_times=times, dt=dt).position for dt in (3.6e-5, 1.8e-5))
    assert np.max(np.abs(coarse - fine)) < 2e-9  # both are within that of the reference, see above
