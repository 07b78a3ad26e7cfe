"""Claims on the coefficients alone: rejection, interpolation and the size of sigma_k (figures 5 to 7 and 9, tables)."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from stochfric_mb import statistics
from stochfric_mb.coefficients import CoefficientPath
from stochfric_mb.coefficients.processes import Matern, OrnsteinUhlenbeck
from stochfric_mb.reproduction.claims import FAILS, HOLDS, UNDECIDABLE, Claim, Mend, Number, of_estimate
from stochfric_mb.reproduction.output_step import paper_process
from stochfric_mb.reproduction.settings import Settings
from stochfric_mb.scenario import Scenario

Array = npt.NDArray[np.float64]

DISTANCES = (4.0, 3.0, 2.0, 1.0, 0.0)
"""Distances d = (mean mu_s - mean mu_k)/sqrt(sigma_s^2 + sigma_k^2) at which rejection is measured, equal sigmas."""
UNCHANGED = 0.01
"""Shift of the mean below which rejection leaves a distribution as it is [sigma]."""
NEVER = 1.0e-6
"""Share of infeasible pairs below which there are none in practice [-]."""
FRACTIONS = tuple(i / 10 for i in range(11))
"""Places between two knots at which interpolation is measured."""
SIMPSON = np.array([1, 4, 2, 4, 2, 4, 2, 4, 2, 4, 1]) / 30.0
"""Weights of those places in an average over time (Simpson: a plain mean of the ends would be 0.2 % off)."""
PATH_BATCH = 50
"""Paths of a batch; batches give the interval of a standard deviation."""
ABOUT = 0.005
"""What "about 5 %" leaves open to either side."""
CLAIMED_SHARE = 0.05
HALF_DIGIT = 0.0005
"""The tables give coefficients to 0.001."""


@dataclasses.dataclass(frozen=True)
class Rejection:
    """Pairs before and after rejection, at one distance of the means."""

    name: str
    """Where: a table of the paper, or d = ..."""
    d: float
    """Distance of the means [joint standard deviations]."""
    exact: float
    """Infeasible share, exactly [-]."""
    before: Array
    """Pairs as drawn, shape (n, 2)."""
    feasible: npt.NDArray[np.bool_]
    """Which of them are kept, shape (n,)."""
    sigma: tuple[float, float]
    """Standard deviations [-]."""
    means: tuple[float, float]
    """Means [-]."""


@dataclasses.dataclass(frozen=True)
class Interpolation:
    """Standard deviation between two knots, over sigma."""

    fraction: Array
    """Place between the knots, shape (n,)."""
    batches: Array
    """Standard deviation of mu_s over sigma_s in each batch of paths, shape (n_batches, n)."""


def draw_rejections(scenarios: Mapping[str, Scenario], settings: Settings, seed: int) -> list[Rejection]:
    """Return pairs before and after rejection, for the tables and for means that come closer."""
    rng = np.random.default_rng([seed, 1])
    items: list[Rejection] = []
    for name, scenario in scenarios.items():
        assert scenario.process is not None
        means, sigma = (scenario.law.mu_s, scenario.law.mu_k), (scenario.process.sigma_s, scenario.process.sigma_k)
        items.append(_rejection(name, means, sigma, settings.n_pairs, rng))
    sigma = (0.05, 0.05)
    for d in DISTANCES:
        means = (0.8, 0.8 - d * math.hypot(*sigma))
        items.append(_rejection(f"d = {d:g}", means, sigma, settings.n_pairs, rng))
    return items


def _rejection(
    name: str, means: tuple[float, float], sigma: tuple[float, float], n: int, rng: np.random.Generator
) -> Rejection:
    d = (means[0] - means[1]) / math.hypot(*sigma)
    before = np.array(means) + np.array(sigma) * rng.standard_normal((n, 2))
    feasible = before[:, 1] < before[:, 0]
    return Rejection(name, d, 0.5 * math.erfc(d / math.sqrt(2.0)), before, feasible, sigma, means)


def rejection_claim(rejections: list[Rejection]) -> Claim:
    """Return the claim that rejection leaves the distributions as they are."""
    numbers: list[Number] = []
    verdicts: list[str] = []
    for r in rejections:
        key = r.name.lower().replace(" ", "_").replace("_=_", "")
        share = statistics.proportion(int(np.sum(~r.feasible)), len(r.feasible))
        shift = _shift(r)
        numbers += [
            Number(name=f"infeasible_exact_{key}", label=f"infeasible share, exact, {r.name} (d = {r.d:.3g})", value=r.exact),
            of_estimate(f"infeasible_{key}", f"infeasible share, drawn, {r.name}", share, n=share_n(r)),
            of_estimate(f"mean_shift_{key}", f"shift of the mean of mu_s, {r.name}", shift, unit="sigma_s", n=share_n(r)),
        ]
        if not r.name.startswith("d ="):
            verdicts.append(_unchanged(r.exact, shift))
    verdict = FAILS if FAILS in verdicts else UNDECIDABLE if UNDECIDABLE in verdicts else HOLDS
    tables = [r for r in rejections if not r.name.startswith("d =")]
    return Claim(
        id="rejection_keeps_distributions",
        claim="Rejecting pairs with mu_k >= mu_s leaves the distributions of both coefficients as they are",
        where="section 2.2, figures 5 to 7",
        test="pairs of normals drawn before rejection; share infeasible, and shift of the mean of mu_s after it, for the "
        "tables' means and for means that come closer (equal sigmas)",
        rule=f"for the tables: holds if the infeasible share is below {NEVER:g} and the interval of the shift lies within "
        f"{UNCHANGED:g} sigma; fails if the interval lies outside; undecidable otherwise",
        verdict=verdict,
        reason="Infeasible share " + " and ".join(f"{r.exact:.1e} ({r.name})" for r in tables),
        numbers=tuple(numbers),
        remark="It holds for means as far apart as the tables', not in general: at d = 2 and closer the means shift, and a "
        "warning says so. Draws with mu_k < 0 are redrawn as well (20 sigma away in both tables).",
    )


def share_n(r: Rejection) -> int:
    """Return the number of pairs drawn."""
    return len(r.feasible)


def _shift(r: Rejection) -> statistics.Estimate:
    """Return the shift of the mean of mu_s by rejection [sigma_s], as mean over the kept pairs less the known mean."""
    return statistics.mean((r.before[r.feasible, 0] - r.means[0]) / r.sigma[0])


def _unchanged(exact: float, shift: statistics.Estimate) -> str:
    if exact < NEVER and shift.low > -UNCHANGED and shift.high < UNCHANGED:
        return HOLDS
    return FAILS if shift.low > UNCHANGED or shift.high < -UNCHANGED else UNDECIDABLE


SMOOTH_TIME = 0.05
"""Correlation time of the processes that are tried in the place of independent knots [s]."""


def measure_interpolation(scenario: Scenario, settings: Settings, seed: int) -> Interpolation:
    """Return the standard deviation of mu_s between the first two knots, over many paths of the package."""
    process = scenario.process
    assert process is not None
    times = np.array(FRACTIONS) * process.knot_spacing
    drawn = np.array(
        [CoefficientPath(process, scenario.law, seed=seed, sample=i).at_times(times)[:, 0] for i in range(settings.n_paths)]
    )
    batches = drawn.reshape(-1, PATH_BATCH, len(times)).std(axis=1, ddof=1) / process.sigma_s
    return Interpolation(np.array(FRACTIONS), batches)


def interpolation_claims(
    measured: Interpolation, scenarios: Mapping[str, Scenario], settings: Settings, seed: int
) -> list[Claim]:
    """Return the claims that interpolation keeps the distribution, and that it keeps pairs feasible."""
    # A standard deviation of 50 values is low by the factor 1 - 1/(4 * 50): corrected, since intervals are narrower.
    batches = measured.batches / _unbiased(PATH_BATCH)
    averaged = statistics.mean(batches @ SIMPSON)
    rms = statistics.mean(np.sqrt(measured.batches**2 @ SIMPSON))
    between = [
        of_estimate(
            f"sd_at_{f:g}", f"standard deviation at {f:g} of the way to the next knot", statistics.mean(batches[:, i]),
            unit="sigma", n=settings.n_paths, group="Between the knots",
        )
        for i, f in enumerate(measured.fraction)
    ]  # fmt: skip
    verdict = _keeps_sigma(averaged)
    keeps = Claim(
        id="interpolation_keeps_distribution",
        claim="With linear interpolation between knots the coefficients have the standard deviation sigma at all times",
        where="figure 9",
        test=f"{settings.n_paths} paths, standard deviation of mu_s at {len(FRACTIONS)} places between two knots",
        rule="holds if the interval of the time-averaged standard deviation lies within 5 % of sigma; fails if it lies "
        "outside; undecidable otherwise",
        verdict=verdict,
        reason=f"Time-averaged standard deviation {averaged.value:.3f} sigma ({averaged.low:.3f} to {averaged.high:.3f})",
        numbers=(
            of_estimate(
                "sd_time_average", "time average of the standard deviation", averaged, unit="sigma", n=settings.n_paths
            ),
            of_estimate("sd_time_rms", "root of the time-averaged variance", rms, unit="sigma", n=settings.n_paths),
            Number(
                name="sd_exact_average",
                label="time average, exact: (1 + asinh(1)/sqrt 2)/2",
                value=_exact_average(),
                unit="sigma",
            ),
            Number(
                name="sd_exact_rms",
                label="root of the time-averaged variance, exact: sqrt(2/3)",
                value=math.sqrt(2 / 3),
                unit="sigma",
            ),
            *between,
        ),
        remark="Half-way between two independent knots the standard deviation is sigma/sqrt 2. Matern and "
        "Ornstein-Uhlenbeck paths, whose knots are closer than their correlation time, keep sigma.",
        mends=_smooth_paths(next(iter(scenarios.values())), settings, seed),
    )
    return [keeps, _feasible_claim(scenarios, settings, seed)]


def _keeps_sigma(averaged: statistics.Estimate) -> str:
    """Return the verdict of the rule on the time-averaged standard deviation [sigma]."""
    if averaged.low > 0.95 and averaged.high < 1.05:
        return HOLDS
    return FAILS if averaged.high < 0.95 or averaged.low > 1.05 else UNDECIDABLE


def _smooth_paths(scenario: Scenario, settings: Settings, seed: int) -> tuple[Mend, ...]:
    """Return the standard deviation of processes with a correlation time, measured as that of the paper's knots."""
    assert scenario.process is not None
    sigma_s, sigma_k = scenario.process.sigma_s, scenario.process.sigma_k
    remedies: list[Mend] = []
    for cls in (Matern, OrnsteinUhlenbeck):
        process = cls(correlation_time=SMOOTH_TIME, spacing=SMOOTH_TIME / 10.0, sigma_s=sigma_s, sigma_k=sigma_k)
        measured = measure_interpolation(dataclasses.replace(scenario, process=process), settings, seed)
        averaged = statistics.mean(measured.batches / _unbiased(PATH_BATCH) @ SIMPSON)
        number = of_estimate(
            "sd_time_average", "time average of the standard deviation", averaged, unit="sigma", n=settings.n_paths
        )
        name = f"{cls.kind}, correlation time {SMOOTH_TIME:g} s"
        text = "knots at a tenth of the correlation time; the same measurement"
        remedies.append(Mend(process=name, text=text, outcome=_keeps_sigma(averaged), numbers=(number,)))
    return tuple(remedies)


