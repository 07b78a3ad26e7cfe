"""Are two samples of one distribution, how far apart are they, and how well is a mean known: with intervals.

Tests and resampling are SciPy's.
"""

# pyright: reportUnknownMemberType=false, reportUnknownArgumentType=false, reportUnknownVariableType=false
# pyright: reportMissingTypeStubs=false
# (SciPy is partly typed)

from __future__ import annotations

import dataclasses
import warnings
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import special, stats

from stochfric_mb.ensemble.result import EnsembleResult
from stochfric_mb.errors import InputError, require_number

Array = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Estimate:
    """A number with its confidence interval."""

    value: float
    """The estimate."""
    low: float
    """Lower end of the interval."""
    high: float
    """Upper end of the interval."""
    confidence: float
    """Confidence of the interval, 0 .. 1."""


@dataclasses.dataclass(frozen=True)
class TestResult:
    """Outcome of a test of the hypothesis that two samples are of one distribution."""

    __test__ = False  # not a test of pytest's

    statistic: float
    """The test's statistic."""
    p_value: float
    """Probability of a statistic at least as large if the hypothesis is true."""


def ks_test(a: npt.ArrayLike, b: npt.ArrayLike) -> TestResult:
    """Return the two-sample Kolmogorov-Smirnov test: the largest distance of the two distribution functions.

    Args:
        a: first sample, shape (n,), n >= 2.
        b: second sample, shape (m,), m >= 2.

    Raises:
        InputError: fewer than two values, or values that are not finite.
    """
    with warnings.catch_warnings():
        # SciPy says so when an exact p-value is out of reach, and takes the asymptotic one, which is what is wanted.
        warnings.filterwarnings("ignore", message="ks_2samp: Exact calculation unsuccessful", category=RuntimeWarning)
        result: Any = stats.ks_2samp(_sample("a", a), _sample("b", b))
    return TestResult(float(result.statistic), float(result.pvalue))


def anderson_darling_test(a: npt.ArrayLike, b: npt.ArrayLike, *, n_resamples: int = 999, seed: int = 0) -> TestResult:
    """Return the two-sample Anderson-Darling test (midranks), p-value by permutation: more weight on the tails.

    Args:
        a: first sample, shape (n,), n >= 2.
        b: second sample, shape (m,), m >= 2.
        n_resamples: number of permutations; the smallest p-value is 1/(n_resamples + 1).
        seed: of the permutations.

    Raises:
        InputError: fewer than two values, values that are not finite, or one value only in both samples.

    Reference: F. Scholz, M. Stephens, J. Am. Stat. Assoc. 82, 1987, 918-924, doi 10.2307/2288805.
    """
    x, y = _sample("a", a), _sample("b", b)
    if np.ptp(np.concatenate([x, y])) == 0.0:
        raise InputError(f"both samples hold the value {x[0]:g} only; an Anderson-Darling test needs distinct values")
    method = stats.PermutationMethod(n_resamples=n_resamples, rng=np.random.default_rng(seed))
    result: Any = stats.anderson_ksamp([x, y], **_midrank(), method=method)
    return TestResult(float(result.statistic), float(result.pvalue))


def energy_test(a: npt.ArrayLike, b: npt.ArrayLike, *, n_resamples: int = 999, seed: int = 0) -> TestResult:
    """Return the test of the energy distance against its distribution under permutation.

    Args and Raises as for `anderson_darling_test`, but one value only is no error.
    """
    x, y = _sample("a", a), _sample("b", b)
    result: Any = stats.permutation_test(
        (x, y), stats.energy_distance, vectorized=False, alternative="greater", n_resamples=n_resamples,
        rng=np.random.default_rng(seed),
    )  # fmt: skip
    return TestResult(float(result.statistic), float(result.pvalue))


