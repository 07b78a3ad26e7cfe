"""Claim: distributions of the response do not depend on the output time step (figures 11 and 12)."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb import ensemble, statistics
from stochfric_mb.coefficients import Knots, Matern, OrnsteinUhlenbeck, OutputStep, Process, Spatial
from stochfric_mb.ensemble import EnsembleResult
from stochfric_mb.reproduction.claims import (
    ALPHA,
    ENOUGH,
    FAILS,
    HOLDS,
    RELEVANT_DISTANCE,
    UNDECIDABLE,
    Claim,
    Mend,
    Number,
    differs,
    of_estimate,
    same_distribution,
    worst,
)
from stochfric_mb.reproduction.settings import Settings
from stochfric_mb.scenario import Scenario

Array = npt.NDArray[np.float64]
Tick = Callable[[int], None]

IDENTICAL = 1.0e-9
"""Positions that agree to this are the same: what the integration itself leaves, with a margin [m]."""
IDENTICAL_VELOCITY = 1.0e-7
"""The same of velocities [m/s]: positions to 1e-9 m at natural frequencies below 100 rad/s."""
BATCH = 100
"""Samples of a batch, as many as the paper's ensembles."""
LEVEL = 0.05
"""Level of a single test in a batch [-]."""
DECIMALS = 12
"""Positions and velocities are rounded to so many decimals of m and m/s: velocities of runs that stick, equal in theory,
differ by 1e-16 m/s, and a test of ranks would compare the rounding."""
RESOLUTION = 1.0e-3
"""Width of the bins in which a histogram would show velocities [m/s]; those of runs that stick fall into one."""
FEWEST_SLIPPING = 20
"""Slipping samples from which their velocities are compared."""


@dataclasses.dataclass(frozen=True)
class StepStudy:
    """Ensembles at several output steps."""

    ensembles: Mapping[str, Mapping[float, EnsembleResult]]
    """Law -> output step [s] -> its runs at the times of the settings."""
    n_paper: int
    """Of these, how many the paper's sample size takes."""


def paper_process(sigma_s: float, sigma_k: float, step: float) -> Process:
    """Return the paper's process at an output step [s]: one pair of coefficients per output step."""
    return OutputStep(sigma_s=sigma_s, sigma_k=sigma_k, spacing=step)


def run_steps(scenarios: Mapping[str, Scenario], settings: Settings, seed: int, tick: Tick) -> StepStudy:
    """Return ensembles of each law's scenario at each output step, all with samples of their own.

    Args:
        scenarios: law -> scenario with a process, whose sigmas are taken.
        settings: sizes.
        seed: of the coefficients.
        tick: called with the number of runs done.
    """
    done = 0
    table: dict[str, dict[float, EnsembleResult]] = {}
    for law, scenario in scenarios.items():
        table[law] = {}
        for i, step in enumerate(settings.steps):
            assert scenario.process is not None
            process = paper_process(scenario.process.sigma_s, scenario.process.sigma_k, step)
            table[law][step] = _run(scenario, process, step, settings, seed, first=i * settings.n_many)
            done += settings.n_many
            tick(done)
    return StepStudy(table, settings.n_paper)


def claims(study: StepStudy, mends: Mapping[str, tuple[Mend, ...]], settings: Settings) -> list[Claim]:
    """Return the claims on displacement and on velocity; ``mends``: quantity -> what mends it."""
    rule = (
        f"fails if for any law, time and pair of steps the two-sample Kolmogorov-Smirnov test of {settings.n_many} samples "
        f"has p < {ALPHA:g}/(number of tests) and the bootstrap interval of the distance lies above {RELEVANT_DISTANCE:g}; "
        f"holds if no test rejects with at least {ENOUGH} samples; undecidable otherwise"
    )
    common = {
        "where": "figures 11 and 12, at 2 and 10 s",
        "test": "Table 1 with one pair of coefficients per output step, at output steps "
        + ", ".join(f"{s:g}" for s in settings.steps)
        + " s and three laws; every pair of steps compared, each sample used once",
        "rule": rule,
    }
    items: list[Claim] = []
    for quantity, word in (("position", "displacement"), ("velocity", "velocity")):
        distances = _distances(study, quantity, settings)
        verdict = same_distribution(distances)
        most = worst(distances)
        numbers = [*_shown(distances, settings), *_few(study, quantity, settings), *_power(study, quantity, settings)]
        numbers += _break_aways(study) if quantity == "position" else _slipping(study, settings)
        numbers += _means(study, quantity)
        items.append(
            Claim(
                id=f"step_independence_{word}",
                claim=f"The distribution of {word} does not depend on the output time step",
                verdict=verdict,
                reason=f"Largest distance {most.value:.3f} ({most.low:.3f} to {most.high:.3f}): {most.label}. "
                f"Law by law: {_by_law(distances, study)}",
                numbers=tuple(numbers),
                mends=mends.get(quantity, ()),
                remark=_remark(quantity, distances),
                **common,
            )
        )
    return items


