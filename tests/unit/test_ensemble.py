"""Ensembles: lanes, blocks, threads, memory, statistics without runs."""

import dataclasses
import itertools
import math
import pickle
import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stochfric_mb import (
    Empirical,
    Knots,
    Lognormal,
    Matern,
    OrnsteinUhlenbeck,
    PerEvent,
    Spatial,
    TruncatedNormal,
    Uniform,
    ensemble,
    make_law,
)
from stochfric_mb.coefficients.path import CURSOR, CoefficientPath
from stochfric_mb.ensemble import elastic_stick, havsin, lanes
from stochfric_mb.ensemble.schedule import schedule
from stochfric_mb.ensemble.sketch import Sketch
from stochfric_mb.errors import InputError, StabilityError
from stochfric_mb.laws import elastic_stick as elastic_law
from stochfric_mb.laws import havsin as havsin_law
from stochfric_mb.scenario import load_scenario

SIGMAS = {"sigma_s": 0.015, "sigma_k": 0.023}
SIDE_BY_SIDE = ["coulomb", "havsin", "elastic_stick"]
TIMES = np.array([0.0, 0.05, 0.123, 0.2])


def scenario(law="coulomb", **changes):
    return dataclasses.replace(load_scenario("kang2015_table1", law=law), **changes)


# --- lanes ------------------------------------------------------------------------------------------------------------


@given(st.floats(-0.5 * math.pi, 0.5 * math.pi))
@settings(deadline=None)
def test_sine(y):
    # 4e-16: two units in the last place of 1
    assert abs(lanes.sine(y) - math.sin(y)) < 4e-16


@given(st.floats(-700.0, 0.0))
@settings(deadline=None)
def test_exponential(y):
    assert lanes.exponential(y) == pytest.approx(math.exp(y), rel=5e-16, abs=0.0)  # two units in the last place


def test_exponential_far_below_is_nothing_that_matters():
    assert 0.0 < lanes.exponential(-1.0e300) < 1e-300


@given(
    speed=st.floats(0.0, 3.0e-3),
    mu_s=st.floats(0.5, 0.9),
    mu_k=st.floats(0.1, 0.5),
    v_s=st.floats(1e-5, 5e-4),
    gap=st.floats(1e-5, 2e-3),
)
@settings(deadline=None)
def test_havsin_without_branches_is_the_law(speed, mu_s, mu_k, v_s, gap):
    v_d = v_s + gap
    ours = havsin.coefficient(speed, mu_s, mu_k, v_s, 1.0 / v_s, 1.0 / (v_d - v_s))
    # 1e-13: (speed - v_s)/(v_d - v_s) loses digits to the difference, by up to v_s/gap = 50 roundings
    assert abs(ours - havsin_law.coefficient(speed, mu_s, mu_k, v_s, v_d)) < 1e-13


@given(speed=st.floats(0.0, 0.05), v_s=st.floats(1e-5, 5e-4), decay=st.one_of(st.just(0.0), st.floats(1e-4, 1e-2)))
@settings(deadline=None)
def test_elastic_slip_without_branches_is_the_law(speed, v_s, decay):
    ours = elastic_stick.coefficient(speed, 0.8, 0.46, v_s, 1.0 / decay if decay > 0.0 else 1e300)
    # 1e-13: the exponent, up to 500, is rounded before exp
    assert abs(ours - elastic_law.slip_coefficient(speed, 0.8, 0.46, v_s, decay)) < 1e-13


@given(z=st.floats(-3e-5, 3e-5), v=st.floats(-5e-3, 5e-3), mu_s=st.floats(0.7, 0.9))
@settings(deadline=None)
def test_elastic_stick_without_branches_is_the_law(z, v, mu_s):
    law = make_law("elastic_stick", mu_s=0.8, mu_k=0.46)
    p, n, m = law.parameters(), 13.0, 6.08
    state = (0.0, 0.0, 0.0, 0.0, 0.0)
    f, _ = elastic_law.force(0.0, z, 0.0, v, 0.0, n, state, mu_s, 0.46, m, 0.0, 0.0, p)
    k, c = elastic_law.stick_stiffness(n, p), elastic_law.stick_damping(n, m, p)
    ours = elastic_stick.stick_force(z, v, elastic_law.deflection_limit(mu_s, p), k, c, mu_s * n)
    # 1e-12 N: a rounding of k z, which is up to 31 N before it is clipped, and of a sum of two such
    assert abs(ours - f) < 1e-12


