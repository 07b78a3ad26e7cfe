"""The report of a comparison: its figures and its page."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# (matplotlib leaves keyword arguments untyped)

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import Any, cast

import numpy as np
import numpy.typing as npt
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from stochfric_mb.comparison import Comparison
from stochfric_mb.metrics import relative_velocity
from stochfric_mb.report.figures import colour, dots, legend, new_figure, svg
from stochfric_mb.report.page import plain, render, said
from stochfric_mb.storage import versions
from stochfric_mb.trajectory import Trajectory

LAST_SHARE = 0.15
"""Share of the run that the close-up shows [-]."""
FLOOR = 1.0e-16
"""Errors below this are drawn at it in the convergence plot, since a logarithm has no zero [m]."""

UNITS = {
    "mass": "kg", "damping": "N s/m", "stiffness": "N/m", "normal_force": "N", "belt_velocity": "m/s",
    "excitation_amplitude": "m", "excitation_angular_frequency": "rad/s", "initial_position": "m",
    "initial_velocity": "m/s", "mu_s": "-", "mu_k": "-", "sigma_s": "-", "sigma_k": "-", "duration": "s",
    "output_step": "s", "e_lim": "m", "zeta": "-", "v_s": "m/s", "v_d": "m/s", "decay_velocity": "m/s",
    "stribeck_velocity": "m/s", "sigma_0": "1/m", "sigma_1": "s/m", "sigma_2": "s/m", "correlation_time": "s",
}  # fmt: skip
"""Units of the scenario's keys, for the reader."""


def figures(comparison: Comparison) -> dict[str, str]:
    """Return the figures of a comparison as SVG: name -> content."""
    wanted = dict(_FIGURES)
    if any(engine.convergence for engine in comparison.engines):
        wanted["convergence"] = _convergence
    return {name: svg(functools.partial(draw, comparison)) for name, draw in wanted.items()}


def page(comparison: Comparison, drawn: Mapping[str, str], command: str) -> str:
    """Return the report as one HTML text that needs no other file.

    Args:
        comparison: the numbers.
        drawn: its figures, from `figures`.
        command: the command that made it.
    """
    packages = [e.name for e in comparison.engines if e.name in ("mujoco", "exudyn", "pymunk")]
    return render(
        "comparison.html",
        comparison=comparison,
        content=comparison.to_dict(),
        tables=_scenario_tables(comparison),
        drawn=drawn,
        captions=CAPTIONS,
        colour=colour,
        shown_value=_shown,
        steps=sorted({p.dt for e in comparison.engines for p in e.convergence}, reverse=True),
        command=command,
        versions=versions(*packages),
    )


CAPTIONS: dict[str, str] = {
    "position": "Position of the box: the whole run, and its last part. Engines are drawn over the reference.",
    "phase_portrait": "Phase portrait: velocity against position. On the dashed line the box moves with the belt.",
    "friction": "Friction force against relative velocity (belt minus box), as the engines applied it, sample by sample.",
    "error": "Absolute difference of position from the reference, at each output sample.",
    "convergence": "Position error against step. Grey lines: slopes of orders 1, 2 and 4.",
}
"""What each figure shows."""


def _scenario_tables(comparison: Comparison) -> list[tuple[str, list[tuple[str, Any, str]]]]:
    """Return the scenario's tables: title, and rows of key, value and unit."""
    spacing = {"spatial": "m"}.get(
        comparison.scenario.coefficient_process.kind if comparison.scenario.coefficient_process else "", "s"
    )
    tables: list[tuple[str, list[tuple[str, Any, str]]]] = []
    for name, table in comparison.scenario.to_dict().items():
        if isinstance(table, dict):
            table = cast(dict[str, Any], table)
            relative = name == "uncertainty"
            rows = [(k, v, "relative" if relative else _unit(k, v, spacing)) for k, v in table.items()]
            tables.append((name, rows))
    return tables


def _unit(key: str, value: Any, spacing: str) -> str:
    if not isinstance(value, int | float):
        return ""
    return spacing if key == "spacing" else UNITS.get(key, "")


def _shown(value: Any) -> Markup:
    """Return a value of the scenario with its numbers marked."""
    if isinstance(value, dict):
        parts = [Markup("{} = {}").format(k, _shown(v)) for k, v in cast(dict[str, Any], value).items()]
        return Markup(", ").join(parts)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return said(value)
    return plain(value)


def _runs(comparison: Comparison) -> list[tuple[str, Trajectory]]:
    """Return name and trajectory of the reference and of each engine."""
    return [("reference", comparison.reference), *((e.name, e.trajectory) for e in comparison.engines)]


