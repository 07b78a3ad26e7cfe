"""The look of all figures: one style, one colour an engine, SVG out (PNG for the README)."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# (matplotlib leaves keyword arguments untyped)

from __future__ import annotations

import io
import json
import re
from collections.abc import Callable
from typing import Any
from xml.sax.saxutils import quoteattr

import matplotlib
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

COLOURS = {"reference": "#1f2933", "mujoco": "#0072b2", "exudyn": "#d55e00", "pymunk": "#009e73"}
"""Colour of an engine (Okabe and Ito's, which the colour-blind distinguish as well)."""
OTHER = "#cc79a7"
"""Colour of an engine that is not in `COLOURS`."""

STYLE: dict[str, Any] = {
    "font.family": "sans-serif",
    "font.size": 9.5,
    "axes.formatter.useoffset": False,  # a number that is added to all others beside the axis is overlooked
    "axes.titlesize": 10.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelcolor": "#52606d",
    "axes.edgecolor": "#9aa5b1",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e7eb",
    "grid.linewidth": 0.7,
    "xtick.color": "#52606d",
    "ytick.color": "#52606d",
    "lines.linewidth": 1.3,
    "legend.frameon": False,
    "savefig.dpi": 160,
    "svg.fonttype": "none",
    "svg.hashsalt": "stochfric_mb",
}
POINTS = 72.0
"""Points in an inch: the unit of SVG."""
CELLS = (600, 400)
"""Dots of a cloud are kept one a cell of so many columns and rows: more could not be distinguished."""


def new_figure(width: float, height: float, columns: int = 1) -> tuple[Figure, list[Axes]]:
    """Return a figure [inch] and its axes, side by side."""
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, list(figure.subplots(1, columns, squeeze=False)[0])


def png(draw: Callable[[], Figure]) -> bytes:
    """Return the figure that ``draw`` returns as PNG, drawn in the common style."""
    buffer = io.BytesIO()
    styled: Any = matplotlib.rc_context
    with styled(STYLE):
        draw().savefig(buffer, format="png", metadata={"Software": None})
    return buffer.getvalue()


def svg(draw: Callable[[], Figure]) -> str:
    """Return the figure that ``draw`` returns as SVG, drawn in the common style.

    The root's ``data-axes`` says how points of the drawing are turned into values, for `templates/plots.js`.
    """
    buffer = io.StringIO()
    styled: Any = matplotlib.rc_context
    with styled(STYLE):
        figure = draw()
        named = _name_series(figure)
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
        facts = [_axes_facts(figure, axes) | {"series": names} for axes, names in zip(figure.axes, named, strict=True)]
    text = buffer.getvalue()
    text = text[text.index("<svg ") :]
    text = re.sub(r"font-family: [^;\"]*", "font-family: sans-serif", text)
    text = re.sub(r'"[^"]*\d\.\d{3}[^"]*"', _rounded, text)
    text = re.sub(r' id="axes_(\d+)"', r' class="axes" data-number="\1"', text)
    text = re.sub(r' id="matplotlib\.axis_\d+"', ' class="axis"', text)
    text = re.sub(r' id="series_(\d+)"', r' data-series="\1"', text)
    text = re.sub(r'<g id="[^"]*"', "<g", text)
    return text.replace("<svg ", f"<svg data-axes={quoteattr(json.dumps(facts))} ", 1)


def _rounded(attribute: re.Match[str]) -> str:
    """Return an attribute with its coordinates rounded to hundredths of a point; labels are no attributes."""
    return re.sub(r"\d+\.\d{3,}", lambda number: f"{float(number[0]):.2f}", attribute[0])


def _name_series(figure: Figure) -> list[list[str]]:
    """Give the curves of a figure numbers that stand in the SVG; return their labels, axes by axes ("" for one without)."""
    named: list[list[str]] = []
    for axes in figure.axes:
        names: list[str] = []
        for line in axes.get_lines():
            line.set_gid(f"series_{len(names)}")
            label = str(line.get_label())
            names.append("" if label.startswith("_") else label)
        named.append(names)
    return named


def _axes_facts(figure: Figure, axes: Axes) -> dict[str, Any]:
    """Return where axes lie in the SVG [pt], and what values their edges have."""
    width, height = (POINTS * float(size) for size in figure.get_size_inches())
    place = axes.get_position()
    return {
        "box": [round(width * place.x0, 3), round(height * (1.0 - place.y1), 3), round(width * place.x1, 3),
                round(height * (1.0 - place.y0), 3)],
        "x": [float(v) for v in axes.get_xlim()], "y": [float(v) for v in axes.get_ylim()],
        "scales": [axes.get_xscale(), axes.get_yscale()], "labels": [axes.get_xlabel(), axes.get_ylabel()],
        "numbers": [_has_numbers(axis) for axis in (axes.xaxis, axes.yaxis)],
    }  # fmt: skip


def _has_numbers(axis: Any) -> bool:
    """Return whether an axis is one of numbers, not of names or without ticks."""
    labels = [label.get_text().replace("−", "-") for label in axis.get_ticklabels()]
    return any(re.fullmatch(r"[-+.\de$\\{}^a-z]*\d[-+.\de$\\{}^a-z]*", label) for label in labels)


def dots(x: npt.NDArray[np.float64], y: npt.NDArray[np.float64]) -> npt.NDArray[np.int64]:
    """Return which points of a cloud are worth drawing: the first of each of `CELLS`."""
    cells = np.zeros((2, len(x)), dtype=np.int64)
    for row, values, count in zip(cells, (x, y), CELLS, strict=True):
        low, high = float(np.min(values)), float(np.max(values))
        row[:] = (values - low) / ((high - low) or 1.0) * (count - 1)
    return np.sort(np.unique(cells[0] * CELLS[1] + cells[1], return_index=True)[1])


def colour(engine: str) -> str:
    """Return the colour of an engine."""
    return COLOURS.get(engine, OTHER)


def legend(figure: Figure, axes: Axes) -> None:
    """Put the legend of ``axes`` above the figure, in one row."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=4, markerscale=2.2, handlelength=1.8, columnspacing=1.4)
