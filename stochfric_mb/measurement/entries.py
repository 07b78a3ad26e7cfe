"""The ``[[runs]]`` of a dataset file: keys, types, environment variables."""

from __future__ import annotations

import dataclasses
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

from stochfric_mb.errors import InputError, require_name, require_number
from stochfric_mb.measurement.assemble import RunEntry
from stochfric_mb.measurement.run import require_role

SCHEMA = "stochfric.dataset/1"
DATA = "STOCHFRIC_DATA"
"""Environment variable of the folder with measured data."""

_TABLES = ("schema", "title", "scenario", "runs")
RUN_KEYS = (
    "file", "name", "role", "set", "columns", "units", "sign", "scale", "signed_bits", "skip_rows", "time_range", "max_gap",
)  # fmt: skip


def run_entries(tables: Mapping[str, Any], folder: Path) -> list[RunEntry]:
    """Return the runs that the content of a dataset file names.

    Args:
        tables: content of the TOML file.
        folder: what its file names are relative to.

    Raises:
        InputError: unknown or missing key, wrong type or value.
    """
    for key in tables:
        require_name("key", key, _TABLES)
    if tables.get("schema") != SCHEMA:
        raise InputError(f"schema = {tables.get('schema')!r}; this version reads {SCHEMA!r}")
    runs = tables.get("runs")
    if not isinstance(runs, list) or not runs:
        raise InputError("no runs; add a [[runs]] table with file and role for each record")
    entries = [_entry(_mapping(run, f"runs {i}"), i, folder) for i, run in enumerate(cast(list[Any], runs), start=1)]
    return _named_apart(entries)


def expanded(text: str) -> str:
    """Return ``text`` with its environment variables, ``$NAME`` or ``${NAME}``, replaced by their values.

    Without ``STOCHFRIC_DATA`` the folder ``../shared/data`` beside the project stands in for it, if there is one.

    Raises:
        InputError: a variable is not set.
    """

    def value(match: re.Match[str]) -> str:
        name = match.group(1) or match.group(2)
        if name in os.environ:
            return os.environ[name]
        if name == DATA and (beside := data_folder()) is not None:
            return str(beside)
        raise InputError(
            f"file = {text!r}: the environment variable {name} is not set; set it to the folder that holds the files, "
            f"or write the folder instead of ${{{name}}}"
        )

    return re.sub(r"\$(?:\{(\w+)\}|(\w+))", value, text)


def data_folder() -> Path | None:
    """Return the folder of measured data: ``STOCHFRIC_DATA``, or ``../shared/data`` beside the project, or None."""
    given = os.environ.get(DATA)
    folder = Path(given) if given else Path(__file__).resolve().parents[3] / "shared" / "data"
    return folder if folder.is_dir() else None


def _entry(run: Mapping[str, Any], number: int, folder: Path) -> RunEntry:
    where = f"runs {number}"
    for key in run:
        require_name(f"key of {where}", key, RUN_KEYS)
    for key in ("file", "role"):
        if not isinstance(run.get(key), str):
            raise InputError(f'{where}: {key} = {run.get(key)!r}; write {key} = "{"run.csv" if key == "file" else "fit"}"')
    require_role(where, run["role"])
    file = Path(expanded(run["file"]))
    return RunEntry(
        file=file if file.is_absolute() else folder / file,
        name=str(run.get("name", file.stem)),
        role=run["role"],
        settings={k: require_number(f"{where}: set.{k}", v) for k, v in _table(run, "set", where).items()},
        columns={k: _column(v, f"{where}: columns.{k}") for k, v in _table(run, "columns", where).items()},
        units={k: _text(v, f"{where}: units.{k}") for k, v in _table(run, "units", where).items()},
        sign={k: _sign(v, f"{where}: sign.{k}") for k, v in _table(run, "sign", where).items()},
        scale={k: _scale(v, f"{where}: scale.{k}") for k, v in _table(run, "scale", where).items()},
        signed_bits={k: _count(v, f"{where}: signed_bits.{k}") for k, v in _table(run, "signed_bits", where).items()},
        skip_rows=_count(run.get("skip_rows", 0), f"{where}: skip_rows"),
        time_range=_range(run["time_range"], where) if "time_range" in run else None,
        max_gap=require_number(f"{where}: max_gap", run["max_gap"], above=0.0, unit="s") if "max_gap" in run else None,
    )


def _named_apart(entries: list[RunEntry]) -> list[RunEntry]:
    """Return the entries with a number behind names that several have."""
    names = [entry.name for entry in entries]
    return [
        dataclasses.replace(entry, name=f"{entry.name} #{names[: i + 1].count(entry.name)}")
        if names.count(entry.name) > 1
        else entry
        for i, entry in enumerate(entries)
    ]


def _mapping(value: Any, where: str) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise InputError(f"{where} = {value!r} is not a table of keys and values")
    return cast(Mapping[str, Any], value)


def _table(run: Mapping[str, Any], key: str, where: str) -> Mapping[str, Any]:
    return _mapping(run.get(key, {}), f"{where}: {key}")


def _column(value: Any, where: str) -> str | int:
    if isinstance(value, bool) or not isinstance(value, str | int):
        raise InputError(f"{where} = {value!r}; give the name of a column, or its number counted from 0")
    return value


def _text(value: Any, where: str) -> str:
    if not isinstance(value, str):
        raise InputError(f'{where} = {value!r}; give a unit in quotes, such as "mm"')
    return value


def _sign(value: Any, where: str) -> float:
    if isinstance(value, bool) or value not in (1, -1):
        raise InputError(f"{where} = {value!r}; a sign is 1 or -1 (units and scale hold other factors)")
    return float(value)


def _scale(value: Any, where: str) -> float:
    if (factor := require_number(where, value)) == 0.0:
        raise InputError(f"{where} = {value!r}; a column times 0 shows nothing: give the factor, such as 1/radius of a pulley")
    return factor


def _count(value: Any, where: str) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise InputError(f"{where} = {value!r}; give a whole number >= 0")
    return value


def _range(value: Any, where: str) -> tuple[float, float]:
    if not isinstance(value, list) or len(cast(list[Any], value)) != 2:
        raise InputError(f"{where}: time_range = {value!r}; give [first, last] in s")
    start, end = (require_number(f"{where}: time_range", v, unit="s") for v in cast(list[Any], value))
    if start >= end:
        raise InputError(f"{where}: time_range = [{start:g}, {end:g}]; the first must be before the last")
    return start, end
