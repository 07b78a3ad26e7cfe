"""A job: everything that decides the bits of an ensemble, and how any worker computes a block of it."""

from __future__ import annotations

import dataclasses
import functools
import json
import threading
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb import __version__
from stochfric_mb.effects.combine import any_but_random
from stochfric_mb.engines import ENGINES, adapter
from stochfric_mb.ensemble import methods
from stochfric_mb.ensemble.collect import checked_block
from stochfric_mb.ensemble.engines import RUNS, Prepared, all_at_once, many
from stochfric_mb.ensemble.fixed_step import check_step
from stochfric_mb.ensemble.planning import MAX_SAMPLES, Plan, check_address, plan
from stochfric_mb.ensemble.result import Block
from stochfric_mb.ensemble.schedule import checked_times
from stochfric_mb.ensemble.sketch import BINS
from stochfric_mb.errors import SimulationError
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.scenario import Scenario

THREADS, BATCH, PROCESSES = "threads", "batch", "processes"
"""How an engine uses the cores of one machine: compiled kernels on threads, MuJoCo's Batch, a process each."""
EVENT_DRIVEN_RUNS = 2048
"""Runs in a block where a kernel runs samples side by side and needs no step."""
FIXED_STEP_RUNS = 512
"""Runs in a block where such a kernel steps."""
SINGLE_RUNS = 4
"""Runs in a block where an engine runs one sample at a time."""
BLOCK_BYTES = 2**25
"""Size that a block does not exceed, unless one run does [bytes]."""


