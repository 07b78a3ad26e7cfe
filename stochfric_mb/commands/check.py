"""``stochfric check``: what a MuJoCo model's own friction does, and ours in its place."""

from __future__ import annotations

import importlib
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from stochfric_mb.commands import completion
from stochfric_mb.commands.speech import answer, say, spoken
from stochfric_mb.errors import InputError

if TYPE_CHECKING:
    from stochfric_mb.mujoco.check.findings import CheckResult

EXAMPLE = """\b
Example:
  stochfric check incline
"""
TITLE = "Friction as it is (native) and with this package's law (ours)"
HEAD = ("site", "load", "drift", "50 %", "90 %", "breaks", "slows", "energy", "limit")
LEAST = 1.0e-3
"""Drift shown as 0 below this [um/s]."""
LEGEND = """\
load: friction force in the given state, in % of mu N; drift: in um/s (urad/s) under that load, at 50 and at 90 % of
mu N; breaks: break-away force in % of mu_s N; slows: deceleration in % of mu_k N/m; energy: created by friction [J];
limit: explicit step limit of our law [s]; -: could not be measured, see notes in the file"""


@click.command(epilog=EXAMPLE)
@spoken
@click.argument("model", metavar="MODEL", type=click.Path())
@click.option("--keyframe", metavar="NAME", help="Keyframe to start from, by name or number; default: the initial state.")
@click.option("--settle", type=float, default=2.0, show_default=True, metavar="S", help="Time left to itself first [s].")
@click.option("--duration", type=float, metavar="S", help="Time of each hold [s].  [default: 0.5, at most 500 steps]")
@click.option(
    "--law", shell_complete=completion.laws, default="elastic_stick", show_default=True, metavar="KIND", help="Our law."
)
@click.option("--mu-k-ratio", type=float, default=1.0, show_default=True, help="Its mu_k over mu_s, from 0 to 1.")
@click.option("--most", type=click.IntRange(1), default=12, show_default=True, help="Most contact pairs to probe.")
@click.option("-o", "--out", default="check.json", show_default=True, metavar="FILE", help="What to write.")
@click.option("--force", is_flag=True, help="Replace what is at --out.")
def check(
    model: str,
    keyframe: str | None,
    settle: float,
    duration: float | None,
    law: str,
    mu_k_ratio: float,
    most: int,
    out: str,
    force: bool,
) -> None:
    """Probe each contact pair, joint and tendon with friction in MODEL (an MJCF, URDF or MJB file) and say what to change."""
    from stochfric_mb.commands.progress import display
    from stochfric_mb.engines import ENGINES
    from stochfric_mb.errors import MissingEngineError
    from stochfric_mb.outputs import check_target, claimed, whole_file

    _require_model(model)
    target = check_target(Path(out) / "check.json" if Path(out).is_dir() else out, force=force)
    if not ENGINES["mujoco"].installed:
        raise MissingEngineError("mujoco is not installed; in a clone of this package run: pip install '.[mujoco]'")
    with display() as shown, claimed(target):
        shown.note("loading mujoco")
        probe = importlib.import_module("stochfric_mb.mujoco.check").check

        result: CheckResult = probe(
            model, keyframe=keyframe, settle=settle, duration=duration, law=law, mu_k_ratio=mu_k_ratio, most=most,
            stage=shown.stage,
        )  # fmt: skip
        content = result.to_dict()
        with whole_file(target, replace=force) as temporary:
            temporary.write_text(json.dumps(content, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    answer(content)
    _show(content)
    say(str(target))


def _require_model(model: str) -> None:
    """Require that a model that looks like a file is there: what is missing first is said first."""
    if Path(model).suffix and not Path(model).is_file():
        raise InputError(f"{model}: no such file; give an MJCF (.xml), URDF or binary (.mjb) model, or a bundled one: incline")


def _show(content: Mapping[str, Any]) -> None:
    from stochfric_mb.commands.tables import print_cards, print_table

    about = f"timestep {content['timestep']:g} s, {content['integrator']}, {content['cone']} cone"
    say(f"{content['model']}: {about}")
    rows = content["rows"]
    if not rows:
        seen = f"No pair that touches within {content['settle']:g} s, no joint and no tendon has friction"
        say(f"{seen}: nothing to check (see --settle and --keyframe)")
    else:
        print_table(HEAD, [line for row in rows for line in _lines(row)], title=TITLE, whole=True)
        say(LEGEND)
        print_cards([(row["name"], [(row["kind"], row["advice"])]) for row in rows], title="What to change")
        _show_imports(rows)
    for note in content["notes"]:
        say(f"Note: {note}")


def _show_imports(rows: Sequence[Mapping[str, Any]]) -> None:
    """Say where the names in the advice come from."""
    from stochfric_mb.laws import law_class

    taken = [row for row in rows if "add_friction(" in row["advice"]]
    if not taken:
        return
    names = ["add_friction", *dict.fromkeys(row["kind"].capitalize() for row in taken if row["kind"] != "contact")]
    laws = {law_class(row["law"]["kind"]) for row in taken}
    say(f"In Python: from stochfric_mb.mujoco import {', '.join(names)}")
    for law in sorted(laws, key=lambda law: law.__name__):
        say(f"           from {law.__module__} import {law.__name__}")


def _lines(row: Mapping[str, Any]) -> list[list[str]]:
    """Return the lines of a site: its name, then one for each friction."""
    lines = [[row["name"], *7 * [""], _limit(row["step_limit"])]]
    for name in ("native", "ours"):
        result = row[name]
        lines.append([f"  {name}", *(["-"] * 7 if result is None else _numbers(result)), ""])
    return lines


def _limit(limit: float | None) -> str:
    return "" if limit is None else f"{limit:.2g}"


def _numbers(entry: Mapping[str, Any]) -> list[str]:
    broken, slide = entry["break_away"], entry["slide"]
    own = entry["own"]
    return [
        f"{100.0 * own['load']:.0f} %",
        *map(_drift, (own, *entry["held"])),
        "none" if broken is None else f"{100.0 * broken['share']:.0f} %",
        "-" if slide is None else f"{100.0 * slide['deceleration'] / slide['expected']:.0f} %",
        f"{entry['energy_created']:.1g}",
    ]


def _drift(drift: Mapping[str, float] | None) -> str:
    if drift is None:
        return "-"
    value = 1.0e6 * drift["speed"]
    if abs(value) < LEAST:
        return "0"
    return f"{value:.0f}" if abs(value) >= 100.0 else f"{value:.2g}"
