"""What friction costs: Warp's own step beside the step with friction, in one process and in turns.

On a GPU both steps are replayed from captured graphs, as MuJoCo Warp is meant to run there; the callback is part of the graph.

Run it with ``python -m stochfric_mb.warp.bench [--worlds 1,64,4096] [--model MODEL.xml --geom floor]``.
"""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import statistics
import time

import click
import mujoco
import mujoco_warp as mjw
import numpy as np
import warp as wp

from stochfric_mb.coefficients import Knots
from stochfric_mb.errors import InputError
from stochfric_mb.friction import Friction
from stochfric_mb.laws import make_law
from stochfric_mb.warp.attach import add_friction

BOX = """<mujoco><option timestep="2e-3" cone="elliptic"/><worldbody><geom name="floor" type="plane" size="50 50 .1"/>
<body pos="0 0 .0499"><freejoint/><geom type="box" size=".1 .1 .05" mass="1"/></body></worldbody></mujoco>"""
LAW = "coulomb"
"""Law whose cost is measured. Its coefficients are near MuJoCo's own, 1, so that the same contacts stick with and without it:
MuJoCo Warp's solver takes a third longer where contacts slide, by its own friction or by ours."""
SETTLING = 250
"""Steps before anything is measured, after which a robot stands: MuJoCo Warp's solver goes on until the slowest world is done,
and worlds without friction of their own are all alike while they land."""
TURNS = 9
"""Turns of each; the table gives the median of the ratios."""
SECONDS = 0.4
"""Aim of a turn [s]."""


class Stepper:
    """A model in many worlds, with or without friction, and what its steps take."""

    def __init__(self, model: mujoco.MjModel, geom: str, nworld: int, *, friction: bool) -> None:
        """Put the model on the device, and let it settle: kernels are loaded, contacts are there."""
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        self.m, self.d = mjw.put_model(model), mjw.put_data(model, data, nworld=nworld)
        self.callback = 0.0
        """Time spent in the callback [s]."""
        self.graph = None
        cuda = wp.get_preferred_device().is_cuda
        self.clock = time.perf_counter if cuda else time.process_time  # others' load does not count
        if friction:
            law = Friction(make_law(LAW, mu_s=1.0, mu_k=0.9), Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01))
            steer = add_friction(model, self.m, self.d, ("*", geom), law).steer

            def timed(m: mjw.Model, d: mjw.Data) -> None:
                wp.synchronize()
                began = self.clock()
                steer(m, d)
                wp.synchronize()
                self.callback += self.clock() - began

            if not cuda:  # in a graph nothing waits for it
                self.m.callback.passive = timed
        self.steps(1)
        if cuda:
            with wp.ScopedCapture() as capture:
                mjw.step(self.m, self.d)
            self.graph = capture.graph
        self.steps(SETTLING)

    def steps(self, n: int) -> float:
        """Take n steps; return the time that they took [s]."""
        wp.synchronize()
        began = self.clock()
        for _ in range(n):
            if self.graph is None:
                mjw.step(self.m, self.d)
            else:
                wp.capture_launch(self.graph)
        wp.synchronize()
        return self.clock() - began


def cost(model: mujoco.MjModel, geom: str, nworld: int) -> tuple[float, float, float]:
    """Return the time of Warp's own step [s], and the callback's (0 in a graph) and that of a step with friction over it."""
    native, ours = (Stepper(model, geom, nworld, friction=on) for on in (False, True))
    n = max(1, round(SECONDS / native.steps(5) * 5))
    ours.callback = 0.0
    pairs = [(native.steps(n), ours.steps(n)) for _ in range(TURNS)]
    step = statistics.median(a for a, _ in pairs) / n
    return step, ours.callback / (n * TURNS) / step, float(np.median([b / a for a, b in pairs]))


def _numbers_of_worlds(_: click.Context, __: click.Parameter, text: str) -> list[int]:
    words = text.split(",")
    if not all(word.strip().isdecimal() and int(word) > 0 for word in words):
        raise click.BadParameter(f"{text!r} is no list of whole numbers from 1 on; give for instance 1,64,4096")
    return [int(word) for word in words]


@click.command()
@click.option(
    "--worlds", default="1,64,4096", show_default=True, callback=_numbers_of_worlds, help="Numbers of worlds, with commas."
)
@click.option("--model", type=click.Path(exists=True), help="MJCF file; a box on a plane if not given.")
@click.option("--geom", default="floor", show_default=True, help="Geom whose contacts get friction.")
def main(worlds: list[int], model: str | None, geom: str) -> None:
    """Print what a step costs with and without friction."""
    spec = mujoco.MjSpec.from_file(model) if model else mujoco.MjSpec.from_string(BOX)
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    compiled = spec.compile()
    compiled.geom_condim[:] = np.maximum(compiled.geom_condim, 3)
    device = str(wp.get_preferred_device())
    for nworld in worlds:
        try:
            seconds, callback, ratio = cost(compiled, geom, nworld)
        except InputError as error:
            raise click.ClickException(str(error)) from error
        took = f"{1e6 * seconds:.0f} us a step" + (f", callback {100 * callback:.1f} % of it" if callback else "")
        click.echo(f"{device}, {nworld} worlds: {took}; a step with friction {ratio:.3f} of it")


if __name__ == "__main__":
    main()
