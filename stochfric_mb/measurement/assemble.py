"""From the columns of a file to a run: names, units, signs, time range, checks, uniform grid."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, require_name
from stochfric_mb.measurement.quantities import KNOWN, known_name, split_header
from stochfric_mb.measurement.readers import read_table
from stochfric_mb.measurement.run import Role, Run
from stochfric_mb.measurement.sampling import FROZEN, Places, longest_still, require_finite, require_growing, uniform_grid
from stochfric_mb.measurement.table import Table
from stochfric_mb.measurement.units import same_unit, to_si

Array = npt.NDArray[np.float64]

MOVING = ("position", "velocity", "acceleration", "force", "torque")
"""Channels that stay at one number to the last digit only at rest, or when they are dead."""

TURNS = {"rad": math.tau, "deg": 360.0, "degree": 360.0, "degrees": 360.0, "°": 360.0}
"""Unit of an angle -> one turn."""
WRAPPED = 0.9
"""Jump between neighbouring readings from which an angle has started anew [turns]: what is left it may have moved meanwhile."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class RunEntry:
    """One ``[[runs]]`` entry of a dataset: a file and how to read it."""

    file: Path
    """The measured file, relative to dataset.toml; `$NAME` and `${NAME}` are replaced by environment variables."""
    name: str
    """Name of the run."""
    role: Role = "fit"
    """`fit`: models are fitted to it; `test`: held out, only scored."""
    settings: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Keys of `[mechanism]` whose values in this run differ from the scenario's, in SI units."""
    columns: Mapping[str, str | int] = dataclasses.field(default_factory=dict[str, str | int])
    """Quantity -> name of its column in the file, or its number from 0."""
    units: Mapping[str, str] = dataclasses.field(default_factory=dict[str, str])
    """Quantity -> unit, where the file does not say it or says it wrongly."""
    sign: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Quantity -> 1 or -1, by which it is multiplied."""
    scale: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Quantity -> number by which its column is multiplied, before its unit counts: of a pulley, a gear, counts."""
    signed_bits: Mapping[str, int] = dataclasses.field(default_factory=dict[str, int])
    """Column -> word length of signed integers that the file holds as unsigned ones (two's complement)."""
    skip_rows: int = 0
    """Lines (samples, in other than text files) left out at the start."""
    time_range: tuple[float, float] | None = None
    """First and last time [s] of the run, in the time of the file; all of it if left out."""
    max_gap: float | None = None
    """Longest distance between samples [s] that is bridged by interpolation; four median distances if left out."""


