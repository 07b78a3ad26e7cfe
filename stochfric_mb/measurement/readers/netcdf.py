"""Variables of NetCDF files, read by xarray: NetCDF 4 through h5netcdf, the classic format through SciPy."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.readers.arrays import table_of
from stochfric_mb.measurement.table import Table


def read(path: Path, *, skip_rows: int = 0) -> Table:
    """Return the numeric variables, fill values as NaN; units are those of the attribute ``units``.

    A time in ``seconds since ...`` is kept as seconds.

    Raises:
        InputError: not a NetCDF file.
    """
    library: Any = importlib.import_module("xarray")
    with path.open("rb") as file:
        engine = "scipy" if file.read(3) == b"CDF" else "h5netcdf"
    try:
        with library.open_dataset(path, engine=engine, decode_times=False) as dataset:
            items = [(str(name), variable.values) for name, variable in dataset.variables.items()]
            stated = {str(name): variable.attrs.get("units") for name, variable in dataset.variables.items()}
    except (OSError, ValueError, TypeError) as error:
        raise InputError(f"{path}: not a NetCDF file: {error}") from None
    units = {name: str(unit).partition(" since ")[0] for name, unit in stated.items() if unit is not None}
    return table_of(path, items, units=units, skip_rows=skip_rows)
