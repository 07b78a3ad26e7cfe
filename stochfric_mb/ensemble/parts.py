"""The parts folder: finished blocks of an ensemble beside its target, until it is whole.

A part appears whole or not at all. ``job.json`` says what the parts belong to; nothing is mixed. Where only statistics
are kept, blocks are folded into them in the order of the runs, and a *checkpoint* (the statistics of the first blocks)
takes the place of the blocks in it, so that the folder stays small.
"""

from __future__ import annotations

import dataclasses
import json
import shutil
import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.ensemble.collect import QUANTITIES, Runs, Statistics
from stochfric_mb.ensemble.job import Job
from stochfric_mb.ensemble.result import Block, EnsembleResult
from stochfric_mb.ensemble.sketch import Sketch
from stochfric_mb.errors import InputError
from stochfric_mb.outputs import whole_file, whole_folder

SCHEMA = "stochfric.ensemble-parts/1"
JOB = "job.json"
"""File that shows what the parts belong to."""
CHECKPOINT = "checkpoint.npz"
CHECKPOINT_BYTES = 2**26
"""Folded blocks are kept up to this size before a checkpoint takes their place [bytes]."""

Arrays = Mapping[str, npt.NDArray[Any]]


def parts_folder(target: str | Path) -> Path:
    """Return the parts folder of a target: beside it, its name with ``.parts`` at the end."""
    target = Path(target)
    return target.with_name(target.name + ".parts")


class Parts:
    """Finished blocks of one job on the disk."""

    def __init__(self, folder: Path, job: Job) -> None:
        """Take a folder that `open_parts` has checked."""
        self.folder = folder
        self.job = job
        self.finished: set[int] = set()
        """Numbers of the blocks that need not be computed any more."""

    def add(self, number: int, block: Block) -> None:
        """Store a finished block."""
        _save(self._path(number), block._asdict())
        self.finished.add(number)

    def load(self, number: int) -> Block:
        """Return a stored block.

        Raises:
            InputError: the file is damaged.
        """
        arrays = _load(self._path(number))
        _, n = self.job.span(number)
        shape = (n, len(self.job.times))
        if arrays is None or set(arrays) != set(Block._fields) or arrays["position"].shape != shape:
            raise InputError(f"{self._path(number)} is missing or damaged; run the same command again to compute it anew")
        return Block(**arrays)

    def result(self, attributes: dict[str, Any]) -> EnsembleResult:
        """Return the whole ensemble once all blocks are finished."""
        collect = Runs(np.array(self.job.times), self.job.n_runs)
        for number in range(self.job.n_blocks):
            collect.add(self.load(number), self.job.span(number)[0])
        return collect.result(attributes)

    def blocks(self) -> Iterator[Block]:
        """Give the blocks in the order of the runs."""
        return (self.load(number) for number in range(self.job.n_blocks))

    def remove(self) -> None:
        """Delete the folder: the target is whole."""
        shutil.rmtree(self.folder)

    def resume(self) -> None:
        """Find what is finished; what an interrupt or a fault has left damaged is deleted."""
        for leftover in self.folder.glob(".*.partial"):
            leftover.unlink(missing_ok=True)
        for number in range(self.job.n_blocks):
            if self._path(number).exists():
                self._check(number)

    def _check(self, number: int) -> None:
        try:
            self.load(number)
        except InputError:
            self._path(number).unlink()
        else:
            self.finished.add(number)

    def _path(self, number: int) -> Path:
        return self.folder / f"block-{number:07d}.npz"


