"""Blocks on a Dask cluster: other machines, or other processes of this one."""

# pyright: reportMissingImports=false, reportMissingTypeStubs=false
# (distributed is optional, and not typed)

from __future__ import annotations

import contextlib
import itertools
import time
import uuid
from collections.abc import Iterable, Iterator
from typing import Any

from stochfric_mb.ensemble.job import Job, compute, versions
from stochfric_mb.ensemble.result import Block
from stochfric_mb.errors import InputError, MissingEngineError, SimulationError

CONNECT = 20.0
"""Time to wait for a scheduler [s]."""
PATIENCE = 120.0
"""Time to wait for workers when there is none [s]."""
BLOCKS_A_THREAD = 3
"""Blocks begun for each thread of the cluster."""
LOOK = 5.0
"""Time between two looks at whether there are workers [s]."""

Outcome = tuple[Block, dict[str, str]]


def connect(scheduler: Any) -> tuple[Any, bool]:
    """Return a client of a scheduler, and whether it was made here (and has to be closed).

    Args:
        scheduler: address, such as ``tcp://host:8786``, or a ``distributed.Client``.

    Raises:
        MissingEngineError: Dask is not installed.
        InputError: no scheduler answers there.
    """
    try:
        from distributed import Client
    except ImportError:
        raise MissingEngineError("a scheduler needs Dask; in a clone of this package run: pip install '.[cluster]'") from None
    if isinstance(scheduler, Client):
        return scheduler, False
    try:
        return Client(scheduler, timeout=CONNECT, set_as_default=False), True
    except (OSError, ValueError, TypeError) as error:
        raise InputError(
            f"no Dask scheduler at {scheduler!r} ({error}); start one with `dask scheduler` and give the address it shows, "
            "such as tcp://host:8786"
        ) from None


def on_cluster(job: Job, numbers: Iterable[int], client: Any) -> Iterator[tuple[int, Block]]:
    """Give blocks as the cluster finishes them; those of a worker that dies are computed by another.

    Raises:
        SimulationError: a run broke down, there are no workers, or a worker runs other versions.
    """
    left = iter(numbers)
    running: dict[Any, int] = {}
    try:
        while True:
            for number in itertools.islice(left, max(BLOCKS_A_THREAD * _threads(client) - len(running), 0)):
                running[client.submit(_outcome, job, number, pure=False, key=f"stochfric-{uuid.uuid4().hex}")] = number
            if not running:
                return
            for future in sorted(_finished(running, client), key=running.__getitem__):
                block, result = _result(future, client)
                _require_same(result, versions(job.engine))
                yield running.pop(future), block
                del future  # the cluster forgets the block
    finally:
        client.cancel(list(running))


def _outcome(job: Job, number: int) -> Outcome:
    """Return a block and the versions that made it (this runs on a worker)."""
    return compute(job, number), versions(job.engine)


def _threads(client: Any) -> int:
    """Return the number of the cluster's threads once it has any.

    Raises:
        SimulationError: no worker has come.
    """
    begun = time.monotonic()
    while True:
        threads = sum(client.nthreads().values())
        if threads:
            return threads
        if time.monotonic() - begun > PATIENCE:
            raise SimulationError(
                f"the scheduler {client.scheduler.address} has had no workers for {PATIENCE:g} s; start some with "
                "`dask worker ADDRESS`, then run the same command again: it goes on where it was"
            )
        time.sleep(0.1)


def _finished(running: Iterable[Any], client: Any) -> list[Any]:
    """Return the futures that are finished, at least one."""
    from distributed import wait

    while True:
        with contextlib.suppress(TimeoutError), client.as_current():
            waited: Any = wait(list(running), timeout=LOOK, return_when="FIRST_COMPLETED")
            return list(waited.done)
        _threads(client)


def _result(future: Any, client: Any) -> Outcome:
    """Return what a worker has computed.

    Raises:
        SimulationError: its run broke down, it died again and again, or the scheduler has gone.
    """
    from concurrent.futures import CancelledError

    from distributed import KilledWorker

    try:
        return future.result()
    except KilledWorker:
        raise SimulationError(
            "several workers in a row died while they computed the same block; they may be out of memory: give them more, "
            "then run the same command again: it goes on where it was"
        ) from None
    except CancelledError:
        raise SimulationError(
            f"the scheduler {client.scheduler.address} has gone; start it anew and run the same command again: it goes on "
            "where it was"
        ) from None


def _require_same(texts: dict[str, str], wanted: dict[str, str]) -> None:
    if texts != wanted:
        raise SimulationError(f"a worker runs {texts}, but here runs {wanted}; install the same versions everywhere")