def _by_law(distances: list[Number], study: StepStudy) -> str:
    """Return the verdict of the same rule for each law alone."""
    alone = {law: [d for d in distances if d.name.startswith(f"ks_{law}_")] for law in study.ensembles}
    return ", ".join(f"{law} {same_distribution(result)}" for law, result in alone.items())


def _remark(quantity: str, distances: list[Number]) -> str:
    if quantity == "position":
        return (
            "More knots a second are more draws near break-away: the smallest mu_s of many decides when the box breaks "
            "away, and mu_k averages out over a slip. The knot spacing is a correlation time, that is, a physical "
            "parameter, and must not be tied to the output."
        )
    quiet = [d for d in distances if not differs(d, len(distances))]
    return (
        f"{len(quiet)} of {len(distances)} pairs do not differ. A run that sticks moves with the belt (within v_s of it under "
        "the laws without true stick) whatever its coefficients are: where nearly all runs stick at the time of the "
        "comparison under both steps, velocities look independent of the step, above all at the resolution of a "
        "histogram. The shares that stick are below."
    )


def run_mends(scenario: Scenario, settings: Settings, seed: int, tick: Tick) -> dict[str, tuple[Mend, ...]]:
    """Return, for position and velocity, how far each depends on the output step with each of our processes.

    Args:
        scenario: coulomb, with a process whose sigmas are taken.
        settings: sizes.
        seed: of the coefficients.
        tick: called with the number of runs done.
    """
    assert scenario.process is not None
    sigmas: dict[str, Any] = {"sigma_s": scenario.process.sigma_s, "sigma_k": scenario.process.sigma_k}
    spacing = settings.steps[0]
    along_belt = scenario.mechanism.belt_velocity * spacing
    tests: list[Callable[[], tuple[Mend, ...]]] = [
        lambda: _identical(scenario, Knots(spacing=spacing, **sigmas), f"knots, {spacing:g} s", settings, seed),
        lambda: _identical(
            scenario, Spatial(spacing=along_belt, **sigmas), f"spatial, {1e6 * along_belt:g} um", settings, seed
        ),
    ]
    for cls, tau in ((Matern, 0.05), (Matern, 0.2), (OrnsteinUhlenbeck, 0.05), (OrnsteinUhlenbeck, 0.2)):
        tests.append(lambda cls=cls, tau=tau: _refined(scenario, cls, tau, sigmas, settings, seed))
    items: list[tuple[Mend, ...]] = []
    for number, test in enumerate(tests, start=1):
        items.append(test())
        tick(number)
    return {quantity: tuple(mends[i] for mends in items) for i, quantity in enumerate(QUANTITIES)}


QUANTITIES = {"position": "m", "velocity": "m/s"}
"""What is compared -> its unit."""
N_MENDS = 6
"""Processes tried."""


def _identical(scenario: Scenario, process: Process, name: str, settings: Settings, seed: int) -> tuple[Mend, ...]:
    """Compare the same samples on output grids of each step: the path does not know the output step."""
    grids: dict[str, list[Array]] = {quantity: [] for quantity in QUANTITIES}
    last = settings.times[-1]
    for step in settings.steps:
        problem = dataclasses.replace(scenario, process=process, output_step=step, duration=last)
        every = problem.output_times() if process.clock == 0.0 else list(settings.times)
        result = ensemble.run(problem, settings.n_grid, seed=seed, output_times=every, max_bytes=2**33)
        places = np.searchsorted(result.time, np.array(settings.times) - 1.0e-9)
        assert result.position is not None
        assert result.velocity is not None
        grids["position"].append(result.position[:, places])
        grids["velocity"].append(result.velocity[:, places])
    text = "the same samples on output grids of each step; the path does not know the output step"
    remedies: list[Mend] = []
    for (quantity, unit), limit in zip(QUANTITIES.items(), (IDENTICAL, IDENTICAL_VELOCITY), strict=True):
        gap = max(float(np.max(np.abs(a - b))) for a, b in itertools.combinations(grids[quantity], 2))
        label = f"largest difference of {quantity} between output steps, run by run"
        number = Number(name="largest_difference", label=label, value=gap, unit=unit, n=settings.n_grid)
        remedies.append(Mend(process=name, text=text, outcome=HOLDS if gap <= limit else FAILS, numbers=(number,)))
    return tuple(remedies)


