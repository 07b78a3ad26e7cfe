"""What is kept of an ensemble when trajectories are not: moments and histograms at each output time.

Both are filled sample by sample in the order of the samples, so that block size and threads change no bit. A histogram
starts with bins far below any scale of interest and doubles their width whenever its values outgrow them; the bins'
edges are whole multiples of their width. What is in it therefore depends on the set of values alone: histograms of
parts merge to exactly the histogram of the whole.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import numpy.typing as npt

from stochfric_mb.compile import compiled
from stochfric_mb.errors import InputError, SimulationError

Array = npt.NDArray[np.float64]

FINEST = -44
"""Exponent of the first bin width, 2^-44 = 5.7e-14 (m or m/s)."""
BINS = 2048
"""Bins of a histogram, unless stated otherwise."""


@dataclasses.dataclass
class Sketch:
    """Mean, standard deviation, quantiles and histogram of one quantity at n_times times, without its samples."""

    counts: npt.NDArray[np.uint32]
    """Samples in each bin, shape (n_times, n_bins); the bins in use start at 0."""
    low: npt.NDArray[np.int64]
    """Lower edge of the first bin, in bin widths, shape (n_times,)."""
    exponent: npt.NDArray[np.int64]
    """Bin width = 2^exponent, shape (n_times,)."""
    moments: Array
    """Shift, sum and sum of squares of (value - shift), smallest and largest value, shape (5, n_times)."""
    n: int = 0
    """Samples so far."""

    @classmethod
    def empty(cls, n_times: int, bins: int = BINS) -> Sketch:
        """Return a sketch without samples.

        Args:
            n_times: number of output times.
            bins: bins of each histogram, an even number >= 4; a quantile is off by at most 2 (max - min)/(bins - 2).
        """
        if bins < 4 or bins % 2 or int(bins) != bins:
            raise InputError(f"bins = {bins} must be an even whole number of at least 4; try {BINS}")
        moments = np.zeros((5, n_times))
        moments[3], moments[4] = math.inf, -math.inf
        return cls(
            np.zeros((n_times, bins), dtype=np.uint32),
            np.zeros(n_times, dtype=np.int64),
            np.full(n_times, FINEST, dtype=np.int64),
            moments,
        )

    @staticmethod
    def nbytes(n_times: int, bins: int = BINS) -> int:
        """Return the memory of a sketch [bytes]."""
        return n_times * (4 * bins + 7 * 8)

    def add(self, values: Array) -> None:
        """Add samples, shape (n, n_times).

        Raises:
            SimulationError: a value is not finite.
        """
        if self.n == 0 and len(values):
            self.moments[0] = values[0]
        if (bad := _add(values, self.counts, self.low, self.exponent, self.moments)) >= 0:
            raise SimulationError(f"sample {self.n + bad} of the ensemble is not finite; take a smaller dt")
        self.n += len(values)

    def merge(self, other: Sketch) -> None:
        """Add the samples of another sketch: counts exactly, moments to rounding."""
        if other.counts.shape != self.counts.shape:
            raise InputError(f"sketches of shapes {self.counts.shape} and {other.counts.shape} cannot be merged")
        if other.n == 0:
            return
        if self.n == 0:
            self.moments[0] = other.moments[0]
        _merge(self.counts, self.low, self.exponent, other.counts, other.low, other.exponent)
        gap = other.moments[0] - self.moments[0]
        self.moments[2] += other.moments[2] + 2.0 * gap * other.moments[1] + other.n * gap**2
        self.moments[1] += other.moments[1] + other.n * gap
        self.moments[3] = np.minimum(self.moments[3], other.moments[3])
        self.moments[4] = np.maximum(self.moments[4], other.moments[4])
        self.n += other.n

    @property
    def mean(self) -> Array:
        """Mean at each time, shape (n_times,)."""
        return self.moments[0] + self.moments[1] / self.n

    @property
    def std(self) -> Array:
        """Standard deviation (of the sample, n - 1) at each time, shape (n_times,)."""
        if self.n < 2:
            return np.full(len(self.low), np.nan)
        squares: Array = self.moments[2] - self.moments[1] ** 2 / self.n
        return np.sqrt(np.maximum(squares, 0.0) / (self.n - 1)).astype(np.float64)

    @property
    def quantile_error(self) -> Array:
        """Bin width at each time: no quantile is off by more, shape (n_times,)."""
        return np.array([math.ldexp(1.0, int(e)) for e in self.exponent])

    def quantiles(self, levels: npt.ArrayLike) -> Array:
        """Return the quantiles at the given levels (linear between order statistics), shape (n_levels, n_times)."""
        levels = checked_levels(levels)
        return np.array([[self._quantile(i, float(q)) for i in range(len(self.low))] for q in levels])

    def histogram(self, i: int) -> tuple[npt.NDArray[np.int64], Array]:
        """Return the counts and the bin edges (one more) at output time number ``i``, empty ends left out."""
        used = np.flatnonzero(self.counts[i])
        first, last = (int(used[0]), int(used[-1])) if used.size else (0, 0)
        width = math.ldexp(1.0, int(self.exponent[i]))
        edges = (self.low[i] + np.arange(first, last + 2)) * width
        return self.counts[i, first : last + 1].astype(np.int64), edges

    def _quantile(self, i: int, level: float) -> float:
        rank = level * (self.n - 1)
        cumulated = np.cumsum(self.counts[i], dtype=np.int64)
        below = self._order_statistic(i, cumulated, math.floor(rank))
        above = self._order_statistic(i, cumulated, math.ceil(rank))
        value = below + (rank - math.floor(rank)) * (above - below)
        return float(min(max(value, self.moments[3, i]), self.moments[4, i]))

    def _order_statistic(self, i: int, cumulated: npt.NDArray[np.int64], rank: int) -> float:
        """Return the value of the given rank (0 .. n - 1), the samples of a bin evenly spread over it."""
        b = int(np.searchsorted(cumulated, rank, side="right"))
        count = int(self.counts[i, b])
        part = (rank - (int(cumulated[b]) - count) + 0.5) / count
        return math.ldexp(float(self.low[i] + b) + part, int(self.exponent[i]))


def checked_levels(levels: npt.ArrayLike) -> Array:
    """Return quantile levels as an array.

    Raises:
        InputError: a level outside 0 .. 1.
    """
    levels = np.atleast_1d(np.asarray(levels, dtype=np.float64))
    if not np.all((levels >= 0.0) & (levels <= 1.0)):
        raise InputError(f"quantile levels {levels.tolist()} must lie in 0 .. 1; 0.5 is the median")
    return levels


@compiled
def _add(values, counts, low, exponent, moments):
    """Add samples in order; return -1, or the number of the first one that is not finite."""
    for j in range(values.shape[0]):
        for i in range(values.shape[1]):
            value = values[j, i]
            if not abs(value) < 1.0e300:
                return j
            d = value - moments[0, i]
            moments[1, i] += d
            moments[2, i] += d * d
            moments[3, i] = min(moments[3, i], value)
            moments[4, i] = max(moments[4, i], value)
            _count(value, counts[i], low, exponent, i, moments[3, i], moments[4, i])
    return -1


@compiled
def _count(value, counts, low, exponent, i, smallest, largest):
    """Count a value in the histogram at time i, whose values so far, this one included, run from smallest to largest."""
    bins = len(counts)
    while not _fits(smallest, largest, exponent[i], bins):
        _coarsen(counts, low, exponent, i)
    b = math.floor(math.ldexp(value, -exponent[i]))
    if b < low[i] or b >= low[i] + bins or (smallest == largest):
        _shift(counts, low, i, np.int64(math.floor(math.ldexp(smallest, -exponent[i]))))
    counts[int(b) - low[i]] += 1


@compiled
def _fits(smallest, largest, exponent, bins):
    """Return whether values from smallest to largest lie in ``bins`` bins of width 2^exponent, with exact edges."""
    first = math.floor(math.ldexp(smallest, -exponent))
    last = math.floor(math.ldexp(largest, -exponent))
    return last - first < bins and max(abs(first), abs(last)) < 2.0**52


@compiled
def _coarsen(counts, low, exponent, i):
    """Double the width of the bins."""
    odd = low[i] % 2
    for b in range(len(counts)):
        moved = (b + odd) // 2
        count = counts[b]
        counts[b] = 0
        counts[moved] += count
    low[i] = (low[i] - odd) // 2
    exponent[i] += 1


@compiled
def _shift(counts, low, i, new):
    """Make ``new`` the first bin; what is counted lies at or above it."""
    by = low[i] - new
    low[i] = new
    bins = len(counts)
    if by > 0:
        for b in range(bins - 1, -1, -1):
            counts[b] = counts[b - by] if b >= by else 0
    elif by < 0:
        for b in range(bins):
            counts[b] = counts[b - by] if b - by < bins else 0


@compiled
def _merge(counts, low, exponent, other_counts, other_low, other_exponent):
    """Add the counts of other histograms."""
    bins = counts.shape[1]
    for i in range(len(low)):
        extra = other_counts[i].copy()
        other_l, other_e = other_low[i : i + 1].copy(), other_exponent[i : i + 1].copy()
        while other_e[0] < exponent[i]:
            _coarsen(extra, other_l, other_e, 0)
        while exponent[i] < other_e[0]:
            _coarsen(counts[i], low, exponent, i)
        while True:
            first, last = _span(counts[i], low[i])
            other_first, other_last = _span(extra, other_l[0])
            if last < first:
                first, last = other_first, other_last
            lowest, highest = min(first, other_first), max(last, other_last)
            if highest - lowest < bins:
                break
            _coarsen(counts[i], low, exponent, i)
            _coarsen(extra, other_l, other_e, 0)
        _shift(counts[i], low, i, lowest)
        for b in range(bins):
            if extra[b] > 0:
                counts[i, b + other_l[0] - lowest] += extra[b]


@compiled
def _span(counts, low):
    """Return the numbers of the first and the last bin in use (the last below the first if none is)."""
    first, last = 0, -1
    for b in range(len(counts)):
        if counts[b] > 0:
            if last < 0:
                first = b
            last = b
    return low + first, low + last
