"""``stochfric run``: one trajectory, in one engine or the reference, into one file."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import click

from stochfric_mb.commands.options import scenario_options
from stochfric_mb.engines import ENGINES

if TYPE_CHECKING:
    from stochfric_mb.scenario import Scenario
    from stochfric_mb.trajectory import Trajectory

EXAMPLE = """\b
Example:
  stochfric run kang2015_table1 --engine reference --seed 1 --out run.nc
"""


@click.command(epilog=EXAMPLE)
@scenario_options
@click.option("--engine", default="reference", show_default=True, metavar="|".join(ENGINES), help="What computes it.")
@click.option("--out", required=True, metavar="FILE", help="What to write: .nc, .csv or .parquet. Missing folders are made.")
def run(
    scenario: str, seed: int, dt: float | None, law: str | None, overrides: tuple[str, ...], force: bool, engine: str, out: str
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
            from stochfric_mb.comparison import checked_step

            checked_step(problem, dt)
        progress = shown.stage(engine, problem.duration)
        trajectory = module.simulate(problem, seed=seed, dt=dt, progress=progress)
        shown.note(f"writing {out}")
        write_trajectory(trajectory, out, scenario=problem, force=force)
    click.echo(_summary(out, problem, trajectory))


def _load(scenario: str, law: str | None, overrides: tuple[str, ...]) -> Scenario:
    from stochfric_mb.scenario import load_scenario

    return load_scenario(scenario, law=law, overrides=overrides)


def _summary(out: str, scenario: Scenario, trajectory: Trajectory) -> str:
    from stochfric_mb.metrics import period, stick_fraction

    about = trajectory.attributes
    interval = period(trajectory, scenario.law, scenario.mechanism)
    lines = [
        f"{out}: {len(trajectory.time)} samples over {scenario.duration:g} s, law {about['law']}, "
        f"{about['engine']} {about['version']}, dt {about['dt']:g} s, seed {about['seed']}",
        f"stick fraction {stick_fraction(trajectory, scenario.law, scenario.mechanism):.4f}, "
        + (f"period {interval:.6f} s" if math.isfinite(interval) else "no period: fewer than two break-aways"),
    ]
    return "\n".join([*lines, *(f"Note: {note}" for note in about["notes"])])
