"""Time records of universal files (UFF, data set 58, text or binary), read by pyuff."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.readers import missing
from stochfric_mb.measurement.readers.arrays import table_of
from stochfric_mb.measurement.table import Table

FUNCTION = 58
"""Type of the data sets that hold functions."""
PEEKED = 65536
"""Bytes of a file in which its first data set must begin."""
TIME = 17
"""Code of time among the kinds of data on the abscissa."""
KINDS = {5: "temperature", 8: "position", 9: "force", 11: "velocity", 12: "acceleration", 13: "force", 15: "pressure"}
"""Codes of the kinds of data on the ordinate that are known quantities (record 9, field 1)."""


def read(path: Path, *, skip_rows: int = 0) -> Table:
    """Return the records over time; time is ``time``.

    A record is named by the label of its ordinate, by the kind of its data, or by its id; where several would have one
    name, node and direction are added: ``position_7_x``. A label ``NONE`` is none.

    Raises:
        InputError: not a universal file, or none of its data sets 58 is over time.
        MissingEngineError: pyuff is not installed.
    """
    try:
        pyuff: Any = importlib.import_module("pyuff")
    except ImportError:
        raise missing("pyuff", "UFF") from None
    with path.open("rb") as start:
        if all(line.strip() != b"-1" for line in start.read(PEEKED).splitlines()):
            raise InputError(f"{path}: not a universal file: no data set begins with a line -1")
    try:
        file = pyuff.UFF(str(path))
        chosen = [i for i, kind in enumerate(file.get_set_types()) if int(kind) == FUNCTION]
        sets: list[dict[str, Any]] = [file.read_sets(i) for i in chosen]
    except Exception as error:  # pyuff raises bare Exception
        raise InputError(f"{path}: not a universal file that can be read: {error}") from None
    records = [s for s in sets if int(s.get("abscissa_spec_data_type", 0)) == TIME]
    if not records:
        raise InputError(f"{path}: none of its {len(sets)} data sets 58 is over time; export time histories")
    clock = np.asarray(records[0]["x"], dtype=np.float64)
    items: list[tuple[str, Any]] = [("time", clock)]
    units = {"time": _label(records[0], "abscissa_axis_units_lab") or "s"}
    names = [_name(record) for record in records]
    for record, plain in zip(records, names, strict=True):
        if not np.array_equal(record["x"], clock):
            raise InputError(f"{path}: record {plain!r} has other time stamps than the first; export one clock to a file")
        name = plain if names.count(plain) == 1 else f"{plain}_{record['rsp_node']}_{_direction(record)}"
        items.append((name, record["data"]))
        if unit := _label(record, "ordinate_axis_units_lab"):
            units[name] = unit
    return table_of(path, items, units=units, skip_rows=skip_rows)


def _label(record: dict[str, Any], key: str) -> str:
    text = str(record.get(key, "")).strip()
    return "" if text.upper() == "NONE" else text


def _name(record: dict[str, Any]) -> str:
    kind = KINDS.get(int(record.get("ordinate_spec_data_type", 0)), "")
    return _label(record, "ordinate_axis_lab") or kind or _label(record, "id1") or "record"


def _direction(record: dict[str, Any]) -> str:
    """Return the direction of the response, such as ``-x`` (1 to 3: along an axis, 4 to 6: about it)."""
    code = int(record.get("rsp_dir", 0))
    axes = ("0", "x", "y", "z", "rx", "ry", "rz")
    return ("-" if code < 0 else "") + (axes[abs(code)] if abs(code) < len(axes) else str(abs(code)))
