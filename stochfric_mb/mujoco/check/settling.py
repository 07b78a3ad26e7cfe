"""A model left to itself before anything is probed, and the contacts it has in the end."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import mujoco
import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import SimulationError
from stochfric_mb.mujoco.check.loading import keyframe_number
from stochfric_mb.mujoco.check.sites import touch
from stochfric_mb.mujoco.contact.tracking import stopped_early
from stochfric_mb.mujoco.reading import diverged

Array = npt.NDArray[np.float64]
Stage = Callable[[str, float], Callable[[float], None]]

TAIL = 0.2
"""Share of the settling time at whose end contacts are looked for."""


@dataclasses.dataclass
class Seen:
    """A pair of geoms that touched in the last part of settling."""

    dim: int
    """Dimension of its contacts."""
    mu: tuple[float, float]
    """Their sliding coefficients [-]."""
    normal: float = 0.0
    """Mean normal force since it was first seen [N]."""
    friction: Array = dataclasses.field(default_factory=lambda: np.zeros(3))
    """Mean friction force on the first geom, likewise [N, world axes]."""
    touching: float = 0.0
    """Share of the instants since then in which it touched [-]."""
    samples: int = 0
    """How many instants these are."""


@dataclasses.dataclass
class Settled:
    """What settling shows."""

    data: mujoco.MjData
    """The state at its end."""
    tail: dict[tuple[int, int], Seen] = dataclasses.field(default_factory=dict)
    """The pairs of geoms that touched in its last part."""
    met: set[tuple[int, int]] = dataclasses.field(default_factory=set)
    """All pairs of geoms that have touched."""
    unconverged: int = 0
    """Steps in which MuJoCo's solver stopped at its limit of iterations."""
    steps: int = 0
    """All steps."""

    def look(self, model: mujoco.MjModel) -> None:
        """Add the contacts of this instant (or of the step just done, at its start or last stage) to the means over all."""
        now: dict[tuple[int, int], list[int]] = {}
        for i, (a, b) in enumerate(self.data.contact.geom.tolist()):
            if min(a, b) >= 0 and self.data.contact.efc_address[i] >= 0:
                now.setdefault((a, b), []).append(i)
        for geoms, contacts in now.items():
            mu = self.data.contact.friction[contacts[0]]
            self.tail.setdefault(geoms, Seen(int(self.data.contact.dim[contacts[0]]), (float(mu[0]), float(mu[1]))))
        for geoms, seen in self.tail.items():
            touching = [touch(model, self.data, i, geoms) for i in now.get(geoms, ())]
            seen.samples += 1
            seen.normal += (sum(t.normal for t in touching) - seen.normal) / seen.samples
            seen.friction += (sum((t.friction for t in touching), np.zeros(3)) - seen.friction) / seen.samples
            seen.touching += ((len(touching) > 0) - seen.touching) / seen.samples


def settle(model: mujoco.MjModel, keyframe: str | None, duration: float, stage: Stage) -> Settled:
    """Simulate from the initial state, or from a keyframe.

    Raises:
        InputError: there is no such keyframe.
        SimulationError: the model breaks.
    """
    data = mujoco.MjData(model)
    if keyframe is not None:
        mujoco.mj_resetDataKeyframe(model, data, keyframe_number(model, keyframe))
    settled = Settled(data, steps=round(duration / model.opt.timestep))
    advance = stage("settling", duration)
    for i in range(settled.steps + 1):
        if i < settled.steps:
            mujoco.mj_step(model, data)
            settled.unconverged += stopped_early(model._address, data._address)
            advance((i + 1) * model.opt.timestep)
        else:
            mujoco.mj_forward(model, data)
        settled.met.update((a, b) for a, b in data.contact.geom.tolist() if min(a, b) >= 0)
        if i >= (1.0 - TAIL) * settled.steps:
            settled.look(model)
        if not np.isfinite(data.qvel).all() or diverged(data):
            raise SimulationError(
                f"the model itself breaks at t = {data.time:.4g} s with timestep {model.opt.timestep:g} s; "
                "lower its timestep, or shorten the settling time"
            )
    return settled