def _refined(
    scenario: Scenario,
    cls: type[OrnsteinUhlenbeck],
    correlation_time: float,
    sigmas: Mapping[str, Any],
    settings: Settings,
    seed: int,
) -> tuple[Mend, ...]:
    """Compare distributions with the process sampled at each output step: the harder test, knots tied to the output."""
    runs: dict[float, EnsembleResult] = {}
    for i, step in enumerate(settings.steps):
        process = cls(correlation_time=correlation_time, spacing=step, **sigmas)
        runs[step] = _run(scenario, process, step, settings, seed, first=i * settings.n_many)
    name = f"{cls.kind}, correlation time {correlation_time:g} s"
    return tuple(_compared(name, _pairs({scenario.law.kind: runs}, quantity, settings)) for quantity in QUANTITIES)


def _compared(name: str, distances: list[Number]) -> Mend:
    most, least = worst(distances), min(distances, key=lambda d: d.p_value or 0.0)
    n = len(distances)
    numbers = (
        dataclasses.replace(most, name="largest_distance", label=f"largest distance of {n}: {most.label}"),
        Number(name="smallest_p", label=f"smallest p-value of {n}: {least.label}", value=least.p_value or 0.0, n=least.n),
    )
    text = "sampled at each output step in turn; every pair of steps compared"
    certain = least.p_value is not None and least.p_value < ALPHA / n
    outcome = same_distribution(distances)
    return Mend(process=name, text=text, outcome=FAILS if certain and outcome == UNDECIDABLE else outcome, numbers=numbers)


def _run(scenario: Scenario, process: Process, step: float, settings: Settings, seed: int, *, first: int) -> EnsembleResult:
    problem = dataclasses.replace(scenario, process=process, output_step=step, duration=settings.times[-1])
    return ensemble.run(problem, settings.n_many, seed=seed, first_sample=first, output_times=list(settings.times), threads=2)


def values(result: EnsembleResult, quantity: str, i: int) -> Array:
    """Return displacement [m] or velocity [m/s] of each run at output time number ``i``."""
    array = result.position if quantity == "position" else result.velocity
    assert array is not None
    return np.round(array[:, i], DECIMALS)


def _distances(study: StepStudy, quantity: str, settings: Settings) -> list[Number]:
    return _pairs(study.ensembles, quantity, settings)


def _pairs(
    ensembles: Mapping[str, Mapping[float, EnsembleResult]], quantity: str, settings: Settings, *, n: int | None = None
) -> list[Number]:
    """Return the distance of each pair of steps, of each law, at each time."""
    numbers: list[Number] = []
    for law, runs in ensembles.items():
        for i, t in enumerate(settings.times):
            for a, b in itertools.combinations(runs, 2):
                x, y = (values(runs[step], quantity, i)[:n] for step in (a, b))
                label = f"{law}, {t:g} s, steps {a:g} and {b:g} s"
                name = f"ks_{law}_{t:g}s_{a:g}_{b:g}_n{len(x)}"
                numbers.append(distance(name, label, x, y, settings))
    return numbers


def distance(name: str, label: str, x: Array, y: Array, settings: Settings, **more: str) -> Number:
    """Return the Kolmogorov-Smirnov distance of two samples with its interval and the p-value of the test."""
    result = statistics.ks_distance(x, y, n_resamples=settings.resamples)
    n = min(len(x), len(y))
    return of_estimate(name, f"KS distance, {label}", result, p_value=statistics.ks_test(x, y).p_value, n=n, **more)


