"""The look of all figures: one style, one colour an engine, PNG out."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# (matplotlib leaves keyword arguments untyped)

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

COLOURS = {"reference": "#1f2933", "mujoco": "#0072b2", "exudyn": "#d55e00", "pymunk": "#009e73"}
"""Colour of an engine (Okabe and Ito's, told apart by the colour-blind as well)."""
OTHER = "#cc79a7"
"""Colour of an engine that is not in `COLOURS`."""

STYLE: dict[str, Any] = {
    "font.family": "sans-serif",
    "font.size": 9.5,
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
}


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


def colour(engine: str) -> str:
    """Return the colour of an engine."""
    return COLOURS.get(engine, OTHER)


def legend(figure: Figure, axes: Axes) -> None:
    """Put the legend of ``axes`` above the figure, in one row."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=4, markerscale=2.2, handlelength=1.8, columnspacing=1.4)
