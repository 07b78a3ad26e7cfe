"""The page of an ensemble and its figures: fan chart, distributions, phase portrait, stick fraction, break-aways."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# (matplotlib leaves keyword arguments untyped)

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from stochfric_mb.ensemble.result import EnsembleResult
from stochfric_mb.report.figures import colour, new_figure, svg
from stochfric_mb.report.page import render
from stochfric_mb.scenario import Scenario
from stochfric_mb.storage import versions

BANDS = ((0.005, 0.995, 0.15), (0.05, 0.95, 0.35), (0.25, 0.75, 0.65))
"""Lower and upper level of a band of the fan chart, and its opacity."""
MAX_TIMES = 1000
"""The fan chart is drawn at no more than so many times, evenly chosen."""
ONE_VALUE = 1.0e-7
"""Spread, over the value, below which runs have one value: a histogram would show roundings and the step's errors."""
FEW_TIMES = 8
"""Up to so many times are drawn one by one: nothing is known between them."""
CHUNK = 100
"""Runs counted at a time in the phase portrait."""
SHOWN = 4
"""Output times at which distributions are shown, unless stated otherwise."""

Array = npt.NDArray[np.float64]


def figures(result: EnsembleResult, scenario: Scenario, *, times: Sequence[float] | None = None) -> dict[str, str]:
    """Return the figures of an ensemble as SVG: name -> content.

    Args:
        result: the runs, or statistics of them (then without the phase portrait, which needs both quantities of a run).
        scenario: what was simulated.
        times: times at which distributions are shown [s], the nearest output times are taken; a few if not given.
    """
    shown = chosen(result, times)
    wanted: dict[str, Callable[[], Figure]] = {
        "fan_chart": functools.partial(_fan_chart, result),
        "distributions": functools.partial(_distributions, result, shown),
        "stick": functools.partial(_stick, result),
        "break_aways": functools.partial(_break_aways, result),
    }
    if result.position is not None:
        wanted["phase_portrait"] = functools.partial(_phase_portrait, result, scenario)
    return {name: svg(draw) for name, draw in wanted.items()}


CAPTIONS = {
    "fan_chart": "Median over the runs and the bands that hold 50, 90 and 99 % of them.",
    "distributions": "Share of the runs at some output times, on a logarithmic scale.",
    "phase_portrait": "How often the runs pass a state; dashed: the belt's speed.",
    "stick": "Left: share of the runs that stick. Right: how the runs differ in the share of their time that they stick.",
    "break_aways": "Number of break-aways in a run, time of the first, mean mu_s at break-away, mean period.",
}
"""What each figure shows."""
EVENTS = (
    ("period", "cycle period", "s"),
    ("first_break_away", "first break-away", "s"),
    ("break_away_mu_s", "mu_s at break-away", "-"),
    ("stick_fraction", "share of the time in stick", "-"),
    ("n_break_aways", "break-aways in a run", "-"),
)
"""Statistic, its name in words, its unit."""


LEVELS = (0.05, 0.5, 0.95)
"""Quantiles of the response that the page shows."""


def page(title: str, facts: Mapping[str, Any], drawn: Mapping[str, str], command: str) -> str:
    """Return the page of an ensemble as one HTML text that needs no other file.

    Args:
        title: of the scenario.
        facts: what ``stochfric ensemble --json`` says of it, and ``ensemble.json`` holds.
        drawn: its figures, from `figures`.
        command: the command that made it.
    """
    return render(
        "ensemble.html", title=title, facts=facts, drawn=drawn, captions=CAPTIONS, events=EVENTS, command=command,
        versions=versions(),
    )  # fmt: skip


def response(result: EnsembleResult) -> list[dict[str, Any]]:
    """Return mean, standard deviation and quantiles of position and velocity at a few output times [m or rad, s]."""
    few = at_times(result, chosen(result))
    spread = {name: few.std(name).tolist() if result.n_runs > 1 else [None] * len(few.time) for name in _units(result)}
    return [
        {
            "name": name, "unit": unit, "time": few.time.tolist(), "mean": few.mean(name).tolist(),
            "std": spread[name], "levels": LEVELS, "quantiles": few.quantiles(name, LEVELS).tolist(),
        }
        for name, unit in _units(result).items()
    ]  # fmt: skip