def _exact_average() -> float:
    """Return the integral over w in 0 .. 1 of sqrt(w^2 + (1 - w)^2)."""
    return 0.5 * (1.0 + math.asinh(1.0) / math.sqrt(2.0))


def _unbiased(n: int) -> float:
    """Return the mean of the standard deviation of n normal values, over sigma."""
    return math.sqrt(2.0 / (n - 1)) * math.exp(math.lgamma(n / 2) - math.lgamma((n - 1) / 2))


def _feasible_claim(scenarios: Mapping[str, Scenario], settings: Settings, seed: int) -> Claim:
    """Return the claim that interpolated pairs stay feasible, tried where half of the drawn pairs nearly are not."""
    import warnings

    from stochfric_mb.coefficients import FeasibilityWarning

    scenario = next(iter(scenarios.values()))
    law = dataclasses.replace(scenario.law, mu_s=0.8, mu_k=0.79)
    n = 10 * settings.n_paths
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FeasibilityWarning)  # close means are the point
        path = CoefficientPath(paper_process(0.02, 0.02, 1.0), law, seed=seed)
    pairs = path.at_times(np.linspace(0.0, n / 10, n + 1))
    wrong = int(np.sum((pairs[:, 1] >= pairs[:, 0]) | (pairs[:, 1] < 0.0)))
    share = statistics.proportion(wrong, len(pairs))
    return Claim(
        id="interpolation_keeps_feasible",
        claim="Pairs interpolated between feasible pairs are feasible",
        where="section 2.2, figure 9",
        test=f"a path whose means are only d = 0.35 apart, looked at {len(pairs)} times, ten times a knot",
        rule="holds if no pair has mu_k >= mu_s or mu_k < 0; fails if one has",
        verdict=HOLDS if wrong == 0 else FAILS,
        reason=f"{wrong} of {len(pairs)} interpolated pairs are infeasible",
        numbers=(of_estimate("infeasible_share", "infeasible share of interpolated pairs", share, n=len(pairs)),),
        remark="The feasible pairs are a convex set, so that this must hold.",
    )