PROCESSES = [
    Knots(**SIGMAS, spacing=0.01),
    Knots(sigma_s=0.1, sigma_k=0.1, spacing=0.01),  # one pair in 120 is infeasible and redrawn
    Knots(**SIGMAS, spacing=0.01, distribution_s=TruncatedNormal(lower=0.79), distribution_k=Lognormal()),
    Knots(**SIGMAS, spacing=0.01, distribution_s=TruncatedNormal(lower=0.79, upper=0.82)),
    Knots(**SIGMAS, spacing=0.01, distribution_s=Uniform(), distribution_k=Empirical(values=tuple(np.linspace(0.4, 0.5, 20)))),
    OrnsteinUhlenbeck(**SIGMAS, correlation_time=0.05),
    OrnsteinUhlenbeck(**SIGMAS, correlation_time=0.05, distribution_k=Lognormal()),
    OrnsteinUhlenbeck(sigma_s=0.1, sigma_k=0.1, correlation_time=0.05),  # clipped where infeasible
    Knots(**SIGMAS, spacing=0.01, cross_correlation=0.7),
    OrnsteinUhlenbeck(**SIGMAS, correlation_time=0.05, cross_correlation=-0.4),
    Matern(**SIGMAS, correlation_time=0.05),
    Matern(**SIGMAS, correlation_time=0.05, distribution_s=TruncatedNormal(lower=0.79, upper=0.82)),
    None,
]


@pytest.mark.parametrize("process", PROCESSES, ids=lambda p: "none" if p is None else p.kind)
def test_pairs_are_those_of_the_coefficient_path_to_the_bit(process):
    law = make_law("coulomb", mu_s=0.8, mu_k=0.46)
    first, n = 2**32 - lanes.LANES, 120
    a_s, a_k, b_s, b_k = (np.empty(lanes.LANES) for _ in range(4))
    cursors = np.zeros((lanes.LANES, CURSOR))
    descriptor = CoefficientPath(process, law).descriptor
    lanes.first_pairs(descriptor, cursors, 7, first, a_s, a_k, b_s, b_k)
    values = np.empty((n, lanes.LANES, 2))
    for knot in range(n):
        if knot > 0:
            lanes.next_pairs(descriptor, cursors, 7, first, knot, a_s, a_k, b_s, b_k)
        values[knot] = np.column_stack([a_s, a_k])
    for j in (0, 1, 7, 8, lanes.LANES - 1):
        path = CoefficientPath(process, law, seed=7, sample=first + j)
        assert np.array_equal(values[:, j], path.pairs(n))
    # 7680 draws, of which the narrowest bounds clip a third
    assert len(np.unique(values[:, :, 0])) > (0 if process is None else 4000)


# --- schedule ---------------------------------------------------------------------------------------------------------


def test_schedule_meets_every_knot_and_output_once():
    legs = schedule(scenario(), np.array([0.0, 0.005, 0.01, 0.29, 0.295]), longest=0.004)
    ends = legs.start + legs.length
    assert legs.output_at_start
    assert ends[legs.output >= 0] == pytest.approx([0.005, 0.01, 0.29, 0.295], abs=1e-14)  # lengths are rounded to that
    assert np.all(legs.length <= 0.004)
    np.testing.assert_allclose(legs.start[1:], ends[:-1], atol=1e-14)
    starts_knot = np.flatnonzero(legs.from_knot == 0.0)
    assert legs.start[starts_knot] == pytest.approx(0.01 * np.arange(30), abs=1e-13)
    assert legs.knot[starts_knot].tolist() == list(range(30))
    assert np.sum(legs.to_knot == 1.0) == 29
    np.testing.assert_allclose((legs.knot + legs.to_knot) * 0.01, ends, atol=1e-13)


def test_roundings_of_leg_lengths_do_not_add_up():
    legs = schedule(scenario(process=Knots(**SIGMAS, spacing=1e-3 / 7)), np.array([10.0]))
    assert math.fsum(legs.length) == pytest.approx(10.0, abs=1e-13)  # 70,001 legs; rounding each to 1e-14 s gives 1e-10


def test_schedule_without_knots_and_with_an_odd_spacing():
    legs = schedule(scenario(process=None), np.array([1.0]))
    assert (legs.start.tolist(), legs.length.tolist(), legs.output.tolist()) == ([0.0], [1.0], [0])
    odd = schedule(scenario(process=Matern(**SIGMAS, correlation_time=0.07)), np.array([1.0]))
    assert len(odd.length) == 286  # 285 whole spacings of 3.5 ms, and the rest
    assert len(odd.lengths) == 2


# --- blocks, threads, addresses ---------------------------------------------------------------------------------------