def chosen(result: EnsembleResult, times: Sequence[float] | None = None) -> list[int]:
    """Return the numbers of the output times nearest to ``times``; a few evenly spread ones, the last included, if None."""
    n = len(result.time)
    if times is None:
        return sorted({round((n - 1) * i / SHOWN) for i in range(1, SHOWN + 1)}) if n > SHOWN else list(range(n))
    return sorted({int(np.argmin(np.abs(result.time - t))) for t in times})


def at_times(result: EnsembleResult, numbers: Sequence[int]) -> EnsembleResult:
    """Return an ensemble at some of its output times only; the events of the runs stay those of the whole time."""
    i = np.asarray(numbers)

    def cut(runs: npt.NDArray[Any] | None) -> Any:
        return None if runs is None else runs[..., i]

    sketches = {
        name: dataclasses.replace(s, counts=s.counts[i], low=s.low[i], exponent=s.exponent[i], moments=s.moments[:, i])
        for name, s in result.sketches.items()
    }
    return dataclasses.replace(
        result, time=result.time[i], position=cut(result.position), velocity=cut(result.velocity), stick=cut(result.stick),
        sketches=sketches, stuck=cut(result.stuck),
    )  # fmt: skip


def _units(result: EnsembleResult) -> dict[str, str]:
    """Return the quantities that are drawn and their units; they are shown in thousandths of them."""
    unit = str(result.attributes.get("position_unit", "m"))
    return {"position": unit, "velocity": f"{unit}/s"}


