"""Friction where the counter-surface or the body turns: tilting plates, turntables, drums, balls and wheels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from exudyn.itemInterface import CartesianSpringDamper, LoadTorqueVector, MarkerBodyRigid, RigidBodySpringDamper

from stochfric_mb.errors import InputError, require_name, require_number
from stochfric_mb.exudyn import frames
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn.contact import OUTPUT, FrictionContact
from stochfric_mb.exudyn.normal import ConstantNormal, Normal
from stochfric_mb.exudyn.plane import set_plane
from stochfric_mb.friction import Friction
from stochfric_mb.laws import Law

FRAMES = {"marker0": frames.MARKER_0, "marker1": frames.MARKER_1, "space": frames.SPACE}
"""What a tangent plane can turn with."""
_BODIES_THAT_TURN = ("RigidBody", "RigidBody2D", "RotationalMass1D", "Ground")
_MARKERS_THAT_TURN = ("BodyRigid", "NodeRigid", "SuperElementRigid", "KinematicTreeRigid")
_PLACES = ((frames.POSITION, 3, OUTPUT.Position), (frames.VELOCITY, 3, OUTPUT.Velocity))
_PLACES_OF_TURNING = ((frames.OMEGA, 3, OUTPUT.AngularVelocity), (frames.ROTATION, 9, OUTPUT.RotationMatrix))


class TurningContact(FrictionContact):
    """Friction in a plane that turns, or on a body that turns; made by `add_friction`."""

    def __init__(
        self,
        mbs: Any,
        markers: tuple[Any, Any],
        friction: Law | Friction,
        normal_force: Normal | None,
        penalty: tuple[float, float, float] | None,
        normal: Sequence[float] | None,
        surface_velocity: Any,
        turns_with: str,
        radius: float,
        **options: Any,
    ) -> None:
        super().__init__(mbs, friction, normal_force or ConstantNormal(0.0), **options)
        set_plane(self, penalty, normal, surface_velocity)
        self._words[at.ASK_FIRST] = 1
        self._frame, self._radius = FRAMES[turns_with], radius
        rigid = [has_orientation(mbs, m) for m in markers]
        self._markers = tuple(with_orientation(mbs, m) if r else m for m, r in zip(markers, rigid, strict=True))
        self._seen, self._out = np.zeros(2 * frames.MARKER), np.zeros(frames.OUTCOME)
        self._reads: list[tuple[Any, Any, Any, int]] = []
        self._gone = False
        for side, (marker, turning) in enumerate(zip(self._markers, rigid, strict=True)):
            seen = self._seen.reshape(2, frames.MARKER)[side]
            seen[frames.ROTATION :] = np.eye(3).ravel()
            places = _PLACES + _PLACES_OF_TURNING if turning else _PLACES
            self._reads += [(seen[place : place + size], marker, output, side) for place, size, output in places]
        self.object = mbs.AddObject(self._connector(all(rigid)))
        self.lever: Any = None
        """Number of the load that is the rest of the torque on marker 0's body; None where it cannot turn."""
        if rigid[0] and not on_ground(mbs, markers[0]):
            self.lever = mbs.AddLoad(
                LoadTorqueVector(
                    markerNumber=self._markers[0], loadVector=[0.0] * 3, loadVectorUserFunction=self._lever_function()
                )
            )
            self.is_load = True
            mbs.SetLoadParameter(self.lever, "name", f"{self._name} lever")
        self._begin()

    def find(self) -> bool:
        """Find object and load again; a load whose object is gone gives no torque any more."""
        self._gone = not super().find()
        if self.lever is not None:
            self.lever = self._mbs.GetLoadNumber(f"{self._name} lever")
        return not self._gone

    def _follow_markers(self) -> None:
        """Read the motion of the markers' new numbers."""
        self._reads = [(into, self._markers[side], variable, side) for into, _, variable, side in self._reads]

    @property
    def force(self) -> Any:
        """The friction force [N] on marker 1's body that the engine applies now, a vector in global axes."""
        self._push(float(self._mbs.systemData.GetTime()))
        return self._out[frames.GLOBAL : frames.GLOBAL + 3].copy()

    def prepare(self, dt: float, start: float) -> None:
        """Start afresh, as any contact does; tell implicit solvers what the load depends on."""
        super().prepare(dt, start)
        if self.lever is not None:
            self._mbs.systemData.AddODE2LoadDependencies(self.lever, self._coordinates())

    def _coordinates(self) -> list[int]:
        """Return the places of marker 1's coordinates among the system's."""
        entry, data = self._mbs.GetMarker(self._markers[1]), self._mbs.systemData
        if "bodyNumber" in entry:
            return list(data.GetObjectLTGODE2(entry["bodyNumber"]))
        if "nodeNumber" in entry:
            return list(data.GetNodeLTGODE2(entry["nodeNumber"]))
        return list(data.GetObjectLTGODE2(entry["objectNumber"]))

    def _forces(self) -> Any:
        self._push(float(self._mbs.systemData.GetTime()))
        return float(self._out[0]), float(self._out[1])

    def _see(self) -> None:
        """Take position, velocity, rotation and angular velocity of both markers."""
        output = self._mbs.GetMarkerOutput
        for into, marker, variable, _ in self._reads:
            into[:] = output(marker, variable)

    def _read_motion(self) -> None:
        self._see()
        frames.take_motion(self._seen, self.where, self._frame, self._radius)

    def _push(self, t: float) -> None:
        """Compute the forces of the engine's current motion."""
        self._see()
        frames.push(t, self._seen, self.where, self._frame, self._radius, self._out)

    def _connector(self, both_turn: bool) -> Any:
        """Return the object that applies the force to both bodies: with a torque, where both markers have an orientation."""
        push, out, markers = self._push, self._out, list(self._markers)
        function: Any

        def force_and_torque(mbs: Any, t: float, *_: Any) -> Any:
            push(t)
            return out[frames.PULL : frames.PULL + 6]

        def force(mbs: Any, t: float, *_: Any) -> Any:
            push(t)
            return out[frames.PULL_GLOBAL : frames.PULL_GLOBAL + 3]

        if both_turn:
            function = force_and_torque
            return RigidBodySpringDamper(markerNumbers=markers, springForceTorqueUserFunction=function)
        function = force
        return CartesianSpringDamper(markerNumbers=markers, springForceUserFunction=function)

    def _lever_function(self) -> Any:
        push, out = self._push, self._out

        def torque(mbs: Any, t: float, load: Any) -> Any:
            if self._gone:
                return [0.0] * 3
            push(t)
            return out[frames.LEVER : frames.LEVER + 3]

        return torque


