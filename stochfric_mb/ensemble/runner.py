"""Ensembles: many runs of one scenario, each with its own coefficient path, in blocks."""

from __future__ import annotations

import collections
import dataclasses
import math
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.engines import ENGINES
from stochfric_mb.ensemble import methods
from stochfric_mb.ensemble.lanes import TALLIES
from stochfric_mb.ensemble.result import Block, EnsembleResult
from stochfric_mb.ensemble.schedule import Array, checked_times
from stochfric_mb.ensemble.sketch import BINS, Sketch
from stochfric_mb.errors import InputError, SimulationError, require_name, require_number
from stochfric_mb.scenario import Scenario

MAX_BYTES = 2**31
"""Memory that an ensemble may take unless told otherwise [bytes]."""
QUANTITIES = ("position", "velocity")
MAX_SAMPLES = 2**32


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
    """Return what `run` with these arguments will do and how much memory it will take.

    Args: as for `run`.

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
        bytes_working=_in_flight(threads) * block * row,
    )


def run_block(
    scenario: Scenario,
    first_sample: int,
    n: int,
    seed: int,
    *,
    output_times: npt.ArrayLike | None = None,
    engine: str = "reference",
    dt: float | None = None,
) -> Block:
    """Return runs ``first_sample`` .. ``first_sample + n - 1``: a pure function of its arguments, for any worker.

    Blocks put one after the other are to the bit what one larger block gives.

    Args: as for `run`.

    Raises:
        InputError: arguments that cannot be used.
        SimulationError: a run broke down; names the sample.
    """
    times = checked_times(scenario, output_times)
    _check_address(seed, first_sample, n)
    return _checked(methods.method(scenario, engine, dt).prepare(times)(seed, first_sample, n), scenario, first_sample)


def run(
    scenario: Scenario,
    n_runs: int,
    *,
    seed: int = 0,
    output_times: npt.ArrayLike | None = None,
    statistics_only: bool = False,
    first_sample: int = 0,
    engine: str = "reference",
    dt: float | None = None,
    threads: int | None = None,
    block: int | None = None,
    bins: int = BINS,
    max_bytes: int = MAX_BYTES,
    progress: Callable[[int], None] | None = None,
) -> EnsembleResult:
    """Return ``n_runs`` runs of a scenario, run i with the coefficient path (seed, first_sample + i).

    Block size and number of threads change no bit of the result.

    Args:
        scenario: what is simulated.
        n_runs: number of runs, >= 1.
        seed: first part of the address of the coefficient paths.
        output_times: increasing times [s] within the scenario's duration; its own output times if not given.
        statistics_only: whether to keep means, standard deviations and histograms instead of the runs.
        first_sample: sample number of run 0.
        engine: who computes the runs. "reference" takes a kernel that runs samples side by side where there is one (see
            `plan`), and the reference solution one sample at a time otherwise.
        dt: step [s]; half the law's stability limit or 1e-4 s, whichever is smaller, if not given. Without effect where
            there is no step.
        threads: blocks computed at a time; 1 if not given.
        block: runs in a block.
        bins: bins of the histograms that ``statistics_only`` keeps.
        max_bytes: memory that may be taken [bytes]; a plan that needs more is an error.
        progress: called with the number of runs done after each block.

    Raises:
        InputError: arguments that cannot be used, or a plan that needs more memory than ``max_bytes``.
        SimulationError: a run broke down; names the sample.
    """
    times = checked_times(scenario, output_times)
    p = plan(
        scenario, n_runs, output_times=times, statistics_only=statistics_only, engine=engine, dt=dt, threads=threads,
        block=block, bins=bins,
    )  # fmt: skip
    _check_address(seed, first_sample, n_runs)
    if p.bytes_total > max_bytes:
        raise InputError(
            f"{n_runs} runs at {len(times)} times need {p.bytes_total / 2**20:.0f} MiB, more than max_bytes = "
            f"{max_bytes / 2**20:.0f} MiB; ask for fewer output_times, statistics_only=True, or raise max_bytes"
        )
    before = time.perf_counter()
    collect = _Statistics(times, p, bins) if statistics_only else _Runs(times, p)
    compute = methods.method(scenario, engine, dt).prepare(times)
    done = 0
    for part in _blocks(compute, p, seed, first_sample):
        collect.add(_checked(part, scenario, first_sample + done), done)
        done += len(part.tallies)
        if progress is not None:
            progress(done)
    attributes: dict[str, Any] = {
        "engine": engine,
        "method": p.method,
        "law": scenario.law.kind,
        "dt": p.dt,
        "seed": seed,
        "first_sample": first_sample,
        "n_runs": n_runs,
        "seconds": time.perf_counter() - before,
    }
    return collect.result(attributes)


def _blocks(compute: Callable[[int, int, int], Block], p: Plan, seed: int, first_sample: int) -> Iterator[Block]:
    """Give the blocks in order, ``p.threads`` of them computed at a time and few waiting."""
    tasks = [(seed, first_sample + low, min(p.block, p.n_runs - low)) for low in range(0, p.n_runs, p.block)]
    if p.threads == 1:
        for task in tasks:
            yield compute(*task)
        return
    with ThreadPoolExecutor(p.threads) as pool:
        waiting: collections.deque[Future[Block]] = collections.deque()
        try:
            for task in tasks:
                waiting.append(pool.submit(compute, *task))
                if len(waiting) == _in_flight(p.threads):
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()
        finally:
            for future in waiting:
                future.cancel()


def _in_flight(threads: int) -> int:
    return 1 if threads == 1 else 2 * threads


class _Runs:
    """Collects whole runs."""

    def __init__(self, times: Array, p: Plan) -> None:
        self.times = times
        shape = (p.n_runs, len(times))
        self.arrays = Block(np.empty(shape), np.empty(shape), np.empty(shape, dtype=np.bool_), np.empty((p.n_runs, TALLIES)))

    def add(self, part: Block, done: int) -> None:
        for mine, new in zip(self.arrays, part, strict=True):
            mine[done : done + len(new)] = new

    def result(self, attributes: dict[str, Any]) -> EnsembleResult:
        a = self.arrays
        return EnsembleResult(
            time=self.times, position=a.position, velocity=a.velocity, stick=a.stick, tallies=a.tallies, attributes=attributes
        )


class _Statistics:
    """Collects statistics only."""

    def __init__(self, times: Array, p: Plan, bins: int) -> None:
        self.times = times
        self.sketches = {name: Sketch.empty(len(times), bins) for name in QUANTITIES}
        self.stuck = np.zeros(len(times), dtype=np.int64)
        self.tallies = np.empty((p.n_runs, TALLIES))

    def add(self, part: Block, done: int) -> None:
        for name, sketch in self.sketches.items():
            sketch.add(getattr(part, name))
        self.stuck += part.stick.sum(axis=0)
        self.tallies[done : done + len(part.tallies)] = part.tallies

    def result(self, attributes: dict[str, Any]) -> EnsembleResult:
        return EnsembleResult(
            time=self.times, sketches=self.sketches, stuck=self.stuck, tallies=self.tallies, attributes=attributes
        )


def _checked(part: Block, scenario: Scenario, first: int) -> Block:
    """Return the block once all its positions are finite and of a size that the mechanism can reach.

    Raises:
        SimulationError: they are not; an engine can return success with a state that means nothing.
    """
    b = scenario.mechanism
    size = scenario.law.mu_s * b.normal_force / b.stiffness + abs(b.excitation_amplitude) + abs(b.initial_position)
    size += abs(b.initial_velocity) * math.sqrt(b.mass / b.stiffness) + abs(b.belt_velocity) * math.sqrt(b.mass / b.stiffness)
    wrong = ~(np.abs(part.position) <= 1.0e3 * size).all(axis=1)
    if wrong.any():
        j = int(np.argmax(wrong))
        raise SimulationError(
            f"sample {first + j} left every plausible position (abs(x) <= {1e3 * size:g} m) or is not finite; "
            "take a smaller dt or check the law's parameters"
        )
    return part


def _check_address(seed: int, first_sample: int, n: int) -> None:
    _whole("seed", seed, low=0, high=MAX_SAMPLES - 1)
    _whole("n_runs", n, low=1, high=MAX_SAMPLES)
    _whole("first_sample", first_sample, low=0, high=MAX_SAMPLES - n)


def _whole(name: str, value: object, *, low: int, high: int) -> int:
    number = require_number(name, value, low=low, high=high)
    if number != int(number):
        raise InputError(f"{name} = {number:g} is not a whole number; give one from {low} to {high}")
    return int(number)
