"""Trajectories in NetCDF, CSV and Parquet."""

from __future__ import annotations

import csv
import importlib
import io
import json
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, MissingEngineError
from stochfric_mb.outputs import check_target, whole_file
from stochfric_mb.scenario import Scenario
from stochfric_mb.trajectory import COLUMNS, MORE_COLUMNS, Trajectory

SCHEMA = "stochfric.trajectory/1"
KNOWN = COLUMNS | MORE_COLUMNS
"""Every column that a file may have."""

Array = npt.NDArray[np.float64]
Attributes = dict[str, Any]


def trajectory_ending(path: str | Path) -> str:
    """Return the ending of a trajectory file.

    Raises:
        InputError: it is none of those that can be written.
    """
    ending = Path(path).suffix.lower()
    if ending not in FORMATS:
        raise InputError(f"{path}: ending {ending!r} is unknown; a trajectory is written as {', '.join(FORMATS)}")
    if ending == ".parquet":
        _pyarrow()
    return ending


def write_trajectory(
    trajectory: Trajectory, path: str | Path, *, scenario: Scenario | None = None, force: bool = False
) -> Path:
    """Return the path of the file that now holds ``trajectory``; it is written whole or not at all.

    Args:
        trajectory: what to write.
        path: target; its ending is ``.nc`` (NetCDF 4), ``.csv`` or ``.parquet``. Missing folders are made.
        scenario: what was simulated; kept in NetCDF and Parquet files as its TOML text.
        force: whether an existing file is replaced.

    Raises:
        InputError: unknown ending, or the file exists.
        MissingEngineError: Parquet without pyarrow.
    """
    ending = trajectory_ending(path)
    target = check_target(path, force=force)
    write = FORMATS[ending][0]
    with whole_file(target, replace=force) as temporary:
        write(trajectory.columns(), _attributes(trajectory, scenario), temporary)
    return target


def read_trajectory(path: str | Path) -> Trajectory:
    """Return the trajectory in a file that `write_trajectory` wrote (a CSV file has no attributes).

    Raises:
        InputError: no such file, unknown ending, or a content that is not a trajectory; names the file and the place.
        MissingEngineError: Parquet without pyarrow.
    """
    ending = trajectory_ending(path)
    path = Path(path)
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    columns, attributes = FORMATS[ending][1](path)
    for name in COLUMNS:
        if name not in columns:
            raise InputError(f"{path}: column {name!r} is missing; a trajectory has {', '.join(COLUMNS)}")
        if (bad := np.flatnonzero(~np.isfinite(columns[name]))).size:
            raise InputError(f"{path}, sample {bad[0] + 1}: {name} is not finite; remove or correct the sample")
    if (bad := np.flatnonzero(np.diff(columns["time"]) <= 0.0)).size:
        raise InputError(f"{path}, sample {bad[0] + 2}: time does not grow; sort the samples and remove repeated ones")
    more = {name: columns[name] for name in MORE_COLUMNS if name in columns}
    return Trajectory(**{name: columns[name] for name in COLUMNS}, **more, attributes=attributes)


def versions(*packages: str) -> dict[str, str]:
    """Return the versions of Python, of this package and of those it computes with: name -> version."""
    import importlib.metadata
    import platform

    from stochfric_mb import __version__

    own = {"python": platform.python_version(), "stochfric_mb": __version__}
    return own | {p: importlib.metadata.version(p) for p in ("numpy", "scipy", "numba", *packages)}


def _attributes(trajectory: Trajectory, scenario: Scenario | None) -> Attributes:
    """Return what a file says about itself: strings and numbers only."""
    import tomli_w

    given = dict(trajectory.attributes)
    notes = "\n".join(given.pop("notes", []))
    values: Attributes = {"schema": SCHEMA, "title": scenario.title if scenario else ""} | given
    values |= {"notes": notes, "versions": json.dumps(versions())}
    if scenario is not None:
        values["scenario"] = tomli_w.dumps(scenario.to_dict())
    values = {k: int(v) if isinstance(v, bool) else v for k, v in values.items()}  # NetCDF has no truth values
    return {k: v if isinstance(v, str | int | float) else json.dumps(v) for k, v in values.items()}


def _restored(stored: Mapping[str, Any]) -> Attributes:
    """Return the attributes of a file as they were before `_attributes`."""
    values: Attributes = {k: v.item() if isinstance(v, np.generic) else v for k, v in stored.items()}
    values["notes"] = str(values.get("notes", "")).splitlines()
    return values


