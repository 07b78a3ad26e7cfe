"""Readers of measured files, one file each; `READERS` is the registry: ending of the file -> module with ``read``.

A reader module has one function::

    read(path, *, skip_rows=0) -> Table

`skip_rows` lines of a text file, or samples of any other, are left out at its start. Readers of other packages join by
an entry point in the group `GROUP`, name = ending without the dot, value = module; or by `register_reader`.
"""

from __future__ import annotations

import importlib
import importlib.metadata
from pathlib import Path
from typing import Protocol

from stochfric_mb.errors import InputError, MissingEngineError
from stochfric_mb.measurement.table import Table

GROUP = "stochfric_mb.readers"
"""Group of the entry points by which other packages bring readers."""


class Reader(Protocol):
    """What returns the columns of a file."""

    def __call__(self, path: Path, *, skip_rows: int = 0) -> Table:
        """Return the columns of the file ``path``; raise `InputError` where it is none of this format."""
        ...


_HERE = "stochfric_mb.measurement.readers"
_BUILT_IN: dict[str, str | Reader] = {
    ".csv": f"{_HERE}.text",
    ".tsv": f"{_HERE}.text",
    ".txt": f"{_HERE}.text",
    ".dat": f"{_HERE}.text",
    ".parquet": f"{_HERE}.parquet",
    ".mat": f"{_HERE}.matlab",
    ".tdms": f"{_HERE}.tdms",
    ".uff": f"{_HERE}.uff58",
    ".unv": f"{_HERE}.uff58",
    ".h5": f"{_HERE}.hdf5",
    ".hdf5": f"{_HERE}.hdf5",
    ".nc": f"{_HERE}.netcdf",
    ".json": f"{_HERE}.json_log",
    ".jsonl": f"{_HERE}.json_log",
}


def _brought() -> dict[str, str | Reader]:
    """Return the readers that installed packages bring by an entry point; nothing is loaded."""
    return {f".{entry.name.lower()}": entry.module for entry in importlib.metadata.entry_points(group=GROUP)}


READERS: dict[str, str | Reader] = _brought() | _BUILT_IN
"""Ending of a file -> the module of its reader, or the reader itself if a user registered it."""


def register_reader(ending: str, reader: Reader) -> Reader:
    """Add a reader to the registry of this process, in the place of one for the same ending; return it.

    Args:
        ending: of the files, such as ``.log``.
        reader: what reads them.
    """
    READERS[ending.lower()] = reader
    return reader


def read_table(path: Path, *, skip_rows: int = 0) -> Table:
    """Return the columns of a measured file, by the reader for its ending.

    Raises:
        InputError: no such file, no reader for its ending, or not a file of that format.
        MissingEngineError: the reader's library is not installed; says what to install.
    """
    if not path.is_file():
        raise InputError(f"{path}: no such file; give the path relative to the file that names it")
    ending = path.suffix.lower()
    if ending not in READERS:
        raise InputError(f"{path}: there is no reader for {ending!r}; known: {', '.join(sorted(READERS))}")
    entry = READERS[ending]
    read: Reader = importlib.import_module(entry).read if isinstance(entry, str) else entry
    return read(path, skip_rows=skip_rows)


def missing(library: str, what: str, extra: str = "measured") -> MissingEngineError:
    """Return the error for a reader whose library is not installed."""
    return MissingEngineError(
        f"{what} files are read by {library}, which is not installed; in a clone of this package run: "
        f"pip install '.[{extra}]', or convert the file to CSV"
    )
