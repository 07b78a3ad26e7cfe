"""The report of a reproduction: its figures and its page."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# (matplotlib leaves keyword arguments untyped)

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stochfric_mb.report.figures import new_figure, svg
from stochfric_mb.report.page import render
from stochfric_mb.reproduction import Number, Reproduction
from stochfric_mb.reproduction.coefficients import Rejection
from stochfric_mb.reproduction.kang2015 import LAWS, SOURCE, TITLE
from stochfric_mb.reproduction.output_step import values
from stochfric_mb.reproduction.portraits import PAPER_DURATION, Portrait
from stochfric_mb.reproduction.scaling import SAMPLES
from stochfric_mb.storage import versions

Array = npt.NDArray[np.float64]

STEP_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")
"""Colours of output steps, coarse to fine (Okabe and Ito's)."""
SHOWN_LAW = "elastic_stick"
"""Law of the portraits drawn."""
MAX_RUNS = 20
"""Runs of a stochastic portrait that are drawn."""
BINS = 60


def figures(result: Reproduction) -> dict[str, str]:
    """Return the figures of a reproduction as SVG: name -> content."""
    wanted: dict[str, Callable[[], Figure]] = {
        "step_position": functools.partial(_steps, result, "position", None),
        "step_position_few": functools.partial(_steps, result, "position", result.settings.n_paper),
        "step_velocity": functools.partial(_steps, result, "velocity", None),
        "step_velocity_few": functools.partial(_steps, result, "velocity", result.settings.n_paper),
        "rejection": functools.partial(_rejection, result),
        "infeasible": functools.partial(_infeasible, result),
        "interpolation": functools.partial(_interpolation, result),
        "sensitivity": functools.partial(_sensitivity, result),
        "growth": functools.partial(_growth, result),
    }
    for number, p in enumerate(p for p in result.portraits if p.law == SHOWN_LAW):
        wanted[f"portrait_{number + 1}"] = functools.partial(_portrait, p)
    return {name: svg(draw) for name, draw in wanted.items()}


def page(result: Reproduction, drawn: Mapping[str, str], command: str) -> str:
    """Return the report as one HTML text that needs no other file.

    Args:
        result: the numbers.
        drawn: its figures, from `figures`.
        command: the command that made it.
    """
    return render(
        "reproduction.html",
        result=result,
        content=result.to_dict(),
        title=TITLE,
        source=SOURCE,
        drawn=drawn,
        captions=_captions(result),
        pictures=_pictures(result),
        grouped=grouped,
        command=command,
        versions=versions(),
    )


def grouped(numbers: tuple[Number, ...]) -> list[tuple[str, list[Number]]]:
    """Return numbers by group, the ones that are always shown (group "") first."""
    names = sorted({n.group for n in numbers}, key=lambda name: (name != "", name))
    return [(name, [n for n in numbers if n.group == name]) for name in names]


def _pictures(result: Reproduction) -> dict[str, list[str]]:
    """Return which figures belong to which claim."""
    table = {
        "step_independence_displacement": ["step_position", "step_position_few"],
        "step_independence_velocity": ["step_velocity", "step_velocity_few"],
        "rejection_keeps_distributions": ["rejection", "infeasible"],
        "interpolation_keeps_distribution": ["interpolation"],
        "laws_alike": ["sensitivity"],
        "cost_of_a_run": ["growth"],
    }
    wider = [claim.id for claim in result.claims if claim.id.startswith("portrait_wider")]
    return table | {name: [f"portrait_{i + 1}"] for i, name in enumerate(wider)}


def _captions(result: Reproduction) -> dict[str, str]:
    n, few = result.settings.n_many, result.settings.n_paper
    steps = "Distribution functions at three output steps, one pair of coefficients per step (figures 11 and 12)"
    captions = {
        "step_position": f"{steps}: displacement, {n} samples.",
        "step_position_few": f"The same with the first {few} samples.",
        "step_velocity": f"{steps}: velocity, {n} samples.",
        "step_velocity_few": f"The same with the first {few} samples.",
        "rejection": "Densities of both coefficients before (line) and after (filled) rejection (figures 5 and 6).",
        "infeasible": "Left: infeasible share against the distance d of the means (figure 7), line exact, dots drawn. "
        "Right: shift of the mean of mu_s by rejection.",
        "interpolation": "Standard deviation of mu_s between two knots over sigma (figure 9), measured and exact.",
        "sensitivity": "Change of the period of Table 1 when a default that the paper leaves open is halved or doubled.",
        "growth": "Processor time of ensembles of Table 1 on one core against the number of samples (left) and the time "
        "simulated (right). Lines: proportional to either, through the largest ensemble.",
    }
    pictures = [p for p in result.portraits if p.law == SHOWN_LAW]
    for i, p in enumerate(pictures):
        captions[f"portrait_{i + 1}"] = (
            f"{p.name}, {p.law} (figures 13 to 15). Left: deterministic; right: {min(MAX_RUNS, len(p.stochastic[0]))} "
            f"stochastic runs. Above: from rest, 0 to {PAPER_DURATION:g} s, transient and all; below: after {p.discarded:g} s."
        )
    return captions


def _steps(result: Reproduction, quantity: str, n: int | None) -> Figure:
    """Draw distribution functions: one row a time, one column a law."""
    study = result.steps
    figure = Figure(figsize=(9.6, 0.7 + 2.3 * len(result.settings.times)), layout="constrained")
    panels = figure.subplots(len(result.settings.times), len(study.ensembles), squeeze=False)
    unit = "mm" if quantity == "position" else "mm/s"
    for column, (law, runs) in zip(panels.T, study.ensembles.items(), strict=True):
        for i, (axes, t) in enumerate(zip(column, result.settings.times, strict=True)):
            for shade, (step, runs_at_step) in zip(STEP_COLOURS, runs.items(), strict=False):
                x = np.sort(1.0e3 * values(runs_at_step, quantity, i)[:n])
                axes.step(x, np.arange(1, len(x) + 1) / len(x), color=shade, label=f"output step {step:g} s", linewidth=1.4)
            axes.set_title(f"{law}, {t:g} s")
            axes.ticklabel_format(axis="x", useOffset=False)
            axes.set(ylim=(-0.02, 1.02), xlabel=f"{quantity} [{unit}]" if t == result.settings.times[-1] else "")
    for axes in panels[:, 0]:
        axes.set_ylabel("share of the runs")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=4)
    return figure


