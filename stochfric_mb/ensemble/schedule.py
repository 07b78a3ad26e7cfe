"""The common time grid of all samples: legs that end at knots of the coefficients and at output times."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError
from stochfric_mb.scenario import Scenario

Array = npt.NDArray[np.float64]

SAME_TIME = 1.0e-12
"""Times closer than this [s] are one time."""


class Schedule(NamedTuple):
    """Legs of time, one after the other from t = 0; arrays have shape (n_legs,) where nothing else is said."""

    start: Array
    """Start of a leg [s]."""
    length: Array
    """Length of a leg [s]."""
    kind: npt.NDArray[np.int64]
    """Number of the leg's length among ``lengths``."""
    lengths: Array
    """The distinct lengths [s], shape (n_kinds,)."""
    knot: npt.NDArray[np.int64]
    """Knot at or before the leg."""
    from_knot: Array
    """Part of the way to the next knot at the start of the leg, 0 .. 1."""
    to_knot: Array
    """The same at its end."""
    output: npt.NDArray[np.int64]
    """Number of the output time at the leg's end, -1 for none."""
    output_at_start: bool
    """Whether the first output time is t = 0."""


def schedule(scenario: Scenario, output_times: Array, *, longest: float = math.inf) -> Schedule:
    """Return the legs from t = 0 to the last output time.

    Args:
        scenario: what is simulated; its coefficients are constant or run along time.
        output_times: increasing times [s], shape (n_outputs,).
        longest: longest leg [s]; longer ones are cut into equal parts.
    """
    end = float(output_times[-1])
    spacing = math.inf if scenario.coefficient_process is None else scenario.coefficient_process.knot_spacing
    n_knots = 0 if scenario.coefficient_process is None else math.floor((end + SAME_TIME) / spacing)
    knots: Array = np.arange(1, n_knots + 1, dtype=np.float64) * spacing
    ends = _merged(np.concatenate([knots, output_times[output_times > SAME_TIME]]))
    ends = _refined(ends, longest)
    starts = np.concatenate([[0.0], ends[:-1]])
    _, kind = np.unique(np.round(ends - starts, 14), return_inverse=True)
    lengths: Array = np.bincount(kind, weights=ends - starts) / np.bincount(kind)  # means: roundings do not add up
    index = np.searchsorted(output_times, ends - SAME_TIME)
    is_output = np.abs(output_times[np.minimum(index, len(output_times) - 1)] - ends) <= SAME_TIME
    knot = np.zeros(len(ends), dtype=np.int64)
    parts = np.zeros((2, len(ends)))
    if scenario.coefficient_process is not None:
        knot = np.floor(0.5 * (starts + ends) / spacing).astype(np.int64)
        parts = np.clip(np.stack([starts, ends]) / spacing - knot, 0.0, 1.0)
        parts[np.abs(parts - np.round(parts)) < SAME_TIME] = np.round(parts[np.abs(parts - np.round(parts)) < SAME_TIME])
    return Schedule(
        start=starts,
        length=lengths[kind],
        kind=kind.astype(np.int64),
        lengths=lengths,
        knot=knot,
        from_knot=parts[0],
        to_knot=parts[1],
        output=np.where(is_output, index, -1).astype(np.int64),
        output_at_start=bool(output_times[0] <= SAME_TIME),
    )


def checked_times(scenario: Scenario, output_times: npt.ArrayLike | None) -> Array:
    """Return the output times [s] as an array, the scenario's own if None.

    Raises:
        InputError: times that are not increasing, not finite or not within 0 .. duration.
    """
    if output_times is None:
        return scenario.output_times()
    times = np.atleast_1d(np.asarray(output_times, dtype=np.float64))
    if times.ndim != 1 or times.size == 0 or not np.all(np.isfinite(times)):
        raise InputError(f"output_times of shape {times.shape} must be one row of finite times [s]; give at least one")
    if np.any(np.diff(times) <= SAME_TIME):
        i = int(np.argmax(np.diff(times) <= SAME_TIME))
        raise InputError(f"output_times must increase, but {times[i]:g} s is followed by {times[i + 1]:g} s; sort them")
    if times[-1] <= SAME_TIME:
        raise InputError("output_times end at 0 s, where nothing has happened yet; give a time beyond it")
    if times[0] < 0.0 or times[-1] > scenario.duration + SAME_TIME:
        raise InputError(
            f"output_times run from {times[0]:g} s to {times[-1]:g} s; they must be within 0 .. "
            f"duration = {scenario.duration:g} s; set simulation.duration"
        )
    return times


def _merged(times: Array) -> Array:
    """Return the times sorted, those that are the same once (the first of them)."""
    times = np.sort(times)
    return times[np.concatenate([[True], np.diff(times) > SAME_TIME])]


def _refined(ends: Array, longest: float) -> Array:
    starts = np.concatenate([[0.0], ends[:-1]])
    parts = np.maximum(np.ceil((ends - starts) / longest - 1.0e-9), 1.0).astype(np.int64)
    within = np.arange(1, parts.sum() + 1) - np.repeat(np.cumsum(parts) - parts, parts)
    return np.repeat(starts, parts) + np.repeat((ends - starts) / parts, parts) * within