def equal(a, b):
    return all(np.array_equal(x, y, equal_nan=True) for x, y in zip(a, b, strict=True))


def arrays(result):
    return result.position, result.velocity, result.stick, result.tallies


@pytest.mark.parametrize("law", SIDE_BY_SIDE)
def test_same_bits_for_any_block_and_any_threads(law):
    s = scenario(law)
    base = arrays(ensemble.run(s, 150, seed=3, output_times=TIMES, block=150))
    for block, threads in ((1, 1), (7, 2), (64, 3), (100, 2)):
        if block == 1 and law != "coulomb":
            continue  # a block of one costs as much as one of LANES
        assert equal(base, arrays(ensemble.run(s, 150, seed=3, output_times=TIMES, block=block, threads=threads)))


@pytest.mark.parametrize("law", SIDE_BY_SIDE)
def test_blocks_of_workers_concatenate(law):
    s = scenario(law)
    whole = arrays(ensemble.run(s, 70, seed=3, first_sample=1000, output_times=TIMES))
    parts = [ensemble.run_block(s, first, n, 3, output_times=TIMES) for first, n in ((1000, 33), (1033, 37))]
    assert equal(whole, [np.concatenate(p) for p in zip(*parts, strict=True)])


@pytest.mark.parametrize("law", SIDE_BY_SIDE)
def test_statistics_do_not_depend_on_block_or_threads(law):
    s = scenario(law)
    one, other = (
        ensemble.run(s, 150, seed=3, output_times=TIMES, statistics_only=True, block=b, threads=t)
        for b, t in ((150, 1), (41, 2))
    )
    for name in ("position", "velocity"):
        for field in ("counts", "low", "exponent", "moments"):
            assert np.array_equal(getattr(one.sketches[name], field), getattr(other.sketches[name], field))
    assert np.array_equal(one.tallies, other.tallies, equal_nan=True)
    assert np.array_equal(one.stick_probability, other.stick_probability)


def test_other_seeds_and_samples_give_other_runs():
    s = scenario()
    base = ensemble.run(s, 3, seed=1, output_times=[2.0]).position
    assert not np.any(ensemble.run(s, 3, seed=2, output_times=[2.0]).position == base)
    shifted = ensemble.run(s, 3, seed=1, first_sample=1, output_times=[2.0]).position
    assert np.array_equal(shifted[:2], base[1:])


def test_output_times_do_not_change_the_runs():
    s = scenario()
    few, many = (ensemble.run(s, 20, output_times=t).position for t in ([0.3, 2.0], np.arange(1, 2001) / 1000))
    # cutting legs changes roundings only, 1e-18 m each
    np.testing.assert_allclose(many[:, -1], few[:, -1], atol=1e-14)
    np.testing.assert_allclose(many[:, 299], few[:, 0], atol=1e-14)


def test_no_two_runs_or_times_share_an_output_array():
    result = ensemble.run(scenario(), 65, output_times=TIMES)
    assert result.position.shape == result.velocity.shape == result.stick.shape == (65, 4)
    assert np.all(result.position[:, 0] == 0.0)
    assert len(np.unique(result.position[:, 3])) == 65


def test_progress_counts_runs():
    seen = []
    ensemble.run(scenario(), 10, output_times=[0.01], block=4, progress=seen.append)
    assert seen == [4, 8, 10]


def test_an_interrupt_leaves_at_once():
    def stop(done):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ensemble.run(scenario(), 64 * 50, output_times=[0.1], block=64, threads=2, progress=stop)


def test_a_block_and_a_result_travel_between_processes():
    s = scenario()
    block = ensemble.run_block(s, 0, 3, 1, output_times=TIMES)
    assert equal(pickle.loads(pickle.dumps(block)), block)
    result = ensemble.run(s, 3, output_times=TIMES, statistics_only=True)
    assert np.array_equal(pickle.loads(pickle.dumps(result)).mean("position"), result.mean("position"))


# --- plan -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("statistics_only", [False, True])
def test_memory_is_what_the_plan_says(statistics_only):
    s, times = scenario(), np.arange(1, 201) * 0.001
    options = {"output_times": times, "statistics_only": statistics_only, "block": 128}
    ensemble.run(s, 4, **options)  # compile first
    p = ensemble.plan(s, 3000, **options)
    tracemalloc.start()
    ensemble.run(s, 3000, **options)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # the schedule, the checks of a block and Python's own objects come on top: about 1 MB here
    assert 0.9 * p.bytes_total < peak < p.bytes_total + 1.5e6
    assert p.n_blocks == 24


