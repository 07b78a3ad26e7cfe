"""Friction in joints: the rotation of a revolute joint, the sliding of a prismatic one."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from exudyn.itemInterface import GenericJoint, LinearSpringDamper, MarkerBodyRigid, TorsionalSpringDamper

from stochfric_mb.errors import InputError, require_number
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn import pointers
from stochfric_mb.exudyn.attach import bind_own
from stochfric_mb.exudyn.contact import OUTPUT, FrictionContact
from stochfric_mb.exudyn.hooks import Hooks
from stochfric_mb.exudyn.normal import Normal, ReactionNormal, as_normal
from stochfric_mb.exudyn.true_stick import TrueStick, require_holdable
from stochfric_mb.exudyn.turning import with_orientation
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law

_FREE = {"JointRevoluteZ": 5, "JointRevolute2D": 5, "JointPrismaticX": 0, "JointPrismatic2D": 0}
"""Kind of joint -> its axis that is free, as a generic joint counts them: translations along x, y, z, then rotations."""
_CYCLES = (np.eye(3)[:, [1, 2, 0]], np.eye(3)[:, [2, 0, 1]], np.eye(3))
"""Rotations that put the z axis where the joint's x, y, z axis is."""


def add_joint_friction(
    mbs: Any,
    joint: Any,
    friction: Law | Friction,
    *,
    radius: float = 1.0,
    normal_force: float | Callable[[float], float] | str | Any = None,
    effective_mass: float | None = None,
    seed: int = 0,
    sample: int = 0,
    contact: int | None = None,
) -> FrictionContact:
    """Return the friction that now acts in a revolute or prismatic joint, against the motion of its second body.

    Revolute: sliding is ``radius`` times the angle, the friction torque ``radius`` times the force. Prismatic: sliding is
    the displacement along the joint's axis.

    Args:
        mbs: the system.
        joint: object index of a RevoluteJointZ, RevoluteJoint2D, PrismaticJointX, PrismaticJoint2D, or of a GenericJoint
            that leaves one axis free, a rotation or a translation.
        friction: a law, or a law with the process of its coefficients.
        radius: radius of the pin [m], > 0; for revolute joints.
        normal_force: as `add_friction` has it; if not given, the joint's own reaction across its axis (implicit solvers
            only).
        effective_mass: mass that the contact feels [kg] (inertia over radius^2); as `add_friction` has it.
        seed: seed of the path of coefficients.
        sample: number of the sample.
        contact: number of the contact; contacts with different numbers have independent paths. If not given they are numbered
            0, 1, 2, ... as they are added to the system.

    Raises:
        InputError: another kind of joint, a GenericJoint that leaves no axis or more than one free, or as `add_friction`.
    """
    axis = _free_axis(mbs, joint)
    across = [i for i in range(3) if i != axis % 3]
    normal = ReactionNormal(mbs, joint, across) if normal_force is None else as_normal(mbs, normal_force)
    options: dict[str, Any] = {"effective_mass": effective_mass, "seed": seed, "sample": sample, "contact": contact}
    options["hooks"] = Hooks.of(mbs)
    kind, law = JointContact, as_friction(friction).law
    if law.needs_holding_force:
        require_holdable(law.kind, normal)
        kind = TrueStickJoint
    return kind(mbs, joint, axis, friction, normal, require_number("radius", radius, above=0.0, unit="m"), **options)


def _free_axis(mbs: Any, joint: Any) -> int:
    """Return the axis along or about which a joint leaves its second body free: 0 to 2 a translation, 3 to 5 a rotation.

    Raises:
        InputError: as `add_joint_friction`.
    """
    entry = mbs.GetObject(joint)
    kind = entry["objectType"]
    if kind in _FREE:
        return _FREE[kind]
    if kind != "JointGeneric":
        raise InputError(
            f"object {int(joint)} is a {kind}; friction in joints is for {', '.join(_FREE)} and JointGeneric; use add_friction "
            "between markers of its bodies for others"
        )
    free = [i for i, constrained in enumerate(entry["constrainedAxes"]) if not constrained]
    if len(free) != 1:
        raise InputError(
            f"object {int(joint)} is a JointGeneric with constrainedAxes = {list(entry['constrainedAxes'])}, which leaves "
            f"{len(free)} axes free; friction in a joint acts along or about one: constrain five axes, or use add_friction "
            "between markers of its bodies"
        )
    return free[0]