def _rejection(result: Reproduction) -> Figure:
    """Draw densities before and after rejection: the tables, and the closest means."""
    chosen = [r for r in result.rejections if not r.name.startswith("d =") or r.name in ("d = 1", "d = 0")]
    figure, panels = new_figure(11.0, 2.9, columns=len(chosen))
    for axes, r in zip(panels, chosen, strict=True):
        _densities(axes, r)
    panels[0].set_ylabel("density")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=4)
    return figure


def _densities(axes: Axes, r: Rejection) -> None:
    for i, (name, shade) in enumerate((("mu_s", "#0072b2"), ("mu_k", "#d55e00"))):
        low, high = float(r.before[:, i].min()), float(r.before[:, i].max())
        edges = np.linspace(low, high, BINS + 1)
        after, _ = np.histogram(r.before[r.feasible, i], bins=edges, density=True)
        before, _ = np.histogram(r.before[:, i], bins=edges, density=True)
        axes.stairs(after, edges, fill=True, color=shade, alpha=0.4, label=f"{name} after")
        axes.stairs(before, edges, color=shade, linewidth=1.2, label=f"{name} before")
    axes.set(title=f"{r.name}", xlabel="coefficient", yticks=[])


def _infeasible(result: Reproduction) -> Figure:
    figure, (share, shift) = new_figure(9.2, 3.2, columns=2)
    close = [r for r in result.rejections if r.name.startswith("d =")]
    d = np.linspace(0.0, 4.2, 200)
    share.plot(d, [_normal_tail(x) for x in d], color="#52606d", linewidth=1.0)
    claim = result.claim("rejection_keeps_distributions")
    for r in close:
        key = r.name.replace(" = ", "")
        _error_bar(share, r.d, claim.number(f"infeasible_{key}"))
        _error_bar(shift, r.d, claim.number(f"mean_shift_{key}"))
    share.set(yscale="log", xlabel="d", ylabel="infeasible share", ylim=(1.0e-5, 1.0))
    shift.set(xlabel="d", ylabel="shift of the mean of mu_s [sigma]")
    return figure


