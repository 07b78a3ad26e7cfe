"""The page of a plan: every number in it stands in ``plan.json``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from stochfric_mb.effects import words_of
from stochfric_mb.report.comparison import UNITS
from stochfric_mb.report.discovery import in_words, number
from stochfric_mb.report.page import render

NUMBERS = {
    "seconds": ("duration", "s"), "sample_rate": ("sampling", "Hz"), "noise": ("noise of position", "m"),
    "stroke": ("stroke", "m"), "period": ("period", "s"), "force_noise": ("noise of force", "N"),
    "slow_speed": ("slow speed", "m/s"), "fast_speed": ("fast speed", "m/s"), "slips": ("slips", "simulated"),
}  # fmt: skip
"""Number of a planned run -> its name and its unit along a line."""
ABOUT_AN_AXIS = {"m": "rad", "N": "N m"}
"""Unit along a line -> where friction acts about an axis."""


def plan_page(content: Mapping[str, Any], title: str, command: str) -> str:
    """Return the page of a plan.

    Args:
        content: what ``plan.json`` holds.
        title: title of the scenario.
        command: the command that made it.
    """
    numbers = {
        key: (name, ABOUT_AN_AXIS.get(unit, unit) if content["rotational"] else unit)
        for key, (name, unit) in NUMBERS.items()
        if any(run.get(key) is not None for run in content["runs"])
    }
    return render(
        "planning.html", plan=content, title=title, command=command, words=words_of, in_words=in_words, beside=_beside,
        number=number, numbers=numbers, units=UNITS,
    )  # fmt: skip


def beside(limit: Mapping[str, Any]) -> str:
    """Return the numbers that a detection limit belongs to, in words."""
    return ", ".join(
        f"{words_of(key)} {value if isinstance(value, str) else f'{value:.3g}'} {unit}".rstrip()
        for key, value, unit in _beside(limit)
    )


def _beside(limit: Mapping[str, Any]) -> list[tuple[str, float | str, str]]:
    """Return name, value and unit of each number that a detection limit belongs to."""
    shown = [(k, v) for k, v in limit["beside"].items() if not k.startswith("phase")]
    return [(k, v, "" if limit["units_beside"].get(k, "-") == "-" else limit["units_beside"][k]) for k, v in shown]


def pair_text(pair: Mapping[str, Any]) -> str:
    """Return two effects that are not distinguished, and from which size on they are, in words."""
    multiple = pair["told_apart_from"]
    until = "at any size" if multiple is None else f"below {multiple:.2g} times their limits"
    return f"{words_of(pair['first'])} and {words_of(pair['second'])}, {until}"
