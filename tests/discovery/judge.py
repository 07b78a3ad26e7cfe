"""Answers against truths: one row a case, then the confusion table and the table of what must be reached."""

from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np

from .generator.expectation import NONE, UNKNOWN

COUNTED_STRENGTH = 0.5
REDUCIBLE = 0.05

TARGETS = {
    "top-1 name right": (0.88, 0.94),
    "truth in the reported class": (0.95, 0.98),
    "false alarms when nothing is missing": (0.02, 0.02),
    "out-of-vocabulary effect answered unknown": (0.80, 0.92),
    "forced into a wrong name": (0.12, 0.04),
    "gap closed, median": (0.95, 0.95),
    "gap closed, 10 % quantile": (0.85, 0.85),
    "seconds a case, median": (10.0, 30.0),
}
"""At one operating point and at several."""


@dataclass(frozen=True)
class Verdict:
    """How one answer compares with its truth."""

    name: str
    forms: str
    kind: str
    """The true kind, `unknown`, `none`, or two kinds joined by +."""
    design: str
    strength: float
    several_points: bool
    visible: bool
    answer: str
    """First named kind, `unknown`, `none`, or `failed`."""
    others: tuple[str, ...]
    """Further named kinds."""
    top_1: bool
    """The answer is one of the names that are right in this experiment."""
    exact: bool
    """The answer is the true name itself."""
    in_class: bool
    """The true name is the answer or one of its equivalents."""
    all_named: bool
    """Every planted effect is among the named kinds or their equivalents."""
    closed: float | None
    """Closed share of the gap; None if none was reducible."""
    seconds: float
    reproduced: float | None = None
    """Share that `augmented.toml` closes when it is re-simulated alone, less the reported share; None if that was not done
    or nothing was reducible."""

    @property
    def counted(self) -> bool:
        """Whether the case belongs in the table of what must be reached."""
        return self.visible and self.strength >= COUNTED_STRENGTH and "+" not in self.kind


def judge(truth: dict[str, Any], result: dict[str, Any] | None, seconds: float, again: dict[str, Any] | None = None) -> Verdict:
    """Compare a result (None: the run failed) with the truth record of its case; `again`: a second scoring of the gap."""
    case = truth["case"]
    named = (result or {}).get("effects") or []
    kinds = [effect["kind"] for effect in named]
    classes = [{effect["kind"], *effect.get("equivalent_to", ())} for effect in named]
    answer = "failed" if result is None else (kinds[0] if result["verdict"] == "effect" and kinds else result["verdict"])
    first_class = classes[0] if classes and answer == kinds[0] else {answer}
    right = [set(names) for names in truth["acceptable"]]
    return Verdict(
        name=f"{case['forms']}-{case['design']}-{case['strength']:g}-{case['seed']}",
        forms="+".join(truth["forms"]),
        kind="+".join(truth["kinds"]),
        design=case["design"],
        strength=case["strength"],
        several_points=truth["several_points"],
        visible=all(truth["visible"]),
        answer=answer,
        others=tuple(kinds[1:]),
        top_1=any(answer in names for names in right),
        exact=answer in truth["kinds"],
        in_class=bool(first_class & set(truth["kinds"])),
        all_named=all(any(kind in names for names in classes) for kind in truth["kinds"]),
        closed=_closed(result),
        seconds=seconds,
        reproduced=_reproduced(_closed(result), again),
    )


def _closed(result: dict[str, Any] | None) -> float | None:
    """The reported closed share, where the reported reducible share is large enough to count."""
    leading = (result or {}).get("leading", "gap")
    gap = (result or {}).get(leading) or {}
    recalibrated, floor, closed = gap.get("recalibrated"), gap.get("floor"), gap.get("closed")
    if closed is None or not recalibrated or floor is None or (recalibrated - floor) / recalibrated < REDUCIBLE:
        return None
    return float(closed)


def _reproduced(closed: float | None, again: dict[str, Any] | None) -> float | None:
    if closed is None or again is None or again["closed"] is None:
        return None
    return float(again["closed"]) - closed


def summary(verdicts: list[Verdict]) -> dict[str, dict[str, Any]]:
    """Rows of TARGETS plus what stands beside them; per row and group `value` and `n` (value None if n is 0)."""
    groups = {"one": [v for v in verdicts if not v.several_points], "several": [v for v in verdicts if v.several_points]}
    rows: dict[str, dict[str, Any]] = {}
    for group, members in groups.items():
        for row, (value, n) in shares(members).items():
            rows.setdefault(row, {})[group] = {"value": value, "n": n}
    return rows


