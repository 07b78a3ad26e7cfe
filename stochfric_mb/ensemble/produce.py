"""From a job to its file: blocks from threads, processes or a cluster, kept as parts until the target is whole."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from stochfric_mb.ensemble import cluster
from stochfric_mb.ensemble.dataset import (
    CHUNK_BYTES,
    ZARR,
    check_ensemble_target,
    ensemble_ending,
    write_blocks,
    write_ensemble,
)
from stochfric_mb.ensemble.job import Description, Job, describe, versions
from stochfric_mb.ensemble.parts import Parts, open_parts
from stochfric_mb.ensemble.planning import MAX_BYTES
from stochfric_mb.ensemble.result import Block
from stochfric_mb.ensemble.workers import cores, on_this_machine
from stochfric_mb.errors import InputError
from stochfric_mb.outputs import claimed
from stochfric_mb.storage import versions as all_versions


@dataclasses.dataclass(frozen=True)
class Produced:
    """A finished ensemble on the disk."""

    path: Path
    """The file or folder."""
    description: Description
    """What really ran."""
    n_resumed: int
    """Blocks that an earlier, interrupted run had finished."""
    n_computed: int
    """Blocks computed now."""
    seconds: float
    """Time taken now [s]."""


def produce(
    job: Job,
    out: str | Path,
    *,
    workers: int | None = None,
    scheduler: Any = None,
    force: bool = False,
    max_bytes: int = MAX_BYTES,
    progress: Callable[[int], None] | None = None,
) -> Produced:
    """Compute an ensemble into a file that appears whole; what is finished survives an interrupt and is not redone.

    Finished blocks lie in the folder ``OUT.parts`` until the target is there. The same call goes on where an interrupted
    one was, with any number of workers or a cluster: the result is the same to the bit.

    Args:
        job: what is computed, from `job.job`.
        out: target: ``.nc``, or ``.zarr`` for an ensemble beyond the memory.
        workers: threads or processes on this machine; all cores if not given.
        scheduler: address of a Dask scheduler, or a ``distributed.Client``, that computes instead.
        force: whether what is at ``out``, and parts of another job, are replaced.
        max_bytes: memory that may be taken [bytes].
        progress: called with the number of runs that are finished, first with those of an interrupted run.

    Raises:
        InputError: arguments that cannot be used, parts of another job, or more memory than ``max_bytes``.
        MissingEngineError: an engine, Dask or Zarr is not installed.
        SimulationError: a run broke down, or the workers did.
    """
    began = time.perf_counter()
    target = check_ensemble_target(out, force=force)
    workers = checked_workers(workers, scheduler)
    check_memory(job, target, workers, max_bytes)
    description = describe(job)
    with claimed(target), _source(job, workers, scheduler) as blocks_of:
        parts = open_parts(target, job, force=force)
        resumed = len(parts.finished)
        _compute(parts, blocks_of, progress)
        _write(parts, target, description, force)
    parts.remove()
    return Produced(target, description, resumed, job.n_blocks - resumed, time.perf_counter() - began)


def checked_workers(workers: int | None, scheduler: Any) -> int:
    """Return the number of workers on this machine.

    Raises:
        InputError: it is below 1, or given beside a scheduler.
    """
    if workers is not None and scheduler is not None:
        raise InputError(
            f"workers = {workers} are of this machine, but the scheduler {scheduler} has its own; give one of them"
        )
    if workers is not None and (workers < 1 or workers > 1024):
        raise InputError(f"workers = {workers} must be from 1 to 1024; leave it out to take all {cores()} cores")
    return 1 if scheduler is not None else workers or cores()


def memory(job: Job, target: Path, workers: int) -> int:
    """Return the memory that a job takes here [bytes], interpreter and libraries apart."""
    p = job.plan(workers)
    row = 17 * p.n_times
    if job.statistics_only:
        return p.bytes_total + p.bytes_result  # written as they are, and as quantiles
    if ensemble_ending(target) == ZARR:
        chunk = min(max(CHUNK_BYTES // (8 * p.n_times), 1), p.n_runs)
        return p.bytes_working + 3 * (chunk + p.block) * row  # put together from blocks, cut, and packed
    copy = 8 * p.n_times * p.n_runs  # xarray copies a variable when it writes it
    return p.bytes_total + copy + p.bytes_result  # the file is built in memory


def check_memory(job: Job, target: Path, workers: int, max_bytes: int) -> None:
    """Return if a job fits into ``max_bytes``.

    Raises:
        InputError: it does not; says what would.
    """
    needed = memory(job, target, workers)
    if needed > max_bytes:
        raise InputError(
            f"{job.n_runs} runs at {len(job.times)} times need {needed / 2**20:.0f} MiB, over {max_bytes / 2**20:.0f} MiB; "
            "ask for fewer output times, for statistics only, or write to a folder that ends in .zarr"
        )


Source = Callable[[Parts], Iterator[tuple[int, Block]]]


@contextlib.contextmanager
def _source(job: Job, workers: int, scheduler: Any) -> Iterator[Source]:
    """Give the function that computes the blocks that a parts folder misses."""
    if scheduler is None:
        yield lambda parts: on_this_machine(job, _missing(parts), workers)
        return
    client, ours = cluster.connect(scheduler)
    try:
        yield lambda parts: cluster.on_cluster(job, _missing(parts), client)
    finally:
        if ours:
            client.close()


def _missing(parts: Parts) -> list[int]:
    return [number for number in range(parts.job.n_blocks) if number not in parts.finished]


def _compute(parts: Parts, blocks_of: Source, progress: Callable[[int], None] | None) -> None:
    job = parts.job
    done = sum(job.span(number)[1] for number in parts.finished)
    if progress is not None:
        progress(done)
    with contextlib.closing(blocks_of(parts)) as blocks:  # type: ignore[type-var]  # generators can be closed
        for number, block in blocks:
            parts.add(number, block)
            done += job.span(number)[1]
            if progress is not None:
                progress(done)


def _write(parts: Parts, target: Path, description: Description, force: bool) -> None:
    job = parts.job
    attributes = {
        "engine": job.engine,
        "engine_version": versions(job.engine).get(job.engine, versions(job.engine)["stochfric_mb"]),
        "method": job.plan().method,
        "law": description.law,
        "notes": list(description.notes),
        "dt": description.dt,
        "position_unit": description.unit,
        "seed": job.seed,
        "first_sample": job.first_sample,
        "n_runs": job.n_runs,
        "versions": json.dumps(all_versions() | versions(job.engine)),
    }
    if ensemble_ending(target) == ZARR and not job.statistics_only:
        times = np.array(job.times)
        write_blocks(parts.blocks(), job.n_runs, times, target, scenario=job.scenario, attributes=attributes, force=force)
        return
    write_ensemble(parts.result(attributes), target, scenario=job.scenario, force=force)