def _shown(distances: list[Number], settings: Settings) -> list[Number]:
    """Return the distances, those of neighbouring steps folded away."""
    ends = f"steps {settings.steps[0]:g} and {settings.steps[-1]:g} s"
    return [d if d.label.endswith(ends) else dataclasses.replace(d, group="Other pairs of steps") for d in distances]


def _few(study: StepStudy, quantity: str, settings: Settings) -> list[Number]:
    """Return the distances with the paper's number of samples."""
    result = _pairs(study.ensembles, quantity, settings, n=study.n_paper)
    return [dataclasses.replace(d, group=f"With {study.n_paper} samples, as in the paper") for d in result]


def _power(study: StepStudy, quantity: str, settings: Settings) -> list[Number]:
    """Return how often 100 samples are enough to see the difference between the coarsest and the finest step."""
    numbers: list[Number] = []
    a, b = settings.steps[0], settings.steps[-1]
    for law, runs in study.ensembles.items():
        for i, t in enumerate(settings.times):
            x, y = (values(runs[step], quantity, i) for step in (a, b))
            n = len(x) // BATCH
            if n == 0:
                continue
            seen = sum(_rejects(x[j * BATCH : (j + 1) * BATCH], y[j * BATCH : (j + 1) * BATCH]) for j in range(n))
            share = statistics.proportion(seen, n)
            label = f"share of batches of {BATCH} that show it at {LEVEL:.0%}, {law}, {t:g} s, steps {a:g} and {b:g} s"
            group = f"With {study.n_paper} samples, as in the paper"
            numbers.append(of_estimate(f"detected_{law}_{t:g}s_n{BATCH}", label, share, n=n, group=group))
    return numbers


def _rejects(x: Array, y: Array) -> bool:
    return statistics.ks_test(x, y).p_value < LEVEL


def _break_aways(study: StepStudy) -> list[Number]:
    return [
        of_estimate(
            f"break_away_mu_s_{law}_{step:g}", f"mean mu_s at break-away, {law}, step {step:g} s",
            statistics.event_statistics(result).break_away_mu_s, n=result.n_runs,
        )
        for law, runs in study.ensembles.items()
        for step, result in runs.items()
    ]  # fmt: skip


def _means(study: StepStudy, quantity: str) -> list[Number]:
    unit = "mm" if quantity == "position" else "mm/s"
    return [
        of_estimate(
            f"mean_{law}_{t:g}s_{step:g}", f"mean, {law}, {t:g} s, step {step:g} s",
            statistics.mean(1.0e3 * values(result, quantity, i)), unit=unit, n=result.n_runs, group="Means",
        )
        for law, runs in study.ensembles.items()
        for step, result in runs.items()
        for i, t in enumerate(result.time)
    ]  # fmt: skip


def _slipping(study: StepStudy, settings: Settings) -> list[Number]:
    """Return the share of runs that stick, and the distance between the velocities of those that slip."""
    numbers: list[Number] = []
    for law, runs in study.ensembles.items():
        for i, t in enumerate(settings.times):
            stuck = {step: _stuck(result, i) for step, result in runs.items()}
            for step, s in stuck.items():
                share = statistics.proportion(int(s.sum()), len(s))
                numbers.append(
                    of_estimate(
                        f"stick_{law}_{t:g}s_{step:g}", f"share that sticks, {law}, {t:g} s, step {step:g} s", share, n=len(s)
                    )
                )
            a, b = settings.steps[0], settings.steps[-1]
            x, y = (np.floor(values(runs[step], "velocity", i) / RESOLUTION) for step in (a, b))
            label = f"velocity in bins of {1.0e3 * RESOLUTION:g} mm/s, {law}, {t:g} s, steps {a:g} and {b:g} s"
            numbers.append(distance(f"ks_binned_{law}_{t:g}s", label, x, y, settings))
            x, y = (values(runs[step], "velocity", i)[~stuck[step]] for step in (a, b))
            if min(len(x), len(y)) >= FEWEST_SLIPPING:
                label = f"of those that slip, {law}, {t:g} s, steps {a:g} and {b:g} s"
                slipping = distance(f"ks_slipping_{law}_{t:g}s", label, x, y, settings, group="Velocity of those that slip")
                numbers.append(slipping)
    return numbers


def _stuck(result: EnsembleResult, i: int) -> npt.NDArray[np.bool_]:
    assert result.stick is not None
    return result.stick[:, i]