def _write_netcdf(columns: Mapping[str, Array], attributes: Attributes, path: Path) -> None:
    import xarray

    variables = {
        name: ("time", column, {"units": _cf_unit(KNOWN[name][0]), "long_name": KNOWN[name][1]})
        for name, column in columns.items()
    }
    time = variables.pop("time")
    dataset: Any = xarray.Dataset(variables, coords={"time": time}, attrs={"Conventions": "CF-1.11"} | attributes)
    write_netcdf(dataset, path)


def write_netcdf(dataset: Any, path: Path, *, encoding: Mapping[str, Any] | None = None) -> None:
    """Write an `xarray.Dataset` as NetCDF 4: built in memory, because the HDF5 library crashes where a disk is full.

    Args:
        dataset: what to write.
        path: target.
        encoding: variable -> how it is packed, as of `xarray.Dataset.to_netcdf`.

    Raises:
        OSError: the file cannot be written.
    """
    content = io.BytesIO()
    dataset.to_netcdf(content, engine="h5netcdf", encoding=encoding)
    path.write_bytes(content.getbuffer())


def _cf_unit(unit: str) -> str:
    return {"-": "1", "m/s": "m s-1"}.get(unit, unit)


def _read_netcdf(path: Path) -> tuple[dict[str, Array], Attributes]:
    import xarray

    library: Any = xarray
    try:
        with library.open_dataset(path, engine="h5netcdf", decode_times=False) as dataset:
            columns = {str(n): np.asarray(dataset[n].values, dtype=np.float64) for n in KNOWN if n in dataset}
            attributes = _restored({str(k): v for k, v in dataset.attrs.items()})
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: not a NetCDF 4 file: {error}") from None
    if attributes.get("schema") != SCHEMA:
        raise InputError(f"{path}: schema = {attributes.get('schema')!r}; this version reads {SCHEMA!r}")
    return columns, attributes


def _headers(names: Iterable[str] = COLUMNS) -> list[str]:
    return [f"{name} [{KNOWN[name][0]}]" for name in names]


def _write_csv(columns: Mapping[str, Array], _attributes: Attributes, path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(_headers(columns))
        writer.writerows(zip(*(column.tolist() for column in columns.values()), strict=True))


def _read_csv(path: Path) -> tuple[dict[str, Array], Attributes]:
    with path.open(newline="", encoding="utf-8") as file:
        header, *rows = list(csv.reader(file)) or [[]]
    names = [_name_of(path, text) for text in header]
    values = np.empty((len(rows), len(names)))
    for number, row in enumerate(rows):
        try:
            values[number] = [float(text) for text in row]
        except ValueError:
            raise InputError(f"{path}, row {number + 2}: expected {len(names)} numbers, got {','.join(row)!r}") from None
    return dict(zip(names, values.T.copy(), strict=True)), {}


def _write_parquet(columns: Mapping[str, Array], attributes: Attributes, path: Path) -> None:
    arrow = _pyarrow()
    table = arrow.table(dict(zip(_headers(columns), columns.values(), strict=True)))
    arrow.parquet.write_table(table.replace_schema_metadata({"stochfric": json.dumps(attributes)}), path)


def _read_parquet(path: Path) -> tuple[dict[str, Array], Attributes]:
    arrow = _pyarrow()
    table: Any
    try:
        table = arrow.parquet.read_table(path)
    except arrow.ArrowInvalid as error:
        raise InputError(f"{path}: not a Parquet file: {error}") from None
    metadata: dict[bytes, bytes] = table.schema.metadata or {}
    stored = metadata.get(b"stochfric", b"{}")
    columns = {_name_of(path, n): table[n].to_numpy() for n in table.column_names}
    return columns, _restored(json.loads(stored))


def _name_of(path: Path, header: str) -> str:
    """Return the quantity of a header such as ``position [m]``."""
    match = re.fullmatch(r"\s*(\w+) \[(.+)\]\s*", header)
    name, unit = match.groups() if match else (header, "")
    if name not in KNOWN or unit != KNOWN[name][0]:
        raise InputError(f"{path}: column {header!r} is unknown; a trajectory has {', '.join(_headers())}")
    return name


def _pyarrow() -> Any:
    try:
        arrow = importlib.import_module("pyarrow")
        importlib.import_module("pyarrow.parquet")
    except ImportError:
        raise MissingEngineError(
            "Parquet files need pyarrow, which is not installed; in a clone of this package run: pip install '.[parquet]', "
            "or write .nc or .csv"
        ) from None
    return arrow


Writer = Callable[[Mapping[str, Array], Attributes, Path], None]
Reader = Callable[[Path], tuple[dict[str, Array], Attributes]]

FORMATS: dict[str, tuple[Writer, Reader]] = {
    ".nc": (_write_netcdf, _read_netcdf),
    ".csv": (_write_csv, _read_csv),
    ".parquet": (_write_parquet, _read_parquet),
}
"""Ending of a trajectory file -> what writes and what reads it."""
