"""Logs in JSON: a list of records, a table of columns, or either inside an object with further numbers about the run."""

from __future__ import annotations

import codecs
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

import numpy as np

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.quantities import split_header
from stochfric_mb.measurement.readers.arrays import table_of
from stochfric_mb.measurement.table import Array, Table

PEEKED = 65536
"""Bytes of a large file that are looked at before all of it is read."""


def read(path: Path, *, skip_rows: int = 0) -> Table:
    """Return the numeric columns of a log; numbers beside them are constants.

    ``[{"t": 0.0, "x": 0.1}, ...]``, ``{"t": [0.0, ...], "x": [0.1, ...]}``, ``{"mass": 0.5, "entries": [{...}, ...]}``, and one
    record a line (``.jsonl``). A key that a record lacks is a missing value; words are left out; truth values are 0 and 1.

    Raises:
        InputError: not JSON, or nothing in it is a table.
    """
    content = _loaded(path)
    about: Mapping[str, Any] = {}
    if isinstance(content, Mapping):
        about = cast(Mapping[str, Any], content)
        content = _records(about) or _lists(about)
    if not isinstance(content, list | Mapping):
        raise InputError(f"{path}: a single value, no log; store a list of records")
    columns = _columns(cast(list[Any], content)) if isinstance(content, list) else cast(Mapping[str, Any], content)
    units: dict[str, str] = {}
    items: list[tuple[str, Any]] = []
    for header, values in columns.items():
        name, unit = split_header(header)
        items.append((name, _numbers(values)))
        if unit is not None:
            units[name] = unit
    numbers = [(k, v) for k, v in about.items() if isinstance(v, int | float)]
    return table_of(path, items + numbers, units=units, skip_rows=skip_rows)


def _loaded(path: Path) -> Any:
    try:
        with path.open("rb") as file:
            start = codecs.getincrementaldecoder("utf-8-sig")().decode(file.read(PEEKED))
        if len(start) > PEEKED // 4 and start.lstrip()[:1] not in ("{", "["):  # a short file is read, and told more of
            raise InputError(f"{path}: not JSON: it begins with {start[:20]!r}, not with {{ or [")
        text = path.read_text(encoding="utf-8-sig")
        if path.suffix.lower() == ".jsonl":
            return [json.loads(line) for line in text.splitlines() if line.strip()]
        return json.loads(text)
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: not JSON: {error}") from None


def _records(about: Mapping[str, Any]) -> list[Any]:
    """Return the longest list of records in an object; empty if there is none."""
    lists = [cast(list[Any], v) for v in about.values() if isinstance(v, list)]
    return max((v for v in lists if v and isinstance(v[0], Mapping)), key=len, default=list[Any]())


def _lists(about: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the lists of an object, or of the first object in it that has lists."""
    own: dict[str, Any] = {k: v for k, v in about.items() if isinstance(v, list)}
    if own:
        return own
    inner = [cast(Mapping[str, Any], v) for v in about.values() if isinstance(v, Mapping)]
    return next((result for v in inner if (result := _lists(v))), own)


def _columns(records: list[Any]) -> dict[str, list[Any]]:
    rows = [cast(Mapping[str, Any], record) for record in records if isinstance(record, Mapping)]
    names = dict.fromkeys(key for row in rows for key in row)
    return {name: [row.get(name) for row in rows] for name in names}


def _numbers(values: Any) -> Array:
    """Return the values as float64[n], NaN for missing ones; empty if any is a word or a table."""
    if not all(v is None or isinstance(v, int | float) for v in values):
        return np.empty(0)
    return np.array([math.nan if v is None else float(v) for v in values])