def must_turn(mbs: Any, markers: tuple[Any, Any], turns_with: str, radius: float) -> bool:
    """Return whether a contact needs a plane or a point of contact that turns.

    Raises:
        InputError: an unknown name, a radius below 0, or markers that have no orientation where one is needed.
    """
    require_name("normal_turns_with", turns_with, FRAMES)
    require_number("radius", radius, low=0.0, unit="m")
    rigid = [has_orientation(mbs, m) for m in markers]
    if radius > 0.0 and not all(rigid):
        raise InputError(
            f"radius = {radius:g} m: marker {int(markers[rigid.index(False)])} is on something without orientation; a body "
            "that rolls, and what it rolls on, need markers of rigid bodies or of ground"
        )
    if turns_with == "marker1" and not rigid[1]:
        raise InputError(
            f"normal_turns_with = 'marker1': marker {int(markers[1])} has no orientation; use a marker of a rigid body, or "
            "'marker0' or 'space'"
        )
    if radius > 0.0 or turns_with == "marker1" or (rigid[0] and not on_ground(mbs, markers[0])):
        return True
    return turns_with == "marker0" and rigid[0] and _is_turned(mbs, markers[0])


def has_orientation(mbs: Any, marker: Any) -> bool:
    """Return whether a marker, or the body that it is a position of, has an orientation."""
    entry = mbs.GetMarker(marker)
    if entry["markerType"] == "BodyPosition":
        return mbs.GetObject(entry["bodyNumber"])["objectType"] in _BODIES_THAT_TURN
    return entry["markerType"] in _MARKERS_THAT_TURN


def with_orientation(mbs: Any, marker: Any) -> Any:
    """Return the marker, or a new one at the same place of the same body that has an orientation."""
    entry = mbs.GetMarker(marker)
    if entry["markerType"] != "BodyPosition":
        return marker
    return mbs.AddMarker(MarkerBodyRigid(bodyNumber=entry["bodyNumber"], localPosition=entry["localPosition"]))


def on_ground(mbs: Any, marker: Any) -> bool:
    """Return whether a marker is on a ground object."""
    entry = mbs.GetMarker(marker)
    return "bodyNumber" in entry and mbs.GetObject(entry["bodyNumber"])["objectType"] == "Ground"


def _is_turned(mbs: Any, marker: Any) -> bool:
    """Return whether the axes of a marker on ground are not the global ones."""
    entry = mbs.GetMarker(marker)
    rotation = np.asarray(mbs.GetObject(entry["bodyNumber"])["referenceRotation"])
    if "localHT" in entry:
        rotation = rotation @ np.asarray(entry["localHT"])[:3, :3]
    return not np.array_equal(rotation, np.eye(3))
