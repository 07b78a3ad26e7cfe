"""What is frozen of a result, and what differs between two."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

RELATIVE = 1.0e-9
"""Relative difference from which on a number has moved [-]: rounding in another order of sums stays far below it."""
SLOWER = 1.5
"""Ratio of times from which on one has moved [-]: on a busy machine processor times of the same work differ by a quarter."""
LEAST = 1.0
"""Times below which a ratio tells nothing [s]."""


def frozen(result: dict[str, Any]) -> dict[str, Any]:
    """Return the answer and the numbers of a result, as ``Result.to_dict`` gives it; the report's details stay out."""
    answer = {
        "verdict": result["verdict"],
        "effects": [[e["kind"], *e["equivalent_to"]] for e in result["effects"]],
        "axis": (result["where"] or {}).get("axis"),
        "not_identifiable": list(result["not_identifiable"]),
        "next_experiment": result["next_experiment"],
        "notes": len(result["notes"]),
    }
    parts: dict[str, Any] = {f"{i} {e['kind']}": [e["parameters"], e["evidence"]] for i, e in enumerate(result["effects"])}
    ranking: dict[str, float] = {}
    for entry in result["ranking"]:
        ranking.setdefault(entry["kind"], entry["score"])
    parts |= {"gap": result["gap"], "believed": result["believed"], "power": result["power"], "ranking": ranking}
    return {"answer": answer, "numbers": dict(_numbers(parts, ""))}


def _numbers(value: Any, path: str) -> Iterator[tuple[str, float]]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _numbers(inner, f"{path}/{key}" if path else str(key))
    elif isinstance(value, list | tuple):
        for i, inner in enumerate(value):
            yield from _numbers(inner, f"{path}/{i}")
    elif not isinstance(value, bool | str) and value is not None and math.isfinite(value):
        yield path, float(value)


def moved(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Return a line for the answer, for each number and for the time that differ."""
    lines = [
        f"answer {key}: {before['answer'].get(key)} -> {now['answer'].get(key)}"
        for key in before["answer"] | now["answer"]
        if before["answer"].get(key) != now["answer"].get(key)
    ]
    old, new = before["numbers"], now["numbers"]
    for path in old | new:
        a, b = old.get(path), new.get(path)
        if a is None or b is None:
            lines.append(f"{path}: {'gone' if b is None else 'new'}")
        elif abs(a - b) > RELATIVE * max(abs(a), abs(b)):
            lines.append(f"{path}: {a:.10g} -> {b:.10g} ({(b - a) / max(abs(a), abs(b)):+.2g})")
    ratio = max(now["seconds"], LEAST) / max(before["seconds"], LEAST)
    if not 1.0 / SLOWER < ratio < SLOWER:
        lines.append(f"seconds: {before['seconds']} -> {now['seconds']}")
    return lines