def test_a_plan_of_the_demonstration_fits_two_gibibytes():
    s = load_scenario("kang2015_table1")
    p = ensemble.plan(s, 100_000, output_times=np.arange(1, 101) / 10, threads=2)
    assert p.bytes_total < 2**31
    assert p.side_by_side


def test_too_much_memory_is_refused_before_the_run():
    with pytest.raises(InputError, match=r"need .* MiB, more than max_bytes = 1 MiB; ask for fewer"):
        ensemble.run(scenario(), 10_000, max_bytes=2**20)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"output_times": [0.2, 0.1]}, "output_times must increase"),
        ({"output_times": [11.0]}, "within 0 .. duration = 10 s"),
        ({"output_times": [-0.1, 1.0]}, "within 0 .. duration = 10 s"),
        ({"output_times": [0.0]}, "beyond"),
        ({"output_times": [[0.1]]}, "one row"),
        ({"output_times": [math.nan]}, "finite"),
        ({"n_runs": 0}, "n_runs = 0"),
        ({"n_runs": 2.5}, "not a whole number"),
        ({"seed": -1}, "seed = -1"),
        ({"first_sample": 2**32 - 5}, "first_sample"),
        ({"threads": -1}, "threads = -1"),
        ({"block": 0}, "block = 0"),
        ({"engine": "adams"}, "unknown engine 'adams'"),
        ({"bins": 7, "statistics_only": True}, "bins = 7"),
    ],
)
def test_errors_name_the_value(options, message):
    with pytest.raises(InputError, match=message):
        ensemble.run(scenario(), **({"n_runs": 10, "output_times": [0.1]} | options))


def test_a_step_beyond_the_limit_is_refused_with_the_formula():
    with pytest.raises(StabilityError, match=r"dt = 0.0001 s is beyond .* 4 v_s m_eff"):
        ensemble.run(scenario("havsin"), 2, output_times=[0.1], dt=1e-4)


# --- one at a time ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("law", "process"),
    [
        ("coulomb", Spatial(**SIGMAS, spacing=1e-4)),
        ("elastic_stick", PerEvent(**SIGMAS)),
        ("tanh", Knots(**SIGMAS, spacing=0.01)),
        ("lugre", None),
    ],
)
def test_what_has_no_kernel_runs_one_sample_at_a_time(law, process):
    s = scenario(law, process=process, duration=0.05)
    p = ensemble.plan(s, 3)
    assert not p.side_by_side
    result = ensemble.run(s, 3, seed=5, output_times=[0.01, 0.05])
    from stochfric_mb.reference import simulate

    for j in range(3):
        trajectory = simulate(s, seed=5, sample=j)
        assert np.array_equal(result.position[j], trajectory.position[[10, 50]])


def test_another_engine_runs_one_sample_at_a_time():
    pytest.importorskip("pymunk", reason="pymunk is not installed")
    s = scenario("elastic_stick", duration=0.02)
    result = ensemble.run(s, 2, engine="pymunk", output_times=[0.02])
    assert "pymunk" in ensemble.plan(s, 2, engine="pymunk").method
    reference = ensemble.run(s, 2, output_times=[0.02])
    # 1e-6 m: pymunk's own accuracy at this step over 0.02 s is better than that
    assert np.allclose(result.position, reference.position, atol=1e-6)
    assert result.attributes["engine"] == "pymunk"


def test_output_times_between_samples_need_a_kernel():
    with pytest.raises(InputError, match=r"output time 0.0005 s is no multiple of simulation.output_step"):
        ensemble.run(scenario("tanh"), 1, output_times=[0.0005])


# --- result -----------------------------------------------------------------------------------------------------------


def test_statistics_of_kept_runs_and_of_none():
    s = scenario()
    options = {"seed": 2, "output_times": np.arange(1, 21) / 10}
    runs = ensemble.run(s, 700, **options)
    none = ensemble.run(s, 700, statistics_only=True, **options)
    assert none.position is None
    assert np.array_equal(runs.tallies, none.tallies, equal_nan=True)
    assert np.array_equal(runs.stick_probability, none.stick_probability)
    levels = [0.0, 0.025, 0.5, 0.9, 1.0]
    for name in ("position", "velocity"):
        scale = np.abs(runs.mean(name)).max()
        np.testing.assert_allclose(none.mean(name), runs.mean(name), atol=1e-14 * scale)  # rounding of 700 sums
        np.testing.assert_allclose(none.std(name), runs.std(name), atol=1e-10 * scale)  # its root
        error = np.abs(none.quantiles(name, levels) - runs.quantiles(name, levels))
        assert np.all(error <= none.quantile_error(name))
        assert np.all(runs.quantile_error(name) == 0.0)
        spread = runs.quantiles(name, 1.0)[0] - runs.quantiles(name, 0.0)[0]
        assert np.all(none.quantile_error(name) <= np.maximum(2.0 * spread / 2046, 2.0**-44))
        counts, edges = none.histogram(name, 7)
        expected, _ = np.histogram(getattr(runs, name)[:, 7], bins=edges)
        assert counts.sum() == 700
        assert np.array_equal(counts, expected)


