"""Exudyn systems of one's own that tests share: mechanisms with friction, and their energy."""

# ruff: noqa: E402  (Exudyn may be missing)

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

exudyn = pytest.importorskip("exudyn", reason="exudyn is not installed")

from exudyn.itemInterface import (
    Force,
    MarkerBodyPosition,
    MarkerBodyRigid,
    MarkerNodeCoordinate,
    Mass1D,
    Node1D,
    NodePointGround,
    NodeRigidBody2D,
    ObjectGround,
    RevoluteJoint2D,
    RigidBody2D,
)

from stochfric_mb.exudyn import add_joint_friction

OUT: Any = exudyn.OutputVariableType
G = 9.81


@dataclasses.dataclass
class System:
    """A system with friction, not yet assembled."""

    mbs: Any
    contacts: list[Any]
    bodies: list[tuple[Any, float, float]] = dataclasses.field(default_factory=list[Any])
    """Planar bodies: object, mass, inertia."""

    def energy(self) -> float:
        """Return kinetic and potential energy [J] of the planar bodies as they are now."""
        total = 0.0
        for body, m, inertia in self.bodies:
            get = self.mbs.GetObjectOutputBody
            x, v, w = (get(body, what, [0.0] * 3) for what in (OUT.Position, OUT.Velocity, OUT.AngularVelocity))
            total += 0.5 * m * float(v @ v) + 0.5 * inertia * float(w[2]) ** 2 + m * G * float(x[1])
        return total


def block(velocity: float, mass: float = 1.0, *, position: float = 0.0) -> tuple[Any, Any, Any, Any]:
    """Return a system with one sliding mass, its node, and the markers of ground and of its coordinate."""
    mbs = exudyn.SystemContainer().AddSystem()
    node = mbs.AddNode(Node1D(referenceCoordinates=[0.0], initialCoordinates=[position], initialVelocities=[velocity]))
    mbs.AddObject(Mass1D(nodeNumber=node, mass=mass))
    ground = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=mbs.AddNode(NodePointGround()), coordinate=0))
    return mbs, node, ground, mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))


def four_bar(law: Any, *, speed: float, radius: float) -> System:
    """Return a four-bar under gravity with friction in its joints, pressed by their own reactions.

    Ground 0.5 m, crank 0.2 m at 60 degrees with ``speed`` [rad/s], coupler 0.5 m, rocker 0.45 m; 1, 2 and 1.5 kg.
    """
    mbs = exudyn.SystemContainer().AddSystem()
    a, d = np.zeros(2), np.array([0.5, 0.0])
    b = 0.2 * np.array([math.cos(math.pi / 3.0), math.sin(math.pi / 3.0)])
    r = float(np.linalg.norm(d - b))
    along = (0.5**2 - 0.45**2 + r**2) / (2.0 * r)
    e = (d - b) / r
    c = b + along * e + math.sqrt(0.5**2 - along**2) * np.array([-e[1], e[0]])

    def turned(v: Any) -> Any:
        return np.array([-v[1], v[0]])

    v_b = speed * turned(b - a)
    rates = np.linalg.solve(np.column_stack([turned(c - b), -turned(c - d)]), -v_b)
    ground, bodies = mbs.AddObject(ObjectGround()), []
    for p, q, w, v_p, m in ((a, b, speed, 0.0 * v_b, 1.0), (b, c, rates[0], v_b, 2.0), (d, c, rates[1], 0.0 * v_b, 1.5)):
        length, middle, angle = float(np.linalg.norm(q - p)), 0.5 * (p + q), math.atan2(*(q - p)[::-1])
        velocity = v_p + w * turned(middle - p)
        node = mbs.AddNode(NodeRigidBody2D(referenceCoordinates=[*middle, angle], initialVelocities=[*velocity, w]))
        body = mbs.AddObject(RigidBody2D(nodeNumber=node, mass=m, inertia=m * length**2 / 12.0))
        mbs.AddLoad(Force(markerNumber=mbs.AddMarker(MarkerBodyPosition(bodyNumber=body)), loadVector=[0.0, -m * G, 0.0]))
        bodies.append((body, m, m * length**2 / 12.0, length))

    def at(body: Any, x: float, y: float = 0.0) -> Any:
        return mbs.AddMarker(MarkerBodyRigid(bodyNumber=body, localPosition=[x, y, 0.0]))

    (crank, _, _, l_1), (coupler, _, _, l_2), (rocker, _, _, l_3) = bodies
    pins = (
        (at(ground, *a), at(crank, -0.5 * l_1)),
        (at(crank, 0.5 * l_1), at(coupler, -0.5 * l_2)),
        (at(coupler, 0.5 * l_2), at(rocker, 0.5 * l_3)),
        (at(ground, *d), at(rocker, -0.5 * l_3)),
    )
    joints = [mbs.AddObject(RevoluteJoint2D(markerNumbers=list(pin))) for pin in pins]
    contacts = [
        add_joint_friction(mbs, joint, law, radius=radius, effective_mass=0.01 / radius**2, contact=i)
        for i, joint in enumerate(joints)
    ]
    return System(mbs, contacts, [body[:3] for body in bodies])
