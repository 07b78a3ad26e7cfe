"""Arrays of HDF5 files, read by h5py."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.quantities import split_header
from stochfric_mb.measurement.readers.arrays import table_of
from stochfric_mb.measurement.table import Table

SIGNATURE = b"\x89HDF\r\n\x1a\n"
"""First bytes of HDF5 content."""


def read(path: Path, *, skip_rows: int = 0) -> Table:
    """Return the numeric arrays; names are ``group/name``, or ``name`` where all are in one group.

    A unit stands in the name (``position [mm]``) or in the array's attribute ``units`` or ``unit``.

    Raises:
        InputError: not an HDF5 file.
    """
    arrays = arrays_in(path)
    groups = {name.rpartition("/")[0] for name, _, _ in arrays}
    items: list[tuple[str, Any]] = []
    units: dict[str, str] = {}
    for full, value, stored in arrays:
        name, unit = split_header(full.rpartition("/")[2] if len(groups) == 1 else full)
        items.append((name, value))
        if unit is not None or stored is not None:
            units[name] = unit if unit is not None else (stored or "")
    return table_of(path, items, units=units, skip_rows=skip_rows)


def arrays_in(path: Path) -> list[tuple[str, Any, str | None]]:
    """Return name, value and unit of each numeric array in an HDF5 file, in its order.

    Raises:
        InputError: not an HDF5 file.
    """
    library: Any = importlib.import_module("h5py")
    columns: list[tuple[str, Any, str | None]] = []

    def visit(name: str, node: Any) -> None:
        if isinstance(node, library.Dataset) and node.dtype.kind in "biuf" and not name.startswith("#"):
            unit = node.attrs.get("units", node.attrs.get("unit"))
            columns.append((name, node[()], unit.decode() if isinstance(unit, bytes) else unit))

    try:
        with library.File(path, "r") as file:
            file.visititems(visit)
    except OSError as error:
        raise InputError(f"{path}: not an HDF5 file: {error}") from None
    return columns
