"""Time stamps: that they grow, that nothing is missing, and a uniform grid where the clock jittered."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError

Array = npt.NDArray[np.float64]

UNIFORM = 0.01
"""Time stamps this close to a uniform grid are on it [sample intervals]: interpolation would change less than noise does."""
MOSTLY = 0.1
"""Share of rows in which what is named the time falls, from which on it is another column, or runs backwards [-]: a file that
was joined falls once; a position that swings falls in half of its rows, one in stick-slip in each slip."""
GAP = 4.0
"""Distance between two samples from which samples are missing, not late [median distances]."""
MIN_SAMPLES, MIN_PIECE = 30, 50
"""Fewest samples of a run that was recorded as such, and of a piece that is cut out of one: a slide one way says its friction
with 30, a piece of a longer motion with fewer than 50 holds neither a noise level nor one cycle."""
FROZEN = 0.2
"""Share of a run in which a channel that moves stays at one number, from which on it may be dead [-]."""


class GapError(InputError):
    """Samples are missing within a record; ``pieces`` are the first and last times between the gaps [s]."""

    def __init__(self, message: str, pieces: list[tuple[float, float]]) -> None:
        """Say what is missing, and what is there."""
        super().__init__(message)
        self.pieces = pieces


@dataclasses.dataclass(frozen=True)
class Places:
    """Where the samples of a record are in its file, for messages."""

    file: str
    """The file."""
    rows: npt.NDArray[np.int64]
    """Number of the line or sample, int64[n]."""
    word: str
    """What the number counts."""

    def at(self, sample: int) -> str:
        """Return the place of a sample, such as ``run.csv, line 12``."""
        return f"{self.file}, {self.word} {self.rows[sample]}"


def require_growing(time: Array, places: Places) -> None:
    """Return if the time stamps [s], float64[n], are finite and grow.

    Raises:
        InputError: they do not; names the line.
    """
    bad = np.flatnonzero(~np.isfinite(time))
    if bad.size:
        raise InputError(f"{places.at(bad[0])}: time is {time[bad[0]]}, a missing value; remove the row or correct it")
    steps = np.diff(time)
    bad = np.flatnonzero(steps <= 0.0)
    if not bad.size:
        return
    falls = int((steps < 0.0).sum())
    if falls > MOSTLY * len(time):
        raise InputError(
            f"{places.at(bad[0] + 1)}: the time falls in {falls} of {len(time)} rows: that is no time; were two "
            "columns swapped, or was the record turned round?"
        )
    i = int(bad[0])
    n = f" ({bad.size} such rows)" if bad.size > 1 else ""
    if steps[i] == 0.0:
        raise InputError(
            f"{places.at(i + 1)}: time stamp {time[i + 1]:g} s is there twice{n}; remove repeated samples, or write the time "
            "with more digits"
        )
    raise InputError(
        f"{places.at(i + 1)}: time falls from {time[i]:g} s to {time[i + 1]:g} s{n}; sort the rows, or cut the file there "
        "with time_range or into two files"
    )


def require_finite(name: str, values: Array, places: Places) -> None:
    """Return if a column, float64[n], has no missing value.

    Raises:
        InputError: it has; names the line.
    """
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        n = f" ({bad.size} such rows)" if bad.size > 1 else ""
        raise InputError(
            f"{places.at(int(bad[0]))}: {name} is missing or not finite{n}; remove or correct the row, or cut it away with "
            "time_range"
        )


def require_interval(time: Array, interval: float, places: Places) -> None:
    """Return if time stamps [s], float64[n], are ``interval`` [s] apart, as near as `uniform_grid` asks.

    Raises:
        InputError: they are not, or the interval is not positive.
    """
    if not interval > 0.0:
        raise InputError(f"{places.file}: sample_interval = {interval:g} s; give the positive distance between samples")
    away = np.abs(time - time[:1] - interval * np.arange(time.size)).max(initial=0.0)
    if away > max(UNIFORM * interval, _rounding(time, interval)):
        shown = float(np.median(np.diff(time)))
        raise InputError(
            f"{places.file}: sample_interval = {interval:.6g} s, but time stamps are {shown:.6g} s apart (median) and up to "
            f"{away:.3g} s off such a grid; give their distance, or interpolate onto a uniform time"
        )


@dataclasses.dataclass(frozen=True)
class Grid:
    """The uniform grid of a record."""

    time: Array
    """Time [s], float64[m]."""
    interval: float
    """Distance between samples [s]."""
    note: str
    """What was done about the clock; empty: nothing."""


def uniform_grid(time: Array, places: Places, *, max_gap: float | None = None) -> Grid:
    """Return the uniform grid that the time stamps are on, or onto which they are to be interpolated.

    Time stamps within `UNIFORM` intervals of a uniform grid, or within the digits in which they are written, are on it.
    Others are to be interpolated onto a grid with the median of their distances. Aliasing is none where the median is
    what the recorder aimed at.

    Args:
        time: growing time stamps [s], float64[n].
        places: where they are, for messages.
        max_gap: longest distance between samples [s] that is bridged; None: `GAP` median distances.

    Raises:
        InputError: too few samples; names the line.
        GapError: a gap, with the pieces of at least `MIN_PIECE` samples beside it.
    """
    if time.size < MIN_SAMPLES:
        raise InputError(
            f"{places.file}: {time.size} samples; at least {MIN_SAMPLES} are needed, record longer or widen time_range"
        )
    steps = np.diff(time)
    mean, median = float((time[-1] - time[0]) / (time.size - 1)), float(np.median(steps))
    exact = time[0] + mean * np.arange(time.size)
    away = float(np.max(np.abs(time - exact)))
    if away <= max(UNIFORM * mean, _rounding(time, mean)):
        return Grid(exact, mean, "")
    longest = int(np.argmax(steps))
    limit = (GAP * median if max_gap is None else max_gap) * (1.0 + 1.0e-9)  # time stamps are rounded
    if steps[longest] > limit:
        n = int(np.count_nonzero(steps > limit))
        ends = np.flatnonzero(steps > limit)
        firsts, lasts = [0, *(ends + 1)], [*ends, time.size - 1]
        pieces = [(float(time[i]), float(time[j])) for i, j in zip(firsts, lasts, strict=True) if j - i + 1 >= MIN_PIECE]
        raise GapError(
            f"{places.at(longest + 1)}: {steps[longest]:.4g} s without a sample, where {median:.4g} s is usual ({n} gaps "
            f"longer than {limit:.4g} s); cut the run there with time_range, or, where nothing moved meanwhile, allow "
            f"interpolation across with max_gap = {_rounded_up(float(steps[longest])):g}",
            pieces,
        )
    count = int(np.floor((time[-1] - time[0]) / median * (1.0 + 1.0e-12))) + 1
    note = (
        f"the clock jittered ({steps.min():.4g} to {steps.max():.4g} s between samples): interpolated linearly onto a "
        f"uniform grid of {median:.4g} s"
    )
    return Grid(time[0] + median * np.arange(count), median, note)


def _rounding(time: Array, interval: float) -> float:
    """Return how far rounding to the digits in the file can move a time stamp [s]; 0 if they are not rounded.

    Time stamps on a uniform grid that were rounded to d decimals differ from the grid through two of them by at most
    10^-d. With decimals coarser than half an interval the clock looks like jitter, and 0 is returned.
    """
    for decimals in range(10):
        unit = 10.0**-decimals
        if unit <= 0.5 * interval and np.all(np.abs(time / unit - np.round(time / unit)) < 1.0e-4):
            return unit
    return 0.0


def _rounded_up(value: float) -> float:
    """Return ``value`` to two digits, not below it."""
    unit = 10.0 ** (np.floor(np.log10(value)) - 1)
    return float(np.ceil(value / unit - 1.0e-9) * unit)


def longest_still(values: Array) -> tuple[int, int]:
    """Return the first and the last sample of the longest stretch in which values, float64[n], stay at one number."""
    edges = np.concatenate(([0], np.flatnonzero(np.diff(values)) + 1, [len(values)]))
    longest = int(np.argmax(np.diff(edges)))
    return int(edges[longest]), int(edges[longest + 1]) - 1
