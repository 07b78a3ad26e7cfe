"""The pictures of a discovery: cycles forecast, forces left over, events, ranking, gap; and pictures given as data."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# (matplotlib leaves keyword arguments untyped)

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from stochfric_mb.discovery.stick_slip.screening.folding import TURN
from stochfric_mb.discovery.stick_slip.simulation.forecast import N_OUTPUTS, REACH
from stochfric_mb.effects import effect_kinds
from stochfric_mb.report.discovery_evidence import PLACES, Evidence, LeftOver, band
from stochfric_mb.report.figures import legend, new_figure, svg

COLOURS = {
    "data": "#1f2933", "believed": "#9aa5b1", "recalibrated": "#d55e00", "augmented": "#0072b2", "floor": "#009e73",
}  # fmt: skip
"""Colour of the data and of each model."""
LABELS = {
    "data": "measured", "believed": "model as stated", "recalibrated": "recalibrated", "augmented": "with the effects",
    "floor": "noise floor",
}  # fmt: skip
"""What they are called in a legend."""
MOST_CYCLES = 60
"""Measured cycles that are drawn over each other."""
PALE = 4.0
"""Standard deviations of the noise at which the colours of the map end, or further out [-]."""
FOLDED_IN_TIME = ("normal_load_ripple", "harmonic_force", "belt_speed_ripple")
"""Effects that repeat in time."""
EVENT_LABELS = {"period": "cycle period [s]", "break_away_force": "force at break-away [N]", "slip_travel": "slip travel [mm]"}
"""Axis of each statistic of events."""


def figures(content: Mapping[str, Any], evidence: Evidence | None) -> dict[str, str]:
    """Return the pictures of a discovery as SVG: name -> content.

    Args:
        content: what ``result.json`` holds.
        evidence: what is drawn of a belt-box; None on other mechanisms.
    """
    wanted: dict[str, Callable[[], Figure]] = {}
    if evidence is not None:
        if evidence.cycles:
            wanted["cycles"] = functools.partial(_cycles, evidence)
        wanted["map"] = functools.partial(_map, evidence)
        wanted["left_over"] = functools.partial(_left_over, evidence)
        if (repeated := _repeated(content)) is not None:
            wanted["folded"] = functools.partial(_folded, evidence, *repeated)
        if evidence.friction:
            wanted["friction"] = functools.partial(_friction, evidence)
        wanted["events"] = functools.partial(_events, evidence)
    if content["ranking"]:
        wanted["ranking"] = functools.partial(_ranking, content)
    if (gap := content[content["leading"]]) is not None:
        wanted["gap"] = functools.partial(_gap, gap, added=bool(content["effects"] or content["unnamed"]))
    return {name: svg(draw) for name, draw in wanted.items()}


def given(data: Mapping[str, Any]) -> str:
    """Return a picture that came as data, as SVG.

    Args:
        data: ``{"panels": [{"x": label, "y": label, "title": ..., "series": [{"name", "x", "y", "draw"}]}]}``, where
            ``draw`` is "line" (if not given) or "points", and a series' name may be one of `COLOURS`.
    """
    return svg(functools.partial(_given, data))


def _given(data: Mapping[str, Any]) -> Figure:
    panels = list(data["panels"])
    figure, axes_list = new_figure(9.2 if len(panels) > 1 else 6.4, 3.4, columns=len(panels))
    for axes, panel in zip(axes_list, panels, strict=True):
        for series in panel["series"]:
            style: dict[str, Any] = (
                {"marker": ".", "linestyle": "none", "markersize": 2.5} if series.get("draw") == "points" else {}
            )
            if (name := series.get("name", "")) in COLOURS:
                style["color"] = COLOURS[name]
            axes.plot(series["x"], series["y"], label=LABELS.get(name, name), **style)
        axes.set(xlabel=panel["x"], ylabel=panel["y"], title=panel.get("title", ""))
    legend(figure, axes_list[0])
    return figure


def _models(evidence: Evidence) -> list[str]:
    """Return the models that are compared in close-ups: the best without and with the effects."""
    return [name for name in ("recalibrated", "augmented") if name in evidence.cycles]


def _cycles(evidence: Evidence) -> Figure:
    figure, (cycle, error) = new_figure(9.2, 3.7, columns=2)
    run = int(np.argmax([len(w) for w in evidence.windows]))
    window = evidence.windows[run]
    chosen = np.unique(np.linspace(0, len(window) - 1, min(MOST_CYCLES, len(window))).round().astype(int))
    time = window.stride / window.record.rate * np.arange(1, N_OUTPUTS + 1)
    start = window.starts[:, 1:2]
    for number, i in enumerate(chosen):
        label = LABELS["data"] if number == 0 else None
        cycle.plot(time, 1.0e3 * (window.targets - start)[i], color=COLOURS["data"], linewidth=0.6, alpha=0.35, label=label)
    styles: dict[str, Any] = {"believed": "--", "recalibrated": "-", "augmented": (0.0, (4.0, 2.0))}
    for name in ("believed", *_models(evidence)):
        middle, low, high = band(1.0e3 * (evidence.cycles[name].runs[run] - start), axis=0)
        cycle.plot(time, middle, color=COLOURS[name], linestyle=styles[name], linewidth=1.8, label=LABELS[name])
        if name != "believed":
            cycle.fill_between(time, low, high, color=COLOURS[name], alpha=0.18, linewidth=0.0)
    cycle.set(title="one cycle ahead", xlabel="time since the forecast began [s]", ylabel="displacement [mm]")
    share = REACH * np.arange(1, N_OUTPUTS + 1) / N_OUTPUTS
    for name in _models(evidence):
        middle, low, high = band(1.0e6 * evidence.cycles[name].error, axis=0)
        error.fill_between(share, low, high, color=COLOURS[name], alpha=0.3, linewidth=0.0)
        error.plot(share, middle, color=COLOURS[name], linewidth=1.6)
        if evidence.cycles[name].spread.any():
            _, low, high = band(1.0e6 * evidence.cycles[name].spread, axis=0)
            for edge in (low, high):
                error.plot(share, edge, color=COLOURS[name], linewidth=1.0, linestyle=":")
    error.axhline(0.0, color=COLOURS["data"], linewidth=0.7)
    error.set(title="measured minus forecast", xlabel="time since the forecast began [cycles]", ylabel="error [µm]")
    legend(figure, cycle)
    return figure


def _map(evidence: Evidence) -> Figure:
    states = {"recalibrated": evidence.before} | ({"augmented": evidence.after} if evidence.after is not None else {})
    # where nothing but noise is left, the map is pale
    limit = 1.0e3 * max(float(np.quantile(np.abs(evidence.before.along), 0.97)), PALE * evidence.before.noise)
    figure, axes_list = new_figure(9.2, 3.4, columns=len(states))
    for axes, (name, left) in zip(axes_list, states.items(), strict=True):
        order = np.lexsort((left.time, left.run))
        shown = 1.0e3 * left.along[order].T
        mesh = axes.imshow(
            shown, origin="lower", aspect="auto", cmap="RdBu_r", vmin=-limit, vmax=limit, interpolation="nearest",
            extent=(0.5, len(left.time) + 0.5, 50.0 * (1.0 + PLACES[0]), 50.0 * (1.0 + PLACES[-1])),
        )  # fmt: skip
        for edge in np.flatnonzero(np.diff(left.run[order])) + 1.5:
            axes.axvline(edge, color=COLOURS["data"], linewidth=0.8)
        axes.grid(visible=False)
        axes.set(title=LABELS[name], xlabel="slip number, runs side by side", ylabel="course of the slip [%]")
        if axes is axes_list[-1]:
            figure.colorbar(mesh, ax=axes_list, label="measured minus model [mN]", shrink=0.9)
    return figure


def _left_over(evidence: Evidence) -> Figure:
    figure = Figure(figsize=(9.2, 4.9), layout="constrained")
    grid = figure.subplots(2, 2, sharex="col", sharey="row", squeeze=False)
    for name, left in _states(evidence):
        for row, values in enumerate((left.onset, left.mean)):
            for axes, along in zip(grid[row], (left.time, 1.0e3 * left.belt_position), strict=True):
                axes.plot(
                    along, 1.0e3 * values, ".", color=COLOURS[name], markersize=4.5, markeredgewidth=0.0, label=LABELS[name]
                )
    grid[0, 0].set(ylabel="at break-away [mN]")
    grid[1, 0].set(ylabel="mean over the slip [mN]", xlabel="time in the run [s]")
    grid[1, 1].set(xlabel="position on the belt [mm]")
    legend(figure, grid[0, 0])
    return figure


def _repeated(content: Mapping[str, Any]) -> tuple[str, float] | None:
    """Return how the first periodic effect repeats: along "belt" with its wavelength [m], or in "time" with its period [s].

    Slips that come back each turn of the belt repeat with it, although no effect is named.
    """
    if (travel := content["details"].get(TURN)) is not None:
        return "belt", float(travel)
    for effect in content["effects"]:
        numbers = effect["parameters"]
        if (wavelength := numbers.get("wavelength", {}).get("value")) and effect["kind"] == "position_dependent_friction":
            return "belt", float(wavelength)
        if (frequency := numbers.get("frequency", {}).get("value")) and effect["kind"] in FOLDED_IN_TIME:
            return "time", 1.0 / float(frequency)
    return None


def _folded(evidence: Evidence, along: str, length: float) -> Figure:
    """Draw what is left of each slip of the first run against its place in one round of what repeats."""
    figure, axes_list = new_figure(9.2, 3.1, columns=2)
    scale, unit = (1.0e3, "mm") if along == "belt" else (1.0, "s")
    for name, left in _states(evidence):
        mine = left.run == left.run[0]
        places = scale * np.mod((left.belt_position if along == "belt" else left.time)[mine], length)
        for axes, values in zip(axes_list, (left.onset, left.mean), strict=True):
            style: dict[str, Any] = {"color": COLOURS[name], "markersize": 4.5, "markeredgewidth": 0.0}
            axes.plot(places, 1.0e3 * values[mine], ".", label=LABELS[name], **style)
    for axes, what in zip(axes_list, ("at break-away [mN]", "mean over the slip [mN]"), strict=True):
        axes.set(ylabel=what, xlabel=f"position on the belt within {scale * length:.3g} mm [mm]" if along == "belt" else
                 f"time within {length:.3g} s [{unit}]")  # fmt: skip
    legend(figure, axes_list[0])
    return figure


def _states(evidence: Evidence) -> list[tuple[str, LeftOver]]:
    """Return the residuals of the recalibrated model and, if there is one, of that with the effects."""
    after: list[tuple[str, LeftOver]] = [] if evidence.after is None else [("augmented", evidence.after)]
    return [("recalibrated", evidence.before), *after]


def _friction(evidence: Evidence) -> Figure:
    """Draw friction against relative velocity: as each model has it, and as measured: a model's and what it leaves."""
    figure, (axes,) = new_figure(4.8, 3.9)
    name, left = [(n, residual) for n, residual in _states(evidence) if n in evidence.friction][-1]
    speed, law = evidence.friction[name].at(PLACES)
    middle, low, high = band(law + left.in_full[left.run == left.run[0]], axis=0)
    # forces that turn on the box's motion differ on the way up and down in speed: both branches are drawn
    label: str | None = LABELS["data"]
    for branch in np.array_split(np.arange(len(PLACES)), [int(np.argmax(speed)) + 1]):
        axes.fill_between(1.0e3 * speed[branch], low[branch], high[branch], color=COLOURS["data"], alpha=0.12, linewidth=0.0)
        axes.plot(
            1.0e3 * speed[branch], middle[branch], "o-", color=COLOURS["data"], markersize=3.0, linewidth=0.8, label=label
        )
        label = None
    for model, slip in evidence.friction.items():
        axes.plot(1.0e3 * slip.relative_velocity, slip.force, color=COLOURS[model], linewidth=1.6, label=LABELS[model])
    _at_rest(axes, evidence)
    axes.set(xlabel="relative velocity [mm/s]", ylabel="friction force in the slip [N]")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper left", ncols=2)
    return figure


