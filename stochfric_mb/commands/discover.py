"""``stochfric discover``: find the effect that a model lacks, from measured data."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from pathlib import Path

    from stochfric_mb.discovery.workflow import Outcome

EXAMPLE = """\b
Example:
  stochfric discover models/discovery_example --out discovery
"""
MARKER = "result.json"
"""File that shows that a folder holds the result of a discovery."""


@click.command(epilog=EXAMPLE)
@click.argument("dataset")
@click.option("--scenario", metavar="SCENARIO", help="Model believed so far; needed for a measured file alone.")
@click.option("--out", required=True, metavar="DIR", help="Folder for result.json, augmented.toml, report.html and plots.")
@click.option("--force", is_flag=True, help="Replace what is at --out.")
def discover(dataset: str, scenario: str | None, out: str, force: bool) -> None:
    """Find where the runs of DATASET and their model disagree, name the missing effect, and show that the gap shrinks."""
    from stochfric_mb.commands.progress import display
    from stochfric_mb.storage import check_target, whole_folder

    target = check_target(out, force=force, marker=MARKER)
    with display() as shown:
        shown.note("loading")
        from stochfric_mb import discovery as library

        outcome = library.discover(dataset, scenario=scenario, progress=shown.note)
        shown.note("drawing the report")
        with whole_folder(target) as folder:
            write(outcome, folder)
    _show(outcome)
    click.echo(f"{target}")


def write(outcome: Outcome, folder: Path) -> None:
    """Write result.json and augmented.toml of a discovery into an existing folder."""
    import tomli_w

    (folder / MARKER).write_text(outcome.result.to_json(), encoding="utf-8")
    (folder / "augmented.toml").write_text(tomli_w.dumps(outcome.scenario.to_dict()), encoding="utf-8")


def _show(outcome: Outcome) -> None:
    result = outcome.result
    names = ", ".join(e.kind for e in result.effects)
    click.echo(f"verdict: {result.verdict}" + (f" ({names})" if names else ""))
