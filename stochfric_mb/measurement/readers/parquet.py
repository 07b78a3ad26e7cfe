"""Columns of Parquet files, read by pyarrow."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.quantities import split_header
from stochfric_mb.measurement.readers import missing
from stochfric_mb.measurement.readers.arrays import table_of
from stochfric_mb.measurement.table import Table


def read(path: Path, *, skip_rows: int = 0) -> Table:
    """Return the numeric columns; a unit stands in the name (``position [mm]``) or in the field's metadata (``unit``).

    Raises:
        InputError: not a Parquet file.
        MissingEngineError: pyarrow is not installed.
    """
    try:
        arrow: Any = importlib.import_module("pyarrow")
        parquet: Any = importlib.import_module("pyarrow.parquet")
    except ImportError:
        raise missing("pyarrow", "Parquet", "parquet") from None
    try:
        table = parquet.read_table(path)
    except (arrow.ArrowInvalid, OSError) as error:
        raise InputError(f"{path}: not a Parquet file: {error}") from None
    items: list[tuple[str, Any]] = []
    units: dict[str, str] = {}
    for field in table.schema:
        name, unit = split_header(field.name)
        about: dict[bytes, bytes] = field.metadata or {}
        stored = about.get(b"unit", about.get(b"units"))
        items.append((name, np.atleast_1d(table[field.name].to_numpy())))
        if unit is not None or stored is not None:
            units[name] = unit if unit is not None else (stored or b"").decode()
    return table_of(path, items, units=units, skip_rows=skip_rows)
