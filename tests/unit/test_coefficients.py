"""Random numbers, distributions and coefficient paths."""

import dataclasses
import math
import re
import warnings
from pathlib import Path

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import kstest, truncnorm

from stochfric_mb import (
    CoefficientPath,
    ElasticStick,
    Empirical,
    InputError,
    Knots,
    Lognormal,
    Matern,
    OrnsteinUhlenbeck,
    PerEvent,
    Spatial,
    TruncatedNormal,
    Uniform,
)
from stochfric_mb.coefficients import PROCESSES as PROCESS_KINDS
from stochfric_mb.coefficients import FeasibilityWarning
from stochfric_mb.coefficients.distributions import truncated
from stochfric_mb.coefficients.path import canonical_time, evaluate
from stochfric_mb.coefficients.philox import normals, philox4x32, uniforms

LAW = ElasticStick(mu_s=0.8, mu_k=0.46)
SIGMAS = {"sigma_s": 0.015, "sigma_k": 0.023}
PROCESSES = [
    Knots(**SIGMAS, spacing=0.01),
    OrnsteinUhlenbeck(**SIGMAS, correlation_time=0.05),
    Matern(**SIGMAS, correlation_time=0.05),
    Spatial(**SIGMAS, spacing=1e-3),
    PerEvent(**SIGMAS),
]


@pytest.mark.parametrize(
    ("counter", "key", "words"),
    [
        # Random123 1.09, kat_vectors, philox4x32 10
        ((0, 0, 0, 0), (0, 0), (0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8)),
        ((0xFFFFFFFF,) * 4, (0xFFFFFFFF,) * 2, (0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD)),
        (
            (0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344),
            (0xA4093822, 0x299F31D0),
            (0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1),
        ),
    ],
)
def test_philox_known_answers(counter, key, words):
    assert tuple(int(w) for w in philox4x32(*map(np.uint64, counter + key))) == words


def test_addresses_fill_counter_and_key_as_documented():
    knot = -3
    word = knot % 2**64  # two's complement
    out = philox4x32(*map(np.uint64, (word & 0xFFFFFFFF, word >> 32, 7, 2, 5, 9)))
    w = [int(x) for x in out]
    k1, k2 = ((w[1] << 32) + w[0]) >> 11, ((w[3] << 32) + w[2]) >> 11
    assert uniforms(9, 5, 7, knot, 2) == ((k1 + 0.5) * 2.0**-53, (k2 + 0.5) * 2.0**-53)


@given(seed=st.integers(0, 2**32 - 1), knot=st.integers(-(2**40), 2**40))
@settings(max_examples=200, deadline=None)
def test_normals_are_box_muller_to_the_last_digits(seed, knot):
    u1, u2 = (mpmath.mpf(u) for u in uniforms(seed, 3, 1, knot, 0))
    radius, angle = mpmath.sqrt(-2 * mpmath.log(u1)), 2 * mpmath.pi * u2
    z = normals(seed, 3, 1, knot, 0)
    # 4e-15: the largest |z| (8.6) times a few units in the last place
    assert abs(z[0] - radius * mpmath.cos(angle)) < 4e-15
    assert abs(z[1] - radius * mpmath.sin(angle)) < 4e-15


def test_moments_of_normals():
    z = np.array([normals(1, 0, 0, i, 0) for i in range(20_000)])
    se = 1.0 / math.sqrt(len(z))
    assert np.all(np.abs(z.mean(0)) < 4 * se)  # 4 standard errors, here and below
    assert np.all(np.abs(z.var(0) - 1.0) < 4 * math.sqrt(2.0) * se)
    assert abs(np.mean(z[:, 0] * z[:, 1])) < 4 * se
    assert abs(np.mean(z[1:, 0] * z[:-1, 0])) < 4 * se


@pytest.mark.parametrize("process", PROCESSES, ids=lambda p: p.kind)
def test_moments_and_feasibility_of_every_process(process):
    pairs = CoefficientPath(process, LAW, seed=3).pairs(20_000)
    independent = 20_000 if process.correlation == 0.0 else 20_000 / 40.0  # 20 knots a correlation time
    for column, mean, sigma in ((0, 0.8, 0.015), (1, 0.46, 0.023)):
        assert abs(pairs[:, column].mean() - mean) < 4 * sigma / math.sqrt(independent)
        assert abs(pairs[:, column].std() / sigma - 1.0) < 4 / math.sqrt(2 * independent)
    assert np.all(pairs[:, 1] < pairs[:, 0])
    assert np.all(pairs[:, 1] >= 0.0)