def _at_rest(axes: Axes, evidence: Evidence) -> None:
    """Draw the force at break-away, measured and stated by the models, at zero velocity."""
    for name in ("data", *(n for n in ("recalibrated", "augmented") if n in evidence.events)):
        if len(values := evidence.events[name]["break_away_force"]):
            middle, low, high = band(values)
            marker = "s" if name == "data" else "_"
            axes.plot([0.0, 0.0], [low, high], color=COLOURS[name], linewidth=3.0, alpha=0.35)
            axes.plot([0.0], [middle], marker, color=COLOURS[name], markersize=5.0 if name == "data" else 12.0)


def _events(evidence: Evidence) -> Figure:
    figure, axes_list = new_figure(9.2, 2.9, columns=len(EVENT_LABELS))
    names = [name for name in ("data", "recalibrated", "augmented") if name in evidence.events]
    scatter = np.random.default_rng(0)
    for axes, (statistic, label) in zip(axes_list, EVENT_LABELS.items(), strict=True):
        for row, name in enumerate(reversed(names)):
            values = evidence.events[name][statistic] * (1.0e3 if statistic == "slip_travel" else 1.0)
            if not len(values):
                continue
            middle, low, high = band(values)
            heights = row + scatter.uniform(-0.22, 0.22, len(values))
            axes.plot(values, heights, ".", color=COLOURS[name], markersize=3.5, markeredgewidth=0.0, alpha=0.45)
            axes.plot([low, high], [row, row], color=COLOURS[name], linewidth=3.0, solid_capstyle="butt")
            axes.plot([middle] * 2, [row - 0.32, row + 0.32], color=COLOURS[name], linewidth=2.0)
        first = axes is axes_list[0]
        axes.set_yticks(range(len(names)), [LABELS[n].replace(" the ", "\nthe ") if first else "" for n in reversed(names)])
        axes.set(xlabel=label, ylim=(-0.5, len(names) - 0.5))
        axes.locator_params(axis="x", nbins=5)
    return figure


