"""The raw record of a run: what was measured, before anything is inferred from it, with stick and slip shaded."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# (matplotlib leaves keyword arguments untyped)

from __future__ import annotations

import functools
import itertools
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.scales import slip_spans
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.report.figures import legend, new_figure, svg

Array = npt.NDArray[np.float64]

COLUMNS = 800
"""Columns in which a curve is drawn, each from its least to its largest value, so that no peak is lost."""
MOST_RUNS = 6
"""Runs that a page shows."""
SHOWN = ("position", "velocity", "force", "torque", "friction_force")
"""Channels of which the first that was measured is drawn."""
MANY_SLIPS, CLOSE_UP = 40, 6
"""Slips of a run beyond which shading says little, and slips from its middle that are drawn beside it then."""
SAME_SPEED = 0.1
"""Difference from the usual speed in stick up to which a record's beginning or end is stick as well [-]."""
STICK, SLIP = "#56b4e9", "#d55e00"
"""Colours of the phases (Okabe and Ito's)."""


def record_pictures(data: Dataset) -> list[tuple[str, str]]:
    """Return, for the first runs of a dataset, a caption and the picture of the raw record as SVG."""
    drawn: list[tuple[str, str]] = []
    sticks = isinstance(data.scenario.mechanism, BeltBox)
    for run in data.runs[:MOST_RUNS]:
        name = next((n for n in SHOWN if n in run.channels), None)
        if name is not None:
            slips = slip_spans(run.channels[name], run.sample_interval) if name == "position" and sticks else []
            use = "used to fit" if run.role == "fit" else "held out"
            caption = f"{run.name} ({use}): {name} as measured" + ("; stick and slip shaded" if slips else "")
            caption += f", {CLOSE_UP} of {len(slips)} slips beside it" if len(slips) > MANY_SLIPS else ""
            unit = f" [{run.units[name]}]" if run.units.get(name) else ""
            drawn.append((caption, record(run.time, run.channels[name], name + unit, slips)))
    return drawn


def record(time: Array, values: Array, label: str, slips: Sequence[tuple[int, int]] = ()) -> str:
    """Return a measured curve over time as SVG, with stick and slip shaded where slips were detected; of many, some closely.

    Args:
        time: [s], shape (n,).
        values: what is drawn, shape (n,).
        label: of the upright axis.
        slips: first and last sample of each slip.
    """
    return svg(functools.partial(_draw, time, values, label, slips))


def _draw(time: Array, values: Array, label: str, slips: Sequence[tuple[int, int]]) -> Figure:
    parts = [slice(0, len(time))]
    if len(slips) > MANY_SLIPS:
        first = (len(slips) - CLOSE_UP) // 2
        parts.append(slice(slips[first - 1][1], slips[first + CLOSE_UP][0]))
    figure, panels = new_figure(9.2, 2.6, len(parts))
    spans = _sticks(time, values, slips)
    for axes, part in zip(panels, parts, strict=True):
        _shade(axes, time, spans, slips)
        shown = _thinned(time[part], values[part])
        axes.plot(*shown, color="#1f2933", linewidth=0.9, label=label.partition(" [")[0] if slips else None)
        axes.set(xlabel="time [s]", xlim=(float(shown[0][0]), float(shown[0][-1])))
        axes.grid(visible=False, axis="x")
    panels[0].set_ylabel(label)
    if slips:
        legend(figure, panels[0])
    return figure


def _shade(axes: Axes, time: Array, sticks: Sequence[tuple[int, int]], slips: Sequence[tuple[int, int]]) -> None:
    """Shade what lies between slips as stick, the slips as slip."""
    across = axes.get_xaxis_transform()
    for spans, colour, word in ((sticks, STICK, "stick"), (slips, SLIP, "slip")):
        bars = [(float(time[i]), float(time[j] - time[i])) for i, j in spans]
        if not bars:
            continue
        axes.broken_barh(bars, (0.0, 1.0), transform=across, facecolor=colour, alpha=0.22, linewidth=0.0, label=word)


def _sticks(time: Array, values: Array, slips: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return both ends of each stick phase: between slips, and before and after them where the box moves as it does there."""
    between = [(before[1], after[0]) for before, after in itertools.pairwise(slips)]
    if not between:
        return []
    usual = float(np.median([(values[j] - values[i]) / (time[j] - time[i]) for i, j in between]))
    ends = [(0, slips[0][0]), (slips[-1][1], len(time) - 1)]
    return between + [
        (i, j)
        for i, j in ends
        if i < j and abs(np.polyfit(time[i : j + 1], values[i : j + 1], 1)[0] - usual) < SAME_SPEED * abs(usual)
    ]


def _thinned(time: Array, values: Array) -> tuple[Array, Array]:
    """Return the curve with the least and the largest value of each column, in the order of time."""
    if time.size <= 4 * COLUMNS:
        return time, values
    edges = np.linspace(0, time.size, COLUMNS + 1).astype(np.intp)
    spans = itertools.pairwise(edges)
    places = np.ravel([sorted((a + values[a:b].argmin(), a + values[a:b].argmax())) for a, b in spans])
    return time[places], values[places]
