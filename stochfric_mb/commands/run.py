"""``stochfric run``: one trajectory, in one engine or the reference, into one file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from stochfric_mb.commands import completion
from stochfric_mb.commands.options import scenario_options
from stochfric_mb.commands.speech import answer, say, spoken
from stochfric_mb.engines import ENGINES

if TYPE_CHECKING:
    from stochfric_mb.scenario import Scenario
    from stochfric_mb.trajectory import Trajectory

EXAMPLE = """\b
Example:
  stochfric run kang2015_table1 --engine reference --seed 1 --out run.nc
"""


@click.command(epilog=EXAMPLE)
@spoken
@scenario_options
@click.option(
    "--engine",
    shell_complete=completion.engines,
    default="reference",
    show_default=True,
    metavar="|".join(ENGINES),
    help="What computes it.",
)
@click.option("--however-long", is_flag=True, help="Go on also where the run would take more than a day.")
@click.option(
    "-o", "--out", required=True, metavar="FILE", help="What to write: .nc, .csv or .parquet. Missing folders are made."
)
def run(
    scenario: str,
    seed: int,
    dt: float | None,
    law: str | None,
    overrides: tuple[str, ...],
    force: bool,
    engine: str,
    however_long: bool,
    out: str,
) -> None:
    """Simulate one trajectory of SCENARIO (a TOML file or the name of a bundled one) and write it to a file."""
    from stochfric_mb.commands.progress import display
    from stochfric_mb.engines import adapter
    from stochfric_mb.outputs import check_target, claimed
    from stochfric_mb.storage import trajectory_ending, write_trajectory

    trajectory_ending(out)
    target = check_target(out, force=force)
    with display() as shown, claimed(target):
        shown.note(f"loading {engine}")
        problem = _load(scenario, law, overrides)
        module = adapter(engine, effects=problem.effects)
        if dt is not None:
            problem.dividing_step(dt)
        progress = shown.run(engine, problem.duration, however_long=however_long)
        trajectory = module.simulate(problem, seed=seed, dt=dt, progress=progress)
        shown.note(f"writing {out}")
        write_trajectory(trajectory, out, scenario=problem, force=force)
    facts = _facts(out, problem, trajectory)
    answer(facts)
    say(_summary(facts, problem))


def _load(scenario: str, law: str | None, overrides: tuple[str, ...]) -> Scenario:
    from stochfric_mb.scenario import load_scenario

    return load_scenario(scenario, law=law, overrides=overrides)


def _facts(out: str, scenario: Scenario, trajectory: Trajectory) -> dict[str, Any]:
    """Return what there is to say of a trajectory."""
    from stochfric_mb.metrics import period, resolves_slips, stick_fraction

    about = trajectory.attributes
    interval = period(trajectory, scenario.law, scenario.mechanism)
    kept = ("law", "engine", "version", "dt", "seed")
    notes = [*about["notes"]]
    if not resolves_slips(trajectory, scenario.mechanism):
        notes.append(
            f"slips may fall between samples {scenario.output_step:g} s apart: lower simulation.output_step for a period"
        )
    return {"out": out, "n_samples": len(trajectory.time), "duration": scenario.duration, **{k: about[k] for k in kept}} | {
        "stick_fraction": stick_fraction(trajectory, scenario.law, scenario.mechanism),
        "period": interval if math.isfinite(interval) else None,
        "notes": notes,
    }


def _summary(facts: Mapping[str, Any], scenario: Scenario) -> str:
    interval = facts["period"]
    step = f", dt {facts['dt']:g} s" if facts["dt"] else ""  # the reference has none
    lines = [
        f"{facts['out']}: {facts['n_samples']} samples over {scenario.duration:g} s, law {facts['law']}, "
        f"{facts['engine']} {facts['version']}{step}, seed {facts['seed']}",
        f"stick fraction {facts['stick_fraction']:.4f}, "
        + ("no period: fewer than two break-aways are seen" if interval is None else f"period {interval:.6f} s"),
    ]
    return "\n".join([*lines, *(f"Note: {note}" for note in facts["notes"])])