def _ranking(content: Mapping[str, Any]) -> Figure:
    screened = {entry["kind"] for entry in content["ranking"]}
    # effects of the stick phases, of the sensor and of the scatter are not screened in the slips: they stand first
    elsewhere = [
        {"kind": e["kind"], "score": e["evidence"]["score"]}
        for e in content["effects"]
        if e["kind"] not in screened and e["evidence"]["score"] is not None
    ]
    ranking: list[dict[str, Any]] = (elsewhere + content["ranking"])[:12]
    result = {e["kind"] for e in content["effects"]} | {k for e in content["effects"] for k in e["equivalent_to"]}
    known = set(effect_kinds())
    named = content["details"]["thresholds"]["named"]
    figure, (axes,) = new_figure(4.8, 3.9)
    for row, entry in enumerate(reversed(ranking)):
        kind = entry["kind"]
        colour = COLOURS["augmented"] if kind in result else COLOURS["believed"] if kind in known else "#e4c590"
        axes.barh(row, max(entry["score"], 0.0), color=colour)
    axes.set_yticks(range(len(ranking)), [str(e["kind"]).replace("_", " ") for e in reversed(ranking)], fontsize=8)
    top = max(*(float(e["score"]) for e in ranking), 2.0 * named)
    if top > 20.0 * named:
        axes.set_xscale("symlog", linthresh=named, linscale=0.5)
        axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlim(0.0, 1.15 * top)
    axes.axvline(named, color=COLOURS["data"], linewidth=1.0, linestyle="--")
    axes.text(named, len(ranking) - 0.35, " named from here", fontsize=8, color="#52606d")
    axes.set(xlabel="evidence [-]")
    axes.grid(visible=False, axis="y")
    return figure


