"""A model left to itself before anything is probed, and the contacts it has in the end."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import mujoco
import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import SimulationError
from stochfric_mb.mujoco.check import probes
from stochfric_mb.mujoco.check.loading import keyframe_number
from stochfric_mb.mujoco.check.sites import contact_forces
from stochfric_mb.mujoco.contact.tracking import stopped_early
from stochfric_mb.mujoco.reading import diverged

Array = npt.NDArray[np.float64]
Stage = Callable[[str, float], Callable[[float], None]]

TAIL = 0.2
"""Share of the settling time at whose end contacts are looked for."""


@dataclasses.dataclass
class Seen:
    """A touching pair over the last part of settling."""

    dim: int
    mu: tuple[float, float]
    normal: float = 0.0
    friction: Array = dataclasses.field(default_factory=lambda: np.zeros(3))
    count: int = 0
    first: int = 0
    samples: int = 0


@dataclasses.dataclass(frozen=True)
class Settled:
    """What settling shows."""

    state: probes.State
    """The state at its end."""
    tail: dict[tuple[int, int], Seen]
    """The pairs of geoms that touched in its last part."""
    met: set[frozenset[int]]
    """All pairs of geoms that have touched."""
    duration: float
    """Time simulated [s]."""
    unconverged: int
    """Steps in which MuJoCo's solver stopped at its limit of iterations."""
    steps: int
    """All steps."""

    def convergence_note(self, limit: int) -> list[str]:
        """Return what to say of steps that MuJoCo's solver left early, at most one note; ``limit`` is ``option.iterations``."""
        if not self.unconverged:
            return []
        return [
            f"MuJoCo's solver stopped at option.iterations = {limit} in {self.unconverged} of {self.steps} steps of settling, "
            "with forces that are not the solution, friction's too; raise it"
        ]


def settle(model: mujoco.MjModel, keyframe: str | None, duration: float, stage: Stage) -> Settled:
    """Simulate from the initial state, or from a keyframe.

    Raises:
        InputError: there is no such keyframe.
        SimulationError: the model breaks.
    """
    data = mujoco.MjData(model)
    if keyframe is not None:
        mujoco.mj_resetDataKeyframe(model, data, keyframe_number(model, keyframe))
    tail: dict[tuple[int, int], Seen] = {}
    met: set[frozenset[int]] = set()
    steps, unconverged = round(duration / model.opt.timestep), 0
    advance = stage("settling", duration)
    for i in range(steps + 1):
        mujoco.mj_forward(model, data)
        met.update(frozenset(pair) for pair in data.contact.geom[: data.ncon].tolist())
        if i >= (1.0 - TAIL) * steps:
            _look(model, data, tail)
        if i < steps:
            mujoco.mj_step(model, data)
            unconverged += stopped_early(model._address, data._address)
            advance((i + 1) * model.opt.timestep)
        if not np.isfinite(data.qvel).all() or diverged(data):
            raise SimulationError(
                f"the model itself breaks at t = {data.time:.4g} s with timestep {model.opt.timestep:g} s; "
                "lower its timestep, or shorten the settling time"
            )
    return Settled(probes.snapshot(model, data), tail, met, float(data.time), unconverged, steps)


def _look(model: mujoco.MjModel, data: mujoco.MjData, tail: dict[tuple[int, int], Seen]) -> None:
    """Add the contacts of this instant to running means over all instants looked at."""
    now: dict[tuple[int, int], list[int]] = {}
    for i in range(data.ncon):
        a, b = (int(g) for g in data.contact.geom[i])
        if a >= 0 and b >= 0 and data.contact.efc_address[i] >= 0:
            now.setdefault((a, b), []).append(i)
    for geoms, contacts in now.items():
        mu = data.contact.friction[contacts[0]]
        seen = tail.setdefault(geoms, Seen(int(data.contact.dim[contacts[0]]), (float(mu[0]), float(mu[1]))))
        seen.count += 1
    for geoms, seen in tail.items():
        seen.samples += 1
        normal, friction = 0.0, np.zeros(3)
        for i in now.get(geoms, ()):
            push, force = contact_forces(model, data, i, geoms[0])
            normal += push
            friction += force
        seen.normal += (normal - seen.normal) / seen.samples
        seen.friction += (friction - seen.friction) / seen.samples