@dataclasses.dataclass(frozen=True)
class Job:
    """An ensemble to be computed; made by `job`."""

    scenario: Scenario
    """What is simulated."""
    engine: str
    """Who computes."""
    dt: float | None
    """Step asked for [s]; None: the engine's default."""
    times: tuple[float, ...]
    """Output times [s]."""
    n_runs: int
    """Number of runs."""
    seed: int
    """First part of the address of the coefficient paths."""
    first_sample: int
    """Sample number of run 0."""
    statistics_only: bool
    """Whether statistics are kept instead of the runs."""
    block: int
    """Runs in a block."""
    bins: int
    """Bins of the histograms of statistics."""

    @property
    def n_blocks(self) -> int:
        """Number of blocks."""
        return -(-self.n_runs // self.block)

    @property
    def how(self) -> str:
        """How the cores of one machine are used: `THREADS`, `BATCH` or `PROCESSES`."""
        if many(self.engine) is not None:
            return BATCH
        return THREADS if methods.method(self.scenario, self.engine, self.dt).side_by_side else PROCESSES

    def span(self, number: int) -> tuple[int, int]:
        """Return (number of its first run, number of its runs) of a block."""
        first = number * self.block
        return first, min(self.block, self.n_runs - first)

    def plan(self, workers: int = 1) -> Plan:
        """Return what the job needs when ``workers`` blocks are computed at a time."""
        return plan(
            self.scenario, self.n_runs, output_times=self.times, statistics_only=self.statistics_only, engine=self.engine,
            dt=self.dt, threads=workers, block=self.block, bins=self.bins,
        )  # fmt: skip

    def fingerprint(self) -> dict[str, Any]:
        """Return what parts of one ensemble have in common: they fit together if, and only if, this is equal."""
        import hashlib

        return {
            "scenario": self.scenario.to_dict(),
            "engine": self.engine,
            "dt": self.dt,
            "seed": self.seed,
            "first_sample": self.first_sample,
            "n_runs": self.n_runs,
            "n_times": len(self.times),
            "output_times": hashlib.sha256(np.array(self.times).tobytes()).hexdigest(),
            "statistics_only": self.statistics_only,
            "bins": self.bins,
            "block": self.block,
            "versions": versions(self.engine),
        } | _identity(self)


def job(
    scenario: Scenario,
    n_runs: int,
    *,
    seed: int = 0,
    output_times: npt.ArrayLike | None = None,
    statistics_only: bool = False,
    first_sample: int = 0,
    engine: str = "reference",
    dt: float | None = None,
    block: int | None = None,
    bins: int = BINS,
) -> Job:
    """Return the job of an ensemble, with a block size that does not depend on who computes it.

    Args: as for `runner.run`.

    Raises:
        InputError: arguments that cannot be used.
    """
    times = checked_times(scenario, output_times)
    check_address(seed, first_sample, n_runs)
    options = {"output_times": times, "statistics_only": statistics_only, "engine": engine, "dt": dt, "bins": bins}
    known = plan(scenario, n_runs, block=block, **options)
    if block is None:
        largest = _largest_block(engine, known)
        block = max(min(largest, BLOCK_BYTES // (17 * len(times)), known.n_runs), 1)
    return Job(
        scenario, engine, dt, tuple(times.tolist()), known.n_runs, int(seed), int(first_sample), statistics_only,
        min(int(block), MAX_SAMPLES), bins,
    )  # fmt: skip


def _largest_block(engine: str, known: Plan) -> int:
    """Return a number of runs that takes a few seconds, so that an interrupt costs little."""
    if known.side_by_side:
        return EVENT_DRIVEN_RUNS if known.dt == 0.0 else FIXED_STEP_RUNS
    return RUNS.get(engine, SINGLE_RUNS)


def _identity(given: Job) -> dict[str, str]:
    """Return what the scenario leaves to other files, such as a user's own model; empty if nothing."""
    if isinstance(given.scenario.mechanism, BeltBox):
        return {}
    return {"model": adapter(given.engine).identity(given.scenario)}


@dataclasses.dataclass(frozen=True)
class Description:
    """What an engine says about its runs."""

    law: str
    """Kind of the law that really runs."""
    notes: tuple[str, ...]
    """What differs from the scenario, such as a law that stands in for another."""
    dt: float
    """Step [s]; 0 where there is none."""
    unit: str = "m"
    """Unit of the position."""


def describe(given: Job) -> Description:
    """Return what the engine will really run, from one output step of it: what cannot run fails here.

    Raises:
        InputError, StabilityError, MissingEngineError, SimulationError: as the engine's ``simulate``.
    """
    known = methods.method(given.scenario, given.engine, given.dt)
    if known.side_by_side:
        if known.dt > 0.0:
            check_step(given.scenario, known.dt)
        return Description(given.scenario.law.kind, (), known.dt)
    short = dataclasses.replace(given.scenario, duration=given.scenario.output_step)
    about = adapter(given.engine).simulate(short, seed=given.seed, sample=given.first_sample, dt=given.dt).attributes
    known.prepare(np.array(given.times))
    return Description(
        str(about["law"]), tuple(about.get("notes", ())), float(about["dt"]), str(about.get("position_unit", "m"))
    )


def versions(engine: str) -> dict[str, str]:
    """Return the versions that decide the bits of a block: name -> version."""
    table = {"stochfric_mb": __version__, "numpy": np.__version__}
    return table if engine == "reference" else table | {engine: str(ENGINES[engine].version)}


def compute(given: Job, number: int, threads: int = 1) -> Block:
    """Return a block of a job: a pure function of its arguments, for any thread, process or machine.

    Raises:
        SimulationError: a run broke down; names the samples.
    """
    first, n = given.span(number)
    low = given.first_sample + first
    try:
        return checked_block(_prepared(_Key(given))(given.seed, low, n, threads), given.scenario, low)
    except SimulationError as error:
        raise SimulationError(f"samples {low} .. {low + n - 1} of seed {given.seed}: {error}") from error


class _Key:
    """A job as a key of a cache."""

    def __init__(self, given: Job) -> None:
        self.job = given
        self.text = json.dumps(given.fingerprint(), sort_keys=True)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Key) and other.text == self.text

    def __hash__(self) -> int:
        return hash(self.text)


@functools.lru_cache(maxsize=2)
def _prepared(key: _Key) -> Prepared:
    given = key.job
    times = np.array(given.times)
    simulate_many = many(given.engine)
    if simulate_many is not None and not any_but_random(given.scenario.effects):
        return all_at_once(given.scenario, simulate_many, given.dt, times)
    known = methods.method(given.scenario, given.engine, given.dt)
    simulate = known.prepare(times)
    if known.side_by_side:
        return lambda seed, first, n, threads: simulate(seed, first, n)

    def alone(seed: int, first: int, n: int, threads: int) -> Block:
        with _ONE_AT_A_TIME:
            return simulate(seed, first, n)

    return alone


_ONE_AT_A_TIME = threading.Lock()
"""Engines that hold the interpreter's lock, or keep state of their own, run one at a time in a process."""
