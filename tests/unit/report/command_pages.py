"""Pages as the commands write them: compare, reproduce, ensemble, plan, dry run, refused data, a driven joint."""

import dataclasses
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from stochfric_mb import load_scenario, reproduction
from stochfric_mb.__main__ import main
from stochfric_mb.reference import simulate
from tests.discovery.joint_generator.case import Case, write

FEW = dataclasses.replace(
    reproduction.QUICK, n_many=100, steps=(0.01, 0.001), resamples=9, n_grid=1, n_pairs=10_000, n_paths=100, n_portrait=2,
    discarded=dict.fromkeys(reproduction.QUICK.discarded, 10.0), portrait_time=5.0, n_sensitivity=2, n_cost=2,
)  # fmt: skip
"""Sizes of a reproduction whose page has all its parts and whose numbers nobody should trust."""


@dataclasses.dataclass(frozen=True)
class Command:
    """What writes a page."""

    words: tuple[str, ...]
    """The command, without ``--out``."""
    page: str = "out/report.html"
    """The page, in the folder it was called in."""
    numbers: str = ""
    """The file of its numbers; empty: none."""
    out: str = "out"
    """What ``--out`` is."""
    before: Callable[[Path], None] | None = None
    """What writes the data that the command reads."""
    exit_code: int = 0


def _record(folder: Path, every: int = 1) -> None:
    motion = simulate(load_scenario("kang2015_table1", overrides=("simulation.duration=30",)), seed=3)
    table = np.column_stack([motion.time, motion.position])[::every]
    np.savetxt(folder / "run.csv", table, "%.9g", ",", header="time [s],position [m]", comments="")


def _coarse(folder: Path) -> None:
    """Write a record at 25 Hz: too few samples in a slip."""
    _record(folder, every=40)


def _joint(folder: Path) -> None:
    write(Case("viscous_friction.proportional", "slide", 1.0, 4), folder / "rig", folder / "truth.json")


TABLE_1 = "kang2015_table1"
COMMANDS = {
    "comparison": Command(("compare", TABLE_1, "--seed", "1", "--set", "simulation.duration=2"), numbers="out/compare.json"),
    "reproduction": Command(("reproduce", "kang2015", "--quick"), numbers="out/reproduce.json"),
    "ensemble": Command(
        ("ensemble", TABLE_1, "--n-runs", "40", "--plot"), "ens_plots/report.html", "ens_plots/ensemble.json", "ens.nc"
    ),
    "plan": Command(("plan", TABLE_1, "--noise", "5e-6", "--run", "duration=30"), numbers="out/plan.json"),
    "dry run": Command(("discover", "run.csv", "--scenario", TABLE_1, "--dry-run"), "out/records.html", before=_record),
    "refused": Command(("discover", "run.csv", "--scenario", TABLE_1), "out/records.html", before=_coarse, exit_code=2),
    "joint": Command(("discover", "rig"), numbers="out/result.json", before=_joint),
}
"""Name of a page -> what writes it."""


def made(name: str, folder: Path) -> tuple[str, object]:
    """Return the text of a page and the content of the file of its numbers, written into an empty folder."""
    command = COMMANDS[name]
    if command.before is not None:
        command.before(folder)
    with pytest.MonkeyPatch.context() as patched:
        patched.chdir(folder)
        patched.setattr(reproduction, "QUICK", FEW)
        done = CliRunner().invoke(main, [*command.words, "--out", command.out, "-q"])
    assert done.exit_code == command.exit_code, done.output
    content = json.loads((folder / command.numbers).read_text(encoding="utf-8")) if command.numbers else {}
    return (folder / command.page).read_text(encoding="utf-8"), content