def _normal_tail(x: float) -> float:
    return 0.5 * math.erfc(x / math.sqrt(2.0))


def _error_bar(axes: Axes, x: float, number: Number) -> None:
    low = number.value - (number.value if number.low is None else number.low)
    high = (number.value if number.high is None else number.high) - number.value
    axes.errorbar(
        [x], [number.value], yerr=[[max(low, 0.0)], [max(high, 0.0)]], fmt="o", color="#0072b2", markersize=4.5, capsize=3
    )


def _interpolation(result: Reproduction) -> Figure:
    figure, (axes,) = new_figure(5.6, 3.2)
    claim = result.claim("interpolation_keeps_distribution")
    w = np.linspace(0.0, 1.0, 101)
    axes.plot(w, np.sqrt(w**2 + (1.0 - w) ** 2), color="#52606d", linewidth=1.0, label="exact")
    for f in result.interpolation.fraction:
        _error_bar(axes, float(f), claim.number(f"sd_at_{f:g}"))
    axes.axhline(1.0, color="#9aa5b1", linestyle="--", linewidth=0.8)
    axes.set(xlabel="place between two knots", ylabel="standard deviation / sigma", ylim=(0.6, 1.15))
    return figure


def _sensitivity(result: Reproduction) -> Figure:
    shown = [s for s in result.sensitivities if s.parameter != "knot spacing"]
    figure, (axes,) = new_figure(7.6, 0.7 + 0.38 * len(shown))
    for row, s in enumerate(reversed(shown)):
        base = s.responses[1][1].period
        for (_, r), shade, word in zip(s.responses[::2], ("#0072b2", "#d55e00"), ("halved", "doubled"), strict=True):
            axes.barh(
                row + (0.18 if word == "halved" else -0.18), 100.0 * (r.period / base - 1.0), height=0.32, color=shade,
                label=word if row == 0 else None,
            )  # fmt: skip
    axes.set_yticks(range(len(shown)), [f"{s.parameter} ({s.law})" for s in reversed(shown)])
    axes.axvline(0.0, color="#52606d", linewidth=0.8)
    axes.set(xlabel="change of the period [%]")
    axes.legend(loc="best")
    return figure


def _growth(result: Reproduction) -> Figure:
    figure, panels = new_figure(9.2, 3.6, columns=2)
    for s in result.growth:
        axes = panels[0 if s.along == SAMPLES else 1]
        shade = STEP_COLOURS[LAWS.index(s.law)]
        rest = f"{s.fixed:g} s" if s.along == SAMPLES else f"{s.fixed:g} samples"
        axes.plot(s.size, s.seconds[-1] * s.size / s.size[-1], color=shade, linewidth=1.0)
        axes.plot(s.size, s.seconds, "o", color=shade, markersize=5, label=f"{s.law}, {rest}")
    for axes, label in zip(panels, ("samples", "time simulated [s]"), strict=True):
        axes.set(xscale="log", yscale="log", xlabel=label, ylabel="processor time [s]")
        axes.legend(loc="lower right")
    return figure


def _portrait(p: Portrait) -> Figure:
    figure = Figure(figsize=(9.2, 6.4), layout="constrained")
    panels = figure.subplots(2, 2, sharex=True, sharey=True)
    windows = ((0.0, PAPER_DURATION), (p.discarded, float(p.time[-1])))
    for row, (low, high) in zip(panels, windows, strict=True):
        for axes, runs, word in zip(row, (p.deterministic, p.stochastic), ("deterministic", "stochastic"), strict=True):
            inside = (p.time >= low) & (p.time <= high)
            x, v = (part[:MAX_RUNS, inside] for part in runs)
            for one_x, one_v in zip(x, v, strict=True):
                axes.plot(
                    1.0e3 * one_x,
                    1.0e3 * one_v,
                    color="#0072b2",
                    linewidth=0.6,
                    alpha=0.8 if len(x) == 1 else 0.35,
                )
            axes.axhline(1.0e3 * p.belt_velocity, color="#d55e00", linestyle="--", linewidth=0.8)
            axes.set_title(f"{word}, {low:g} to {high:g} s")
    for axes in panels[1]:
        axes.set_xlabel("position [mm]")
    for axes in panels[:, 0]:
        axes.set_ylabel("velocity [mm/s]")
    return figure