def assemble(entry: RunEntry, *, rotational: bool | None) -> Run:
    """Return the run that an entry of a dataset describes, read from its file and checked.

    Args:
        entry: the file and how to read it.
        rotational: whether the scenario's friction acts about an axis: positions in rad, friction in N m; None: its joints
            are of both kinds, and units say which.

    Raises:
        InputError: the file or the entry cannot be used; names the file, the key or line, and the remedy.
        MissingEngineError: a library that reads the file is not installed.
    """
    table = read_table(entry.file, skip_rows=entry.skip_rows)
    columns, units, notes = _named(entry, table, any_name=rotational is None)
    _require_keys("units", entry.units, columns, entry)
    _require_keys("sign", entry.sign, columns, entry)
    _require_keys("scale", entry.scale, columns, entry)
    _require_keys("signed_bits", entry.signed_bits, columns, entry)
    for name, bits in entry.signed_bits.items():  # before interpolation, which would mix the two ends of the range
        columns[name] = np.where(columns[name] >= 2.0 ** (bits - 1), columns[name] - 2.0**bits, columns[name])
    columns |= {name: factor * columns[name] for name, factor in entry.scale.items()}
    file_units = {name: unit for name, unit in units.items() if name in KNOWN}
    columns, units = _in_si(entry, columns, units, rotational=rotational)
    time = columns.pop("time")
    rows = np.arange(1, time.size + 1, dtype=np.int64) + entry.skip_rows if table.rows is None else table.rows
    kept = _within(time, entry)
    places = Places(str(entry.file), rows[kept], table.row_word)
    time = time[kept]
    require_growing(time, places)
    channels = {k: v[kept] * entry.sign.get(k, 1.0) for k, v in columns.items() if k in KNOWN}
    covariates = {k: v[kept] * entry.sign.get(k, 1.0) for k, v in columns.items() if k not in KNOWN}
    for name, values in channels.items():
        require_finite(name, values, places)
    if rotational is not False:  # before interpolation, which would put readings between the two ends of the turn
        notes += [said for group in (channels, covariates) for k in group if (said := _unwrapped(group, k, units.get(k, "")))]
    grid = uniform_grid(time, places, max_gap=entry.max_gap)
    if grid.note:
        notes.append(grid.note)
        channels = {k: np.interp(grid.time, time, v) for k, v in channels.items()}
        covariates = {k: np.interp(grid.time, time, v) for k, v in covariates.items()}
    notes += [f"{k} is constant ({v[0]:g} {units[k]})" for k, v in channels.items() if v.size and np.ptp(v) == 0.0]
    notes += [said for k, v in channels.items() if (said := _frozen(k, v, grid.time, units[k]))]
    return Run(
        name=entry.name,
        role=entry.role,
        time=grid.time,
        channels=channels,
        settings=dict(entry.settings),
        covariates=covariates,
        units={k: units.get(k, "") for k in (*channels, *covariates)},
        file_units=file_units,
        turned=tuple(k for k in channels if entry.sign.get(k) == -1.0),
        constants=dict(table.constants),
        sample_interval=grid.interval,
        source=str(entry.file),
        notes=tuple(notes),
    )


def _unwrapped(group: dict[str, Array], name: str, unit: str) -> str:
    """Unwrap an angle in a group of columns if it starts anew after each turn; return what is said of that, empty if not."""
    turn, values = TURNS.get(unit, math.inf), group[name]
    jumps = int(np.count_nonzero(np.abs(np.diff(values)) > WRAPPED * turn))
    if not jumps or np.ptp(values) > turn * (1.0 + 1.0e-6):
        return ""
    group[name] = np.unwrap(values, period=turn)
    return f"{name} jumps by a full turn {jumps} times, as an angle does that starts anew after each: it is unwrapped"


def _frozen(name: str, values: Array, time: Array, unit: str) -> str:
    """Return what is said of a channel that moves, and stays at one number for much of the run; nothing where it does not."""
    if name not in MOVING or values.size < 2 or np.ptp(values) == 0.0:
        return ""
    first, last = longest_still(values)
    share = (last - first) / (values.size - 1)
    if share < FROZEN:
        return ""
    return (
        f"{name} stays at {values[first]:g} {unit} from {time[first]:.4g} to {time[last]:.4g} s ({share:.0%} of the run): at "
        "rest, or a dead channel; cut that away with time_range if it is dead"
    )


