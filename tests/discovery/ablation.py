"""What each part of discovery is worth: python -m tests.discovery.ablation --out DIR [--sample N] [--seeds A..B].

Runs the whole method, the method without confirmation, without the kinematic channel, and the plain pointwise
regression on the same cases. Leaves DIR/METHOD/CASE.json, DIR/ablation.md and DIR/ablation.json. Cases that
are there are not run again.
"""

import argparse
import json
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from stochfric_mb.discovery.stick_slip.study import Channels
from stochfric_mb.discovery.stick_slip.workflow import discover_belt_box
from stochfric_mb.measurement.dataset import load_dataset

from . import judge, plan, suite
from .generator.case import Case, write
from .pointwise import by_points

COLUMNS = {
    "top-1": "top-1 name right",
    "class": "truth in the reported class",
    "false alarms": "false alarms when nothing is missing",
    "unknown answered": "out-of-vocabulary effect answered unknown",
    "forced into a wrong name": "forced into a wrong name",
    "gap closed, median": "gap closed, median",
}
"""Columns of the table, and the judge's rows that fill them."""


def with_channels(channels: Channels) -> suite.Discover:
    """Discovery with some of its parts."""

    def discover(dataset: Path, out: Path) -> None:
        outcome = discover_belt_box(load_dataset(dataset), channels=channels)
        out.mkdir(parents=True, exist_ok=True)
        (out / "result.json").write_text(outcome.result.to_json())

    return discover


METHODS: dict[str, suite.Discover] = {
    "whole method": with_channels(Channels()),
    "without confirmation": with_channels(Channels(confirmation=False)),
    "without kinematic channel": with_channels(Channels(kinematic=False)),
    "pointwise regression": by_points,
}


def run(
    cases: list[Case], out: Path, methods: Mapping[str, suite.Discover] = METHODS, *, limit: float = 300.0
) -> dict[str, dict[str, Any]]:
    """Run every method on every case that it has not answered yet; per method and column `value` and `n`."""
    verdicts: dict[str, list[judge.Verdict]] = {name: [] for name in methods}
    for i, case in enumerate(cases):  # case by case: a run that is cut off leaves the methods with the same cases
        for name, stored in _answers(case, out, methods, limit).items():
            verdicts[name].append(suite.judged(stored))
        said = "; ".join(f"{name}: {members[-1].answer}" for name, members in verdicts.items())
        print(f"[{i + 1}/{len(cases)}] {case.name}: {said}", flush=True)
        _write(cases[: i + 1], verdicts, out)
    return table(verdicts)


def _answers(case: Case, out: Path, methods: Mapping[str, suite.Discover], limit: float) -> dict[str, dict[str, Any]]:
    """What each method says of one case, stored or new; the dataset is made once."""
    files = {name: out / name.replace(" ", "_") / f"{case.name}.json" for name in methods}
    missing = [name for name, file in files.items() if not file.exists()]
    with tempfile.TemporaryDirectory() as folder:
        dataset = Path(folder) / "dataset"
        truth = write(case, dataset, Path(folder) / "truth.json") if missing else {}
        for name in missing:
            stored = suite.answered(truth, dataset, Path(folder) / "answer", methods[name], limit)
            files[name].parent.mkdir(parents=True, exist_ok=True)
            files[name].write_text(json.dumps(stored, indent=1))
    return {name: json.loads(file.read_text()) for name, file in files.items()}


def table(verdicts: Mapping[str, list[judge.Verdict]]) -> dict[str, dict[str, Any]]:
    """Per method and column `value` and `n`, over one and several operating points together."""
    rows = {name: judge.shares(members) for name, members in verdicts.items()}
    return {
        name: {column: {"value": of[row][0], "n": of[row][1]} for column, row in COLUMNS.items()} for name, of in rows.items()
    }


def as_markdown(numbers: Mapping[str, Mapping[str, Any]]) -> str:
    """The table: a row a method."""
    lines = ["| method | " + " | ".join(COLUMNS) + " |", "|---|" + "---|" * len(COLUMNS)]
    for name, cells in numbers.items():
        lines.append(f"| {name} | " + " | ".join(judge.cell(cells[column]) for column in COLUMNS) + " |")
    return "\n".join(lines) + "\n"


def _write(cases: list[Case], verdicts: Mapping[str, list[judge.Verdict]], out: Path) -> None:
    numbers = table(verdicts)
    (out / "ablation.md").write_text(as_markdown(numbers))
    answers = {name: {v.name: v.answer for v in members} for name, members in verdicts.items()}
    stored = {"seeds": sorted({case.seed for case in cases}), "cases": len(cases), "table": numbers, "answers": answers}
    (out / "ablation.json").write_text(json.dumps(stored, indent=1))


def main() -> None:
    """Parse the command line and run."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--sample", type=int, default=24, help="about this many cases, spread evenly")
    parser.add_argument(
        "--seeds", type=suite.seed_range, default=range(1), help="A..B of 0..99 (tuning) or 1000..9999 (reporting)"
    )
    chosen = parser.parse_args()
    run(plan.sampled(list(plan.cases(chosen.seeds)), chosen.sample), chosen.out)
    print((chosen.out / "ablation.md").read_text())


if __name__ == "__main__":
    main()
