"""``stochfric export``: friction for other codes, as a Functional Mock-up Unit or as C."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from stochfric_mb.commands import completion
from stochfric_mb.commands.speech import answer, say, spoken

if TYPE_CHECKING:
    from stochfric_mb.export import Exported

EXAMPLE = """\b
Example:
  stochfric export c kang2015_table1 --out friction_c
"""
FMU_EXAMPLE = """\b
Example:
  stochfric export fmu kang2015_table1 --out friction.fmu
"""


@click.group(epilog=EXAMPLE)
def export() -> None:
    """Take friction to other codes: fmu (Functional Mock-up Unit) or c (C library)."""


def _common(command: Callable[..., Any]) -> Callable[..., Any]:
    for option in (
        click.option("--force", is_flag=True, help="Replace what is at --out."),
        click.option("--set", "overrides", multiple=True, metavar="TABLE.KEY=VALUE", help="Override a value; repeatable."),
        click.option(
            "--law",
            metavar="KIND",
            shell_complete=completion.laws,
            help="Replace the scenario's law; shared parameters are kept.",
        ),
        click.argument("source"),
    ):
        command = option(command)
    return spoken(command)


@export.command(epilog=FMU_EXAMPLE)
@_common
@click.option("-o", "--out", required=True, metavar="FILE", help="The .fmu file to write. Missing folders are made.")
@click.option("--fmi", type=click.Choice(["2", "3"]), default="2", show_default=True, help="Version of FMI.")
@click.option(
    "--part",
    type=click.Choice(["element", "belt_box"]),
    help="The friction alone, or the whole belt-box; default: belt_box where there is one.",
)
@click.option("--platforms", metavar="LIST", help="Platforms to compile for, separated by commas; default: all.")
def fmu(
    source: str,
    law: str | None,
    overrides: tuple[str, ...],
    force: bool,
    out: str,
    fmi: str,
    part: str | None,
    platforms: str | None,
) -> None:
    """Export SOURCE (a friction file, a scenario, or the name of a bundled one) as an FMU, with its C sources inside."""
    from stochfric_mb.c.compiler import TARGETS
    from stochfric_mb.commands.progress import display
    from stochfric_mb.errors import InputError, require_name
    from stochfric_mb.export import load_exported
    from stochfric_mb.export.fmu import fmu_source, write_fmu
    from stochfric_mb.outputs import check_target, claimed, whole_file

    if Path(out).suffix != ".fmu":
        raise InputError(f"--out {out!r} does not end in .fmu; masters look for that ending: add it")
    target = check_target(out, force=force)
    chosen = (
        list(TARGETS) if platforms is None else [require_name("platform", p.strip(), TARGETS) for p in platforms.split(",")]
    )
    with display() as shown, claimed(target):
        shown.note("translating")
        exported = load_exported(source, law=law, overrides=overrides)
        mechanism = exported.mechanism is not None if part is None else part == "belt_box"
        made = fmu_source(exported, fmi=int(fmi), mechanism=mechanism, name=target.stem)
        compiled = shown.count("platforms", len(chosen))
        with whole_file(target, replace=force) as temporary:
            write_fmu(made, temporary, platforms=chosen, compiled=compiled)
    size = target.stat().st_size
    chosen_part = "belt_box" if mechanism else "element"
    more = {"part": chosen_part, "fmi": f"{fmi}.0", "size": size, "platforms": chosen, "model_identifier": made.identifier}
    answer(lambda: _content(out, exported) | more)
    what = {"belt_box": "belt-box", "element": "friction element"}[chosen_part]
    say(f"{out}: {what}, law {exported.inner.kind}, FMI {fmi}.0, {size / 1e6:.2f} MB, {', '.join(chosen)}")
    _say_notes(exported)


@export.command(epilog=EXAMPLE)
@_common
@click.option("-o", "--out", required=True, metavar="DIR", help="The folder to write.")
def c(source: str, law: str | None, overrides: tuple[str, ...], force: bool, out: str) -> None:
    """Export SOURCE (a friction file, a scenario, or the name of a bundled one) as a small C library."""
    from stochfric_mb.export import load_exported
    from stochfric_mb.export.library import MARKER, write_library
    from stochfric_mb.outputs import check_target, claimed, whole_folder

    target = check_target(out, force=force, marker=MARKER)
    with claimed(target):
        exported = load_exported(source, law=law, overrides=overrides)
        with whole_folder(target, replace=force) as temporary:
            write_library(exported, temporary)
    answer(lambda: _content(out, exported) | {"files": sorted(path.name for path in target.iterdir())})
    say(f"{out}: stochfric.h and stochfric.c, law {exported.inner.kind}, with glue for Adams, RecurDyn and Simulink")
    _say_notes(exported)


def _content(out: str, exported: Exported) -> dict[str, Any]:
    """Return what both commands say of their result."""
    return {
        "out": out,
        "law": exported.inner.kind,
        "effects": [effect.kind for effect in exported.effects],
        "notes": list(exported.notes),
    }


def _say_notes(exported: Exported) -> None:
    for note in exported.notes:
        say(f"Note: {note}")
