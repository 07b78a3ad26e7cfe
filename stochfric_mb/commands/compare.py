"""``stochfric compare``: the same law, seed and coefficient path in several engines, against the reference."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from stochfric_mb.commands import completion
from stochfric_mb.commands.options import command_line, engine_names, scenario_options
from stochfric_mb.commands.speech import answer, say, spoken

if TYPE_CHECKING:
    from pathlib import Path

    from stochfric_mb.comparison import Comparison

EXAMPLE = """\b
Example:
  stochfric compare kang2015_table1 --seed 1 --out comparison
"""
MARKER = "compare.json"
"""File that shows that a folder holds a comparison."""
ERRORS = "Engine minus reference: position, period, stick fraction, coefficients; computing time"


@click.command(epilog=EXAMPLE)
@spoken
@scenario_options
@click.option(
    "--engines",
    metavar="A,B,...",
    shell_complete=completion.engines,
    help="Engines to compare with the reference; default: all that are installed.",
)
@click.option(
    "--convergence/--no-convergence", default=True, show_default=True, help="Measure the error at four steps as well."
)
@click.option("--however-long", is_flag=True, help="Go on also where an engine would take more than a day.")
@click.option("-o", "--out", required=True, metavar="DIR", help="Folder for compare.json, report.html and plots.")
def compare(
    scenario: str,
    seed: int,
    dt: float | None,
    law: str | None,
    overrides: tuple[str, ...],
    force: bool,
    engines: str | None,
    convergence: bool,
    however_long: bool,
    out: str,
) -> None:
    """Compare engines with the reference on SCENARIO (a TOML file or the name of a bundled one) and write a report."""
    from stochfric_mb import comparison as library
    from stochfric_mb.commands.compiling import compiling_beside
    from stochfric_mb.commands.progress import display
    from stochfric_mb.engines import adapter
    from stochfric_mb.outputs import check_target, claimed, whole_folder
    from stochfric_mb.scenario import load_scenario

    names = engine_names(engines)
    problem = load_scenario(scenario, law=law, overrides=overrides)
    target = check_target(out, force=force, marker=MARKER)
    with display() as shown, claimed(target):
        shown.note("loading engines")
        for name in names or ():
            adapter(name)
        chosen = names or [name for name in library.installed_engines() if name != "reference"]
        with compiling_beside(chosen, problem) as wait_for:

            def stage(name: str, duration: float) -> Callable[[float], None]:
                wait_for(name)
                return shown.run(name, duration, however_long=however_long)

            result = library.compare(problem, engines=names, seed=seed, dt=dt, convergence=convergence, stage=stage)
        shown.note("drawing the report")
        with whole_folder(target, replace=force) as folder:
            content = write(result, folder, command_line())
    answer(content)
    _show(result)
    say(f"{target / 'report.html'}")


def write(comparison: Comparison, folder: Path, command: str) -> dict[str, Any]:
    """Write compare.json, report.html and plots/ of a comparison into an existing folder; return its numbers."""
    from stochfric_mb.commands.report_folder import write_report
    from stochfric_mb.report.comparison import figures, page

    drawn = figures(comparison)
    content = comparison.to_dict() | {"command": command}
    write_report(folder, numbers=MARKER, content=content, plots=drawn, page=page(comparison, drawn, command))
    return content


def _show(comparison: Comparison) -> None:
    from stochfric_mb.commands.tables import print_table

    rows: list[list[str]] = []
    for name, engine in comparison.to_dict()["engines"].items():
        error, seconds = engine["period_relative_error"], engine["seconds_per_step"]
        rows.append([
            name,
            f"{1.0e6 * engine['max_abs_position_error']:.3g}",
            f"{1.0e6 * engine['rms_position_error']:.3g}",
            "-" if error is None else f"{100.0 * error:.2g}",
            f"{engine['stick_fraction_error']:.2g}",
            f"{engine['coefficient_path_max_difference']:.2g}",
            "-" if seconds is None else f"{1.0e6 * seconds:.3g}",
        ])  # fmt: skip
    print_table(("engine", "max [um]", "rms [um]", "period [%]", "stick", "path", "us/step"), rows, title=ERRORS)
    for engine in comparison.engines:
        for note in engine.notes:
            say(f"Note, {engine.name}: {note}")
