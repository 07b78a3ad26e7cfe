"""``stochfric discover``: find the effect that a model lacks, from measured data."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from stochfric_mb.commands import completion
from stochfric_mb.commands.options import command_line
from stochfric_mb.commands.speech import answer, say, spoken
from stochfric_mb.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    from stochfric_mb.discovery.outcome import Outcome

EXAMPLE = """\b
Example:
  python examples/discover_random_coefficients.py --out rig
  stochfric discover rig --out discovery
"""
MARKER = "result.json"
"""File that shows that a folder holds the result of a discovery."""


@click.command(epilog=EXAMPLE)
@spoken
@click.argument("dataset", type=click.Path())
@click.option(
    "--scenario",
    metavar="SCENARIO",
    shell_complete=completion.scenarios,
    help="Scenario of the model; needed if DATASET is a measured file.",
)
@click.option("-o", "--out", required=True, metavar="DIR", help="Folder for report, result and exports.")
@click.option("--dry-run", is_flag=True, help="Read and check everything, draw the raw records, say what would be done.")
@click.option("--force", is_flag=True, help="Replace what is at --out.")
def discover(dataset: str, scenario: str | None, out: str, dry_run: bool, force: bool) -> None:
    """Find where the runs of DATASET and their model disagree, name the missing effect, and show that the gap shrinks."""
    from stochfric_mb.commands import dry_run as rehearsal
    from stochfric_mb.commands.progress import display
    from stochfric_mb.outputs import check_target, claimed, whole_folder

    if dry_run:
        rehearsal.dry_run(dataset, scenario, out, force=force)
        return
    refused_before = rehearsal.only_records(out)
    target = check_target(out, force=force or refused_before, marker=rehearsal.MARKER if refused_before else MARKER)
    with display() as shown, claimed(target):
        shown.note("loading")
        from stochfric_mb import discovery as library

        try:
            outcome = library.discover(dataset, scenario=scenario, progress=shown.note)
        except InputError as error:
            raise rehearsal.with_records(dataset, scenario, target, error) from None
        shown.note("drawing the report")
        with whole_folder(target, replace=force or refused_before) as folder:
            # the same data give the same bytes, wherever they are written to
            content = write(outcome, folder, f"{command_line(without=('out', 'force'))} --out DIR")
    answer(content)
    _show(content)
    say(f"{target / 'report.html'}")


def write(outcome: Outcome, folder: Path, command: str) -> dict[str, Any]:
    """Write result.json, report.html, plots/ and the exports of a discovery into an existing folder.

    Returns:
        The content of ``result.json``.
    """
    import json

    from stochfric_mb.commands.report_folder import write_report
    from stochfric_mb.discovery.export import files
    from stochfric_mb.report.discovery import further, page
    from stochfric_mb.report.discovery_evidence import gather
    from stochfric_mb.report.discovery_facts import complete
    from stochfric_mb.report.discovery_pictures import figures
    from stochfric_mb.report.record_picture import record_pictures

    evidence = gather(outcome)
    content = json.loads(complete(outcome, evidence, command).to_json())
    drawn = figures(content, evidence)
    more, records = further(outcome), record_pictures(outcome.dataset)
    plots = drawn | {f"{number}_{title.lower().replace(' ', '_')}": svg for number, (title, _, svg) in enumerate(more, 1)}
    write_report(folder, numbers=MARKER, content=content, plots=plots, page=page(content, drawn, more, records))
    for name, text in files(outcome).items():
        (folder / name).write_text(text, encoding="utf-8")
    return content


def _show(content: Mapping[str, Any]) -> None:
    from stochfric_mb.commands.tables import print_table
    from stochfric_mb.report.discovery import METRICS

    names = ", ".join(e["kind"] for e in content["effects"])
    say(f"Verdict: {content['verdict']}" + (f" ({names})" if names else ""))
    if content["where"] is not None:
        say(content["where"]["text"])
    rows = [
        [effect["kind"], name, f"{p['value']:.4g}", _interval(p), p["unit"]]
        for effect in content["effects"]
        for name, p in effect["parameters"].items()
        if p["value"] or p["low"] != p["high"]
    ]
    if rows:
        print_table(("effect", "parameter", "value", "95 % interval", "unit"), rows)
    for effect in content["effects"]:
        if effect["equivalent_to"]:
            say(f"These data cannot distinguish {effect['kind']} from {', '.join(effect['equivalent_to'])}")
    if (gap := content[content["leading"]]) is not None:
        stages = ("baseline", "recalibrated", "augmented", "floor")
        rows = [[f"{gap[stage]:.3g}" if gap[stage] is not None else "-" for stage in stages]]
        rows[0].append("-" if gap["closed"] is None else f"{100.0 * gap['closed']:.3g} %")
        metric = str(gap["metric"])
        what = METRICS.get(metric, metric)
        title = f"{what[0].upper()}{what[1:]}, on held-out runs, in {gap['unit']} ({metric})"
        print_table(("as stated", *stages[1:], "closed"), rows, title=title)
    for note in content["notes"]:
        say(f"Note: {note}")
    say(f"Next experiment: {content['next_experiment']}")


def _interval(parameter: Mapping[str, Any]) -> str:
    low, high = parameter["low"], parameter["high"]
    return f"{low:.4g} .. {high:.4g}" if low != high else "not fitted"