def _line(axes: Axes, name: str, x: npt.NDArray[np.float64], y: npt.NDArray[np.float64], order: int) -> None:
    """Draw one run; the reference is a broad pale line under the others, whose dashes let each other through."""
    if name == "reference":
        axes.plot(x, y, color="#b8c0ca", linewidth=3.2, label=name, solid_capstyle="round")
        return
    axes.plot(x, y, color=colour(name), linewidth=1.2, label=name, linestyle=(4.0 * order, (4.0, 4.0)) if order else "-")


def _position(comparison: Comparison) -> Figure:
    figure, (whole, close) = new_figure(9.2, 3.3, columns=2)
    for order, (name, run) in enumerate(_runs(comparison), start=-1):
        _line(whole, name, run.time, 1.0e3 * run.position, order)
        last = run.time >= run.time[-1] * (1.0 - LAST_SHARE)
        _line(close, name, run.time[last], 1.0e3 * run.position[last], order)
    for axes, title in ((whole, "whole run"), (close, f"last {100.0 * LAST_SHARE:.0f} %")):
        axes.set(title=title, xlabel="time [s]", ylabel="position [mm]")
    legend(figure, whole)
    return figure


def _phase_portrait(comparison: Comparison) -> Figure:
    figure, (axes,) = new_figure(4.8, 3.9)
    for order, (name, run) in enumerate(_runs(comparison), start=-1):
        _line(axes, name, 1.0e3 * run.position, 1.0e3 * run.velocity, order)
    axes.axhline(1.0e3 * comparison.scenario.mechanism.belt_velocity, color="#52606d", linestyle="--", linewidth=0.8)
    axes.set(xlabel="position [mm]", ylabel="velocity [mm/s]")
    legend(figure, axes)
    return figure


def _friction(comparison: Comparison) -> Figure:
    figure, (axes,) = new_figure(4.8, 3.9)
    for name, run in _runs(comparison):
        v = 1.0e3 * relative_velocity(run, comparison.scenario.mechanism)
        big, kept = name == "reference", dots(v, run.friction_force)
        axes.plot(
            v[kept], run.friction_force[kept], ".", label=name, color="#b8c0ca" if big else colour(name),
            markersize=4.5 if big else 2.2, markeredgewidth=0.0,
        )  # fmt: skip
    axes.set(xlabel="relative velocity [mm/s]", ylabel="friction force [N]")
    legend(figure, axes)
    return figure


def _error(comparison: Comparison) -> Figure:
    figure, (axes,) = new_figure(9.2, 3.3)
    true = comparison.reference.position
    errors = {e.name: np.abs(e.trajectory.position - true) for e in comparison.engines}
    seen = [error[error > 0.0] for error in errors.values() if error.any()]
    if seen:
        axes.set_yscale("log")
        axes.set_ylim(0.3 * min(float(np.percentile(e, 2.0)) for e in seen), 3.0 * max(float(e.max()) for e in seen))
    for name, error in errors.items():
        shown = np.where(error > 0.0, error, np.nan) if seen else error
        axes.plot(comparison.reference.time, shown, color=colour(name), label=name, linewidth=0.9)
    axes.set(xlabel="time [s]", ylabel="abs(position - reference) [m]")
    legend(figure, axes)
    return figure


def _convergence(comparison: Comparison) -> Figure:
    figure, (axes,) = new_figure(4.8, 3.9)
    points = [p for engine in comparison.engines for p in engine.convergence]
    shown = [max(p.rms_position_error, FLOOR) for p in points]
    steps = sorted({p.dt for p in points})
    axes.set(xscale="log", yscale="log")
    axes.set(xlim=(0.8 * steps[0], 1.25 * steps[-1]), ylim=(0.5 * min(shown), 2.0 * max(shown)))
    _orders(axes)
    for engine in comparison.engines:
        errors = [max(p.rms_position_error, FLOOR) for p in engine.convergence]
        axes.plot(
            [p.dt for p in engine.convergence], errors, "o-", color=colour(engine.name), label=engine.name, markersize=4.5
        )
    axes.set_xticks(steps, [f"{step:.3g}" for step in steps])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set(xlabel="step [s]", ylabel="rms position error [m]")
    legend(figure, axes)
    return figure


def _orders(axes: Axes) -> None:
    """Draw lines of slope 1, 2 and 4 from the upper right corner down."""
    low, high = axes.get_xlim()
    bottom, top = axes.get_ylim()
    for order in (1, 2, 4):
        axes.plot([low, high], [top * (low / high) ** order, top], color="#cbd2d9", linewidth=0.9, zorder=0)
        at = max(low, high * (bottom / top) ** (1.0 / order))
        axes.text(at, top * (at / high) ** order, f" {order}", color="#9aa5b1", fontsize=8, va="bottom")


_FIGURES: dict[str, Callable[[Comparison], Figure]] = {
    "position": _position,
    "phase_portrait": _phase_portrait,
    "friction": _friction,
    "error": _error,
}
