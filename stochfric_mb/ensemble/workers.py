"""Blocks on the cores of one machine: threads for compiled kernels and for MuJoCo's Batch, processes for the others."""

from __future__ import annotations

import itertools
import multiprocessing
import os
import signal
from collections.abc import Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool

from stochfric_mb.ensemble.job import BATCH, THREADS, Job, compute
from stochfric_mb.ensemble.result import Block
from stochfric_mb.errors import SimulationError

DEATHS = 3
"""So many worker processes in a row may die before a block is finished."""

Numbered = Iterator[tuple[int, Block]]
"""Numbers of blocks and the blocks, as they are finished."""


def cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def on_this_machine(job: Job, numbers: Iterable[int], workers: int) -> Numbered:
    """Give blocks as they are finished, at most twice ``workers`` of them begun at a time.

    Raises:
        SimulationError: a run broke down, or worker processes keep dying.
    """
    if job.how == BATCH:
        return ((number, compute(job, number, threads=workers)) for number in numbers)
    if job.how == THREADS:
        return _on_threads(job, numbers, workers)
    return _on_processes(job, numbers, workers)


def _on_threads(job: Job, numbers: Iterable[int], workers: int) -> Numbered:
    with ThreadPoolExecutor(workers) as pool:
        yield from _as_finished(pool, job, iter(numbers), workers, set())


def _on_processes(job: Job, numbers: Iterable[int], workers: int) -> Numbered:
    """Give blocks from spawned processes; when one dies, its blocks are begun again in new ones."""
    left = iter(numbers)
    begun: set[int] = set()
    deaths = 0
    while True:
        pool = ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn"), initializer=_ignore_interrupts)
        again, begun = sorted(begun), set()
        try:
            for done in _as_finished(pool, job, itertools.chain(again, left), workers, begun):
                deaths = 0
                yield done
            pool.shutdown()
            return
        except BrokenProcessPool:
            deaths += 1
            if deaths == DEATHS:
                raise SimulationError(
                    f"{job.engine}: a worker process died {DEATHS} times in a row without finishing one of the blocks "
                    f"{sorted(begun)} of {job.block} runs; it may be out of memory: take fewer workers"
                ) from None
        finally:
            _stop(pool)


def _as_finished(pool: Executor, job: Job, numbers: Iterator[int], workers: int, begun: set[int]) -> Numbered:
    """Give blocks as a pool finishes them; ``begun`` holds those that are not finished yet."""
    running: dict[Future[Block], int] = {}
    try:
        while True:
            for number in itertools.islice(numbers, 2 * workers - len(running)):
                begun.add(number)
                running[pool.submit(compute, job, number)] = number
            if not running:
                return
            for future in sorted(wait(running, return_when=FIRST_COMPLETED).done, key=running.__getitem__):
                block = future.result()
                number = running.pop(future)
                begun.discard(number)
                yield number, block
    finally:
        for future in running:
            future.cancel()


def _stop(pool: ProcessPoolExecutor) -> None:
    """End the processes of a pool, also in the middle of a block."""
    processes = list((getattr(pool, "_processes", None) or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for process in processes:
        process.terminate()
    for process in processes:
        process.join()


def _ignore_interrupts() -> None:
    """Leave Ctrl-C to the process that waits for the blocks."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
