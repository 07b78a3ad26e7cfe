"""Draw docs/images/belt_box.png: the belt-box with MuJoCo's own friction, and with a law of this package in each engine."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import mujoco
import numpy as np

from stochfric_mb import load_scenario
from stochfric_mb.engines import adapter, installed_engines
from stochfric_mb.scenario import scenario_folders

FILE = Path(__file__).parent / "images" / "belt_box.png"
STYLES = {"reference": ("0.75", "-", 5.0), "mujoco": ("C0", "-", 1.6), "exudyn": ("C3", "--", 1.6), "pymunk": ("C2", ":", 2.2)}


def native(duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Return time [s] and position [m] of the same scene with MuJoCo's own friction, mu = 0.8."""
    spec = mujoco.MjSpec.from_file(str(next(f / "belt_box" / "belt_box.xml" for f in scenario_folders())))
    for geom in spec.geoms:
        geom.condim, geom.friction = 3, [0.8, 0.0, 0.0]
    model = spec.compile()
    data = mujoco.MjData(model)
    rows = []
    while data.time < duration:
        mujoco.mj_step(model, data)
        rows.append((data.time, data.qpos[0]))
    return tuple(np.array(rows).T)


def main() -> None:
    """Simulate and draw."""
    scenario = load_scenario("kang2015_table1", overrides=["simulation.duration=6"])
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.6), width_ratios=(1.7, 1), layout="constrained")
    time, position = native(scenario.duration)
    left.plot(time, 1e3 * position, color="0.45", linewidth=1.2, label="MuJoCo's own friction")
    for engine in (name for name in installed_engines() if name in STYLES):
        run = adapter(engine).simulate(scenario, seed=1)
        colour, line, width = STYLES[engine]
        label = "reference" if engine == "reference" else f"elastic stick in {engine}"
        left.plot(run.time, 1e3 * run.position, line, color=colour, linewidth=width, label=label)
        right.plot(1e3 * run.position, 1e3 * run.velocity, line, color=colour, linewidth=width)
    left.set(xlabel="time [s]", ylabel="position of the box [mm]", title="Box on a belt, random friction coefficients, seed 1")
    right.set(xlabel="position [mm]", ylabel="velocity [mm/s]", title="phase portrait")
    figure.legend(loc="outside lower center", ncols=5, fontsize=8, frameon=False)
    for axes in (left, right):
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    FILE.parent.mkdir(exist_ok=True)
    figure.savefig(FILE, dpi=90)


if __name__ == "__main__":
    main()
