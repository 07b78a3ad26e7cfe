"""Ensembles: many runs of one scenario, each with its own coefficient path, in blocks."""

from __future__ import annotations

import collections
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import numpy.typing as npt

from stochfric_mb.ensemble import methods
from stochfric_mb.ensemble.collect import Runs, Statistics, checked_block
from stochfric_mb.ensemble.planning import MAX_BYTES, Plan, check_address, in_flight, plan
from stochfric_mb.ensemble.result import Block, EnsembleResult
from stochfric_mb.ensemble.schedule import checked_times
from stochfric_mb.ensemble.sketch import BINS
from stochfric_mb.errors import InputError
from stochfric_mb.scenario import Scenario


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
    check_address(seed, first_sample, n)
    return checked_block(methods.method(scenario, engine, dt).prepare(times)(seed, first_sample, n), scenario, first_sample)


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

    >>> from stochfric_mb import load_scenario
    >>> result = run(load_scenario("kang2015_table1", law="coulomb"), 100, output_times=[1.0, 2.0])
    >>> result.position.shape
    (100, 2)
    >>> low, high = result.quantiles("position", [0.025, 0.975])[:, 1]
    >>> f"{1e3 * low:.2f} to {1e3 * high:.2f} mm at 2 s"
    '2.31 to 2.61 mm at 2 s'

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
    check_address(seed, first_sample, n_runs)
    if p.bytes_total > max_bytes:
        raise InputError(
            f"{n_runs} runs at {len(times)} times need {p.bytes_total / 2**20:.0f} MiB, more than max_bytes = "
            f"{max_bytes / 2**20:.0f} MiB; ask for fewer output_times, statistics_only=True, or raise max_bytes"
        )
    before = time.perf_counter()
    collect = Statistics(times, n_runs, bins) if statistics_only else Runs(times, n_runs)
    compute = methods.method(scenario, engine, dt).prepare(times)
    done = 0
    for part in _blocks(compute, p, seed, first_sample):
        collect.add(checked_block(part, scenario, first_sample + done), done)
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
                if len(waiting) == in_flight(p.threads):
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()
        finally:
            for future in waiting:
                future.cancel()
