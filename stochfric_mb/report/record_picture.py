"""The raw record of a run as inline SVG: what was measured, before anything is made of it, with stick and slip shaded."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from markupsafe import Markup, escape

from stochfric_mb.measurement.run import Run
from stochfric_mb.measurement.scales import slip_spans
from stochfric_mb.report.page import digits

Array = npt.NDArray[np.float64]

WIDTH, HEIGHT = 900.0, 190.0
"""Size of a picture [px of its own]; it scales with the page."""
LEFT, RIGHT, TOP, BOTTOM = 64.0, 20.0, 8.0, 30.0
"""Margins [px]."""
COLUMNS = 800
"""Columns in which a curve is drawn, each from its least to its largest value, so that no peak is lost."""
MOST_RUNS = 6
"""Runs that a page shows."""
SHOWN = ("position", "velocity", "force", "torque", "friction_force")
"""Channels of which the first that was measured is drawn."""


def record_pictures(runs: Sequence[Run]) -> list[tuple[str, Markup]]:
    """Return, for the first runs of a dataset, a caption and the picture of the raw record."""
    found: list[tuple[str, Markup]] = []
    for run in runs[:MOST_RUNS]:
        name = next((n for n in SHOWN if n in run.channels), None)
        if name is not None:
            spans = slip_spans(run.channels[name], run.sample_interval) if name == "position" else []
            use = "learned from" if run.role == "fit" else "held out"
            told = f"{run.name} ({use}): {name} as measured" + ("; shaded: slips" if spans else "")
            found.append((told, curve(run.time, run.channels[name], f"{name} [{run.units.get(name, '')}]", spans)))
    return found


def curve(time: Array, values: Array, label: str, spans: Sequence[tuple[int, int]] = ()) -> Markup:
    """Return a curve over time as SVG, with a shaded band for each span.

    Args:
        time: [s], shape (n,).
        values: what is drawn, shape (n,).
        label: of the upright axis.
        spans: first and last sample of each band.
    """
    low, high = float(np.min(values)), float(np.max(values))
    high = high if high > low else low + 1.0
    start, end = float(time[0]), float(time[-1])

    def x(t: Array | float) -> Array:
        return np.asarray(LEFT + (WIDTH - LEFT - RIGHT) * (np.asarray(t) - start) / (end - start))

    def y(v: Array | float) -> Array:
        return np.asarray(TOP + (HEIGHT - TOP - BOTTOM) * (high - np.asarray(v)) / (high - low))

    bands = "".join(
        f'<rect x="{x(time[i]):.1f}" y="{TOP:g}" width="{max(float(x(time[j]) - x(time[i])), 0.6):.1f}" '
        f'height="{HEIGHT - TOP - BOTTOM:g}"><title>slip from {digits(float(time[i]), 6)} to {digits(float(time[j]), 6)} s'
        "</title></rect>"
        for i, j in spans
    )
    t, v = _thinned(time, values)
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x(t), y(v), strict=True))
    ticks = "".join(
        f'<text x="{x(at):.1f}" y="{HEIGHT - BOTTOM + 14:g}" text-anchor="middle">{digits(at)}</text>'
        for at in _round(start, end)
    ) + "".join(
        f'<text x="{LEFT - 6:g}" y="{y(at) + 4:.1f}" text-anchor="end">{digits(at)}</text>'
        f'<line x1="{LEFT:g}" x2="{WIDTH - RIGHT:g}" y1="{y(at):.1f}" y2="{y(at):.1f}"/>'
        for at in _round(low, high, 3)
    )
    return Markup(
        f'<svg class="record" viewBox="0 0 {WIDTH:g} {HEIGHT:g}" role="img" aria-label="{escape(label)} over time">'
        f'<g class="slips">{bands}</g><g class="axis">{ticks}'
        f'<text x="{WIDTH - RIGHT:g}" y="{HEIGHT - 4:g}" text-anchor="end">time [s]</text>'
        f'<text x="{LEFT:g}" y="{HEIGHT - 4:g}">{escape(label)}</text></g><polyline points="{points}"/></svg>'
    )


def _thinned(time: Array, values: Array) -> tuple[Array, Array]:
    """Return the curve with the least and the largest value of each column, in the order of time."""
    if time.size <= 4 * COLUMNS:
        return time, values
    size = time.size // COLUMNS
    whole = values[: size * COLUMNS].reshape(COLUMNS, size)
    places = np.stack([whole.argmin(axis=1), whole.argmax(axis=1)], axis=1)
    places = (np.sort(places, axis=1) + size * np.arange(COLUMNS)[:, None]).ravel()
    return time[places], values[places]


def _round(low: float, high: float, count: int = 6) -> list[float]:
    """Return about ``count`` round numbers from ``low`` to ``high``."""
    rough = (high - low) / count
    unit = 10.0 ** math.floor(math.log10(rough))
    step = unit * next(m for m in (1.0, 2.0, 5.0, 10.0) if m * unit >= rough)
    first = math.ceil(low / step)
    return [i * step for i in range(first, math.floor(high / step) + 1)]