def sigma_claims(scenarios: Mapping[str, Scenario]) -> list[Claim]:
    """Return the claim that sigma_k is about 5 % of the mean of mu_k, for each table."""
    claims: list[Claim] = []
    for name, scenario in scenarios.items():
        assert scenario.process is not None
        sigma, mean = scenario.process.sigma_k, scenario.law.mu_k
        share = sigma / mean
        low, high = (sigma - HALF_DIGIT) / mean, (sigma + HALF_DIGIT) / mean
        far = low > CLAIMED_SHARE + ABOUT or high < CLAIMED_SHARE - ABOUT
        claims.append(
            Claim(
                id=f"sigma_k_{name.lower().replace(' ', '_')}",
                claim=f"sigma_k is about 5 % of the mean of mu_k ({name})",
                where=f"section 2.2 and {name}",
                test="the table's own numbers, sigma_k known to half a digit of what is printed",
                rule=f"holds if the interval that rounding leaves reaches {100 * (CLAIMED_SHARE - ABOUT):g} to "
                f"{100 * (CLAIMED_SHARE + ABOUT):g} %; fails otherwise",
                verdict=FAILS if far else HOLDS,
                reason=f"{sigma:g}/{mean:g} = {100 * share:.2f} % ({100 * low:.2f} to {100 * high:.2f})",
                numbers=(
                    Number(
                        name="sigma_k_over_mean",
                        label="sigma_k over mean mu_k",
                        value=share,
                        low=low,
                        high=high,
                        interval="rounding",
                    ),
                ),
                remark="The tables are taken as they are.",
            )
        )
    return claims
