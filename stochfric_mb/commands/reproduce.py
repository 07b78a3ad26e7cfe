"""``stochfric reproduce``: the claims of a published study, each with a verdict."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from stochfric_mb.commands.options import command_line
from stochfric_mb.commands.speech import answer, say, spoken
from stochfric_mb.errors import require_name

if TYPE_CHECKING:
    from pathlib import Path

    from stochfric_mb.reproduction import Reproduction

EXAMPLE = """\b
Example:
  stochfric reproduce kang2015 --quick --out reproduction
"""
MARKER = "reproduce.json"
"""File that shows that a folder holds a reproduction."""
STUDIES = ("kang2015",)


@click.command(epilog=EXAMPLE)
@spoken
@click.argument("study")
@click.option("--quick", is_flag=True, help="Fewer samples and shorter runs: some seconds instead of minutes.")
@click.option("--seed", type=click.IntRange(0, 2**32 - 1), default=0, show_default=True, help="Seed of all random numbers.")
@click.option("-o", "--out", required=True, metavar="DIR", help="Folder for reproduce.json, report.html and plots.")
@click.option("--force", is_flag=True, help="Replace what is at --out.")
def reproduce(study: str, quick: bool, seed: int, out: str, force: bool) -> None:
    """Test every claim of STUDY (kang2015) and write numbers, verdicts and a report."""
    require_name("study", study, STUDIES)
    from stochfric_mb.commands.progress import display
    from stochfric_mb.outputs import check_target, claimed, whole_folder

    target = check_target(out, force=force, marker=MARKER)
    with display() as shown, claimed(target):
        shown.note("loading")
        from stochfric_mb import reproduction as library

        result = library.reproduce(settings=library.QUICK if quick else library.FULL, seed=seed, stage=shown.count)
        shown.note("drawing the report")
        with whole_folder(target, replace=force) as folder:
            content = write(result, folder, command_line())
    answer(content)
    _show(result)
    say(f"{target / 'report.html'}")


def write(result: Reproduction, folder: Path, command: str) -> dict[str, Any]:
    """Write reproduce.json, report.html and plots/ of a reproduction into an existing folder; return its numbers."""
    from stochfric_mb.commands.report_folder import write_report
    from stochfric_mb.report.reproduction import figures, page

    drawn = figures(result)
    content = result.to_dict() | {"command": command}
    write_report(folder, numbers=MARKER, content=content, plots=drawn, page=page(result, drawn, command))
    return content


def _show(result: Reproduction) -> None:
    from stochfric_mb.commands.tables import print_table

    rows = [[claim.id, claim.verdict, claim.reason] for claim in result.claims]
    print_table(("claim", "verdict", "numbers"), rows, title="Claims and verdicts")