OVER_NOISE = ("crps_slip_forces", "log_score_readings")
"""Metrics without a unit that are no percentages."""


def _gap(gap: Mapping[str, Any], *, added: bool) -> Figure:
    """Draw the errors on held-out runs; ``added``: whether the last model has more than the stated one."""
    names = ["baseline", "recalibrated", *(["augmented"] if added else [])]
    shown = {"m": (1.0e6, "µm"), "-": (100.0, "%")} if gap["metric"] not in OVER_NOISE else {}
    scale, unit = shown.get(gap["unit"], (1.0, gap["unit"]))
    figure, (axes,) = new_figure(4.8, 2.5)
    colours = {"baseline": COLOURS["believed"]} | COLOURS
    labels = {"baseline": LABELS["believed"]} | LABELS
    values = [scale * float(gap[n] or np.nan) for n in names]
    floor = scale * float(gap["floor"] or np.nan)
    for row, (name, value) in enumerate(zip(reversed(names), reversed(values), strict=True)):
        axes.barh(row, value, color=colours[name], height=0.6)
        axes.text(value, row, f" {value:.3g}", va="center", fontsize=9)
    finite = np.array([v for v in (*values, floor) if np.isfinite(v) and v > 0.0])
    if finite.max() > 8.0 * finite.min():
        axes.set_xscale("log")
        axes.set_xlim(0.5 * finite.min(), 3.0 * finite.max())
    else:
        axes.set_xlim(0.0, 1.2 * finite.max())
    axes.axvline(floor, color=COLOURS["floor"], linewidth=1.6, linestyle="--", label=LABELS["floor"])
    axes.set_yticks(range(len(names)), [labels[n].replace(" the ", "\nthe ") for n in reversed(names)])
    axes.set(xlabel=f"error on held-out runs [{unit}]")
    axes.grid(visible=False, axis="y")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper right")
    return figure


__all__ = ["COLOURS", "LABELS", "figures", "given"]
