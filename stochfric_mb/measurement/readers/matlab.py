"""Variables of MATLAB files: versions 5 to 7.2 by SciPy, version 7.3 (which is HDF5) by h5py."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.readers.arrays import table_of
from stochfric_mb.measurement.readers.hdf5 import SIGNATURE, arrays_in
from stochfric_mb.measurement.table import Table

_V73_OFFSET = 512
"""MATLAB writes its own text before the HDF5 content [bytes]."""
_ENDS_5 = slice(126, 128)
"""Where a file of versions 5 to 7.2 says its byte order, by the letters MI [bytes]."""
_MOST_4 = 5000
"""Bound of the type number with which a file of version 4 begins (MOPT: at most 4052)."""


def read(path: Path, *, skip_rows: int = 0) -> Table:
    """Return the numeric variables; those of a struct are ``struct.field``, and single numbers are constants.

    Raises:
        InputError: not a MATLAB file.
    """
    if not (_is_v73(path) or _may_be_older(path)):
        raise InputError(f"{path}: not a MATLAB file: it begins like none of the versions 4 to 7.3")
    items = [(n.replace("/", "."), v) for n, v, _ in arrays_in(path)] if _is_v73(path) else list(_version_5(path))
    return table_of(path, items, skip_rows=skip_rows)


def _is_v73(path: Path) -> bool:
    with path.open("rb") as file:
        start = file.read(_V73_OFFSET + len(SIGNATURE))
    return start.startswith(SIGNATURE) or start[_V73_OFFSET:] == SIGNATURE


def _may_be_older(path: Path) -> bool:
    """Return whether a file begins like version 4 to 7.2: SciPy reads all of another before it says so."""
    with path.open("rb") as file:
        start = file.read(_ENDS_5.stop)
    return start[_ENDS_5] in (b"MI", b"IM") or any(int.from_bytes(start[:4], order) < _MOST_4 for order in ("little", "big"))


def _version_5(path: Path) -> Iterator[tuple[str, Any]]:
    library: Any = importlib.import_module("scipy.io")
    try:
        variables = library.loadmat(path, squeeze_me=True, struct_as_record=True)
    except (ValueError, TypeError, OSError, NotImplementedError, library.matlab.MatReadError) as error:
        raise InputError(f"{path}: not a MATLAB file: {error}") from None
    for name, value in variables.items():
        if not name.startswith("__"):
            yield from _flat(name, value)


def _flat(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Give the variables in a value: itself, or the fields of a struct."""
    fields: tuple[str, ...] | None = getattr(getattr(value, "dtype", None), "names", None)
    if fields is None:
        yield name, value
        return
    if np.ndim(value) != 0:  # an array of structs is no table of columns
        return
    for field in fields:
        inner = value[field]
        yield from _flat(f"{name}.{field}", inner.item() if getattr(inner, "dtype", None) == np.dtype(object) else inner)
