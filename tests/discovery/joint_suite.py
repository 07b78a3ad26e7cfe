"""Judge discovery at driven joints: python -m tests.discovery.joint_suite --out DIR [--seeds A..B] [--sample N] [--jobs 2].

`--unseen N` takes the forms of report N in place of those for tuning.

Leaves DIR/cases/CASE.json (truth, result, seconds), DIR/summary.md and DIR/summary.json. Cases that are there are not run
again.
"""

import argparse
import json
import os
import shutil
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict
from pathlib import Path
from typing import Any

from . import joint_plan, judge, plan, suite
from .joint_generator.case import Case, write

MUST = {
    "top-1 name right": 0.88,
    "truth in the reported class": 0.95,
    "effects answered none": 0.03,
    "false alarms when nothing is missing": 0.02,
    "out-of-vocabulary effect answered unknown": 0.80,
    "forced into a wrong name": 0.08,
    "gap closed, median": 0.9,
    "two effects: both in the named classes": 0.6,
    "runs that failed": 0.0,
    "seconds a case, median": 10.0,
    "seconds a case, 90 % quantile": 20.0,
}
"""What must be reached on forms of half strength and above."""


def run_case(case: Case, out: Path, limit: float, *, keep: bool = False) -> dict[str, Any]:
    """Generate, discover, and store what came, with the seconds of processor time."""
    dataset, answer = out / "datasets" / case.name, out / "answers" / case.name
    truth = write(case, dataset, out / "truth" / f"{case.name}.json")
    begin = time.process_time()
    stored = suite.answered(truth, dataset, answer, suite.by_command, limit)
    stored["seconds"] = time.process_time() - begin
    file = _file(case, out)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(stored, indent=1))
    if not keep:
        shutil.rmtree(dataset)
        shutil.rmtree(answer, ignore_errors=True)
    return stored


def run(cases: list[Case], out: Path, *, jobs: int = 1, limit: float = 300.0, keep: bool = False) -> list[judge.Verdict]:
    """Run the cases that are not yet stored and judge all; writes the summaries."""
    waiting = [case for case in cases if not _file(case, out).exists()]
    if jobs == 1:
        for i, case in enumerate(waiting):
            _say(i, len(waiting), case, run_case(case, out, limit, keep=keep))
    else:
        with ProcessPoolExecutor(jobs) as pool:
            futures = {pool.submit(run_case, case, out, limit, keep=keep): case for case in waiting}
            for i, done in enumerate(as_completed(futures)):
                _say(i, len(waiting), futures[done], done.result())
    verdicts = [suite.judged(json.loads(_file(case, out).read_text())) for case in cases]
    seeds = sorted({case.seed for case in cases})
    kind = "reporting" if seeds and seeds[0] in plan.REPORTING else "tuning"
    title = f"Driven joints: {len(cases)} cases, {kind} seeds {seeds[0]}..{seeds[-1]}" if seeds else "Driven joints: no case"
    (out / "summary.md").write_text(as_markdown(verdicts, title))
    tables = {"title": title, "summary": judge.shares(verdicts), "verdicts": [asdict(v) for v in verdicts]}
    (out / "summary.json").write_text(json.dumps(tables, indent=1))
    return verdicts


def as_markdown(verdicts: list[judge.Verdict], title: str) -> str:
    """The table of what must be reached, answers by kind and by mechanism, and the wrong ones."""
    rows = judge.shares(verdicts)
    lines = [f"# {title}", "", "| | value | must |", "|---|---|---|"]
    for row, (value, n) in rows.items():
        if n and not row.startswith(("augmented.toml", "the same")):
            lines.append(f"| {row} | {judge.cell({'value': value, 'n': n})} | {MUST.get(row, '')} |")
    lines += ["", "## Right answers by mechanism", "", "| mechanism | effects | outside the vocabulary | nothing missing |"]
    lines += ["|---|---|---|---|"]
    for design in sorted({v.design for v in verdicts}):
        members = [v for v in verdicts if v.design == design and "+" not in v.kind]
        groups = (
            [v.top_1 for v in members if v.kind not in ("none", "unknown")],
            [v.top_1 for v in members if v.kind == "unknown"],
            [v.top_1 for v in members if v.kind == "none"],
        )
        lines.append(f"| {design} | " + " | ".join(f"{sum(g)} of {len(g)}" for g in groups) + " |")
    lines += ["", "## Answers by true kind", "", "| truth | answers |", "|---|---|"]
    for kind, answers in judge.confusion(verdicts).items():
        lines.append(f"| {kind} | " + ", ".join(f"{answer} {n}" for answer, n in answers.most_common()) + " |")
    lines += ["", "## Wrong answers", "", "| case | answer | in class | closed |", "|---|---|---|---|"]
    for v in verdicts:
        if not v.top_1:
            named = " + ".join([v.answer, *v.others])
            closed = "" if v.closed is None else f"{v.closed:.3g}"
            lines.append(f"| {v.name} | {named} | {'yes' if v.in_class else 'no'} | {closed} |")
    return "\n".join(lines) + "\n"


def _say(i: int, n: int, case: Case, stored: dict[str, Any]) -> None:
    verdict = suite.judged(stored)
    mark = "ok   " if verdict.top_1 else "WRONG"
    named = " + ".join([verdict.answer, *verdict.others])
    reason = f" ({stored['error']})" if stored["error"] else ""
    print(f"[{i + 1}/{n}] {mark} {case.name}: {named} in {verdict.seconds:.1f} s{reason}", flush=True)


def _file(case: Case, out: Path) -> Path:
    return out / "cases" / f"{case.name}.json"


def main() -> None:
    """Parse the command line and run."""
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path)
    parser.add_argument(
        "--seeds", type=suite.seed_range, default=range(1), help="0..99 for tuning, 1000 and above for reporting"
    )
    parser.add_argument("--sample", type=int, help="about this many cases, spread evenly")
    parser.add_argument("--kind", action="append", default=[], help="only forms whose name contains this (repeatable)")
    parser.add_argument("--design", action="append", default=[], help="only this mechanism (repeatable)")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--limit", type=float, default=300.0, help="seconds for one case")
    parser.add_argument("--keep", action="store_true", help="keep datasets and answers")
    parser.add_argument("--list", action="store_true", help="print the cases and end")
    parser.add_argument(
        "--unseen", type=int, nargs="?", const=1, choices=joint_plan.SERIES, help="forms of this report, not those for tuning"
    )
    chosen = parser.parse_args()
    series = chosen.unseen
    planned = joint_plan.unseen_cases(chosen.seeds, series) if series else joint_plan.cases(chosen.seeds)
    cases = [
        case
        for case in planned
        if (not chosen.kind or any(kind in case.forms for kind in chosen.kind))
        and (not chosen.design or case.design in chosen.design)
    ]
    if chosen.sample:
        cases = plan.sampled(cases, chosen.sample)
    if chosen.list:
        print("\n".join(case.name for case in cases))
        return
    if chosen.out is None:
        parser.error("--out DIR is needed")
    run(cases, chosen.out, jobs=chosen.jobs, limit=chosen.limit, keep=chosen.keep)
    print((chosen.out / "summary.md").read_text())


if __name__ == "__main__":
    main()