def test_unknown_quantities_and_levels():
    result = ensemble.run(scenario(), 2, output_times=[0.1])
    with pytest.raises(InputError, match="unknown quantity 'speed'"):
        result.mean("speed")
    with pytest.raises(InputError, match="must lie in 0"):
        result.quantiles("position", [50.0])
    with pytest.raises(InputError, match="output = 3"):
        result.histogram("position", 3)
    assert np.isnan(ensemble.run(scenario(), 1, output_times=[0.1]).std("position")).all()


def test_events_of_a_run():
    result = ensemble.run(scenario(process=None), 2, output_times=[5.0])
    # limit cycle of Table 1: break-aways 1.020006308 s apart (the first ones are in the transient, good to 1e-3 s)
    assert result.n_break_aways.tolist() == [4.0, 4.0]
    assert result.period[0] == pytest.approx(1.020006, abs=1e-3)
    assert result.break_away_mu_s[0] == pytest.approx(0.8, abs=1e-12)  # the mean, to rounding
    assert result.first_break_away[0] < 1.1
    assert 0.85 < result.stick_fraction[0] < 0.9


# --- sketch -----------------------------------------------------------------------------------------------------------

values = st.lists(
    st.one_of(st.floats(-1e3, 1e3), st.floats(-1e-9, 1e-9), st.sampled_from([0.0, 0.25, -2.0, 1e-300])), min_size=1, max_size=60
)


@given(values=values, bins=st.sampled_from([4, 6, 32, 256]), level=st.floats(0.0, 1.0))
@settings(deadline=None)
def test_quantiles_are_within_a_bin(values, bins, level):
    sketch = Sketch.empty(1, bins)
    sketch.add(np.array(values)[:, None])
    width = sketch.quantile_error[0]
    exact = np.quantile(np.array(values), level)
    # 1e-12: rounding of numpy's own interpolation
    assert abs(sketch.quantiles(level)[0, 0] - exact) <= width * (1.0 + 1e-12) + 1e-12 * abs(exact)
    spread = max(values) - min(values)
    largest = max(abs(v) for v in values)
    assert width <= max(2.0 * spread / (bins - 2), 2.0**-44, 2.0**-50 * largest)
    assert sketch.histogram(0)[0].sum() == len(values)


@given(values=values, cut=st.integers(0, 60), bins=st.sampled_from([4, 32, 256]))
@settings(deadline=None)
def test_merged_sketches_are_the_sketch_of_all(values, cut, bins):
    x = np.array(values)[:, None]
    whole, one, two = (Sketch.empty(1, bins) for _ in range(3))
    whole.add(x)
    one.add(x[:cut])
    two.add(x[cut:])
    one.merge(two)
    assert one.n == whole.n
    assert np.array_equal(one.exponent, whole.exponent)
    for a, b in zip(one.histogram(0), whole.histogram(0), strict=True):
        assert np.array_equal(a, b)
    scale = max(1e-300, np.abs(x).max())
    assert one.mean[0] == pytest.approx(whole.mean[0], abs=1e-13 * scale)  # rounding of 60 sums
    if len(values) > 1:
        assert one.std[0] == pytest.approx(whole.std[0], abs=1e-6 * scale)  # root of a rounding


def test_order_does_not_matter_to_a_histogram():
    x = np.random.default_rng(0).lognormal(0.0, 2.0, size=(200, 1))
    sketches = [Sketch.empty(1, 64) for _ in range(3)]
    for sketch, order in zip(sketches, (x, np.sort(x, axis=0), np.sort(x, axis=0)[::-1].copy()), strict=True):
        sketch.add(order)
    for a, b in itertools.pairwise(sketches):
        assert np.array_equal(a.histogram(0)[0], b.histogram(0)[0])
        assert np.array_equal(a.histogram(0)[1], b.histogram(0)[1])


def test_a_sketch_refuses_what_is_not_finite():
    from stochfric_mb.errors import SimulationError

    sketch = Sketch.empty(2, 16)
    with pytest.raises(SimulationError, match="sample 1 of the ensemble is not finite"):
        sketch.add(np.array([[0.0, 1.0], [0.0, math.nan]]))
