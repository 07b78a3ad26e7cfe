"""One trajectory: what an engine or the reference returns."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

COLUMNS: dict[str, tuple[str, str]] = {
    "time": ("s", "time"),
    "position": ("m", "position of the body"),
    "velocity": ("m/s", "velocity of the body"),
    "friction_force": ("N", "friction force on the body, positive along counter-surface minus body velocity"),
    "normal_force": ("N", "normal force"),
    "mu_s": ("-", "static coefficient of friction"),
    "mu_k": ("-", "kinetic coefficient of friction"),
    "stick": ("-", "1 where the contact sticks, otherwise 0"),
}
"""Name of a column -> unit and meaning."""
MORE_COLUMNS: dict[str, tuple[str, str]] = {
    "true_position": ("m", "true position of the body, where position is what a sensor shows"),
}
"""The same for columns that only some trajectories have."""


@dataclasses.dataclass(frozen=True)
class Trajectory:
    """Samples of one run; every array has shape (n,)."""

    time: Array
    """Time [s]."""
    position: Array
    """Position [m]."""
    velocity: Array
    """Velocity [m/s]."""
    friction_force: Array
    """Friction force on the body [N], positive along counter-surface minus body velocity."""
    normal_force: Array
    """Normal force [N]."""
    mu_s: Array
    """Static coefficient [-]."""
    mu_k: Array
    """Kinetic coefficient [-]."""
    stick: Array
    """1 where the contact sticks, otherwise 0."""
    attributes: dict[str, Any] = dataclasses.field(default_factory=dict[str, Any])
    """What made it: engine, version, hook, dt, seed, notes, seconds_per_step, ..."""
    events: Array = dataclasses.field(default_factory=lambda: np.empty((0, 2)))
    """Located switches, shape (n_events, 2): time [s] and 1 (break-away) or 0 (stick); empty if not located."""
    true_position: Array | None = None
    """True position [m], where ``position`` is what a sensor with errors of its own shows."""

    def columns(self) -> dict[str, Array]:
        """Return the arrays by name, in the order of `COLUMNS` and `MORE_COLUMNS`."""
        more = {name: getattr(self, name) for name in MORE_COLUMNS if getattr(self, name) is not None}
        return {name: getattr(self, name) for name in COLUMNS} | more
