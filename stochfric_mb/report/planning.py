"""The page of a plan: every number in it stands in ``plan.json``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from stochfric_mb.effects import words_of
from stochfric_mb.report.page import render


def plan_page(content: Mapping[str, Any], title: str, command: str) -> str:
    """Return the page of a plan.

    Args:
        content: what ``plan.json`` holds.
        title: title of the scenario.
        command: the command that made it.
    """
    return render(
        "planning.html", plan=content, title=title, command=command, words=words_of, beside=beside, pair_text=pair_text
    )


def beside(limit: Mapping[str, Any]) -> str:
    """Return the numbers that a detection limit belongs to, in words."""
    shown = {k: v for k, v in limit["beside"].items() if not k.startswith("phase")}
    units = {k: "" if unit == "-" else unit for k, unit in limit["units_beside"].items()}
    parts = [
        f"{words_of(k)} {v}" if isinstance(v, str) else f"{words_of(k)} {v:.3g} {units[k]}".rstrip() for k, v in shown.items()
    ]
    return ", ".join(parts)


def pair_text(pair: Mapping[str, Any]) -> str:
    """Return two effects that are not told apart, and from which size on they are, in words."""
    multiple = pair["told_apart_from"]
    until = "at any size" if multiple is None else f"below {multiple:.2g} times their limits"
    return f"{words_of(pair['first'])} and {words_of(pair['second'])}, {until}"