def _fan_chart(result: EnsembleResult) -> Figure:
    result = at_times(result, range(0, len(result.time), -(-len(result.time) // MAX_TIMES)))
    figure, panels = new_figure(9.2, 3.5, columns=2)
    ink = colour(str(result.attributes.get("engine", "")))
    for axes, (name, unit) in zip(panels, _units(result).items(), strict=True):
        levels = sorted({0.5, *(level for low, high, _ in BANDS for level in (low, high))})
        quantile = dict(zip(levels, 1.0e3 * result.quantiles(name, levels), strict=True))
        for low, high, opacity in BANDS:
            text = f"{100.0 * (high - low):.0f} %"
            if len(result.time) > FEW_TIMES:
                shade: dict[str, Any] = {"color": "#0072b2", "alpha": opacity, "linewidth": 0.0, "label": text}
                axes.fill_between(result.time, quantile[low], quantile[high], **shade)
            else:
                axes.vlines(
                    result.time, quantile[low], quantile[high], color="#0072b2", alpha=opacity, linewidth=9.0, label=text
                )
        dots: dict[str, Any] = {} if len(result.time) > FEW_TIMES else {"marker": "o", "linestyle": ""}
        axes.plot(result.time, quantile[0.5], color=ink, linewidth=1.0, label="median", **dots)
        axes.set(xlabel="time [s]", ylabel=f"{name} [m{unit}]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=4)
    return figure


def _distributions(result: EnsembleResult, shown: Sequence[int]) -> Figure:
    figure = Figure(figsize=(9.2, 1.0 + 1.7 * len(shown)), layout="constrained")
    panels = figure.subplots(len(shown), 2, squeeze=False)
    for row, i in zip(panels, shown, strict=True):
        for axes, (name, unit) in zip(row, _units(result).items(), strict=True):
            low, high = at_times(result, [i]).quantiles(name, [0.0, 1.0])[:, 0]
            if high - low <= ONE_VALUE * abs(high):
                _one_value(axes, float(high), unit)
            else:
                _histogram_of(axes, *_coarse(*result.histogram(name, i, bins=60)))
            axes.set_title(f"t = {result.time[i]:g} s")
            axes.set(ylabel="share of the runs", xlabel=f"{name} [m{unit}]" if i == shown[-1] else "")
    return figure


def _histogram_of(axes: Axes, counts: npt.NDArray[np.int64], edges: Array) -> None:
    """Draw shares on a logarithmic scale: the runs that stick are many at one velocity, and the others matter as well."""
    axes.set_axisbelow(True)
    axes.stairs(counts / counts.sum(), 1.0e3 * edges, fill=True, color="#0072b2", alpha=0.75)
    axes.set_yscale("log")


def _one_value(axes: Axes, value: float, unit: str) -> None:
    axes.text(0.5, 0.5, f"all runs: {1.0e3 * value:.6g} m{unit}", transform=axes.transAxes, ha="center", color="#52606d")
    axes.set(xticks=[], yticks=[])


def _coarse(counts: npt.NDArray[np.int64], edges: Array, most: int = 60) -> tuple[npt.NDArray[np.int64], Array]:
    """Return a histogram with at most so many bins, neighbours put together."""
    by = -(-len(counts) // most)
    padded = np.concatenate([counts, np.zeros(-len(counts) % by, dtype=np.int64)])
    width = edges[1] - edges[0]
    return padded.reshape(-1, by).sum(axis=1), edges[0] + by * width * np.arange(len(padded) // by + 1)


def _phase_portrait(result: EnsembleResult, scenario: Scenario) -> Figure:
    assert result.position is not None
    assert result.velocity is not None
    figure, (axes,) = new_figure(5.6, 4.2)
    edges = [_edges(result.position), _edges(result.velocity)]
    counts = np.zeros((160, 160))
    for i in range(0, result.n_runs, CHUNK):
        x, v = result.position[i : i + CHUNK].ravel(), result.velocity[i : i + CHUNK].ravel()
        counts += np.histogram2d(x, v, bins=edges)[0]
    shown = np.where(counts > 0.0, counts, np.nan).T
    (left, right), (low, high) = ((1.0e3 * float(edge[0]), 1.0e3 * float(edge[-1])) for edge in edges)
    style: dict[str, Any] = {"cmap": "viridis", "norm": LogNorm(), "origin": "lower", "aspect": "auto"}
    mesh = axes.imshow(shown, extent=(left, right, low, high), interpolation="nearest", **style)
    if hasattr(scenario.mechanism, "belt_velocity"):
        belt: dict[str, Any] = {"color": "#d55e00", "linestyle": "--", "linewidth": 0.8, "label": "belt"}
        axes.axhline(1.0e3 * scenario.mechanism.belt_velocity, **belt)
        axes.legend(loc="lower left")
    across, along = _units(result).values()
    axes.set(xlabel=f"position [m{across}]", ylabel=f"velocity [m{along}]")
    axes.grid(visible=False)
    figure.colorbar(mesh, ax=axes, label="samples")
    return figure


def _edges(values: Array, n: int = 160) -> Array:
    """Return n + 1 edges of bins that hold all values, with a margin."""
    low, high = float(values.min()), float(values.max())
    margin = 0.04 * (high - low) or max(1.0e-3 * abs(high), 1.0e-9)
    return np.linspace(low - margin, high + margin, n + 1)


def _stick(result: EnsembleResult) -> Figure:
    figure, (along, over) = new_figure(9.2, 3.3, columns=2)
    marker: dict[str, Any] = {} if len(result.time) > FEW_TIMES else {"marker": "o", "linestyle": ""}
    along.plot(result.time, result.stick_probability, color="#0072b2", linewidth=1.0, **marker)
    along.set(xlabel="time [s]", ylabel="share of the runs that stick", ylim=(-0.03, 1.03))
    _values(over, result.stick_fraction, "share of its time that a run sticks")
    return figure


def _break_aways(result: EnsembleResult) -> Figure:
    figure, (number, first, mu, period) = new_figure(12.0, 3.1, columns=4)
    counts = result.n_break_aways.astype(np.int64)
    values, runs = np.unique(counts, return_counts=True)
    number.set_axisbelow(True)
    number.bar(values, runs / len(counts), width=0.8, color="#0072b2", alpha=0.75)
    number.set(xlabel="break-aways in a run", ylabel="share of the runs")
    number.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    _values(first, result.first_break_away, "first break-away [s]")
    _values(mu, result.break_away_mu_s, "mean mu_s at break-away")
    _values(period, result.period, "mean period [s]")
    return figure


def _values(axes: Axes, values: Array, label: str) -> None:
    """Draw the histogram of what each run has, NaN left out."""
    seen = values[np.isfinite(values)]
    axes.set(xlabel=label, ylabel="share of the runs")
    if not seen.size:
        axes.text(0.5, 0.5, "no run has one", transform=axes.transAxes, ha="center", color="#52606d")
        return
    axes.set_axisbelow(True)
    axes.xaxis.set_major_locator(MaxNLocator(4))
    counts, edges = np.histogram(seen, bins=min(60, max(10, round(np.sqrt(seen.size)))))
    axes.stairs(counts / len(values), edges, fill=True, color="#0072b2", alpha=0.75)
