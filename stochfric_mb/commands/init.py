"""``stochfric init``: a commented scenario.toml and dataset.toml to fill in, columns guessed from a measured file."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, cast

import click

from stochfric_mb.commands.options import Names
from stochfric_mb.commands.speech import answer, say, spoken
from stochfric_mb.errors import InputError

EXAMPLE = """\b
Example:
  stochfric run kang2015_table1 --seed 1 --out run.csv
  stochfric init belt_box --from run.csv --out rig
"""
MARKER = "scenario.toml"
"""File that shows that a folder holds a rig."""
CHANNELS: dict[str, tuple[str, ...]] = {
    "belt_box": ("time", "position", "velocity", "belt_velocity", "normal_force", "temperature"),
    "prismatic_joint": ("time", "position", "force", "voltage", "velocity", "pressure", "temperature"),
    "hinge_pendulum": ("time", "position", "torque", "voltage", "velocity", "temperature"),
    "spring_slider": ("time", "position", "friction_coefficient", "friction_force", "normal_force", "temperature"),
    "mjcf": ("time", "position", "torque", "force", "velocity", "temperature"),
}
"""Mechanism -> quantities that are looked for in a measured file."""
EXAMPLES: dict[str, dict[str, Any]] = {
    "belt_box": {"mass": 6.08, "damping": 0.768, "stiffness": 3956.0, "normal_force": 13.0, "belt_velocity": 2.5e-3},
    "prismatic_joint": {"mass": 95.0, "normal_force": 932.0},
    "hinge_pendulum": {"mass": 0.6, "length": 0.5, "normal_force": 1.0},
    "spring_slider": {"stiffness": 2000.0},
    "mjcf": {
        "file": "model.xml",
        "friction": {"elbow": 1.0},
        "positions": {"elbow": "position"},
        "drives": {"elbow": "torque"},
    },
}
"""Mechanism -> values of its required keys, to be replaced."""
NEEDED: dict[str, tuple[tuple[str, ...], ...]] = {
    "belt_box": (("position",),),
    "prismatic_joint": (("position",), ("force", "voltage")),
    "hinge_pendulum": (("position",), ("torque", "voltage")),
    "spring_slider": (("position",), ("friction_coefficient", "friction_force")),
    "mjcf": (("position",),),
}
"""Mechanism -> quantities without which it cannot be discovered, each with those that do as well."""
HEADERS = {"position": "position [mm]", "force": "force [N]", "torque": "torque [N m]"}
"""Quantity -> its column in the header of an example."""
UNCERTAINTY: dict[str, dict[str, float]] = {
    "belt_box": {"mass": 0.01, "stiffness": 0.02, "damping": 0.5, "normal_force": 0.05, "mu_s": 0.3, "mu_k": 0.3},
    "prismatic_joint": {"mass": 0.1, "mu_s": 0.5, "mu_k": 0.5},
    "hinge_pendulum": {"mass": 0.1, "mu_s": 0.5, "mu_k": 0.5},
    "spring_slider": {"stiffness": 3.0, "mu_s": 0.1, "mu_k": 0.1},
    "mjcf": {"mass": 0.1, "mu_s": 0.5, "mu_k": 0.5},
}
"""Mechanism -> relative standard deviations to begin with."""


@click.command(epilog=EXAMPLE)
@spoken
@click.argument("mechanism", metavar="MECHANISM", type=Names("mechanism", list(CHANNELS)))
@click.option("--from", "measured", type=click.Path(), metavar="FILE", help="Measured file: its columns are guessed.")
@click.option("-o", "--out", required=True, metavar="DIR", help="Folder for scenario.toml and dataset.toml.")
@click.option("--force", is_flag=True, help="Replace what is at --out.")
def init(mechanism: str, measured: str | None, out: str, force: bool) -> None:
    """Write a commented scenario.toml and dataset.toml for a rig of your own, to fill in.

    MECHANISM: belt_box, prismatic_joint, hinge_pendulum, spring_slider or mjcf.
    """
    from stochfric_mb.outputs import check_target, whole_folder

    target = check_target(out, force=force, marker=MARKER)
    runs, said = _runs(mechanism, Path(measured), target) if measured else (_placeholder(mechanism), [])
    with whole_folder(target, replace=force) as folder:
        (folder / "scenario.toml").write_text(scenario_text(mechanism), encoding="utf-8")
        (folder / "dataset.toml").write_text(dataset_text(runs), encoding="utf-8")
    answer({"out": str(target), "guesses": said})
    for line in said:
        say(line)
    say(f"{target / 'scenario.toml'}: replace every number marked EXAMPLE by your rig's")
    todo = (
        "check what is marked GUESS" if "# GUESS" in runs else "name your files" if measured is None else "add your other files"
    )
    say(f"{target / 'dataset.toml'}: {todo}")
    say(f"Then: stochfric discover {target} --dry-run --out {target}_raw")


def scenario_text(mechanism: str) -> str:
    """Return a scenario for a mechanism: required keys with examples, the others as comments with their defaults."""
    from stochfric_mb.commands.keys import keys_of
    from stochfric_mb.mechanisms import MECHANISMS
    from stochfric_mb.scenario import SCHEMA

    lines = [f'schema = "{SCHEMA}"', 'title = "My rig"', "", "[mechanism]", f'kind = "{mechanism}"']
    examples = EXAMPLES[mechanism]
    for key in keys_of(MECHANISMS[mechanism]):
        if key.name in examples:
            lines.append(f"{key.name} = {_toml(examples[key.name])}  # EXAMPLE. {key.text}")
        else:
            value = "{}" if key.default == "none" and "table" in key.type else "[]" if key.default == "none" else key.default
            lines.append(f"# {key.name} = {value}  # {key.text}")
    lines += ["", "[law]", 'kind = "coulomb"']
    lines += ["mu_s = 0.5  # EXAMPLE. Static coefficient of friction [-]", "mu_k = 0.4  # EXAMPLE. Kinetic one [-]"]
    lines += ["", "[uncertainty]  # relative standard deviations: how well you know each number"]
    lines += [f"{name} = {value:g}  # EXAMPLE: {100.0 * value:g} %" for name, value in UNCERTAINTY[mechanism].items()]
    lines += ["", "[simulation]", "duration = 10.0  # s", "output_step = 1.0e-3  # s, divides the duration"]
    return "\n".join(lines) + "\n"


def dataset_text(runs: str) -> str:
    """Return a dataset with the given ``[[runs]]``."""
    from stochfric_mb.measurement.entries import SCHEMA

    return (
        f'schema = "{SCHEMA}"\ntitle = "My rig"\nscenario = "scenario.toml"\n\n'
        "# A run is used to fit (fit), or held out and only scored (test). Known conditions that differ from the scenario's\n"
        '# [mechanism] go into set, such as set = { normal_force = 20.0 }. Units: units = { position = "mm" }.\n\n' + runs
    )


def _placeholder(mechanism: str) -> str:
    shown = HEADERS | ({"position": "position [deg]"} if mechanism == "hinge_pendulum" else {})
    header = ",".join(["time [s]", *(shown.get(names[0], names[0]) for names in NEEDED[mechanism])])
    entries = [
        f'[[runs]]\nfile = "run_{i}.csv"  # EXAMPLE: header such as {header}\nrole = "{role}"\n'
        for i, role in ((1, "fit"), (2, "test"))
    ]
    return "\n".join(entries)


def _runs(mechanism: str, file: Path, target: Path) -> tuple[str, list[str]]:
    """Return the ``[[runs]]`` of one measured file, its last third held out, and what was guessed, in words."""
    import numpy as np

    from stochfric_mb.commands.guess import guesses
    from stochfric_mb.measurement.dataset import HELD_OUT
    from stochfric_mb.measurement.quantities import KNOWN
    from stochfric_mb.measurement.readers import read_table
    from stochfric_mb.measurement.units import to_si
    from stochfric_mb.mechanisms import MECHANISMS

    table = read_table(file)
    rotational = getattr(MECHANISMS[mechanism], "rotational", False)
    guessed = guesses(table, CHANNELS[mechanism], rotational=rotational)
    by_name = {guess.quantity: guess for guess in guessed}
    if "time" not in by_name:
        raise InputError(
            f"{file}: none of its columns {', '.join(map(repr, table.columns))} looks like a time; name one 'time [s]', or "
            "write the dataset by hand with columns = { time = ... }"
        )
    clock = by_name["time"]
    column = table.columns[str(clock.column)]
    time, _ = to_si(column, clock.unit, KNOWN["time"], rotational=None)
    after = int(np.count_nonzero(time < time[-1] - HELD_OUT * (time[-1] - time[0])))  # no sample is in both
    unsure = [guess for guess in guessed if not guess.sure]
    keys = []
    if unsure:
        pairs = ", ".join(f"{g.quantity} = {_toml(g.column)}" for g in unsure)
        units = ", ".join(f"{g.quantity} = {_toml(g.unit)}" for g in unsure if g.unit)
        keys = [f"columns = {{ {pairs} }}  # GUESS, from the header", f"units = {{ {units} }}  # GUESS"]
    name = _toml(os.path.relpath(file.resolve(), target.resolve()))
    spans = (("fit", f"[{time[0]:.9g}, {time[max(after - 1, 0)]:.9g}]"), ("test", f"[{time[after]:.9g}, {time[-1]:.9g}]"))
    missing = [quantities for quantities in NEEDED[mechanism] if not set(quantities) & set(by_name)]
    entries = [
        "\n".join(["[[runs]]", f"file = {name}", f'role = "{role}"', f"time_range = {span}  # s", *keys]) + "\n"
        for role, span in spans
    ]
    said = [
        f"{g.quantity}: column {g.column!r} [{g.unit or '-'}]" + ("" if g.sure else " (a guess, check it in dataset.toml)")
        for g in guessed
    ]
    said += [
        f"{' or '.join(q)}: none of {', '.join(map(repr, table.columns))} looks like it; if one is, add columns = "
        f"{{ {q[0]} = ... }} to dataset.toml"
        for q in missing
    ]
    return "\n".join(entries), said


def _toml(value: Any) -> str:
    """Return a value in TOML."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {_toml(v)}" for k, v in cast(dict[str, Any], value).items()) + " }"
    return json.dumps(value)