@pytest.mark.parametrize("process", PROCESSES, ids=lambda p: p.kind)
@pytest.mark.parametrize("cross", [-0.6, 0.8, 1.0])
def test_coefficients_scatter_together_as_much_as_they_are_said_to(process, cross):
    plain = CoefficientPath(process, LAW, seed=3).pairs(20_000)
    pairs = CoefficientPath(dataclasses.replace(process, cross_correlation=cross), LAW, seed=3).pairs(20_000)
    independent = 20_000 if process.correlation == 0.0 else 20_000 / 40.0  # 20 knots a correlation time
    error = 4.0 * (1.0 - cross**2) / math.sqrt(independent)
    assert np.corrcoef(pairs.T)[0, 1] == pytest.approx(cross, abs=max(error, 1e-9))
    assert abs(pairs[:, 1].std() / 0.023 - 1.0) < 4 / math.sqrt(2 * independent)
    np.testing.assert_array_equal(pairs[:, 0], plain[:, 0])  # mu_s is drawn as before


def test_a_cross_correlation_beyond_one_is_refused_and_pairs_that_move_together_are_feasible():
    with pytest.raises(InputError, match=r"cross_correlation = 1\.2"):
        PerEvent(**SIGMAS, cross_correlation=1.2)
    close = ElasticStick(mu_s=0.5, mu_k=0.46)
    with pytest.warns(FeasibilityWarning):
        CoefficientPath(PerEvent(sigma_s=0.02, sigma_k=0.02), close)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        CoefficientPath(PerEvent(sigma_s=0.02, sigma_k=0.02, cross_correlation=1.0), close)


@pytest.mark.parametrize(
    ("process", "correlation"),
    [(PROCESSES[1], lambda r: math.exp(-r)), (PROCESSES[2], lambda r: (1 + math.sqrt(3) * r) * math.exp(-math.sqrt(3) * r))],
    ids=["ornstein_uhlenbeck", "matern"],
)
def test_correlation_in_time(process, correlation):
    paths = np.array([CoefficientPath(process, LAW, seed=1, sample=s).pairs(60)[:, 0] for s in range(3000)])
    z = (paths - 0.8) / 0.015
    for lag in (5, 20, 40):
        # 4 standard errors of a correlation from 3000 independent paths
        assert abs(np.mean(z[:, 3] * z[:, 3 + lag]) - correlation(lag / 20)) < 4 * math.sqrt(2 / 3000)


