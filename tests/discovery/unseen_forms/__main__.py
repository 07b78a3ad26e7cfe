"""Makes the records, has each one answered once, and prints the table.

::

    python -m tests.discovery.unseen_forms --out DIR [--series 1] [--plan core] [--seed S]
        [--repeats 1] [--workers 1 | --here] [--limit-s 1200]

An interrupted run goes on where it stopped. ``DIR/cases.jsonl`` has a line a case, ``DIR/records`` the datasets.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Lock

from tests.discovery.suite import time_limit

from .forms import NONE
from .records import Case, cases, write_record
from .tables import judged, table

ROOT = Path(__file__).parents[3]


def main() -> None:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True, help="folder of records and answers")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--repeats", type=int, default=1, help="seeds in turn, from --seed on")
    parser.add_argument("--workers", type=int, default=1, help="cases at a time")
    parser.add_argument("--limit-s", type=float, default=1200.0, help="seconds that discovery may take for a case")
    parser.add_argument(
        "--plan",
        choices=("core", "all", "nulls"),
        default="core",
        help="core: each form once; all: designs and strengths; nulls: the rigs that are as believed, in each design",
    )
    parser.add_argument(
        "--series",
        type=int,
        choices=sorted({case.form.series for case in cases()}),
        default=1,
        help="the set: the first, or one written later",
    )
    parser.add_argument("--strength", type=float, nargs="*", default=[], help="only these strengths")
    parser.add_argument("--only", nargs="*", default=[], help="forms, families (named, unknown, none) or names of cases")
    parser.add_argument("--here", action="store_true", help="one after the other in this process, whose code is loaded once")
    parser.add_argument("--records-only", action="store_true", help="make the records, ask nothing")
    parser.add_argument("--table", action="store_true", help="print the table of what is there")
    parser.add_argument("--make", help=argparse.SUPPRESS)
    parser.add_argument("--answer", type=Path, help=argparse.SUPPRESS)
    given = parser.parse_args()
    out = given.out.resolve()
    if given.make:
        write_record(next(case for case in cases() if case.name == given.make), out, given.seed)
        return
    if given.answer:
        print(json.dumps(_answer(given.answer)))
        return
    out.mkdir(parents=True, exist_ok=True)
    lines = [json.loads(line) for line in _file(out).read_text().splitlines()] if _file(out).exists() else []
    seeds = range(given.seed, given.seed + given.repeats)
    lines = [line for line in lines if line["seed"] in seeds]
    if not given.table:
        chosen = _chosen(given)
        _run([(case, seed) for seed in seeds for case in chosen], out, given, lines)
    if lines:
        print(table(lines))


def _file(out: Path) -> Path:
    return out / "cases.jsonl"


def _chosen(given: argparse.Namespace) -> list[Case]:
    """Return the cases of the plan; `core` takes each form at full strength, designs in turn."""
    every = [case for case in cases() if case.form.series == given.series]
    if given.plan == "core":
        names = list(dict.fromkeys(case.form.name for case in every))
        every = [
            case
            for case in every
            if case.strength == 1.0 and case.design == case.form.designs[names.index(case.form.name) % len(case.form.designs)]
        ]
    if given.plan == "nulls":
        every = [case for case in every if case.family == NONE]
    wanted = set(given.only)
    every = [case for case in every if not given.strength or case.strength in given.strength]
    random.Random(given.series).shuffle(every)  # so that a run that was cut short holds a fair share of everything
    return [case for case in every if not wanted or wanted & {case.form.name, case.family, case.name}]


def _run(chosen: list[tuple[Case, int]], out: Path, given: argparse.Namespace, lines: list[dict]) -> None:
    done = {(line["form"], line["design"], line["strength"], line["seed"]) for line in lines}
    lock = Lock()

    def one(case: Case, seed: int) -> None:
        if (case.form.name, case.design, case.strength, seed) in done:
            return
        folder = out / "records" / f"seed_{seed}" / case.name
        if not (folder / "truth.json").exists():
            if given.here:
                write_record(case, folder, seed)
            else:
                _child("--out", str(folder), "--make", case.name, "--seed", str(seed), limit=None)
        truth = json.loads((folder / "truth.json").read_text())
        if given.records_only:
            print(f"{case.name}: {truth['feature']} {truth['size']:g} floors", flush=True)
            return
        line = judged(truth, (_asked_here if given.here else _asked)(folder / "data", given.limit_s))
        with lock:
            with _file(out).open("a") as file:
                file.write(json.dumps(line) + "\n")
            lines.append(line)
            mark = "right" if line["right"] else "class" if line["class_right"] and case.family != NONE else "wrong"
            print(f"{case.name}: {line['first'] or line['answer']} ({mark}), {line['seconds']:.0f} s", flush=True)

    if given.here:
        for case, seed in chosen:
            one(case, seed)
        return
    with ThreadPoolExecutor(given.workers) as pool:
        list(pool.map(lambda item: one(*item), chosen))


def _child(*arguments: str, limit: float | None) -> str:
    command = [sys.executable, "-m", __package__, *arguments]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen(command, cwd=ROOT, start_new_session=True, **pipes) as child:
        try:
            out, errors = child.communicate(timeout=limit)
        except BaseException:
            os.killpg(child.pid, signal.SIGKILL)  # with its own helpers
            raise
    if child.returncode:
        raise RuntimeError(f"{' '.join(arguments)}: {errors.strip()[-800:]}")
    return out


def _asked(data: Path, limit: float) -> dict:
    """Return the answer to a dataset, or why there is none."""
    start = time.perf_counter()
    try:
        return json.loads(_child("--out", str(data), "--answer", str(data), limit=limit).splitlines()[-1])
    except subprocess.TimeoutExpired:
        return {"verdict": "no answer", "error": "limit", "seconds": time.perf_counter() - start}
    except RuntimeError as error:
        return {"verdict": "no answer", "error": str(error), "seconds": time.perf_counter() - start}


def _asked_here(data: Path, limit: float) -> dict:
    """Return the same, asked in this process."""
    start = time.perf_counter()
    try:
        with time_limit(limit):
            return _answer(data)
    except Exception as error:  # a failure is an answer, too
        return {"verdict": "no answer", "error": f"{type(error).__name__}: {error}", "seconds": time.perf_counter() - start}


def _answer(data: Path) -> dict:
    """Return what discovery says of a dataset."""
    from stochfric_mb import discover

    start, begin = time.perf_counter(), sum(os.times()[:4])
    result = discover(data).result
    first = result.effects[0].kind if result.effects else None
    gap = result.leads
    closed = gap.closed if gap else None
    seconds, processor = time.perf_counter() - start, sum(os.times()[:4]) - begin  # of children that ended, too
    return {"verdict": result.verdict, "first": first, "closed": closed, "seconds": seconds, "processor_seconds": processor}


if __name__ == "__main__":
    main()
