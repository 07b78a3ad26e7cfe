"""The errors this package raises, and the checks that build most of them.

Every message names the value, the rule it broke and the remedy.
"""

from __future__ import annotations

import dataclasses
import difflib
import math
from collections.abc import Iterable
from typing import SupportsFloat


class StochfricError(Exception):
    """Base of every error raised on purpose by this package."""


class InputError(StochfricError, ValueError):
    """A value, key, file or option that cannot be used as given."""


class MissingEngineError(StochfricError, ImportError):
    """An optional engine or reader that is not installed."""


class StabilityError(InputError):
    """A step size beyond the stability limit of the law."""


class SimulationError(StochfricError, RuntimeError):
    """An engine that failed, or returned success with a wrong or non-finite state."""


def require_number(
    name: str,
    value: object,
    *,
    low: float = -math.inf,
    high: float = math.inf,
    above: float = -math.inf,
    below: float = math.inf,
    unit: str = "-",
) -> float:
    """Return ``value`` as a float once it is finite and within its bounds.

    >>> require_number("mu_k", -0.1, low=0.0)
    Traceback (most recent call last):
    ...
    stochfric_mb.errors.InputError: mu_k = -0.1 is out of range: mu_k must be >= 0

    Args:
        name: what the message calls the value.
        value: the candidate.
        low: inclusive lower bound.
        high: inclusive upper bound.
        above: exclusive lower bound.
        below: exclusive upper bound.
        unit: unit of the bounds, for the message.

    Raises:
        InputError: ``value`` is not a finite number within the bounds.
    """
    # most are floats: protocols are slow to ask
    if type(value) is not float and (not isinstance(value, SupportsFloat) or type(value).__name__ in ("bool", "bool_")):
        raise InputError(f"{name} = {value!r} is not a number; give a number{_in(unit)}")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise InputError(f"{name} = {number} is not finite; give a finite number{_in(unit)}")
    if number < low or number <= above or number > high or number >= below:
        shown = f"{number:g}" if unit == "-" else f"{number:g} {unit}"
        raise InputError(f"{name} = {shown} is out of range: {name} must be {_range(low, high, above, below)}")
    return number


def _in(unit: str) -> str:
    """Return " in [unit]"; nothing for a number without unit."""
    return "" if unit == "-" else f" in [{unit}]"


def require_text(name: str, value: object) -> str:
    """Return ``value`` if it is a text.

    Raises:
        InputError: it is none.
    """
    if not isinstance(value, str):
        raise InputError(f'{name} = {value!r} is not a text; write it in quotes, such as {name.rpartition(".")[2]} = "..."')
    return value


def require_name(what: str, name: str, known: Iterable[str]) -> str:
    """Return ``name`` if it is one of ``known``; otherwise list what is known.

    Raises:
        InputError: ``name`` is unknown; the message names the nearest and lists all.
    """
    names = sorted(known)
    if name in names:
        return name
    near = difflib.get_close_matches(str(name), names, n=1)
    hint = f"; did you mean {near[0]!r}?" if near else "."
    raise InputError(f"unknown {what} {name!r}{hint} Known: {', '.join(names)}")


def _range(low: float, high: float, above: float, below: float) -> str:
    parts: list[str] = []
    if above > -math.inf:
        parts.append(f"> {above:g}")
    elif low > -math.inf:
        parts.append(f">= {low:g}")
    if below < math.inf:
        parts.append(f"< {below:g}")
    elif high < math.inf:
        parts.append(f"<= {high:g}")
    return " and ".join(parts)


def require_fields(what: str, cls: type, names: Iterable[str]) -> None:
    """Check that names are those of a dataclass's fields, and that none without a default is missing.

    Args:
        what: what the class is, for messages, such as "law coulomb".
        cls: the dataclass.
        names: what is given.

    Raises:
        InputError: an unknown or a missing name.
    """
    fields = {f.name: f for f in dataclasses.fields(cls)}
    given = list(names)
    for name in given:
        require_name(f"parameter of {what}", name, fields)
    missing = [n for n, f in fields.items() if f.default is dataclasses.MISSING and n not in given]
    if missing:
        raise InputError(f"{what} lacks {', '.join(missing)}; give a number for each")
