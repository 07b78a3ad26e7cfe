"""From arrays of any shape, as binary files hold them, to columns and constants."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.table import Array, Table


def columns_of(name: str, value: Any) -> dict[str, Array]:
    """Return the columns in an array: itself if it is a vector, ``name[0]``, ``name[1]`` ... for the shorter side of a matrix.

    What is not numeric, complex or of more dimensions gives none. Truth values are 0 and 1.
    """
    values = np.asarray(value)
    if values.dtype.kind not in "biuf":
        return {}
    values = np.squeeze(values).astype(np.float64)
    if values.ndim == 1:
        return {name: values}
    if values.ndim != 2:
        return {}
    upright = values if values.shape[0] >= values.shape[1] else values.T
    return {f"{name}[{i}]": upright[:, i].copy() for i in range(upright.shape[1])}


def constants_of(name: str, value: Any) -> dict[str, float]:
    """Return a single number under its name; nothing if the value is none."""
    values = np.asarray(value)
    return {name: float(values.ravel()[0])} if values.size == 1 and values.dtype.kind in "biuf" else {}


def table_of(path: Path, items: Iterable[tuple[str, Any]], *, units: dict[str, str] | None = None, skip_rows: int = 0) -> Table:
    """Return the table of named arrays and numbers.

    Args:
        path: the file, for messages.
        items: names and values.
        units: name -> unit, where the file says it.
        skip_rows: samples left out at the start of each column.

    Raises:
        InputError: there is no column, or none is left.
    """
    columns: dict[str, Array] = {}
    constants: dict[str, float] = {}
    for name, value in items:
        if name in columns or name in constants:
            raise InputError(f"{path}: {name!r} is there twice; give each its own name")
        single = constants_of(name, value)
        constants |= single
        if not single:
            columns |= {k: v for k, v in columns_of(name, value).items() if v.size}
    if not columns:
        raise InputError(f"{path}: no columns of numbers in it; store time and the measured quantities as arrays")
    if skip_rows >= max(values.size for values in columns.values()):
        raise InputError(f"{path}: no samples after skip_rows = {skip_rows}; lower it")
    n = max(values.size for values in columns.values())
    return Table(
        columns={name: values[skip_rows:] for name, values in columns.items()},
        units={name: unit for name, unit in (units or {}).items() if name in columns},
        constants=constants,
        rows=np.arange(1 + skip_rows, n + 1, dtype=np.int64),
    )
