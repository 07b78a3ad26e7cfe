"""Tables of what discovery answered."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from .forms import AT_JOINTS, KINDS, NONE, UNKNOWN


def judged(truth: dict, answer: dict) -> dict:
    """Return the line of a case: what is true, what was answered, and how right that is."""
    verdict, first = answer["verdict"], answer.get("first")
    if first == "unnamed":
        verdict, first = UNKNOWN, None
    name = first if verdict == "effect" else verdict
    kind = (KINDS | AT_JOINTS).get(first or "", first) if verdict == "effect" else verdict
    line = {
        key: truth[key]
        for key in ("form", "truth", "classes", "family", "design", "strength", "rig", "feature", "size", "seed")
    }
    return line | {
        "answer": verdict,
        "first": first,
        "class": kind,
        "right": name in truth["truth"],
        "class_right": kind in truth["classes"],
        "closed": answer.get("closed"),
        "seconds": answer.get("seconds"),
        "processor_seconds": answer.get("processor_seconds"),
        "error": answer.get("error"),
    }


def table(lines: Iterable[dict]) -> str:
    """Return the table of shares, gaps and times, for one operating point, several, and all."""
    lines = list(lines)
    columns = {"one": [], "several": [], "all": lines}
    for line in lines:
        columns[line["design"]].append(line)
    rows = [("", *columns)]
    rows += [(title, *(cell(column) for column in columns.values())) for title, cell in _ROWS]
    for strength in sorted({line["strength"] for line in lines if line["family"] == "named"}):
        chosen = [[line for line in column if line["strength"] == strength] for column in columns.values()]
        rows.append(
            (f"named, strength {strength:g}: first name right", *(_share("named", "right")(column) for column in chosen))
        )
    widths = [max(len(str(row[i])) for row in rows) for i in range(len(rows[0]))]
    text = ["  ".join(str(cell).ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    wrong = [line for line in lines if not line["right"]]
    text += ["", f"not right ({len(wrong)}):"] if wrong else []
    for line in sorted(wrong, key=lambda line: (line["family"], line["form"])):
        name, answer = f"{line['form']}-{line['design']}-{line['strength']:g}", line["first"] or line["answer"]
        text.append(f"  {name}: {'/'.join(line['truth'])} -> {answer}")
    return "\n".join(text)


def _share(family: str, what: str | Callable) -> Callable[[list[dict]], str]:
    def cell(lines: list[dict]) -> str:
        chosen = [line for line in lines if line["family"] == family]
        hits = sum(bool(what(line) if callable(what) else line[what]) for line in chosen)
        return f"{hits}/{len(chosen)} ({100.0 * hits / len(chosen):.0f} %)" if chosen else "-"

    return cell


def _quantile(level: float) -> Callable[[list[dict]], str]:
    def cell(lines: list[dict]) -> str:
        closed = [line["closed"] for line in lines if line["family"] == "named" and line["closed"] is not None]
        return f"{np.quantile(closed, level):.3f}" if closed else "-"

    return cell


def _seconds(level: float, clock: str = "seconds") -> Callable[[list[dict]], str]:
    def cell(lines: list[dict]) -> str:
        seconds = [line[clock] for line in lines if line.get(clock) is not None]
        return f"{np.quantile(seconds, level):.0f} s" if seconds else "-"

    return cell


_ROWS: tuple[tuple[str, Callable[[list[dict]], str]], ...] = (
    ("named: first name right (top-1)", _share("named", "right")),
    ("named: class right", _share("named", "class_right")),
    ("named: answered none", _share("named", lambda line: line["answer"] == NONE)),
    ("named: answered unknown", _share("named", lambda line: line["answer"] == UNKNOWN)),
    ("none: false alarms", _share(NONE, lambda line: line["answer"] in ("effect", UNKNOWN) and not line["right"])),
    ("none: false alarms with a name", _share(NONE, lambda line: line["answer"] == "effect")),
    ("unknown: answered unknown", _share(UNKNOWN, lambda line: line["answer"] == UNKNOWN)),
    ("unknown: forced into a wrong name", _share(UNKNOWN, lambda line: line["answer"] == "effect" and not line["right"])),
    ("unknown: answered none", _share(UNKNOWN, lambda line: line["answer"] == NONE)),
    ("named: gap closed, median", _quantile(0.5)),
    ("named: gap closed, 10 % quantile", _quantile(0.1)),
    ("named: gap closed is null", _share("named", lambda line: line["closed"] is None)),
    ("no answer (limit or error), named", _share("named", "error")),
    ("no answer (limit or error), unknown", _share(UNKNOWN, "error")),
    ("no answer (limit or error), none", _share(NONE, "error")),
    ("time, median", _seconds(0.5)),
    ("time, 90 % quantile", _seconds(0.9)),
    ("processor time, median", _seconds(0.5, "processor_seconds")),
    ("processor time, 90 % quantile", _seconds(0.9, "processor_seconds")),
)