def _named(entry: RunEntry, table: Table, *, any_name: bool) -> tuple[dict[str, Array], dict[str, str], list[str]]:
    """Return the columns under the names of their quantities, their units, and notes about those left out.

    With ``any_name`` no column has to be a known quantity: an MJCF model maps its joints to columns by their names.
    """
    sources = {quantity: _column(entry, table, quantity, column) for quantity, column in entry.columns.items()}
    taken = set(sources.values())
    notes: list[str] = []
    if table.has_header:
        for name in table.columns:
            if name not in taken:
                quantity = known_name(name) or name
                if quantity in sources:
                    notes.append(f"column {name!r} is left out: {quantity} is column {sources[quantity]!r}")
                else:
                    sources[quantity] = name
    if "time" not in sources:
        raise InputError(
            f"{entry.file}: no column is time; its columns are {_listed(table)}: name one "
            f"time [s], or say which it is with columns = {{ time = ... }}"
        )
    length = table.columns[sources["time"]].size
    short = [q for q, name in sources.items() if table.columns[name].size != length]
    for quantity in short:
        if quantity in KNOWN:
            raise InputError(
                f"{entry.file}: {quantity} has {table.columns[sources[quantity]].size} samples but time has {length}; "
                "give each quantity a value at each time"
            )
        del sources[quantity]
    if short:
        notes.append(f"columns {', '.join(map(repr, short))} are not as long as time and are left out")
    if not any_name and not any(q in KNOWN for q in sources if q != "time"):
        raise InputError(
            f"{entry.file}: no column is a known quantity; its columns are {_listed(table)}: name them after "
            f"{', '.join(k for k in KNOWN if k != 'time')}, or with columns = {{ position = ... }}"
        )
    stated = {q: table.units[name] for q, name in sources.items() if name in table.units}
    notes += [
        f"{q} is taken to be in {entry.units[q]}, as its run says, and not in {unit}, as the file's header does"
        for q, unit in stated.items()
        # what is scaled may be in another unit
        if q in entry.units and q not in entry.scale and not same_unit(entry.units[q], unit)
    ]
    units = stated | dict(entry.units)
    return {q: table.columns[name] for q, name in sources.items()}, units, notes


def _column(entry: RunEntry, table: Table, quantity: str, column: str | int) -> str:
    """Return the table's name of the column that the entry gives a quantity."""
    names = list(table.columns)
    if isinstance(column, int):
        wanted = names[column] if table.has_header and 0 <= column < len(names) else str(column)
        if wanted in names:
            return wanted
        raise InputError(
            f"{entry.file}: columns.{quantity} = {column}, but the file has {_listed(table)}; columns are counted from 0"
        )
    if column in names:
        return column
    if (name := split_header(column)[0]) in names:
        return name
    if not table.has_header:
        raise InputError(
            f"{entry.file}: columns.{quantity} = {column!r}, but the file has no header; give the number of the column, "
            "counted from 0"
        )
    try:
        return require_name(f"column for columns.{quantity}", column, names)
    except InputError as error:
        raise InputError(f"{entry.file}: {error}") from None


def _listed(table: Table) -> str:
    return ", ".join(map(repr, table.columns)) if table.has_header else f"{', '.join(table.columns)} (there is no header)"


def _require_keys(key: str, given: Mapping[str, object], columns: Mapping[str, Array], entry: RunEntry) -> None:
    for name in given:
        try:
            require_name(f"quantity in {key} (a quantity of this run)", name, columns)
        except InputError as error:
            raise InputError(f"{entry.file}: {error}") from None


def _in_si(
    entry: RunEntry, columns: Mapping[str, Array], units: Mapping[str, str], *, rotational: bool | None
) -> tuple[dict[str, Array], dict[str, str]]:
    """Return the columns with known quantities in SI units, and the units."""
    values, result = dict(columns), dict(units)
    for name in (k for k in columns if k in KNOWN):
        quantity = KNOWN[name]
        if name not in units:
            si = quantity.units_of(rotational)[0]
            raise InputError(
                f"{entry.file}: {name} has no unit; write the header as '{name} [{si}]', or give "
                f'units = {{ {name} = "{si}" }}'
            )
        try:
            values[name], result[name] = to_si(columns[name], units[name], quantity, rotational=rotational)
        except InputError as error:
            raise InputError(f"{entry.file}: {error}") from None
    return values, result


def _within(time: Array, entry: RunEntry) -> npt.NDArray[np.bool_]:
    if entry.time_range is None:
        return np.ones(time.size, dtype=np.bool_)
    start, end = entry.time_range
    kept = (time >= start) & (time <= end)
    if not kept.any():
        raise InputError(
            f"{entry.file}: time_range = [{start:g}, {end:g}] s holds no sample; the file goes from {np.nanmin(time):g} to "
            f"{np.nanmax(time):g} s"
        )
    return kept
