"""Friction between two markers of any Exudyn system: coordinates, or positions of two bodies."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from exudyn.itemInterface import CoordinateConstraint, CoordinateSpringDamper

from stochfric_mb.errors import InputError, require_number
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn import pointers
from stochfric_mb.exudyn.contact import OUTPUT, FrictionContact
from stochfric_mb.exudyn.hooks import Hooks
from stochfric_mb.exudyn.normal import Normal, as_normal
from stochfric_mb.exudyn.plane import PlaneContact
from stochfric_mb.exudyn.plane_stick import TrueStickPlane
from stochfric_mb.exudyn.true_stick import TrueStick, require_holdable
from stochfric_mb.exudyn.turning import TurningContact, must_turn
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law


def add_friction(
    mbs: Any,
    marker0: Any,
    marker1: Any,
    friction: Law | Friction,
    *,
    normal_force: float | Callable[[float], float] | str | Any = None,
    normal: Sequence[float] | None = None,
    contact_stiffness: float | None = None,
    contact_damping: float = 0.0,
    touch: float | None = None,
    radius: float = 0.0,
    normal_turns_with: str = "marker0",
    surface_velocity: float | Sequence[float] = 0.0,
    effective_mass: float | None = None,
    seed: int = 0,
    sample: int = 0,
    contact: int | None = None,
) -> FrictionContact:
    """Return the contact that now acts between two markers of an Exudyn system.

    Coordinate markers: sliding along a line. The friction force on ``marker1``'s coordinate acts along
    ``surface_velocity - (velocity1 - velocity0)``; marker 0 gets the opposite one. Position markers: sliding in the plane
    across ``normal``, which turns with marker 0 unless stated otherwise. The point of contact lies ``radius`` below marker 1;
    its velocity is that of the body's material there relative to the counter-surface's, so that turntables, drums, balls and
    wheels are right. Forces and torques act at that point on both bodies.

    Compiled code evaluates the law, which the engine calls without Python where its build allows it (see `pointers`); the
    state is committed after each accepted step, in the system's PostStep function, which calls the one that was
    there. A simulation that starts again starts with fresh friction.

    Args:
        mbs: the system.
        marker0: marker of the counter-surface.
        marker1: marker of the body; both of coordinates, or both of positions.
        friction: a law, or a law with the process of its coefficients.
        normal_force: normal force: a number [N], > 0 (normal torque over radius for a rotation); a function of time; or
            a constraint, by its object index or its name, whose reaction it is (implicit solvers only). It goes on along
            a line from step to step. Positions may have ``contact_stiffness`` instead.
        normal: direction from the counter-surface to the body, for positions, in the axes of what it turns with.
        contact_stiffness: stiffness of a unilateral normal contact [N/m], > 0, which acts on the bodies too.
        contact_damping: its damping [N s/m], >= 0.
        touch: distance of the markers along the normal at which contact begins [m]; ``radius`` if not given.
        radius: distance of the point of contact from marker 1, against the normal [m], >= 0: that of a ball or an upright
            wheel whose centre is marker 1.
        normal_turns_with: "marker0": a plane of the counter-surface, such as a plate that tilts; "marker1": a plane of
            the body, such as a pad on a lever; "space": a plane that does not turn, such as where a drum passes by.
        surface_velocity: velocity of the counter-surface on top of marker 0's [m/s]: a number for coordinates, a vector
            for positions, in the axes of what the normal turns with.
        effective_mass: mass that the contact feels [kg], for laws and step limits that need it; taken from the system's mass
            matrix and constraints when a simulation starts, if not given.
        seed: seed of the path of coefficients.
        sample: number of the sample.
        contact: number of the contact; contacts with different numbers have independent paths. If not given they are numbered
            0, 1, 2, ... as they are added to the system.

    Raises:
        InputError: a law that needs the holding force, markers of different or unknown kinds,
            no normal force or two, or a number out of range.
    """
    options: dict[str, Any] = {"effective_mass": effective_mass, "seed": seed, "sample": sample, "contact": contact}
    options["hooks"] = Hooks.of(mbs)
    kinds = {marker_kind(mbs, m) for m in (marker0, marker1)}
    markers = (marker0, marker1)
    if kinds == {"coordinate"}:
        if normal is not None or contact_stiffness is not None or radius != 0.0:
            raise InputError("normal, contact_stiffness and radius are for position markers; give coordinates a normal_force")
        kind, source, law = CoordinateContact, as_normal(mbs, normal_force), as_friction(friction).law
        if law.needs_holding_force:
            require_holdable(law.kind, source)
            kind = TrueStickCoordinate
        return kind(mbs, markers, friction, source, surface_velocity, **options)
    if kinds == {"position"}:
        if (normal_force is None) == (contact_stiffness is None):
            raise InputError("give either normal_force or contact_stiffness, which makes one")
        given = None if normal_force is None else as_normal(mbs, normal_force)
        touch = radius if touch is None else touch
        penalty = None if contact_stiffness is None else (contact_stiffness, contact_damping, touch)
        if not must_turn(mbs, markers, normal_turns_with, radius):
            plane, law = PlaneContact, as_friction(friction).law
            if law.needs_holding_force:
                if given is not None:
                    require_holdable(law.kind, given)
                plane = TrueStickPlane
            return plane(mbs, markers, friction, given, penalty, normal, surface_velocity, **options)
        turning: Any = (normal_turns_with, radius)
        return TurningContact(mbs, markers, friction, given, penalty, normal, surface_velocity, *turning, **options)
    raise InputError("friction acts between two coordinate markers or between two position markers; these are of both kinds")


class CoordinateContact(FrictionContact):
    """Friction between two coordinates; made by `add_friction`."""

    def __init__(
        self,
        mbs: Any,
        markers: tuple[Any, Any],
        friction: Law | Friction,
        normal: Normal,
        surface_velocity: Any,
        **options: Any,
    ) -> None:
        super().__init__(mbs, friction, normal, **options)
        self._markers = markers
        self.route = pointers.route()
        self._own = np.zeros(4)
        self._numbers[at.SURFACE_VELOCITY] = require_number("surface_velocity", surface_velocity, unit="m/s")
        self.object = mbs.AddObject(
            CoordinateSpringDamper(
                markerNumbers=list(markers), stiffness=self.where, springForceUserFunction=pointers.line_function()
            )
        )
        self._begin()

    def _forces(self) -> tuple[float, float]:
        return -float(self._mbs.GetObjectOutput(self.object, OUTPUT.Force)), 0.0

    def connect(self) -> None:
        """Find out where the engine keeps the two coordinates (again, whenever a simulation starts)."""
        indices = [coordinate_index(self._mbs, m) for m in self._markers]
        self._own[:] = 0.0
        self._plain = None not in indices
        self._words[at.ASK_FIRST] = int(not self._plain or self._normal.changes)
        if self._plain:
            bind_coordinates(self._mbs, self._words, self._own, indices)
        else:
            self._bind_own()

    def _read_motion(self) -> None:
        """Take displacement and velocity from the connector, for markers that are no plain coordinates."""
        if not self._plain:
            self._own[1] = self._mbs.GetObjectOutput(self.object, OUTPUT.Displacement)
            self._own[3] = self._mbs.GetObjectOutput(self.object, OUTPUT.Velocity)

    def reset(self, start: float = 0.0) -> None:
        """Start the contact afresh, at the system's initial displacement and velocity."""
        self._own[:] = 0.0
        self._plain = False
        self._bind_own()
        super().reset(start)

    def _bind_own(self) -> None:
        bind_own(self._words, self._own)


