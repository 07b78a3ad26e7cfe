"""Judge discovery on hidden effects: python -m tests.discovery.suite --out DIR [--full] [--seeds A..B] [--jobs 2].

Leaves DIR/cases/CASE.json (truth, result, seconds), DIR/summary.md and DIR/summary.json. Cases that are there
are not run again.
"""

import argparse
import json
import shutil
import signal
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

from . import judge, plan
from .generator.case import Case, write
from .resimulate import rescored

Discover = Callable[[Path, Path], None]
"""(dataset folder, output folder): leaves result.json in the output folder."""


def by_command(dataset: Path, out: Path) -> None:
    """`stochfric discover DATASET --out OUT`, within this process: compiled code is loaded once for all cases."""
    from stochfric_mb.__main__ import main as command

    before = sys.argv
    sys.argv = ["stochfric", "discover", str(dataset), "--out", str(out)]
    try:
        command()
    except SystemExit as end:
        if end.code not in (0, None):
            raise RuntimeError(f"stochfric discover ended with exit code {end.code}") from end
    finally:
        sys.argv = before


def run_case(
    case: Case, out: Path, discover: Discover, limit: float, *, keep: bool = False, rescore: bool = False
) -> dict[str, Any]:
    """Generate, discover, and store what came; a failure is stored as an answer, too.

    With `rescore` what `augmented.toml` closes of the gap by itself is stored beside what the result claims.
    """
    dataset, answer = out / "datasets" / case.name, out / "answers" / case.name
    truth = write(case, dataset, out / "truth" / f"{case.name}.json")
    stored = answered(truth, dataset, answer, discover, limit)
    if rescore and stored["result"] and stored["result"]["verdict"] == "effect":
        again = rescored(dataset, answer)
        stored["rescored"] = again and {**asdict(again), "closed": again.closed}
    file = _file(case, out)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(stored, indent=1))
    if not keep:
        shutil.rmtree(dataset)
        shutil.rmtree(answer, ignore_errors=True)
    return stored


def answered(truth: dict[str, object], dataset: Path, answer: Path, discover: Discover, limit: float) -> dict[str, Any]:
    """Discover in a dataset that is there; what is stored of it: truth, result, error and seconds."""
    shutil.rmtree(answer, ignore_errors=True)  # left by a run that was cut off
    result, error = None, None
    begin = time.perf_counter()
    try:
        with time_limit(limit):
            discover(dataset, answer)
        result = json.loads((answer / "result.json").read_text())
    except Exception as failure:  # whatever goes wrong in one case must not end the suite
        error = f"{type(failure).__name__}: {failure}"
    return {"truth": truth, "result": result, "error": error, "seconds": time.perf_counter() - begin}


def run(
    cases: list[Case],
    out: Path,
    discover: Discover = by_command,
    *,
    jobs: int = 1,
    limit: float = 300.0,
    keep: bool = False,
    retry: bool = False,
    rescore: bool = False,
) -> list[judge.Verdict]:
    """Run the cases that are not yet stored (with `retry` also those that failed) and judge all; writes the summaries."""
    open_cases = [case for case in cases if not _finished(_file(case, out), retry=retry)]
    if jobs == 1:
        for i, case in enumerate(open_cases):
            _say(i, len(open_cases), case, run_case(case, out, discover, limit, keep=keep, rescore=rescore))
    else:
        with ProcessPoolExecutor(jobs) as pool:
            waiting = {
                pool.submit(run_case, case, out, discover, limit, keep=keep, rescore=rescore): case for case in open_cases
            }
            for i, done in enumerate(as_completed(waiting)):
                _say(i, len(open_cases), waiting[done], done.result())
    verdicts = [judged(json.loads(_file(case, out).read_text())) for case in cases]
    out.mkdir(parents=True, exist_ok=True)
    seeds = sorted({case.seed for case in cases})
    kind = "reporting" if seeds and seeds[0] in plan.REPORTING else "tuning"
    title = f"Hidden effects: {len(cases)} cases, {kind} seeds {seeds[0]}..{seeds[-1]}" if seeds else "Hidden effects: no case"
    (out / "summary.md").write_text(judge.as_markdown(verdicts, title))
    tables = {"title": title, "summary": judge.summary(verdicts), "verdicts": [asdict(verdict) for verdict in verdicts]}
    (out / "summary.json").write_text(json.dumps(tables, indent=1))
    return verdicts


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise TimeoutError in this process after the time."""

    def give_up(*_: object) -> None:
        raise TimeoutError(f"no answer after {seconds:g} s")

    before = signal.signal(signal.SIGALRM, give_up)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def judged(stored: dict[str, Any]) -> judge.Verdict:
    """The verdict on what is stored of a case."""
    return judge.judge(stored["truth"], stored["result"], stored["seconds"], stored.get("rescored"))


def _say(i: int, n: int, case: Case, stored: dict[str, Any]) -> None:
    verdict = judged(stored)
    mark = "ok   " if verdict.top_1 else "WRONG"
    reason = f" ({stored['error']})" if stored["error"] else ""
    print(f"[{i + 1}/{n}] {mark} {case.name}: {verdict.answer} in {verdict.seconds:.1f} s{reason}", flush=True)


def _file(case: Case, out: Path) -> Path:
    return out / "cases" / f"{case.name}.json"


def _finished(file: Path, *, retry: bool) -> bool:
    return file.exists() and not (retry and json.loads(file.read_text())["error"])


def seed_range(text: str) -> range:
    """A..B, or one seed, as argparse reads it; all for tuning or all for reporting."""
    first, _, last = text.partition("..")
    seeds = range(int(first), int(last or first) + 1)
    if not any(all(seed in known for seed in seeds) for known in (plan.TUNING, plan.REPORTING)):
        raise argparse.ArgumentTypeError("seeds must be all for tuning (0..99) or all for reporting (1000..9999)")
    return seeds


def main() -> None:
    """Parse the command line and run."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--full", action="store_true", help="all cases of the seeds; default: a sample of 24")
    parser.add_argument("--sample", type=int, help="about this many cases, spread evenly")
    parser.add_argument("--seeds", type=seed_range, default=range(1), help="A..B of 0..99 (tuning) or 1000..9999 (reporting)")
    parser.add_argument("--kind", action="append", default=[], help="only this kind or form (repeatable)")
    parser.add_argument("--design", action="append", default=[], help="only this design (repeatable)")
    parser.add_argument("--strength", action="append", type=float, default=[], help="only this strength (repeatable)")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--limit", type=float, default=300.0, help="seconds for one case")
    parser.add_argument("--keep", action="store_true", help="keep datasets and answers")
    parser.add_argument("--retry", action="store_true", help="run cases again that failed before")
    parser.add_argument("--rescore", action="store_true", help="score each augmented.toml a second time, alone")
    parser.add_argument("--list", action="store_true", help="print the cases and end")
    chosen = parser.parse_args()
    cases = plan.selected(plan.cases(chosen.seeds), set(chosen.kind), set(chosen.design), set(chosen.strength))
    filtered = bool(chosen.kind or chosen.design or chosen.strength)
    if chosen.sample or not (chosen.full or filtered or chosen.list):
        cases = plan.sampled(cases, chosen.sample or 24)
    if chosen.list:
        print("\n".join(case.name for case in cases))
        return
    if chosen.out is None:
        parser.error("--out DIR is needed")
    run(cases, chosen.out, jobs=chosen.jobs, limit=chosen.limit, keep=chosen.keep, retry=chosen.retry, rescore=chosen.rescore)
    print((chosen.out / "summary.md").read_text())


if __name__ == "__main__":
    main()