def energy_distance(
    a: npt.ArrayLike, b: npt.ArrayLike, *, confidence: float = 0.95, n_resamples: int = 999, seed: int = 0
) -> Estimate:
    """Return the energy distance sqrt(2 int (F - G)^2 dx) of two samples [unit^(1/2)] with a bootstrap interval.

    The distance is never negative, so that between samples of one distribution the interval lies above 0: to ask
    whether they differ at all, take `energy_test`.

    Args:
        a: first sample, shape (n,), n >= 2.
        b: second sample, shape (m,), m >= 2.
        confidence: of the interval (percentile bootstrap), 0 .. 1.
        n_resamples: number of bootstrap samples.
        seed: of the resampling.

    Reference: G. Szekely, M. Rizzo, J. Stat. Plan. Inference 143, 2013, 1249-1272, doi 10.1016/j.jspi.2013.03.018.
    """
    x, y = _sample("a", a), _sample("b", b)
    return _bootstrap((x, y), stats.energy_distance, confidence, n_resamples, seed)


def ks_distance(
    a: npt.ArrayLike, b: npt.ArrayLike, *, confidence: float = 0.95, n_resamples: int = 999, seed: int = 0
) -> Estimate:
    """Return the Kolmogorov-Smirnov distance of two samples [-] with a bootstrap interval.

    Args and remark as for `energy_distance`; the test is `ks_test`.
    """
    x, y = _sample("a", a), _sample("b", b)
    return _bootstrap((x, y), _ks_statistic, confidence, n_resamples, seed)


def mean(values: npt.ArrayLike, *, confidence: float = 0.95) -> Estimate:
    """Return the mean with Student's interval; NaN values (such as the period of a run without one) are left out.

    Raises:
        InputError: fewer than two numbers are left.
    """
    x = np.asarray(values, dtype=np.float64).ravel()
    x = _sample("values", x[~np.isnan(x)])
    m = float(x.mean())
    half = float(stats.sem(x)) * float(stats.t.ppf(0.5 + 0.5 * _confidence(confidence), len(x) - 1))
    return Estimate(m, m - half, m + half, confidence)


def proportion(count: int, n: int, *, confidence: float = 0.95) -> Estimate:
    """Return the proportion count/n with Wilson's interval.

    >>> estimate = proportion(8, 10)
    >>> round(estimate.low, 4), estimate.value, round(estimate.high, 4)
    (0.4902, 0.8, 0.9433)

    Raises:
        InputError: count is not within 0 .. n, or n < 1.
    """
    if not 0 <= count <= n or n < 1:
        raise InputError(f"count = {count} of n = {n} is no proportion; give 0 <= count <= n and n >= 1")
    interval = stats.binomtest(int(count), int(n)).proportion_ci(_confidence(confidence), method="wilson")
    return Estimate(count / n, float(interval.low), float(interval.high), confidence)


def crps(observation: npt.ArrayLike, ensemble: npt.ArrayLike) -> Array:
    """Return the continuous ranked probability score of each observation [its unit], fair for a finite ensemble.

    CRPS = E abs(X - y) - E abs(X - X')/2, over independent members X, X' of the ensemble; lower is better.

    Args:
        observation: observed values, shape (...).
        ensemble: members, shape (n_runs, ...): the runs of an `EnsembleResult` as they are; at least two.

    Raises:
        InputError: shapes that do not match, or one member only.

    Reference: T. Gneiting, A. Raftery, J. Am. Stat. Assoc. 102, 2007, 359-378, doi 10.1198/016214506000001437; C. Ferro,
    Q. J. R. Meteorol. Soc. 140, 2014, 1917-1923, doi 10.1002/qj.2270 (fair); M. Zamo, P. Naveau, Math. Geosci. 50, 2018,
    209-234, doi 10.1007/s11004-017-9709-7 (the same from probability weighted moments, in n log n instead of n^2).
    """
    y, members = np.asarray(observation, dtype=np.float64), np.asarray(ensemble, dtype=np.float64)
    if members.ndim != y.ndim + 1 or members.shape[1:] != y.shape or len(members) < 2:
        raise InputError(
            f"an observation of shape {y.shape} needs an ensemble of shape (n_runs >= 2, *{y.shape}), not {members.shape}"
        )
    members = np.sort(members, axis=0)
    count = len(members)
    ranks = np.arange(count, dtype=np.float64).reshape(-1, *(1,) * y.ndim)
    away = np.abs(members - y).mean(axis=0)
    return np.asarray(away + members.mean(axis=0) - 2.0 * (members * ranks).sum(axis=0) / (count * (count - 1.0)))


