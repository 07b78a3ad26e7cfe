"""What an ensemble will do and need, before it runs."""

from __future__ import annotations

import dataclasses
import math

import numpy.typing as npt

from stochfric_mb.engines import ENGINES
from stochfric_mb.ensemble import methods
from stochfric_mb.ensemble.collect import QUANTITIES
from stochfric_mb.ensemble.lanes import TALLIES
from stochfric_mb.ensemble.schedule import checked_times
from stochfric_mb.ensemble.sketch import BINS, Sketch
from stochfric_mb.errors import InputError, require_name, require_number
from stochfric_mb.scenario import Scenario

MAX_BYTES = 2**31
"""Memory that an ensemble may take unless stated otherwise [bytes]."""
MAX_SAMPLES = 2**32
"""Samples that one seed has."""


@dataclasses.dataclass(frozen=True)
class Plan:
    """What an ensemble will do and need, known before it runs."""

    method: str
    """How the runs are computed, in one line."""
    side_by_side: bool
    """Whether a compiled kernel runs samples side by side (otherwise an engine runs them one at a time)."""
    dt: float
    """Step [s]; 0 where there is none."""
    n_runs: int
    """Number of runs."""
    n_times: int
    """Number of output times."""
    block: int
    """Runs in a block."""
    threads: int
    """Blocks computed at a time."""
    bytes_result: int
    """Memory of the result [bytes]."""
    bytes_working: int
    """Memory of the blocks in flight [bytes]."""

    @property
    def n_blocks(self) -> int:
        """Number of blocks."""
        return math.ceil(self.n_runs / self.block)

    @property
    def bytes_total(self) -> int:
        """Memory of result and blocks together [bytes]; the interpreter and its libraries come on top."""
        return self.bytes_result + self.bytes_working


def plan(
    scenario: Scenario,
    n_runs: int,
    *,
    output_times: npt.ArrayLike | None = None,
    statistics_only: bool = False,
    engine: str = "reference",
    dt: float | None = None,
    threads: int | None = None,
    block: int | None = None,
    bins: int = BINS,
) -> Plan:
    """Return what `runner.run` with these arguments will do and how much memory it will take.

    Args: as for `runner.run`.

    Raises:
        InputError: arguments that cannot be used.
    """
    n_runs = _whole("n_runs", n_runs, low=1, high=MAX_SAMPLES)
    times = checked_times(scenario, output_times)
    require_name("engine", engine, ENGINES)
    method = methods.method(scenario, engine, dt)
    threads = _whole("threads", threads or 1, low=1, high=1024)
    block = _whole("block", method.block if block is None else block, low=1, high=MAX_SAMPLES)
    block = min(block, n_runs)
    row = len(times) * (8 + 8 + 1) + TALLIES * 8
    kept = len(QUANTITIES) * Sketch.nbytes(len(times), bins) + 8 * len(times) if statistics_only else n_runs * len(times) * 17
    return Plan(
        method=method.text,
        side_by_side=method.side_by_side,
        dt=method.dt,
        n_runs=n_runs,
        n_times=len(times),
        block=block,
        threads=threads,
        bytes_result=kept + n_runs * TALLIES * 8,
        bytes_working=in_flight(threads) * block * row,
    )


def in_flight(threads: int) -> int:
    """Return how many blocks exist at a time when ``threads`` are computed at a time."""
    return 1 if threads == 1 else 2 * threads


def check_address(seed: int, first_sample: int, n: int) -> None:
    """Check that the n samples from ``first_sample`` on have addresses.

    Raises:
        InputError: a number is not whole or beyond what a seed has.
    """
    _whole("seed", seed, low=0, high=MAX_SAMPLES - 1)
    _whole("n_runs", n, low=1, high=MAX_SAMPLES)
    _whole("first_sample", first_sample, low=0, high=MAX_SAMPLES - n)


def _whole(name: str, value: object, *, low: int, high: int) -> int:
    number = require_number(name, value, low=low, high=high)
    if number != int(number):
        raise InputError(f"{name} = {number:g} is not a whole number; give one from {low} to {high}")
    return int(number)
