"""Claim: stochastic phase portraits are wider than deterministic ones (figures 13 to 15)."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb import ensemble, statistics
from stochfric_mb.reference import solve
from stochfric_mb.reproduction.claims import FAILS, HOLDS, UNDECIDABLE, Claim, Number, of_estimate
from stochfric_mb.reproduction.settings import Settings
from stochfric_mb.scenario import Scenario

Array = npt.NDArray[np.float64]
Tick = Callable[[int], None]

PAPER_DURATION = 10.0
"""Length of a run that keeps its transient [s]."""
STEP = 0.002
"""Distance of the samples of a portrait [s]; a turning point between two is located to about 0.1 um (the velocity is taken
as linear there, though the break-away may fall into the same interval)."""
UPPER = 0.5
"""A turning point counts above this share of mu_s N/k: one a slip, and none of the ringing after a start from x = 0 [-]."""
SETTLED = 1.0e-9
"""A run has settled when the position at break-away changes by no more [m]."""
SAME_CYCLES = 5
"""Break-aways at the end of a run that must agree for it to have settled."""


@dataclasses.dataclass(frozen=True)
class Portrait:
    """Runs of one law in one scenario."""

    name: str
    """Scenario."""
    law: str
    """Law."""
    discarded: float
    """Time discarded as transient [s]."""
    time: Array
    """Sample times [s], shape (n,)."""
    deterministic: tuple[Array, Array]
    """Position [m] and velocity [m/s], shape (1, n)."""
    stochastic: tuple[Array, Array]
    """The same of the stochastic runs, shape (n_runs, n)."""
    settled: float | None
    """Last break-away of the deterministic run that is not yet within 1e-9 m of the final ones [s]; None: never settled."""
    break_away_range: float
    """Range of the position at break-away over the last ten slips of the deterministic run [m]."""
    belt_velocity: float
    """Velocity of the belt [m/s]."""
    static: float
    """Static deflection mu_s N/k [m]."""


@dataclasses.dataclass(frozen=True)
class Turns:
    """Upper turning points (x' = 0 falling) of runs: one a slip."""

    n: Array
    """Turning points of each run, shape (n_runs,)."""
    total: Array
    """Sum of their positions less a common shift [m], shape (n_runs,)."""
    squares: Array
    """Sum of squares of the same, shape (n_runs,)."""

    def spread(self, weights: Array | None = None) -> float:
        """Return the standard deviation of the pooled positions [m], each run counted ``weights`` times."""
        w = np.ones(len(self.n)) if weights is None else weights
        n, s, q = float(w @ self.n), float(w @ self.total), float(w @ self.squares)
        return math.sqrt(max(q - s * s / n, 0.0) / (n - 1.0)) if n > 1.0 else math.nan


def make_portraits(
    scenarios: Mapping[str, Mapping[str, Scenario]], settings: Settings, seed: int, tick: Tick
) -> list[Portrait]:
    """Return deterministic and stochastic runs of each scenario and law.

    Args:
        scenarios: name of the scenario -> law -> scenario with its process.
        settings: sizes.
        seed: of the coefficients.
        tick: called with the number of portraits done.
    """
    items: list[Portrait] = []
    for name, laws in scenarios.items():
        for law, scenario in laws.items():
            items.append(_portrait(name, law, scenario, settings, seed))
            tick(len(items))
    return items


def _portrait(name: str, law: str, scenario: Scenario, settings: Settings, seed: int) -> Portrait:
    discarded = settings.discarded[name]
    end = discarded + settings.portrait_time
    static = scenario.law.mu_s * scenario.mechanism.normal_force / scenario.mechanism.stiffness
    problem = dataclasses.replace(scenario, duration=end, output_step=STEP)
    options: dict[str, Any] = {"seed": seed, "max_bytes": 2**33}
    random = ensemble.run(problem, settings.n_portrait, threads=2, **options)
    alone = ensemble.run(dataclasses.replace(problem, process=None), 1, **options)
    settled, spread = _settling(scenario, end)
    assert random.position is not None and random.velocity is not None  # noqa: PT018
    assert alone.position is not None and alone.velocity is not None  # noqa: PT018
    return Portrait(
        name, law, discarded, random.time, (alone.position, alone.velocity), (random.position, random.velocity),
        settled, spread, scenario.mechanism.belt_velocity, static,
    )  # fmt: skip


def _settling(scenario: Scenario, end: float) -> tuple[float | None, float]:
    """Return when the deterministic run settles [s], and the range of x over its last ten break-aways [m]."""
    events = solve(scenario.mechanism, scenario.law, None, [end]).events
    breaks = events[events[:, 1] == 1.0, 0]
    x = solve(scenario.mechanism, scenario.law, None, breaks).position
    late = float(np.ptp(x[-10:]))
    if np.ptp(x[-SAME_CYCLES:]) > SETTLED:
        return None, late
    off = np.flatnonzero(np.abs(x - x[-1]) > SETTLED)
    return float(breaks[off[-1]]) if off.size else 0.0, late


def turns(p: Portrait, runs: tuple[Array, Array], low: float, high: float) -> Turns:
    """Return the upper turning points of runs of a portrait between two times [s]."""
    time, (x, v) = p.time, runs
    inside = (time >= low) & (time <= high)
    h = time[1] - time[0]
    first, last = int(np.argmax(inside)), len(time) - int(np.argmax(inside[::-1]))
    x, v = x[:, first:last], v[:, first:last]
    at = (v[:, :-1] > 0.0) & (v[:, 1:] <= 0.0) & (x[:, :-1] > UPPER * p.static)
    part = np.divide(v[:, :-1], v[:, :-1] - v[:, 1:], out=np.zeros_like(v[:, 1:]), where=at)
    top = np.where(at, x[:, :-1] + 0.5 * part * h * v[:, :-1] - p.static, 0.0)
    return Turns(at.sum(axis=1).astype(np.float64), top.sum(axis=1), (top**2).sum(axis=1))


def spread(result: Turns, settings: Settings, seed: int) -> statistics.Estimate:
    """Return the standard deviation of the turning points [m], with a bootstrap interval over the runs."""
    rng = np.random.default_rng([seed, 3])
    n = len(result.n)
    drawn = [
        result.spread(np.bincount(rng.integers(0, n, n), minlength=n).astype(np.float64)) for _ in range(settings.resamples)
    ]
    low, high = np.quantile(drawn, [0.025, 0.975])
    return statistics.Estimate(result.spread(), float(low), float(high), 0.95)


def claims(portraits: list[Portrait], settings: Settings, seed: int) -> list[Claim]:
    """Return one claim a scenario."""
    items: list[Claim] = []
    for name in dict.fromkeys(p.name for p in portraits):
        items.append(_claim(name, [p for p in portraits if p.name == name], settings, seed))
    return items


def _claim(name: str, portraits: list[Portrait], settings: Settings, seed: int) -> Claim:
    numbers: list[Number] = []
    outcomes: dict[str, str] = {}
    spreads: list[str] = []
    with_transient: list[str] = []
    for p in portraits:
        end = float(p.time[-1])
        wide = spread(turns(p, p.stochastic, p.discarded, end), settings, seed)
        alone = turns(p, p.deterministic, p.discarded, end).spread()
        outcomes[p.law] = _wider(wide, alone)
        spreads.append(f"{p.law} {1e6 * wide.value:.3g} against {1e6 * alone:.3g} um ({outcomes[p.law]})")
        first = spread(turns(p, p.stochastic, 0.0, PAPER_DURATION), settings, seed)
        first_alone = turns(p, p.deterministic, 0.0, PAPER_DURATION).spread()
        with_transient.append(
            f"{p.law} {1e6 * first.value:.3g} against {1e6 * first_alone:.3g} um ({_wider(first, first_alone)})"
        )
        numbers += [
            _micro(f"stochastic_{p.law}", f"spread, stochastic, {p.law}, after {p.discarded:g} s", wide, len(p.stochastic[0])),
            Number(name=f"deterministic_{p.law}", label=f"spread, deterministic, {p.law}, after {p.discarded:g} s",
                   value=1e6 * alone, unit="um"),
            *_with_transient(p, first, first_alone),
            Number(name=f"settled_{p.law}", label=f"deterministic run settled to 1e-9 m after, {p.law}",
                   value=math.nan if p.settled is None else p.settled, unit="s"),
            Number(name=f"break_away_range_{p.law}", label=f"range of x over its last ten break-aways, {p.law}",
                   value=1e6 * p.break_away_range, unit="um", group="Deterministic run, late"),
        ]  # fmt: skip
    verdict = next((v for v in (FAILS, UNDECIDABLE) if v in outcomes.values()), HOLDS)
    unsettled = [p.law for p in portraits if p.settled is None]
    return Claim(
        id="portrait_wider_" + "".join(c if c.isalnum() else "_" for c in name.lower()).replace("__", "_"),
        claim=f"The stochastic phase portrait is wider than the deterministic one ({name})",
        where="figures 13 to 15",
        test=f"{settings.n_portrait} stochastic runs and one deterministic run of each law; spread: standard deviation over "
        f"slips of the upper turning point (x' = 0), from {portraits[0].discarded:g} s to {portraits[0].time[-1]:g} s",
        rule="for each law: holds if the bootstrap interval of the stochastic spread lies above the deterministic spread in "
        "the same window, fails if below; the claim holds if it does for every law, fails if it fails for one",
        verdict=verdict,
        reason="Spread " + "; ".join(spreads),
        numbers=tuple(numbers),
        remark=_remark(portraits, unsettled, with_transient),
    )


def _wider(wide: statistics.Estimate, alone: float) -> str:
    return HOLDS if wide.low > alone else FAILS if wide.high < alone else UNDECIDABLE


def _remark(portraits: list[Portrait], unsettled: list[str], with_transient: list[str]) -> str:
    settled = [f"{p.law} {p.settled:.1f} s" for p in portraits if p.settled is not None]
    text = f"Deterministic runs settle after {', '.join(settled)}." if settled else ""
    if unsettled:
        text += (
            f" Not settled within {portraits[0].time[-1]:g} s: {', '.join(unsettled)}. A deterministic run that does not "
            "settle has a spread of its own, which is no effect of random coefficients."
        )
    text += f" With transients, 0 to {PAPER_DURATION:g} s from rest, it would read: {'; '.join(with_transient)}."
    return text.strip()


def _with_transient(p: Portrait, wide: statistics.Estimate, alone: float) -> list[Number]:
    """Return the spreads of the first 10 s, transient and all."""
    group = f"With transients: 0 to {PAPER_DURATION:g} s"
    return [
        _micro(f"stochastic_transient_{p.law}", f"spread, stochastic, {p.law}", wide, len(p.stochastic[0]), group=group),
        Number(
            name=f"deterministic_transient_{p.law}",
            label=f"spread, deterministic, {p.law}",
            value=1e6 * alone,
            unit="um",
            group=group,
        ),
    ]


def _micro(name: str, label: str, estimate: statistics.Estimate, n: int, **more: str) -> Number:
    scaled = statistics.Estimate(1e6 * estimate.value, 1e6 * estimate.low, 1e6 * estimate.high, estimate.confidence)
    return of_estimate(name, label, scaled, unit="um", n=n, **more)
