"""Friction as a load on one marker, for scripts that have no connector to hang it on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from exudyn.itemInterface import LoadCoordinate, LoadForceVector

from stochfric_mb.errors import InputError, require_number
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn import pointers
from stochfric_mb.exudyn.attach import bind_coordinates, bind_own, coordinate_index, marker_kind
from stochfric_mb.exudyn.contact import OUTPUT, FrictionContact
from stochfric_mb.exudyn.contact_force import force_now
from stochfric_mb.exudyn.hooks import Hooks
from stochfric_mb.exudyn.normal import Normal, as_normal
from stochfric_mb.exudyn.plane import set_plane
from stochfric_mb.friction import Friction
from stochfric_mb.laws import Law


def add_friction_load(
    mbs: Any,
    marker: Any,
    friction: Law | Friction,
    *,
    normal_force: float | Callable[[float], float] | str | Any,
    normal: Sequence[float] | None = None,
    surface_velocity: float | Sequence[float] = 0.0,
    effective_mass: float | None = None,
    seed: int = 0,
    sample: int = 0,
    contact: int | None = None,
) -> FrictionContact:
    """Return the friction against ground that now acts as a load on one marker.

    The load is a Python function with one compiled call: slower than `add_friction`, and the counter-surface feels
    nothing. An implicit solver needs ``timeIntegration.computeLoadsJacobian``, which `solve_dynamic` sets.

    Args:
        mbs: the system.
        marker: marker of the body: of a node's coordinate, or of a position.
        friction: a law, or a law with the process of its coefficients.
        normal_force: as `add_friction` has it.
        normal: direction from the counter-surface to the body, for a position.
        surface_velocity: velocity of the counter-surface [m/s], a number for a coordinate, a vector for a position.
        effective_mass: mass that the contact feels [kg]; as `add_friction` has it.
        seed: seed of the path of coefficients.
        sample: number of the sample.
        contact: number of the contact; contacts with different numbers have independent paths. If not given they are numbered
            0, 1, 2, ... as they are added to the system.

    Raises:
        InputError: a marker of another kind, or as `add_friction`.
    """
    options: dict[str, Any] = {"effective_mass": effective_mass, "seed": seed, "sample": sample, "contact": contact}
    options["hooks"] = Hooks.of(mbs)
    source = as_normal(mbs, normal_force)
    if marker_kind(mbs, marker) == "position":
        return PositionLoad(mbs, marker, friction, source, normal, surface_velocity, **options)
    if mbs.GetMarker(marker)["markerType"] != "NodeCoordinate":
        raise InputError("friction as a load needs a MarkerNodeCoordinate or a position marker; use add_friction for others")
    return CoordinateLoad(mbs, marker, friction, source, surface_velocity, **options)


class _Load(FrictionContact):
    """What both kinds of load share."""

    is_load = _on_load = True

    def __init__(self, mbs: Any, friction: Law | Friction, normal: Normal, **options: Any) -> None:
        super().__init__(mbs, friction, normal, **options)
        self._out = np.zeros(3)
        self._into = int(self._out.ctypes.data)

    def _forces(self) -> tuple[float, float]:
        if self._words[at.ASK_FIRST]:
            self._read_motion()
        force_now(float(self._mbs.systemData.GetTime()), self.where, self._into)
        return float(self._out[0]), float(self._out[1])


class CoordinateLoad(_Load):
    """Friction as a load on a coordinate; made by `add_friction_load`."""

    def __init__(
        self, mbs: Any, marker: Any, friction: Law | Friction, normal: Normal, surface_velocity: Any, **options: Any
    ) -> None:
        super().__init__(mbs, friction, normal, **options)
        self._markers, self._own, self._zero = (marker,), np.zeros(4), np.zeros(1)
        self._numbers[at.SURFACE_VELOCITY] = require_number("surface_velocity", surface_velocity, unit="m/s")
        bind_own(self._words, self._own)
        self.route = pointers.route()
        self.object = mbs.AddLoad(
            LoadCoordinate(markerNumber=marker, load=self.where, loadUserFunction=pointers.load_function())
        )
        self._begin()

    def connect(self) -> None:
        """Find out where the engine keeps the coordinate (again, whenever a simulation starts)."""
        self._words[at.ASK_FIRST] = int(self._normal.changes)
        bind_coordinates(self._mbs, self._words, self._zero, [-1, coordinate_index(self._mbs, self._markers[0])])

    def reset(self, start: float = 0.0) -> None:
        """Start the contact afresh, at the system's initial displacement and velocity."""
        bind_own(self._words, self._own)
        super().reset(start)

    def _read_motion(self) -> None:
        """Copy the coordinate and its rate, for the time before a simulation starts."""
        data, i = self._mbs.systemData, coordinate_index(self._mbs, self._markers[0])
        if i is not None and 0 <= i < len(data.GetODE2Coordinates()):
            self._own[[1, 3]] = data.GetODE2Coordinates()[i], data.GetODE2Coordinates_t()[i]


class PositionLoad(_Load):
    """Friction as a load on a position; made by `add_friction_load`."""

    def __init__(
        self,
        mbs: Any,
        marker: Any,
        friction: Law | Friction,
        normal_force: Normal,
        normal: Any,
        surface_velocity: Any,
        **options: Any,
    ) -> None:
        super().__init__(mbs, friction, normal_force, **options)
        set_plane(self, None, normal, surface_velocity)
        self._words[at.ASK_FIRST] = 1
        self._markers = (marker,)
        self._distance = self._numbers[at.DISTANCE : at.DISTANCE + 3]
        self._rate = self._numbers[at.RATE : at.RATE + 3]
        self._axes = self._numbers[at.AXIS_1 : at.AXIS_1 + 6].reshape(2, 3)
        where, into, tangential = self.where, self._into, self._out[:2]

        def load_function(mbs: Any, t: float, loadVector: Any) -> Any:
            self._read_motion()
            force_now(t, where, into)
            return tangential @ self._axes

        self.object = mbs.AddLoad(
            LoadForceVector(markerNumber=marker, loadVector=[0.0] * 3, loadVectorUserFunction=load_function)
        )
        self._begin()

    @property
    def force(self) -> Any:
        """The friction force [N] on the marker that the engine applies now, a vector in global axes."""
        return np.asarray(self._forces()) @ self._axes

    def _read_motion(self) -> None:
        """Take position and velocity of the marker."""
        self._distance[:] = self._mbs.GetMarkerOutput(self._markers[0], OUTPUT.Position)
        self._rate[:] = self._mbs.GetMarkerOutput(self._markers[0], OUTPUT.Velocity)
