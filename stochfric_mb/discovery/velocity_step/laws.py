"""Laws that are fitted to velocity steps: constant friction, drift with displacement, dependence on speed, memory."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.velocity_step.rate_and_state import friction_path
from stochfric_mb.effects import kind_found_as
from stochfric_mb.effects.traits import MEMORY, RATE, SLOPE_IN_DISTANCE
from stochfric_mb.measurement.run import Run

Array = npt.NDArray[np.float64]

MEMORY_STARTS = [(b, d, k) for b in (0.01, -0.01) for d in (1.0, 10.0, 100.0) for k in (0.3, 3.0)]
"""Starts of the memory law: evolution effect b, distance D, and stiffness, the last two over the believed ones."""


@dataclasses.dataclass(frozen=True)
class Track:
    """One run: friction and the speed of the load point, or the piece of them between two changes of sampling rate."""

    run: Run
    """The run."""
    friction: Array
    """Friction coefficient [-], shape (n,)."""
    speed: Array
    """Speed of the load point [m/s], shape (n,)."""
    slid: Array
    """Displacement of the load point since the first run began [m], shape (n,)."""


@dataclasses.dataclass(frozen=True)
class Law:
    """A friction law that is fitted."""

    kind: str
    """Effect that it stands for; empty: constant friction."""
    names: tuple[str, ...]
    """Its numbers."""
    units: tuple[str, ...]
    """Their units."""
    starts: tuple[tuple[float, ...], ...]
    """Where fits begin."""
    scales: tuple[float, ...]
    """Natural steps."""
    low: tuple[float, ...]
    """Smallest values."""
    predict: Callable[[Sequence[Track], Array], list[Array]]
    """Tracks and numbers -> friction coefficients."""


def laws(reference: float, stiffness: float, believed: float) -> list[Law]:
    """Return what is fitted: constant friction, drift with displacement, dependence on speed, and memory.

    Args:
        reference: speed v_0 at which mu_0 holds [m/s].
        stiffness: believed stiffness [1/m].
        believed: believed friction coefficient [-].
    """

    def constant(tracks: Sequence[Track], p: Array) -> list[Array]:
        return [p[0] + 0.0 * t.speed for t in tracks]

    def drift(tracks: Sequence[Track], p: Array) -> list[Array]:
        return [p[0] + p[1] * t.slid for t in tracks]

    def speed(tracks: Sequence[Track], p: Array) -> list[Array]:
        return [p[0] + p[1] * t.slid + p[2] * np.log(t.speed / reference) for t in tracks]

    def memory(tracks: Sequence[Track], p: Array) -> list[Array]:
        return [p[0] + p[1] * t.slid + m for t, m in zip(tracks, _remembered(tracks, p[2:], reference), strict=True)]

    return [
        Law("", ("mu_0",), ("-",), ((believed,),), (0.01,), (0.0,), constant),
        Law(
            kind_found_as(SLOPE_IN_DISTANCE), ("mu_0", "slope"), ("-", "1/m"), ((believed, 0.0),),
            (0.01, 1.0), (0.0, -np.inf), drift,
        ),
        Law(
            kind_found_as(RATE), ("mu_0", "slope", "a_minus_b"), ("-", "1/m", "-"), ((believed, 0.0, 0.0),),
            (0.01, 1.0, 0.001), (0.0, -np.inf, -np.inf), speed,
        ),
        Law(
            kind_found_as(MEMORY), ("mu_0", "slope", "direct_effect", "evolution_effect", "log_distance", "log_stiffness"),
            ("-", "1/m", "-", "-", "-", "-"),
            tuple(memory_start(believed, stiffness, *start) for start in MEMORY_STARTS),
            (0.01, 1.0, 0.002, 0.002, 0.3, 0.3), (0.0, -np.inf, 1.0e-4, -np.inf, -np.inf, -np.inf), memory,
        ),
    ]  # fmt: skip


def memory_start(believed: float, stiffness: float, evolution: float, distance: float, stiffer: float) -> tuple[float, ...]:
    """Return a start of the memory law: its numbers in the order of `laws`."""
    length = 1.0e-3 / stiffness
    return (believed, 0.0, 0.01, evolution, float(np.log(distance * length)), float(np.log(stiffer * stiffness)))


def _remembered(tracks: Sequence[Track], p: Array, reference: float) -> list[Array]:
    """Return what the memory law adds to mu_0, marched through all tracks one after the other on one fine grid."""
    step = min(t.run.sample_interval for t in tracks)
    start, end = float(tracks[0].run.time[0]), max(float(t.run.time[-1]) for t in tracks)
    grid = np.arange(start, end + step, step)
    times = np.concatenate([t.run.time for t in tracks])
    speed = np.exp(np.interp(grid, times, np.log(np.concatenate([t.speed for t in tracks]))))
    mu = np.empty(len(grid))
    distance, stiffness = float(np.exp(np.clip(p[2], -40.0, 10.0))), float(np.exp(np.clip(p[3], -10.0, 40.0)))
    friction_path(speed, step, float(p[0]), float(p[1]), distance, stiffness, reference, mu)
    return [np.interp(t.run.time, grid, mu) for t in tracks]