class JointContact(FrictionContact):
    """Friction in a joint; made by `add_joint_friction`."""

    def __init__(
        self, mbs: Any, joint: Any, free: int, friction: Law | Friction, normal: Normal, radius: float, **options: Any
    ) -> None:
        super().__init__(mbs, friction, normal, **options)
        self._own = np.zeros(4)
        bind_own(self._words, self._own)
        self._words[at.ASK_FIRST] = 1
        entry = mbs.GetObject(joint)
        self._turns = free >= 3
        """Whether the joint turns."""
        self._radius = radius if self._turns else 1.0
        self._numbers[[at.RADIUS, at.PERIOD]] = self._radius, 2.0 * math.pi * self._radius if self._turns else 0.0
        self._displacement = OUTPUT.Rotation if self._turns else OUTPUT.DisplacementLocal
        self._velocity = OUTPUT.AngularVelocityLocal if self._turns else OUTPUT.VelocityLocal
        self._reaction = OUTPUT.TorqueLocal if self._turns else OUTPUT.ForceLocal
        markers = [with_orientation(mbs, m) for m in entry["markerNumbers"]]
        function, self.route = pointers.line_function(), pointers.route()
        if self._turns:
            cycle = _CYCLES[free - 3]  # the connector turns about z
            rotations = [np.asarray(entry.get(f"rotationMarker{i}", np.eye(3))) @ cycle for i in range(2)]
            pairs = [_turned(mbs, m, rotation, i) for i, (m, rotation) in enumerate(zip(markers, rotations, strict=True))]
            markers, turn = [marker for marker, _ in pairs], pairs[0][1] | pairs[1][1]
            self._axes = np.asarray(turn.get("rotationMarker0", np.eye(3)))
            connector = TorsionalSpringDamper(
                markerNumbers=markers, stiffness=self.where, springTorqueUserFunction=function, **turn
            )
        else:
            axis = np.asarray(entry["axisMarker0"] if "axisMarker0" in entry else entry["rotationMarker0"][:, free])
            self._axes = _axes_along(axis)
            connector = LinearSpringDamper(
                markerNumbers=markers, stiffness=self.where, axisMarker0=axis, springForceUserFunction=function
            )
        self._markers = tuple(markers)
        self.object = mbs.AddObject(connector)
        self._begin()

    @property
    def torque(self) -> float:
        """The friction torque [N m] on the second body of a revolute joint."""
        return self._radius * self.force

    def _forces(self) -> tuple[float, float]:
        return -float(self._mbs.GetObjectOutput(self.object, self._reaction)) / self._radius, 0.0

    def connect(self) -> None:
        """Keep to reading the joint's motion after each step."""
        self._words[at.ASK_FIRST] = 1

    def _read_motion(self) -> None:
        """Take angle or displacement, and its rate, from the connector."""
        self._own[1] = self._mbs.GetObjectOutput(self.object, self._displacement)
        self._own[3] = self._mbs.GetObjectOutput(self.object, self._velocity)


class TrueStickJoint(TrueStick, JointContact):
    """Friction with true stick in a joint; made by `add_joint_friction`."""

    def _make_hold(self) -> Any:
        axes = [0] * 6
        axes[5 if self._turns else 0] = 1
        self._pair = [self._own_marker(marker) for marker in self._markers]
        return self._mbs.AddObject(GenericJoint(markerNumbers=self._pair, constrainedAxes=axes, activeConnector=False))

    def _own_marker(self, marker: Any) -> Any:
        """Return a new marker at the place of another, with the axes of the joint.

        Raises:
            InputError: the joint's marker is on a node, whose axes cannot be chosen.
        """
        entry = self._mbs.GetMarker(marker)
        if entry["markerType"] != "BodyRigid":
            raise InputError(
                f"law {self.friction.law.kind}: marker {int(marker)} of the joint is a {entry['markerType']}; a constraint "
                "holds it while it sticks, which needs markers of rigid bodies (MarkerBodyRigid)"
            )
        return self._mbs.AddMarker(
            MarkerBodyRigid(bodyNumber=entry["bodyNumber"], localHT=_placed(entry["localHT"], self._axes))
        )

    def _held(self) -> float:
        if self._turns:
            return float(self._mbs.GetObjectOutput(self._hold, OUTPUT.TorqueLocal)[2]) / self._radius
        return -float(self._mbs.GetObjectOutput(self._hold, OUTPUT.ForceLocal)[0])

    def _keep_still(self, stuck: bool) -> None:
        """Hold or let go; its axes on both bodies are those of the moment, since its force goes with 1/cos of their angle."""
        if stuck and self._turns:
            self._pair = [int(m) for m in self._mbs.GetObject(self._hold)["markerNumbers"]]  # deleted items renumber them
            first, second = (self._mbs.GetMarkerOutput(m, OUTPUT.RotationMatrix).reshape(3, 3) for m in self._pair)
            place = self._mbs.GetMarker(self._pair[1])["localHT"]
            self._mbs.SetMarkerParameter(self._pair[1], "localHT", _placed(place, second.T @ first))
        super()._keep_still(stuck)


def _placed(place: Any, rotation: Any) -> Any:
    """Return a marker's place on its body with its axes turned."""
    turned = np.array(place, dtype=np.float64)
    turned[:3, :3] = turned[:3, :3] @ rotation
    return turned


def _axes_along(axis: Any) -> Any:
    """Return axes (columns) of which the first is along ``axis``."""
    first = axis / np.linalg.norm(axis)
    second = np.cross(first, np.eye(3)[np.argmin(np.abs(first))])
    second /= np.linalg.norm(second)
    return np.column_stack([first, second, np.cross(first, second)])


def _turned(mbs: Any, marker: Any, rotation: Any, i: int) -> tuple[Any, dict[str, Any]]:
    """Return a marker with the axes ``rotation`` in those of ``marker``, and what a connector must be told besides."""
    if np.array_equal(rotation, np.eye(3)):
        return marker, {}
    entry = mbs.GetMarker(marker)
    if entry["markerType"] != "BodyRigid":
        return marker, {f"rotationMarker{i}": rotation}
    return mbs.AddMarker(MarkerBodyRigid(bodyNumber=entry["bodyNumber"], localHT=_placed(entry["localHT"], rotation))), {}
