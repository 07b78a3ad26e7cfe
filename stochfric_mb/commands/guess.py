"""Guesses of what the columns of a measured file are, from their headers; a person checks them."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable

from stochfric_mb.measurement.quantities import KNOWN, known_name
from stochfric_mb.measurement.table import Table

SYNONYMS: dict[str, tuple[str, ...]] = {
    "time": ("t", "time", "timestamp", "seconds", "zeit", "temps", "sec"),
    "position": ("x", "q", "pos", "position", "displacement", "disp", "displ", "angle", "theta", "phi", "weg", "stroke"),
    "velocity": ("v", "qd", "dq", "vel", "velocity", "speed", "rate", "omega"),
    "force": ("f", "force", "load", "kraft", "thrust"),
    "torque": ("tau", "torque", "moment", "trq"),
    "voltage": ("u", "volt", "voltage", "vir"),
    "normal_force": ("fn", "normal", "normalforce", "preload"),
    "belt_velocity": ("belt", "vb", "beltspeed", "beltvelocity"),
    "friction_coefficient": ("mu", "cof", "friction", "frict", "reibwert"),
    "friction_force": ("friction", "frictionforce"),
    "temperature": ("temp", "temperature"),
    "pressure": ("p", "pressure"),
}
"""Quantity -> words in headers that may mean it."""
ELECTRIC = ("voltage", "current")
"""Quantities whose units, at the end of a name, are no one's else: ``tau_s`` may be a shoulder's, not in seconds."""


@dataclasses.dataclass(frozen=True)
class Guess:
    """What a column of a file may be."""

    quantity: str
    """Known quantity."""
    column: str | int
    """Name in the file, or number from 0."""
    unit: str
    """Unit, as the file says it or guessed."""
    sure: bool
    """Whether the header says quantity and unit in this package's words, so that nothing need be written."""


def guesses(table: Table, wanted: Iterable[str], *, rotational: bool | None) -> list[Guess]:
    """Return the columns of a file that may be the wanted quantities, each column once.

    Args:
        table: the file's columns.
        wanted: quantities in order of need; without a header the columns are taken in this order.
        rotational: whether positions are angles.
    """
    guessed: list[Guess] = []
    free = list(table.columns)
    for number, quantity in enumerate(wanted):
        name = _column(free, quantity, number, has_header=table.has_header)
        if name is None:
            continue
        free.remove(name)
        said = table.units.get(name, "")
        column = name if table.has_header else int(name)
        unit = said or _unit(name, quantity, rotational)
        guessed.append(Guess(quantity, column, unit, sure=_plain(name) == quantity and bool(said or not unit)))
    return guessed


def _column(free: list[str], quantity: str, number: int, *, has_header: bool) -> str | None:
    """Return the free column that means a quantity: by its name, by a word in it, or without a header by its place."""
    if not has_header:
        return str(number) if str(number) in free and number < 2 else None
    exact = [name for name in free if _plain(name) == quantity]
    alike = [
        name
        for name in free
        if known_name(name) in (None, quantity)
        and _words(name) & set(SYNONYMS.get(quantity, ()))
        and not _electric(name, quantity)
    ]  # a column that names another known quantity is that one
    return next(iter(exact + alike), None)


def _unit(name: str, quantity: str, rotational: bool | None) -> str:
    """Return the unit that a name ends in, such as ``t_ms`` or ``v_mm_s``, or the SI unit."""
    if quantity not in KNOWN:
        return ""  # a ratio, such as the coefficient of friction
    return _ending(name, _units(quantity)) or KNOWN[quantity].units_of(rotational)[0]


def _electric(name: str, quantity: str) -> bool:
    """Return whether a name ends in volts or amperes and the quantity is no such: ``u_V`` is no velocity."""
    return quantity not in ELECTRIC and bool(_ending(name, [unit for known in ELECTRIC for unit in _units(known)]))


def _units(quantity: str) -> tuple[str, ...]:
    """Return the units that a quantity may have, along a line and about an axis."""
    return (*KNOWN[quantity].units_of(None), *KNOWN[quantity].also)


def _ending(name: str, units: Iterable[str]) -> str:
    """Return the longest of the units in which a name ends behind a divider; empty if it ends in none."""
    parts = re.split(r"[^A-Za-z0-9]+", name)
    written = {unit: [part for part in re.split(r"[^A-Za-z0-9]+", unit) if part] for unit in units}
    fits = [u for u, words in written.items() if len(parts) > len(words) and parts[-len(words) :] in (words, ["".join(words)])]
    return max(fits, key=len, default="")


def _plain(name: str) -> str:
    """Return the quantity that a header names in this package's words."""
    return known_name(name) or re.sub(r"\W+", "_", name.strip().lower())


def _words(name: str) -> set[str]:
    """Return the words in a header, in small letters: ``PosAct_mm`` has ``pos``, ``act`` and ``mm``."""
    split = re.sub(r"([a-z])([A-Z])", r"\1 \2", name)
    return {*re.findall(r"[a-z]+", split.lower()), re.sub(r"[^a-z]", "", name.lower())}
