"""Friction with random coefficients, a model without: discovery names what is missing, and the phase portrait spreads.

::

    python examples/discover_random_coefficients.py --out rig          # writes the dataset rig/: two runs and a model
    stochfric discover rig --out discovery                             # what is missing from the model?
    python examples/discover_random_coefficients.py --out rig --discover --plot portrait.png   # both, and the portrait

Kang et al. (Shock and Vibration 2015, 423169) modelled the coefficients of friction of a belt-box as random and saw its
phase portrait spread. Here the box of their Table 1 moves in a multibody engine, with their coefficients; its position is
recorded with a sensor's noise. The stated model has constant coefficients. Data and analysis share no solver, unless no
engine is installed.
"""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path

import numpy as np
import tomli_w

from stochfric_mb import Scenario, load_scenario
from stochfric_mb.engines import adapter, installed_engines
from stochfric_mb.measurement.smoothing import smooth

SCENARIO, ENGINES = "kang2015_table1", ("exudyn", "mujoco", "reference")
NOISE, SEED = 5.0e-6, 1  # of the position [m]; of the coefficients
DATASET = """\
schema = "stochfric.dataset/1"
title = "Belt-box with random coefficients of friction"
scenario = "scenario.toml"
[[runs]]
file = "run_1.csv"
role = "fit"
[[runs]]
file = "run_2.csv"
role = "test"
"""


def write_dataset(folder: Path, *, duration: float = 60.0, engine: str | None = None) -> str:
    """Write two runs of a box with random coefficients, and a model without them; return the engine that made the runs."""
    engine = engine or next(name for name in ENGINES if name in installed_engines())
    truth = load_scenario(SCENARIO, law="coulomb", overrides=(f"simulation.duration={duration}",))
    folder.mkdir(parents=True)
    for run in (1, 2):
        motion = adapter(engine).simulate(truth, seed=SEED, sample=run)
        measured = motion.position + NOISE * np.random.default_rng(run).standard_normal(len(motion.time))
        table = np.column_stack([motion.time, measured])
        np.savetxt(folder / f"run_{run}.csv", table, "%.9g", ",", header="time [s],position [m]", comments="")
    model = dataclasses.replace(truth, title="Kang 2015, Table 1, constant coefficients", process=None)
    (folder / "scenario.toml").write_text(tomli_w.dumps(model.to_dict()), encoding="utf-8")
    (folder / "dataset.toml").write_text(DATASET, encoding="utf-8")
    return engine


def portrait(scenario: Scenario, samples: int = 1) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return position [m] and velocity [m/s] of simulated runs, the first second left out."""
    runs = [adapter("reference").simulate(scenario, seed=7, sample=s) for s in range(samples)]
    return [(r.position[1000:], r.velocity[1000:]) for r in runs]


def measured_portrait(time: np.ndarray, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return position [m] and velocity [m/s] of a record, both through a window of 20 ms, the first second left out."""
    step = float(time[1] - time[0])
    return tuple(smooth(position, 1.0e-2, step, derivative=d)[1000:-20] for d in (0, 1))


def loop_spread(position: np.ndarray, velocity: np.ndarray, speed: float = -5.0e-3) -> float:
    """Return the standard deviation of where slips begin, where the velocity falls below ``speed`` [m/s], in m."""
    begins = np.flatnonzero((velocity[:-1] > speed) & (velocity[1:] <= speed))
    return float(np.std(position[begins]))


def plot(panels: dict[str, list[tuple[np.ndarray, np.ndarray]]], path: str) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 3.6), layout="constrained")
    for axes, (title, loops) in zip(figure.subplots(1, len(panels), sharex=True, sharey=True), panels.items(), strict=True):
        for position, velocity in loops:
            axes.plot(1e3 * position, 1e3 * velocity, color="#0072b2", linewidth=0.3)
        axes.set(title=title, xlabel="position [mm]", ylabel="velocity [mm/s]")
    figure.savefig(path, dpi=150)


def discover(folder: Path, plot_to: str | None) -> None:
    from stochfric_mb.discovery import discover

    outcome = discover(folder)
    for effect in outcome.result.effects:
        values = ", ".join(f"{name} = {p.value:.3g} ({p.low:.3g} to {p.high:.3g})" for name, p in effect.parameters.items())
        print(f"missing from the model: {effect.kind}: {values}")
    if not outcome.result.effects:
        print(f"verdict: {outcome.result.verdict}")
    if (gap := outcome.result.gap) is not None:
        print(f"held-out cycles, error [um]: {1e6 * gap.recalibrated:.3g} without, {1e6 * gap.augmented:.3g} with the effects")
    run = outcome.dataset.test[0]
    short = {"duration": min(20.0, float(run.time[-1]) // 1.0)}
    panels = {
        "measured": [measured_portrait(run.time, run.channels["position"])],
        "model as stated": portrait(dataclasses.replace(outcome.dataset.scenario, **short)),
        "with the effects": portrait(dataclasses.replace(outcome.scenario, **short), samples=3),
    }
    for title, loops in panels.items():
        print(f"{title}: places where slips begin scatter by {1e6 * np.mean([loop_spread(*x) for x in loops]):.3g} um")
    if plot_to:
        plot(panels, plot_to)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", metavar="DIR", required=True, help="folder of the dataset; used as it is if it exists")
    parser.add_argument("--engine", choices=ENGINES, help="what makes the data; default: the first that is installed")
    parser.add_argument("--duration", type=float, default=60.0, help="length of each run [s]")
    parser.add_argument("--discover", action="store_true", help="discover what is missing, and compare the phase portraits")
    parser.add_argument("--plot", metavar="PNG", help="save the phase portraits")
    arguments = parser.parse_args()
    folder = Path(arguments.out)
    if not folder.exists():
        made_by = write_dataset(folder, duration=arguments.duration, engine=arguments.engine)
        print(f"{folder}: two runs of {arguments.duration:g} s, made by {made_by}, and a model with constant coefficients")
    if arguments.discover or arguments.plot:
        discover(folder, arguments.plot)


if __name__ == "__main__":
    main()
