"""A user's model along its records: where joints, tendons and pairs are, how fast they move, and which joints move them."""

# pyright: reportAttributeAccessIssue=false
# (MuJoCo's bindings are not typed)

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.balance.balances import Balances
from stochfric_mb.discovery.driven_joint.balance.force_balance import distance_before, distance_slid, integrated
from stochfric_mb.discovery.driven_joint.balance.weak_form import Window, narrowest
from stochfric_mb.discovery.driven_joint.mjcf.compiled_model import tendon_along
from stochfric_mb.discovery.driven_joint.mjcf.geom_pairs import geom_numbers, line, pair_along, two_forces
from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import back_emf, drive_of, position_of_joint
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import Mjcf

Array = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Path:
    """The motion along a place in one run, and its direction among the joints."""

    position: Array
    """Position through the window [m or rad], shape (count,)."""
    velocity: Array
    """Velocity in weak form [m/s or rad/s], shape (count,)."""
    load: Array
    """Load that the place transmits [N or N m], shape (count,)."""
    load_by_drive: Array | None
    """Change of the load with the driving force, -1 or 1, shape (count,); None: the load is known without it."""
    direction: Array
    """J at the centres, shape (n_centres, n_joints)."""
    weights: Array
    """What friction is of the joints' forces: J/(J J), or at a pair a row of `two_forces`, shape (n_centres, n_joints)."""
    part: Array | None = None
    """At a pair: how fast the geoms part with each joint, shape (n_centres, n_joints)."""
    normal_weights: Array | None = None
    """At a pair whose normal force is not measured: what it is of the joints' forces, shape (n_centres, n_joints)."""


@dataclasses.dataclass(frozen=True)
class Rig(Balances):
    """A model and the records of it."""

    mechanism: Mjcf
    """Its mechanism."""
    mujoco: Any
    """The engine."""
    model: Any
    """The compiled model, without friction of its own."""
    names: tuple[str, ...]
    """Joints in the order of their degrees of freedom."""
    tendons: tuple[str, ...]
    """Tendons in the order of the model."""
    shapes: Any = None
    """The model in which pairs touch across the noise of positions; None: there are none."""
    remembered: dict[tuple[Any, ...], Any] = dataclasses.field(default_factory=dict[Any, Any])
    """What was computed for a run and a window."""

    def joints(self, run: Run, window: Window, derivative: int = 0) -> Array:
        """Return positions of the joints through a window, or derivatives of them, shape (count, n_joints)."""
        return np.column_stack([window.through(position_of_joint(run, self.mechanism, n), derivative) for n in self.names])

    def path(self, run: Run, place: str, window: Window) -> Path:
        """Return the motion along a joint, tendon or pair in a run."""
        of = self._of_pair if place in self.mechanism.pairs else self._of_tendon if place in self.tendons else self._of_joint
        return self._once(("path", run.name, place, window.half_width), lambda: of(run, place, window))

    def _once(self, key: tuple[Any, ...], make: Callable[[], Any]) -> Any:
        if key not in self.remembered:
            self.remembered[key] = make()
        return self.remembered[key]

    def travelled(self, run: Run, place: str) -> Array:
        """Return the distance slid at a place since the record began [m or rad], shape (count,)."""

        def velocity(some: Run) -> Array:
            return self.path(some, place, narrowest(some)).velocity

        before = distance_before(run, self.dataset.runs, velocity)
        return before + distance_slid(velocity(run), narrowest(run))

    def line(self, place: str) -> Array:
        """Return the direction in which a pair slides, in the surface's axes, shape (3,): the same in all runs."""
        return self._once(("line", place), lambda: self._line(place))

    def _line(self, place: str) -> Array:
        run = self.dataset.fit[0]
        window = narrowest(run)
        positions, rates = (self.joints(run, window, d)[window.centres] for d in (0, 1))
        return line(pair_along(self.mujoco, self.shapes, self.geoms[place], positions), rates, place)

    @functools.cached_property
    def geoms(self) -> dict[str, tuple[int, int]]:
        """Pair -> numbers of its geoms, body first."""
        return {name: geom_numbers(self.mujoco, self.model, pair) for name, pair in self.mechanism.pairs.items()}

    def _of_joint(self, run: Run, place: str, window: Window) -> Path:
        q = position_of_joint(run, self.mechanism, place)
        direction = np.zeros((len(window.centres), len(self.names)))
        direction[:, self.names.index(place)] = 1.0
        velocity = window.through(q, 1)
        return Path(window.through(q), velocity, *self._transmitted(run, place, window, velocity), direction, direction)

    def _of_tendon(self, run: Run, place: str, window: Window) -> Path:
        joints, rates = self.joints(run, window), self.joints(run, window, 1)
        position, all_along = tendon_along(self.mujoco, self.model, self.tendons.index(place), joints)
        velocity = np.sum(all_along * rates, axis=1)
        direction = all_along[window.centres]
        weights = direction / np.sum(direction**2, axis=1, keepdims=True)
        return Path(position, velocity, *self._transmitted(run, place, window, velocity), direction, weights)

    def _transmitted(self, run: Run, place: str, window: Window, velocity: Array) -> tuple[Array, Array]:
        """Return the load that a joint or tendon transmits [N or N m], and its change with the drive, shape (count,) each."""
        drive = window.through(drive_of(run, self.mechanism, place)) - back_emf(run, self.mechanism, place) * velocity
        return np.abs(drive), np.sign(drive)

    def _of_pair(self, run: Run, place: str, window: Window) -> Path:
        pair, axis = self.mechanism.pairs[place], self.line(place)
        along = pair_along(self.mujoco, self.shapes, self.geoms[place], self.joints(run, window))
        slide = np.einsum("i,nij->nj", axis, along.slide)
        velocity = np.sum(slide * self.joints(run, window, 1), axis=1)
        # where a body turns its geom stays: what slides by is the integral
        at = window.centres
        slid = integrated(window.held(velocity), run.sample_interval)
        position = float(axis @ along.place[at[0]]) + slid - slid[at[0]]
        direction, part = slide[at], along.part[at]
        load = np.zeros(len(position))
        if pair.normal_force:
            size = np.maximum(np.sum(direction**2, axis=1, keepdims=True), np.finfo(float).tiny)
            return Path(position, velocity, load, None, direction, direction / size, part)
        rows = two_forces(part, direction, place)
        return Path(position, velocity, load, None, direction, rows[:, 1], part, rows[:, 0])