class TrueStickCoordinate(TrueStick, CoordinateContact):
    """Friction with true stick between two coordinates; made by `add_friction`."""

    def _make_hold(self) -> Any:
        offset = float(self._numbers[at.SURFACE_VELOCITY])
        return self._mbs.AddObject(
            CoordinateConstraint(markerNumbers=list(self._markers), velocityLevel=True, offset=offset, activeConnector=False)
        )

    def _held(self) -> float:
        return -float(self._mbs.GetObjectOutput(self._hold, OUTPUT.Force))


def bind_own(words: Any, own: Any) -> None:
    """Let a contact read positions and velocities of its markers from an array of its own, shape (4,)."""
    start = own.ctypes.data
    words[[at.POSITION_0, at.POSITION_1, at.VELOCITY_0, at.VELOCITY_1]] = [start + own.itemsize * i for i in range(4)]


def bind_coordinates(mbs: Any, words: Any, zero: Any, indices: Sequence[int | None]) -> None:
    """Let a contact read positions and velocities of its markers where the engine keeps them; -1: ground."""
    position = mbs.systemData.GetODE2Coordinates(copy=False)
    velocity = mbs.systemData.GetODE2Coordinates_t(copy=False)
    for places, array in (((at.POSITION_0, at.POSITION_1), position), ((at.VELOCITY_0, at.VELOCITY_1), velocity)):
        for place, index in zip(places, indices, strict=True):
            assert index is not None
            words[place] = zero.ctypes.data if index < 0 else array.ctypes.data + array.itemsize * index


def coordinate_index(mbs: Any, marker: Any) -> int | None:
    """Return the place of a marker's coordinate among the system's, -1 on ground, None if it is no plain coordinate."""
    entry = mbs.GetMarker(marker)
    if entry["markerType"] != "NodeCoordinate":
        return None
    if "Ground" in mbs.GetNode(entry["nodeNumber"])["nodeType"]:
        return -1
    return int(mbs.systemData.GetNodeLTGODE2(entry["nodeNumber"])[entry["coordinate"]])


def marker_kind(mbs: Any, marker: Any) -> str:
    """Return "coordinate" or "position".

    Raises:
        InputError: a marker of another kind.
    """
    kind = mbs.GetMarker(marker)["markerType"]
    if kind.endswith("Coordinate"):
        return "coordinate"
    if kind in (
        "BodyPosition",
        "BodyRigid",
        "NodePosition",
        "NodeRigid",
        "SuperElementPosition",
        "SuperElementRigid",
        "KinematicTreeRigid",
    ):
        return "position"
    raise InputError(f"marker {int(marker)} is a {kind}; friction acts between markers of coordinates or of positions")