class StatisticsParts(Parts):
    """Finished blocks of a job that keeps statistics only."""

    def __init__(self, folder: Path, job: Job) -> None:
        """Take a folder that `open_parts` has checked."""
        super().__init__(folder, job)
        self._collect = Statistics(np.array(job.times), job.n_runs, job.bins)
        self._folded = 0
        self._saved = 0
        self._kept_bytes = 0

    def add(self, number: int, block: Block) -> None:
        """Store a finished block, and fold in all that are next."""
        super().add(number, block)
        self._fold({number: block})

    def result(self, attributes: dict[str, Any]) -> EnsembleResult:
        """Return the statistics once all blocks are finished."""
        assert self._folded == self.job.n_blocks
        return self._collect.result(attributes)

    def resume(self) -> None:
        """Load the checkpoint, find finished blocks, and fold in all that are next."""
        saved = _load(self.folder / CHECKPOINT)
        if saved is not None:
            self._restore(saved)
            self.finished = set(range(self._folded))
            for number in self.finished:
                self._path(number).unlink(missing_ok=True)
        super().resume()
        self._fold({})

    def _fold(self, at_hand: Mapping[int, Block]) -> None:
        while self._folded in self.finished:
            block = at_hand.get(self._folded)
            block = self.load(self._folded) if block is None else block
            self._collect.add(block, self.job.span(self._folded)[0])
            self._folded += 1
            self._kept_bytes += sum(a.nbytes for a in block)
        sketches = len(QUANTITIES) * Sketch.nbytes(len(self.job.times), self.job.bins)
        if self._kept_bytes > max(CHECKPOINT_BYTES, 2 * sketches):
            self._checkpoint()

    def _checkpoint(self) -> None:
        """Write the statistics so far, then delete the blocks that are in them."""
        collect, done = self._collect, min(self._folded * self.job.block, self.job.n_runs)
        arrays = {
            f"{name}_{field.name}": np.asarray(getattr(sketch, field.name))
            for name, sketch in collect.sketches.items()
            for field in dataclasses.fields(sketch)
        }
        arrays |= {"stuck": collect.stuck, "tallies": collect.tallies[:done], "folded": np.array(self._folded)}
        _save(self.folder / CHECKPOINT, arrays)
        for number in range(self._saved, self._folded):
            self._path(number).unlink(missing_ok=True)
        self._saved, self._kept_bytes = self._folded, 0

    def _restore(self, saved: Arrays) -> None:
        collect = self._collect
        for name in collect.sketches:
            stored: dict[str, Any] = {field.name: saved[f"{name}_{field.name}"] for field in dataclasses.fields(Sketch)}
            stored["n"] = int(stored["n"])
            collect.sketches[name] = Sketch(**stored)
        collect.stuck[:] = saved["stuck"]
        collect.tallies[: len(saved["tallies"])] = saved["tallies"]
        self._folded = self._saved = int(saved["folded"])


def open_parts(target: str | Path, job: Job, *, force: bool = False) -> Parts:
    """Return the parts of a job beside its target: new, or those that an interrupted run of the same job has left.

    Args:
        target: the file or folder that the ensemble will be.
        job: what is computed.
        force: whether parts of another job are deleted.

    Raises:
        InputError: the folder holds parts of another job, or is none of ours.
    """
    folder = parts_folder(target)
    wanted = json.loads(json.dumps(job.fingerprint() | {"schema": SCHEMA}))
    if folder.exists():
        differs = _differences(_job_of(folder), wanted)
        if differs and not force:
            raise InputError(
                f"{folder} holds parts of another ensemble (other {', '.join(differs)}); finish that one with the options "
                "that it was begun with, give another name, or --force to delete the folder"
            )
        if differs:
            shutil.rmtree(folder)
    if not folder.exists():
        with whole_folder(folder) as temporary:
            (temporary / JOB).write_text(json.dumps(wanted, indent=1) + "\n", encoding="utf-8")
    parts = (StatisticsParts if job.statistics_only else Parts)(folder, job)
    parts.resume()
    return parts


def _job_of(folder: Path) -> dict[str, Any]:
    """Return what the parts in a folder belong to.

    Raises:
        InputError: it is no parts folder.
    """
    try:
        content = json.loads((folder / JOB).read_text(encoding="utf-8"))
        if str(content["schema"]).startswith(SCHEMA.partition("/")[0]):
            return content
    except (OSError, ValueError, KeyError, TypeError):
        pass
    raise InputError(f"{folder} exists and is not a parts folder of an ensemble; move it away or give another name")


def _differences(entry: Mapping[str, Any], wanted: Mapping[str, Any]) -> list[str]:
    """Return the names of what differs."""
    return sorted(name for name in {*entry, *wanted} if entry.get(name) != wanted.get(name))


def _save(path: Path, arrays: Arrays) -> None:
    with whole_file(path) as temporary, temporary.open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)


def _load(path: Path) -> dict[str, npt.NDArray[Any]] | None:
    """Return the arrays of a file, None if it is not there or damaged (every array has a checksum)."""
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as stored:
            return {name: stored[name] for name in stored.files}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile):
        return None
