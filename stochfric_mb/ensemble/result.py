"""What an ensemble returns: its runs, or statistics of them."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from stochfric_mb.ensemble.lanes import BREAK_AWAYS, FIRST, LAST, MU_S_SUM, STICK_TIME, TALLIES
from stochfric_mb.ensemble.sketch import Array, Sketch, checked_levels
from stochfric_mb.errors import InputError, require_name


class Block(NamedTuple):
    """Some runs: what a kernel, an engine or a worker returns."""

    position: Array
    """Position [m], shape (n, n_times)."""
    velocity: Array
    """Velocity [m/s], shape (n, n_times)."""
    stick: npt.NDArray[np.bool_]
    """Whether the contact sticks, shape (n, n_times)."""
    tallies: Array
    """Break-aways, times of the first and the last [s], sum of mu_s at them, time stuck [s], shape (n, 5)."""


def empty_block(n: int, n_times: int) -> Block:
    """Return room for n runs at ``n_times`` times, to be filled."""
    shape = (n, n_times)
    return Block(np.empty(shape), np.empty(shape), np.empty(shape, dtype=np.bool_), np.empty((n, TALLIES)))


@dataclasses.dataclass(frozen=True, kw_only=True)
class EnsembleResult:
    """Runs of an ensemble, or (``statistics_only``) statistics of them, at n_times output times."""

    time: Array
    """Output times [s], shape (n_times,)."""
    tallies: Array
    """Events of each run, shape (n_runs, 5); the properties below give them by name."""
    position: Array | None = None
    """Position [m], shape (n_runs, n_times); None if only statistics were kept, likewise the next two."""
    velocity: Array | None = None
    """Velocity [m/s], shape (n_runs, n_times)."""
    stick: npt.NDArray[np.bool_] | None = None
    """Whether the contact sticks, shape (n_runs, n_times)."""
    sketches: dict[str, Sketch] = dataclasses.field(default_factory=dict[str, Sketch])
    """Statistics of position and velocity, where runs were not kept."""
    stuck: npt.NDArray[np.int64] | None = None
    """Number of runs that stick at each time, where runs were not kept, shape (n_times,)."""
    attributes: dict[str, Any] = dataclasses.field(default_factory=dict[str, Any])
    """What made it: engine, method, law, dt, seed, first_sample, n_runs, seconds."""

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return len(self.tallies)

    @property
    def n_break_aways(self) -> Array:
        """Number of break-aways of each run whose slip went far enough to count, shape (n_runs,)."""
        return self.tallies[:, BREAK_AWAYS]

    @property
    def first_break_away(self) -> Array:
        """Time of each run's first break-away [s], NaN without one, shape (n_runs,)."""
        return self.tallies[:, FIRST]

    @property
    def period(self) -> Array:
        """Mean interval between the break-aways of each run [s], NaN with fewer than two, shape (n_runs,)."""
        intervals = self.n_break_aways - 1.0
        span = self.tallies[:, LAST] - self.tallies[:, FIRST]
        return np.divide(span, intervals, out=np.full(self.n_runs, np.nan), where=intervals > 0.0)

    @property
    def break_away_mu_s(self) -> Array:
        """Mean mu_s at the break-aways of each run [-], NaN without one, shape (n_runs,)."""
        n = self.n_break_aways
        return np.divide(self.tallies[:, MU_S_SUM], n, out=np.full(self.n_runs, np.nan), where=n > 0.0)

    @property
    def stick_fraction(self) -> Array:
        """Share of the time from 0 to the last output time that each run sticks [-], shape (n_runs,)."""
        return self.tallies[:, STICK_TIME] / self.time[-1]

    @property
    def stick_probability(self) -> Array:
        """Share of the runs that stick at each time [-], shape (n_times,)."""
        if self.stick is not None:
            return self.stick.mean(axis=0)
        assert self.stuck is not None
        return self.stuck / self.n_runs

    def mean(self, quantity: str) -> Array:
        """Return the mean of "position" [m] or "velocity" [m/s] over the runs, shape (n_times,)."""
        runs = self._runs(quantity)
        return self.sketches[quantity].mean if runs is None else runs.mean(axis=0)

    def std(self, quantity: str) -> Array:
        """Return the standard deviation over the runs (n - 1), NaN for one run, shape (n_times,)."""
        runs = self._runs(quantity)
        if runs is None:
            return self.sketches[quantity].std
        return runs.std(axis=0, ddof=1) if self.n_runs > 1 else np.full(len(self.time), np.nan)

    def quantiles(self, quantity: str, levels: npt.ArrayLike) -> Array:
        """Return the quantiles over the runs at the given levels, shape (n_levels, n_times).

        Exact (linear between order statistics) where runs were kept, otherwise off by at most `quantile_error`.
        """
        runs = self._runs(quantity)
        levels = checked_levels(levels)
        return self.sketches[quantity].quantiles(levels) if runs is None else np.quantile(runs, levels, axis=0)

    def quantile_error(self, quantity: str) -> Array:
        """Return the largest error of a quantile at each time, 0 where runs were kept, shape (n_times,)."""
        runs = self._runs(quantity)
        return self.sketches[quantity].quantile_error if runs is None else np.zeros(len(self.time))

    def histogram(self, quantity: str, output: int, bins: int = 100) -> tuple[npt.NDArray[np.int64], Array]:
        """Return counts and bin edges at output time number ``output``; ``bins`` applies where runs were kept."""
        if not -len(self.time) <= output < len(self.time):
            raise InputError(f"output = {output} is not one of the {len(self.time)} output times; count from 0")
        runs = self._runs(quantity)
        if runs is None:
            return self.sketches[quantity].histogram(output)
        counts, edges = np.histogram(runs[:, output], bins=bins)
        return counts.astype(np.int64), edges

    def _runs(self, quantity: str) -> Array | None:
        require_name("quantity", quantity, ("position", "velocity"))
        return self.position if quantity == "position" else self.velocity
