"""A friction element as a folder of C: library, header, glue for vendors' interfaces, and how to compile it."""

from __future__ import annotations

from pathlib import Path

from stochfric_mb.export.element import element, template
from stochfric_mb.export.exported import Exported

MARKER = "stochfric.h"
"""The file by which a folder is known to come from an export."""
GLUE = {
    "adams_vfosub.c": "Adams/Solver, C interface: a VFORCE (three force components)",
    "adams_gfosub.c": "Adams/Solver, C interface: a GFORCE (three forces, three torques)",
    "recurdyn_friction.c": "RecurDyn, user subroutine of a screw force",
    "simulink_sfunction.c": "Simulink, level-2 C MEX S-function",
}
"""File of vendor glue -> what it is for."""


def library_files(exported: Exported) -> dict[str, str]:
    """Return the files of the C library: name -> text.

    Raises:
        UntranslatableError: a law or effect that cannot be translated; names it.
    """
    made = element(exported)
    glue = {name: template(f"glue/{name}") for name in GLUE}
    return {
        "stochfric.h": made.header,
        "stochfric.c": made.source,
        "stochfric_steps.h": template("steps.h"),
        "README.txt": _readme(exported),
        **glue,
    }


def write_library(exported: Exported, folder: Path) -> None:
    """Write the C library into an existing folder."""
    for name, text in library_files(exported).items():
        (folder / name).write_text(text, encoding="utf-8")


def _readme(exported: Exported) -> str:
    glue = "\n".join(f"  {name}: {what}" for name, what in GLUE.items())
    notes = "".join(f"Note: {note}.\n" for note in exported.notes)
    return (
        f"{exported.title or 'Friction'}: law {exported.inner.kind}, as C99.\n\n"
        "  stochfric.h, stochfric.c: the library. Compile: cc -std=c99 -O2 -ffp-contract=off -c stochfric.c\n"
        f"{glue}\n\n"
        f"{notes}"
        "The glue was compiled against stand-ins of the vendors' interfaces, never against or inside their products.\n"
    )