def crps_normal(error: npt.ArrayLike, deviation: npt.ArrayLike) -> Array:
    """Return the continuous ranked probability score of normal forecasts [their unit].

    CRPS = s (z (2 Phi(z) - 1) + 2 phi(z) - 1/sqrt(pi)), z = error/s; s/sqrt(pi) on average of what the forecast itself draws.

    Args:
        error: observed values less the forecasts' means, shape (...).
        deviation: standard deviations s > 0 of the forecasts, of a shape that goes with it.

    Reference: T. Gneiting, A. Raftery, J. Am. Stat. Assoc. 102, 2007, 359-378, doi 10.1198/016214506000001437, eq. 21.
    """
    s = np.asarray(deviation, dtype=np.float64)
    z = np.asarray(error, dtype=np.float64) / s
    return np.asarray(
        s * (z * (2.0 * special.ndtr(z) - 1.0) + 2.0 * np.exp(-0.5 * z**2) / np.sqrt(2.0 * np.pi) - 1.0 / np.sqrt(np.pi))
    )


@dataclasses.dataclass(frozen=True)
class EventStatistics:
    """Means over the runs of an ensemble; None where fewer than two runs have the quantity."""

    period: Estimate | None
    """Mean interval between break-aways [s]."""
    first_break_away: Estimate | None
    """Time of the first break-away [s]."""
    break_away_mu_s: Estimate | None
    """mu_s at break-away [-]."""
    stick_fraction: Estimate | None
    """Share of the time that sticks [-]."""
    n_break_aways: Estimate | None
    """Break-aways in a run [-]."""


def event_statistics(result: EnsembleResult, *, confidence: float = 0.95) -> EventStatistics:
    """Return the means of what happens in a run, with Student's intervals over the runs.

    Args:
        result: an ensemble, with or without its runs.
        confidence: of the intervals, 0 .. 1.
    """
    return EventStatistics(
        **{field.name: _mean_or_none(getattr(result, field.name), confidence) for field in dataclasses.fields(EventStatistics)}
    )


def _mean_or_none(values: Array, confidence: float) -> Estimate | None:
    return mean(values, confidence=confidence) if np.count_nonzero(~np.isnan(values)) >= 2 else None


def _bootstrap(samples: tuple[Array, Array], statistic: Any, confidence: float, n_resamples: int, seed: int) -> Estimate:
    result: Any = stats.bootstrap(
        samples, statistic, vectorized=False, method="percentile", confidence_level=_confidence(confidence),
        n_resamples=n_resamples, rng=np.random.default_rng(seed),
    )  # fmt: skip
    interval = result.confidence_interval
    return Estimate(float(statistic(*samples)), float(interval.low), float(interval.high), confidence)


def _ks_statistic(a: Array, b: Array) -> float:
    both = np.sort(np.concatenate([a, b]))
    f, g = (np.searchsorted(np.sort(s), both, side="right") / len(s) for s in (a, b))
    return float(np.max(np.abs(f - g)))


def _midrank() -> dict[str, Any]:
    """Return the argument that asks SciPy for midranks, which was renamed in 1.17."""
    import inspect

    return {"variant": "midrank"} if "variant" in inspect.signature(stats.anderson_ksamp).parameters else {}


def _confidence(value: float) -> float:
    return require_number("confidence", value, above=0.0, below=1.0)


def _sample(name: str, values: npt.ArrayLike) -> Array:
    x = np.asarray(values, dtype=np.float64).ravel()
    if len(x) < 2:
        raise InputError(f"sample {name} has {len(x)} values; give at least 2")
    if not np.all(np.isfinite(x)):
        raise InputError(f"value {int(np.argmax(~np.isfinite(x)))} of sample {name} is not finite; remove or correct it")
    return x
