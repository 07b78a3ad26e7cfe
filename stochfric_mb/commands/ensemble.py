"""``stochfric ensemble``: many runs of one scenario into one dataset; an interrupted one goes on where it was."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from stochfric_mb.commands import completion
from stochfric_mb.commands.options import scenario_options
from stochfric_mb.commands.speech import answer, say, spoken
from stochfric_mb.engines import ENGINES
from stochfric_mb.errors import InputError

if TYPE_CHECKING:
    from stochfric_mb.ensemble.job import Job
    from stochfric_mb.ensemble.produce import Produced
    from stochfric_mb.ensemble.result import EnsembleResult
    from stochfric_mb.scenario import Scenario

EXAMPLE = """\b
Example:
  stochfric ensemble kang2015_table1 --n-runs 1000 --seed 1 --output-times 2,10 --out ens.nc --plot
"""
MARKER = "report.html"
"""File that shows that a folder holds the page of an ensemble."""
INTERRUPTED = 130


@click.command(epilog=EXAMPLE)
@spoken
@scenario_options
@click.option("--n-runs", required=True, type=int, metavar="N", help="Number of runs.")
@click.option(
    "--engine",
    shell_complete=completion.engines,
    default="reference",
    show_default=True,
    metavar="|".join(ENGINES),
    help="What computes them.",
)
@click.option("--output-times", metavar="T,...", help="Times that are kept [s]; default: the scenario's output step.")
@click.option("--statistics-only", is_flag=True, help="Keep means, quantiles and histograms instead of the runs.")
@click.option("--workers", type=int, metavar="W", help="Threads or processes on this machine; default: all cores.")
@click.option("--scheduler", metavar="ADDRESS", help="Compute on a Dask cluster instead, such as tcp://host:8786.")
@click.option("-o", "--out", required=True, metavar="FILE", help="What to write: .nc, or .zarr for what is beyond the memory.")
@click.option("--plot", is_flag=True, help="Write a page with figures, and its numbers, into the folder OUT_plots as well.")
def ensemble(
    scenario: str,
    seed: int,
    dt: float | None,
    law: str | None,
    overrides: tuple[str, ...],
    force: bool,
    n_runs: int,
    engine: str,
    output_times: str | None,
    statistics_only: bool,
    workers: int | None,
    scheduler: str | None,
    out: str,
    plot: bool,
) -> None:
    """Simulate many runs of SCENARIO (a TOML file or the name of a bundled one), each with its own coefficients.

    Finished blocks lie in the folder OUT.parts until OUT is whole. The same command goes on where an interrupted one was.
    """
    from stochfric_mb.commands.progress import display
    from stochfric_mb.ensemble.dataset import check_ensemble_target, read_ensemble
    from stochfric_mb.ensemble.job import job
    from stochfric_mb.ensemble.planning import MAX_BYTES
    from stochfric_mb.ensemble.produce import check_memory, checked_workers, produce
    from stochfric_mb.outputs import check_target
    from stochfric_mb.scenario import load_any_scenario, load_scenario

    target = check_ensemble_target(out, force=force)
    plots = check_target(plots_folder(target), force=force, marker=MARKER) if plot else None
    problem: Any = (load_any_scenario if engine == "warp" else load_scenario)(scenario, law=law, overrides=overrides)
    times = times_of(output_times)
    task = job(problem, n_runs, seed=seed, engine=engine, dt=dt, output_times=times, statistics_only=statistics_only)
    here = checked_workers(workers, scheduler)
    check_memory(task, target, here, MAX_BYTES)
    say(_plan(task, target, here, scheduler))
    try:
        with display() as shown:
            shown.note(f"loading {engine}")
            count = shown.count("runs", n_runs)
            done = produce(task, target, workers=workers, scheduler=scheduler, force=force, progress=count)
    except KeyboardInterrupt:
        _say_how_to_resume(target)
        click.get_current_context().exit(INTERRUPTED)
    result, _ = read_ensemble(target)
    facts = _facts(result, done)
    if plots is not None:
        _plot(result, problem, plots, facts, force=force)
    answer(facts)
    _show(result, facts, done)


def times_of(text: str | None) -> list[float] | None:
    """Return the times in a comma-separated list [s], None if there is no list.

    Raises:
        InputError: something in it is no number.
    """
    if text is None:
        return None
    try:
        return [float(word) for word in text.split(",") if word.strip()]
    except ValueError:
        raise InputError(
            f"--output-times {text!r} is no list of times; give numbers [s] with commas, such as 0.5,2,10"
        ) from None


def plots_folder(target: Path) -> Path:
    """Return the folder for the plots of an ensemble: beside it, ``_plots`` at the end of its name."""
    return target.with_name(target.stem + "_plots")


def _plan(task: Job, target: Path, workers: int, scheduler: str | None) -> str:
    """Return what will be done, and the memory that it takes."""
    from stochfric_mb.ensemble.job import BATCH, PROCESSES
    from stochfric_mb.ensemble.produce import memory

    plan = task.plan(workers)
    kind = {BATCH: "threads of MuJoCo's Batch", PROCESSES: "processes"}.get(task.how, "threads")
    here = "the device of MuJoCo Warp" if task.engine == "warp" else f"{workers} {kind}"
    where = f"the cluster {scheduler}" if scheduler is not None else here
    kept = "statistics" if task.statistics_only else "runs"
    blocks = f"{plan.n_blocks} blocks of {plan.block} runs" if plan.n_blocks > 1 else f"1 block of {plan.block} runs"
    return (
        f"{plan.n_runs} runs at {plan.n_times} times, {plan.method}\n"
        f"{blocks} on {where}; at most {memory(task, target, workers) / 2**20:.1f} MiB of memory for {kept} and blocks"
    )


def _say_how_to_resume(target: Path) -> None:
    from stochfric_mb.ensemble.parts import parts_folder

    folder = parts_folder(target)
    n = len(list(folder.glob("block-*.npz"))) if folder.is_dir() else 0
    click.echo(
        f"Interrupted; {folder} keeps what is finished ({n} block files). The same command goes on from there.", err=True
    )


def _plot(result: EnsembleResult, scenario: Scenario, folder: Path, facts: dict[str, Any], *, force: bool) -> None:
    from stochfric_mb.commands.options import command_line
    from stochfric_mb.outputs import whole_folder
    from stochfric_mb.report.ensemble import figures, page

    drawn = figures(result, scenario)
    with whole_folder(folder, replace=force) as temporary:
        for name, svg in drawn.items():
            (temporary / f"{name}.svg").write_text(svg, encoding="utf-8")
        (temporary / MARKER).write_text(page(scenario.title, facts, drawn, command_line()), encoding="utf-8")
        (temporary / "ensemble.json").write_text(json.dumps(facts, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    say(str(folder / MARKER))


def _facts(result: EnsembleResult, done: Produced) -> dict[str, Any]:
    """Return what there is to say of an ensemble: its file, what ran, the events with their intervals, the response."""
    import dataclasses

    from stochfric_mb.report.ensemble import response
    from stochfric_mb.statistics import event_statistics

    def finite(number: float) -> float | None:
        return number if math.isfinite(number) else None

    events = dataclasses.asdict(event_statistics(result))
    kept = ("law", "engine", "engine_version", "dt", "seed", "notes")
    return (
        {"out": str(done.path), "n_runs": result.n_runs, **{k: result.attributes[k] for k in kept}}
        | {name: None if e is None else {k: finite(float(v)) for k, v in e.items()} for name, e in events.items()}
        | {"response": response(result)}
    )


def _show(result: EnsembleResult, facts: dict[str, Any], done: Produced) -> None:
    from stochfric_mb.commands.tables import print_table
    from stochfric_mb.report.ensemble import EVENTS

    rows: list[list[str]] = []
    for q in facts["response"]:
        numbers = [q["mean"], q["std"], *q["quantiles"]]
        for i, t in enumerate(q["time"]):
            shown = ["-" if values[i] is None else f"{1e3 * values[i]:.4g}" for values in numbers]
            rows.append([f"{q['name']} [m{q['unit']}]", f"{t:g}", *shown])
    print_table(("", "time [s]", "mean", "std", "5 %", "median", "95 %"), rows, title="Over the runs")
    rows = [_interval(name if unit == "-" else f"{name} [{unit}]", facts[key]) for key, name, unit in EVENTS]
    print_table(("", "mean", "95 % interval"), rows, title="Events")
    about = result.attributes
    for note in about["notes"]:
        say(f"Note: {note}")
    resumed = f", {done.n_resumed} blocks from an interrupted run" if done.n_resumed else ""
    step = f", dt {about['dt']:g} s" if about["dt"] else ""
    say(
        f"{done.path}: {result.n_runs} runs, law {about['law']}, {about['engine']} {about['engine_version']}{step}, seed "
        f"{about['seed']}; {done.seconds:.3g} s{resumed}"
    )


def _interval(name: str, estimate: dict[str, float | None] | None) -> list[str]:
    if estimate is None or estimate["low"] is None:
        return [name, "-" if estimate is None else f"{estimate['value']:.6g}", "-"]
    return [name, f"{estimate['value']:.6g}", f"{estimate['low']:.6g} .. {estimate['high']:.6g}"]
