"""Channels of TDMS files (LabVIEW), read by npTDMS."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.quantities import known_name, split_header
from stochfric_mb.measurement.readers import missing
from stochfric_mb.measurement.readers.arrays import table_of
from stochfric_mb.measurement.table import Table

_INCREMENT = "wf_increment"
"""Property of a waveform channel: distance between its samples [s]."""


def read(path: Path, *, skip_rows: int = 0) -> Table:
    """Return the numeric channels; names are ``group/channel``, or ``channel`` where there is one group.

    Units are those of the property ``unit_string``. Where no channel is the time, the waveform's own is taken.

    Raises:
        InputError: not a TDMS file.
        MissingEngineError: npTDMS is not installed.
    """
    try:
        nptdms: Any = importlib.import_module("nptdms")
    except ImportError:
        raise missing("npTDMS", "TDMS") from None
    try:
        file = nptdms.TdmsFile.read(path)
    except (ValueError, KeyError, OSError, EOFError) as error:
        raise InputError(f"{path}: not a TDMS file: {error}") from None
    groups = file.groups()
    items: list[tuple[str, Any]] = []
    units: dict[str, str] = {}
    clock: Any = None
    for group in groups:
        for channel in group.channels():
            name, unit = split_header(channel.name if len(groups) == 1 else f"{group.name}/{channel.name}")
            items.append((name, channel[:]))
            stated = unit if unit is not None else channel.properties.get("unit_string")
            if stated:
                units[name] = str(stated)
            if clock is None and channel.properties.get(_INCREMENT):
                clock = channel.time_track()
    if clock is not None and not any(known_name(name) == "time" for name, _ in items):
        items.insert(0, ("time", clock))
        units["time"] = "s"
    return table_of(path, items, units=units, skip_rows=skip_rows)