def shares(members: list[Verdict]) -> dict[str, tuple[float | None, int]]:
    """Rows of TARGETS plus what stands beside them, over all the verdicts: value (None if n is 0) and n."""
    counted = [v for v in members if v.counted]
    effects = [v for v in counted if v.kind not in (NONE, UNKNOWN)]
    unknowns = [v for v in counted if v.kind == UNKNOWN]
    nulls = [v for v in members if v.kind == NONE]
    weak = [
        v
        for v in members
        if v.visible and v.strength < COUNTED_STRENGTH and v.kind not in (NONE, UNKNOWN) and "+" not in v.kind
    ]
    hidden = [v for v in members if not v.visible]
    pairs = [v for v in members if "+" in v.kind and v.strength >= COUNTED_STRENGTH]
    closed = [v.closed for v in effects if v.closed is not None]
    reproduced = [v.reproduced for v in members if v.reproduced is not None]
    return {
        "top-1 name right": _share([v.top_1 for v in effects]),
        "truth in the reported class": _share([v.in_class for v in effects]),
        "false alarms when nothing is missing": _share([v.answer != NONE for v in nulls]),
        "out-of-vocabulary effect answered unknown": _share([v.answer == UNKNOWN for v in unknowns]),
        "forced into a wrong name": _share([v.answer not in (UNKNOWN, NONE, "failed") and not v.top_1 for v in unknowns]),
        "gap closed, median": (float(np.median(closed)) if closed else None, len(closed)),
        "gap closed, 10 % quantile": (float(np.quantile(closed, 0.1)) if closed else None, len(closed)),
        "augmented.toml re-simulated alone: closed share less the reported one, median": _quantile(reproduced, 0.5),
        "the same, 10 % quantile": _quantile(reproduced, 0.1),
        "seconds a case, median": _quantile([v.seconds for v in members], 0.5),
        "seconds a case, 90 % quantile": _quantile([v.seconds for v in members], 0.9),
        "the very name, not only one that cannot be distinguished": _share([v.exact for v in effects]),
        "effects answered none": _share([v.answer == NONE for v in effects]),
        "effects answered unknown": _share([v.answer == UNKNOWN for v in effects]),
        "runs that failed": _share([v.answer == "failed" for v in members]),
        "strength 0.3: top-1 name right": _share([v.top_1 for v in weak]),
        "effect that the experiment cannot see: none, or its name": _share([v.top_1 for v in hidden]),
        "two effects: first name right": _share([v.top_1 for v in pairs]),
        "two effects: both in the named classes": _share([v.all_named for v in pairs]),
    }


def _share(hits: list[bool]) -> tuple[float | None, int]:
    return (float(np.mean(hits)) if hits else None, len(hits))


def _quantile(values: list[float], at: float) -> tuple[float | None, int]:
    return (float(np.quantile(values, at)) if values else None, len(values))


def confusion(verdicts: list[Verdict]) -> dict[str, Counter[str]]:
    """Answers to each true kind (pairs apart, strength 0.5 and above)."""
    table: dict[str, Counter[str]] = {}
    for verdict in sorted(verdicts, key=lambda v: v.kind):
        if verdict.counted or verdict.kind == NONE:
            table.setdefault(verdict.kind, Counter())[verdict.answer] += 1
    return table


def as_markdown(verdicts: list[Verdict], title: str) -> str:
    """Both tables and the list of wrong answers."""
    lines = [f"# {title}", "", "| | one operating point | must | several | must |", "|---|---|---|---|---|"]
    for row, by_group in summary(verdicts).items():
        must = TARGETS.get(row, (None, None))
        cells = [
            cell(by_group[group]) + f" | {_number(target)}" for group, target in zip(("one", "several"), must, strict=True)
        ]
        lines.append(f"| {row} | " + " | ".join(cells) + " |")
    lines += ["", "## Answers by true kind (strength 0.5 and above)", "", "| truth | answers |", "|---|---|"]
    for kind, answers in confusion(verdicts).items():
        lines.append(f"| {kind} | " + ", ".join(f"{answer} {n}" for answer, n in answers.most_common()) + " |")
    lines += ["", "## Wrong answers", "", "| case | answer | in class | closed |", "|---|---|---|---|"]
    for verdict in verdicts:
        if not verdict.top_1:
            named = " + ".join([verdict.answer, *verdict.others])
            lines.append(f"| {verdict.name} | {named} | {'yes' if verdict.in_class else 'no'} | {_number(verdict.closed)} |")
    return "\n".join(lines) + "\n"


def cell(entry: dict[str, Any]) -> str:
    """A `value` and its `n`, as a table shows them."""
    return "-" if entry["value"] is None else f"{_number(entry['value'])} (n = {entry['n']})"


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.3g}"