@pytest.mark.parametrize("process", PROCESSES, ids=lambda p: p.kind)
def test_same_bits_in_any_order(process):
    forward, random_order = (CoefficientPath(process, LAW, seed=7, sample=2, contact=1) for _ in range(2))
    points = [(0.0013 * i, 0.0007 * i, i // 9) for i in range(200)]
    values = {p: forward.at(*p) for p in points}
    for p in np.random.default_rng(0).permutation(np.array(points)):
        key = (float(p[0]), float(p[1]), int(p[2]))
        assert random_order.at(*key) == values[key]


def test_paths_of_other_addresses_differ():
    base = CoefficientPath(PROCESSES[0], LAW, seed=1).pairs(5)
    for other in ({"seed": 2}, {"seed": 1, "sample": 1}, {"seed": 1, "contact": 1}):
        assert not np.any(CoefficientPath(PROCESSES[0], LAW, **other).pairs(5) == base)


def test_linear_between_knots_and_periodic_evaluation_at_negative_positions():
    path = CoefficientPath(Spatial(**SIGMAS, spacing=1e-3), LAW, seed=1)
    a, b = path.pairs(2, first=-5)
    assert path.at(0.0, -4.5e-3) == pytest.approx(tuple(0.5 * (a + b)), rel=1e-12)  # rounding


def test_interpolated_knots_have_the_known_standard_deviation():
    path = CoefficientPath(PROCESSES[0], LAW, seed=5)
    values = path.at_times(np.arange(0, 200.0, 0.00125) + 1e-9)[:, 0]
    # sqrt(2/3) sigma for linear interpolation of independent knots; 4 standard errors of 20000 knots
    assert values.std() / 0.015 == pytest.approx(math.sqrt(2 / 3), abs=4 * 0.8 / math.sqrt(2 * 20_000))


def test_per_event_holds_its_pair():
    path = CoefficientPath(PerEvent(**SIGMAS), LAW, seed=1)
    assert path.at(0.0, 0.0, 3) == path.at(5.0, 1.0, 3) == tuple(path.pairs(1, first=3)[0])


def test_accumulated_steps_give_the_same_bits_as_products():
    t, bits = 0.0, set()
    path = CoefficientPath(PROCESSES[0], LAW, seed=1)
    for _ in range(100_000):
        t += 1e-5
    for time in (t, 1.0, 100_000 * 1e-5, 10_000 * 1e-4):
        bits.add(path.at(canonical_time(time, 0.5e-5)))
    assert len(bits) == 1


def test_marginals():
    data = tuple(0.8 + 0.02 * math.sin(i) for i in range(500))
    for distribution, column, mean, sigma in (
        (Lognormal(), 0, 0.8, 0.015),
        (Uniform(), 0, 0.8, 0.015),
        (Empirical(data), 0, np.mean(data), np.std(data)),
    ):
        process = Knots(**SIGMAS, spacing=0.01, distribution_s=distribution)
        values = CoefficientPath(process, LAW, seed=2).pairs(20_000)[:, column]
        assert abs(values.mean() - mean) < 4 * sigma / math.sqrt(20_000)
        assert abs(values.std() / sigma - 1) < 4 / math.sqrt(2 * 20_000) + 1e-3  # 1e-3: 257 quantiles of the data
    process = Knots(**SIGMAS, spacing=0.01, distribution_s=TruncatedNormal(0.79, 0.81))
    values = CoefficientPath(process, LAW, seed=2).pairs(2000)[:, 0]
    assert values.min() >= 0.79
    assert values.max() <= 0.81


@pytest.mark.parametrize(
    # physics.md, claim 4: infeasible fraction and mean shift of mu_s [sigma] at d, equal sigmas
    ("d", "infeasible", "shift"),
    [(3.0, 0.00135, 0.003), (2.0, 0.023, 0.039), (1.0, 0.159, 0.20)],
)
def test_rejection_at_small_distance(d, infeasible, shift):
    sigma = 0.05
    law = ElasticStick(mu_s=0.46 + d * math.sqrt(2) * sigma, mu_k=0.46)
    process = Knots(sigma_s=sigma, sigma_k=sigma, spacing=0.01)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FeasibilityWarning)
        path = CoefficientPath(process, law, seed=1)
    n = 40_000
    pairs = path.pairs(n)
    z = np.array([normals(1, 0, 0, i, 0) for i in range(n)])
    rejected = np.mean(law.mu_s + sigma * z[:, 0] <= law.mu_k + sigma * z[:, 1])
    assert abs(rejected - infeasible) < 4 * math.sqrt(infeasible / n) + 5e-4  # 5e-4: rounding of the table
    assert abs((pairs[:, 0].mean() - law.mu_s) / sigma - shift) < 4 / math.sqrt(n) + 5e-3  # likewise


def test_infeasible_pairs_warn_then_fail():
    with pytest.warns(FeasibilityWarning, match="redrawn"):
        CoefficientPath(Knots(sigma_s=0.2, sigma_k=0.1, spacing=0.01), LAW)
    with pytest.warns(FeasibilityWarning, match="clipped"):
        CoefficientPath(Matern(sigma_s=0.2, sigma_k=0.1, correlation_time=0.1), LAW)
    with pytest.raises(InputError, match="smaller sigma_s"):
        CoefficientPath(Knots(sigma_s=2.0, sigma_k=1.0, spacing=0.01), LAW)


@pytest.mark.parametrize("address", [{"seed": -1}, {"seed": 2**32}, {"sample": 0.5}])
def test_bad_addresses(address):
    with pytest.raises(InputError, match="choose one in that range"):
        CoefficientPath(None, LAW, **address)


def test_without_process_the_means_come_out():
    assert CoefficientPath(None, LAW, seed=4).at(3.3, 0.1, 5) == (0.8, 0.46)


def test_compiled_evaluation_is_the_same_as_python():
    path = CoefficientPath(PROCESSES[2], LAW, seed=4)
    slow = evaluate.py_func(path.descriptor, np.zeros(10), 4, 0, 0, 0.123, 0.0, 0.0)
    assert slow == path.at(0.123)


def test_the_table_in_the_docs():
    page = Path(__file__).parents[2] / "docs" / "coefficients.md"
    rows = re.findall(r"^\| (\d) \| (0\.\d{15}) \| (0\.\d{15}) \|$", page.read_text(encoding="utf-8"), re.M)
    assert len(rows) == 10
    pairs = CoefficientPath(PROCESSES[0], LAW, seed=1).pairs(10)
    for knot, mu_s, mu_k in rows:
        assert (float(mu_s), float(mu_k)) == pytest.approx(tuple(pairs[int(knot)]), abs=1e-15)  # the printed digits


BOUNDS = [(0.79, 0.83), (0.8, math.inf), (-math.inf, 0.79), (0.9, 0.95), (0.1, 0.5)]
"""Bounds of mu_s around, at and up to twenty standard deviations from its mean 0.8 (sigma 0.015)."""


@pytest.mark.parametrize("bounds", BOUNDS, ids=str)
def test_the_truncated_quantile_turns_the_distribution_round(bounds):
    """F(F^-1(Phi(z))) = Phi(z), in sixty digits: to 1e-12 of the mass on the smaller side."""
    low, high = bounds
    z = np.linspace(-7.0, 7.0, 57)
    mine = [truncated(x, 0.8, 0.015, low, high) for x in z]
    assert np.all(np.diff(mine) >= 0.0)
    with mpmath.workdps(60):

        def mass(x, y):
            return mpmath.ncdf(y) - mpmath.ncdf(x)

        a, b = (-mpmath.inf if low == -math.inf else (low - mpmath.mpf(0.8)) / 0.015), (high - mpmath.mpf(0.8)) / 0.015
        for x, y in zip(z, mine, strict=True):
            reached = (mpmath.mpf(y) - 0.8) / 0.015
            share = mass(a, reached) / mass(a, b) if x < 0.0 else mass(reached, b) / mass(a, b)
            # y is rounded to 1e-16, worth density times that of the share: more where the share is small and the density is not
            rounding = 2e-16 / 0.015 * float(mpmath.npdf(reached) / mass(a, b))
            assert float(share) == pytest.approx(float(mpmath.ncdf(-abs(x))), rel=1e-12, abs=rounding)


@pytest.mark.parametrize("bounds", [(0.79, 0.83), (0.785, math.inf)], ids=str)
@pytest.mark.parametrize("kind", ["ornstein_uhlenbeck", "matern", "knots"])
def test_a_truncated_normal_has_its_distribution_in_every_process(kind, bounds):
    own = {"spacing": 0.01} if kind == "knots" else {"correlation_time": 0.01, "spacing": 0.1}  # knots 10 times apart
    process = PROCESS_KINDS[kind](sigma_s=0.015, sigma_k=0.023, distribution_s=TruncatedNormal(*bounds), **own)
    mu_s = CoefficientPath(process, LAW, seed=3).pairs(20_000)[:, 0]
    a, b = (bounds[0] - 0.8) / 0.015, (bounds[1] - 0.8) / 0.015
    assert np.count_nonzero((mu_s == bounds[0]) | (mu_s == bounds[1])) == 0  # none is clipped
    # Kolmogorov-Smirnov: 2.2/sqrt(n) is exceeded once in 8000 such tests
    assert kstest(mu_s, truncnorm(a, b, 0.8, 0.015).cdf).statistic <= 2.2 / math.sqrt(20_000)


def test_a_process_along_the_belt_or_by_event_asks_for_its_place():
    along = CoefficientPath(Spatial(sigma_s=0.01, sigma_k=0.01, spacing=1e-3), LAW)
    by_event = CoefficientPath(PerEvent(sigma_s=0.01, sigma_k=0.01), LAW)
    with pytest.raises(InputError, match=r"process spatial does not run along time; give position"):
        along.at(0.1)
    with pytest.raises(InputError, match=r"process spatial"):
        along.at_times([0.1, 0.2])
    with pytest.raises(InputError, match=r"process per_event does not run along time; give events"):
        by_event.at(0.1, 0.2)
    assert along.at(0.1, 0.0) == along.at(0.2, 0.0) != along.at(0.1, 5e-4)
    assert by_event.at(0.1, events=0) != by_event.at(0.1, events=1)
