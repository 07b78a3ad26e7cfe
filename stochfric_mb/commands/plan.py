"""``stochfric plan``: what planned runs could show of what a model may lack, before anything is measured."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from stochfric_mb.commands import completion
from stochfric_mb.commands.options import command_line
from stochfric_mb.commands.speech import answer, say, spoken

if TYPE_CHECKING:
    from stochfric_mb.discovery.planning.planned_run import PlannedRun
    from stochfric_mb.scenario import Scenario

EXAMPLE = """\b
Example:
  stochfric plan kang2015_table1 --noise 5e-6 --run duration=30 --run belt_velocity=5e-3,duration=15 --out plan
"""
MARKER = "plan.json"
"""File that shows that a folder holds a plan."""
SHOWN = 3
"""Further runs that are printed."""


@click.command(epilog=EXAMPLE)
@spoken
@click.argument("scenario", shell_complete=completion.scenarios)
@click.option(
    "--run", "runs", multiple=True, metavar="KEY=NUMBER,...", help="A planned run; repeatable. Default: as [simulation] says."
)
@click.option("--noise", type=float, metavar="X", help="Standard deviation of the position sensor's noise [m or rad].")
@click.option("--joint", metavar="NAME", help="Joint of an mjcf model. Default: the first in mechanism.friction.")
@click.option("--no-extra", is_flag=True, help="Try no further runs.")
@click.option("-o", "--out", required=True, metavar="DIR", help="Folder for report and numbers.")
@click.option("--force", is_flag=True, help="Replace what is at --out.")
def plan(
    scenario: str, runs: tuple[str, ...], noise: float | None, joint: str | None, no_extra: bool, out: str, force: bool
) -> None:
    """Say which effects planned runs of SCENARIO could show and at what size, and which extra run would add most."""
    from stochfric_mb.commands.progress import display
    from stochfric_mb.commands.report_folder import write_report
    from stochfric_mb.outputs import check_target, claimed, whole_folder

    target = check_target(out, force=force, marker=MARKER)
    with display() as shown, claimed(target):
        shown.note("loading")
        from stochfric_mb.discovery.planning.planner import planned
        from stochfric_mb.report.planning import plan_page

        stated, wanted = _wanted(scenario, runs, noise)
        result = planned(stated, wanted, joint=joint, extra=not no_extra, progress=shown.note)
        content = result.to_dict()
        with whole_folder(target, replace=force) as folder:
            page = plan_page(content, stated.title, command_line(without=("out", "force")))
            write_report(folder, numbers=MARKER, content=content, plots={}, page=page)
    answer(content)
    _show(content)
    say(f"{target / 'report.html'}")


def _wanted(scenario: str, texts: tuple[str, ...], noise: float | None) -> tuple[Scenario[Any], list[PlannedRun]]:
    """Return the scenario and the runs that are planned."""
    from stochfric_mb.discovery.planning.planned_run import is_plan, load_plan, run_from_text, usual_run
    from stochfric_mb.errors import InputError
    from stochfric_mb.scenario import load_any_scenario

    if is_plan(Path(scenario)):
        if texts or noise is not None:
            raise InputError(f"{scenario} holds the planned runs; write --run and --noise into it")
        return load_plan(Path(scenario))
    stated = load_any_scenario(scenario)
    usual = usual_run(stated, noise)
    return stated, [run_from_text(text, usual, i) for i, text in enumerate(texts, start=1)] or [usual]


def _show(content: Mapping[str, Any]) -> None:
    from stochfric_mb.commands.tables import print_table
    from stochfric_mb.effects import words_of
    from stochfric_mb.report.planning import beside, pair_text

    rows = [
        [words_of(x["kind"]), x["parameter"], ("<= " if x["at_most"] else "") + f"{x['value']:.3g}", x["unit"], beside(x)]
        for x in content["limits"]
    ]
    if rows:
        print_table(("effect", "parameter", "named from", "unit", "at"), rows, title="Detection limits of the planned runs")
    for kind, what in content["unseen"].items():
        say(f"Not seen at any size: {words_of(kind)}; {what} would show it")
    for pair in content["pairs"]:
        say(f"Not distinguished: {pair_text(pair)}")
    for run in content["extra"][:SHOWN]:
        say(f"Extra run: {run['text']}: {_added(run)}")
    for note in content["notes"]:
        say(f"Note: {note}")


def _added(run: Mapping[str, Any]) -> str:
    """Return what a further run adds, in words."""
    from stochfric_mb.effects import words_of

    parts = [f"shows {', '.join(map(words_of, run['shows']))}"] if run["shows"] else []
    parts += [f"distinguishes {len(run['separates'])} more pairs"] if run["separates"] else []
    return ", ".join([*parts, f"limits times {run['limits']:.2g}"])
