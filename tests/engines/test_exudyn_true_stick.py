"""Laws with true stick in Exudyn: a constraint holds, and switches as the law says."""

# ruff: noqa: E402  (the adapter can be imported only where exudyn is)

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

exudyn = pytest.importorskip("exudyn", reason="exudyn is not installed")

from exudyn.itemInterface import (
    CoordinateConstraint,
    CoordinateSpringDamper,
    Force,
    GenericJoint,
    LoadCoordinate,
    MarkerBodyRigid,
    MarkerNodeCoordinate,
    Mass1D,
    Node1D,
    NodeRigidBody2D,
    ObjectGround,
    RevoluteJoint2D,
    RevoluteJointZ,
    RigidBody2D,
    Torque,
)
from exudyn.utilities import HomogeneousTransformation, RigidBodyInertia, RotationMatrixZ

from stochfric_mb import reference
from stochfric_mb.coefficients import Knots
from stochfric_mb.errors import InputError
from stochfric_mb.exudyn import add_friction, add_joint_friction, silent_settings, solve_dynamic
from stochfric_mb.exudyn.belt_box import without_friction
from stochfric_mb.friction import Friction
from stochfric_mb.laws import make_law
from stochfric_mb.scenario import load_scenario
from tests.engines.exudyn_systems import OUT, block, four_bar

COULOMB = make_law("coulomb", mu_s=0.4, mu_k=0.3)
KNOTS = Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01)


def solve(mbs: Any, dt: float, duration: float, *, locate: bool = True) -> None:
    solve_dynamic(mbs, silent_settings(dt, duration), solver="generalized_alpha", locate=locate)


@pytest.mark.parametrize(
    ("kind", "name", "process", "dt", "tolerance"),
    [  # m; measured 0.3, 0.2, 0.1 and 2.2 um: the trapezoidal rule, and switches located to 1e-3 of a step
        ("coulomb", "kang2015_table1", None, 1e-3, 1e-6),
        ("coulomb", "kang2015_table1", KNOTS, 1e-3, 1e-6),
        ("coulomb", "kang2015_table2_13_8", KNOTS, 1e-3, 1e-6),
        ("stribeck", "kang2015_table1", None, 1e-3, 5e-6),
        ("karnopp", "kang2015_table1", None, 1e-3, 1e-6),
        ("karnopp", "kang2015_table2_13_8", KNOTS, 1e-3, 1e-6),
    ],
)
def test_the_belt_box_follows_the_reference(kind: str, name: str, process: Any, dt: float, tolerance: float) -> None:
    s = dataclasses.replace(load_scenario(name, law=kind), duration=3.0, process=process)
    m = s.mechanism
    mbs, _, ground, slide = without_friction(m)
    friction = Friction(s.law, process)
    contact = add_friction(
        mbs, ground, slide, friction, normal_force=m.normal_force, surface_velocity=m.belt_velocity, seed=1
    )  # fmt: skip
    mbs.Assemble()
    rows = contact.record(s.output_times())
    solve(mbs, dt, s.duration)
    exact = reference.simulate(s, seed=1)
    assert np.max(np.abs(m.belt_velocity * rows[:, 0] - rows[:, 1] - exact.position)) <= tolerance
    assert np.mean(rows[:, 6]) == pytest.approx(np.mean(exact.stick), abs=1e-3)
    assert np.all(np.abs(rows[:, 3]) <= rows[:, 4] * rows[:, 7] * (1.0 + 1e-9))
    assert np.ptp(rows[rows[:, 6] == 1.0, 2]) <= 1e-12  # stuck is at rest on the belt


def test_a_thrown_body_stops_and_stays() -> None:
    mbs, node, ground, slide = block(1.0)
    contact = add_friction(mbs, ground, slide, COULOMB, normal_force=10.0)
    mbs.Assemble()
    solve(mbs, 1e-3, 0.5)
    assert mbs.GetNodeOutput(node, OUT.Coordinates) == pytest.approx(1.0 / 6.0, abs=1e-9)
    assert mbs.GetNodeOutput(node, OUT.Coordinates_t) == 0.0
    assert contact.stick
    assert contact.force == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("load", "holds"), [(3.99, True), (4.01, False)])
def test_the_threshold_is_mu_s(load: float, holds: bool) -> None:
    mbs, node, ground, slide = block(0.0)
    mbs.AddLoad(LoadCoordinate(markerNumber=slide, load=load))
    contact = add_friction(mbs, ground, slide, COULOMB, normal_force=10.0)
    mbs.Assemble()
    solve(mbs, 1e-3, 1.0)
    x = float(mbs.GetNodeOutput(node, OUT.Coordinates))
    if holds:
        assert abs(x) <= 1e-15  # no creep
        assert contact.force == pytest.approx(-load, rel=1e-9)
    else:
        assert x == pytest.approx(0.5 * (load - 3.0), abs=2e-3)  # it lets go at the end of the first step: a h t
        assert contact.force == pytest.approx(-3.0, rel=1e-12)


@pytest.mark.parametrize("coupled", [False, True])
def test_two_bodies_keep_their_momentum(coupled: bool) -> None:
    """2 kg thrown on 1 kg (or on 0.25 kg that moves twice as fast, by a constraint): one velocity in the end, and it stays."""
    mbs, node, _, first = block(3.0, 2.0)
    other = mbs.AddNode(Node1D(referenceCoordinates=[0.0]))
    mbs.AddObject(Mass1D(nodeNumber=other, mass=0.75 if coupled else 1.0))
    second = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=other, coordinate=0))
    if coupled:
        third = mbs.AddNode(Node1D(referenceCoordinates=[0.0]))
        mbs.AddObject(Mass1D(nodeNumber=third, mass=0.25 / 4.0))
        marker = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=third, coordinate=0))
        mbs.AddObject(CoordinateConstraint(markerNumbers=[marker, second], factor1=2.0))
    contact = add_friction(mbs, first, second, COULOMB, normal_force=10.0)
    mbs.Assemble()
    solve(mbs, 1e-3, 1.0)
    v = [float(mbs.GetNodeOutput(n, OUT.Coordinates_t)) for n in (node, other)]
    assert contact.stick
    assert v == pytest.approx([2.0, 2.0], rel=1e-9)


def test_a_block_that_stops_on_a_sliding_plank_takes_it_along() -> None:
    """The plank sticks at the start: a switch acts on the bodies beside the contacts that stick then, not at the start."""
    g, block_mass, plank_mass = 9.81, 0.7, 2.0
    mbs, _, ground, plank = block(0.0, plank_mass)
    node = mbs.AddNode(Node1D(referenceCoordinates=[0.0], initialVelocities=[3.0]))
    mbs.AddObject(Mass1D(nodeNumber=node, mass=block_mass))
    rider = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    below = add_friction(mbs, ground, plank, COULOMB, normal_force=0.1 * (block_mass + plank_mass) * g)
    between = add_friction(mbs, plank, rider, COULOMB, normal_force=block_mass * g)
    mbs.Assemble()
    dt, end = 5e-4, 1.5
    rows = [contact.record(dt * np.arange(1, round(end / dt) + 1)) for contact in (below, between)]
    solve(mbs, dt, end)
    faster, slower, together = (0.3 * block_mass * g - 0.03 * 2.7 * g) / plank_mass, 0.3 * g, 0.03 * g
    meets = 3.0 / (slower + faster)
    # let go at the end of the first step, 0.5e-6 s late (switches are located to 1e-3 of a step), times 5 m/s^2 and less
    speed = faster * meets - together * (end - meets)
    assert mbs.systemData.GetODE2Coordinates_t() == pytest.approx([speed, speed], abs=5e-6)
    after = rows[0][:, 0] > meets + 2 * dt
    assert np.max(np.abs(np.diff(rows[0][after, 2]) / dt - together)) < 1e-6  # v_rel is minus the plank's speed
    assert np.all(np.abs(rows[1][:, 3]) <= rows[1][:, 4] * rows[1][:, 7] * (1.0 + 1e-9))


def test_the_amplitude_falls_by_2_mu_n_over_k_each_half_swing() -> None:
    mbs, node, ground, slide = block(0.0, position=0.0325)
    mbs.AddObject(CoordinateSpringDamper(markerNumbers=[ground, slide], stiffness=800.0))
    add_friction(mbs, ground, slide, make_law("coulomb", mu_s=0.4, mu_k=0.4), normal_force=10.0)
    mbs.Assemble()
    solve(mbs, 2e-4, 0.6)
    assert mbs.GetNodeOutput(node, OUT.Coordinates) == pytest.approx(0.0325 - 3 * 0.01 - 2 * 0.0025, abs=1e-6)
    assert mbs.GetNodeOutput(node, OUT.Coordinates_t) == 0.0


def test_what_cannot_be_held_is_named() -> None:
    mbs, _, ground, slide = block(0.0)
    add_friction(mbs, ground, slide, COULOMB, normal_force=10.0)
    mbs.Assemble()
    with pytest.raises(InputError, match="solver='generalized_alpha'"):
        solve_dynamic(mbs, silent_settings(1e-3, 0.1), solver="rk44")
    with pytest.raises(InputError, match="useNewmark"):
        mbs.SolveDynamic(silent_settings(1e-3, 0.1))
    system = four_bar(make_law("elastic_stick", mu_s=0.4, mu_k=0.3), speed=1.0, radius=0.02)
    with pytest.raises(InputError, match="cannot be the reaction of another"):
        add_joint_friction(system.mbs, system.contacts[0]._normal._object, COULOMB)


def test_two_contacts_that_hold_one_coordinate_are_refused() -> None:
    mbs, _, ground, slide = block(1.0)
    for _ in range(2):
        add_friction(mbs, ground, slide, COULOMB, normal_force=5.0)
    mbs.Assemble()
    with pytest.raises(InputError, match="hold the same bodies"):
        solve(mbs, 1e-3, 0.1)


# --- joints -----------------------------------------------------------------------------------------------------------


def wheel(kind: str, angle: float, speed: float, load: float) -> tuple[Any, Any, Any]:
    """A wheel of 0.2 kg m^2 on a pin, with a torque [N m]."""
    mbs = exudyn.SystemContainer().AddSystem()
    ground = mbs.AddMarker(MarkerBodyRigid(bodyNumber=mbs.AddObject(ObjectGround())))
    if kind == "planar":
        node = mbs.AddNode(NodeRigidBody2D(referenceCoordinates=[0.0, 0.0, angle], initialVelocities=[0.0, 0.0, speed]))
        body = mbs.AddObject(RigidBody2D(nodeNumber=node, mass=1.0, inertia=0.2))
    else:
        inertia = RigidBodyInertia(1.0, 0.2 * np.eye(3))
        turned = RotationMatrixZ(angle)
        body = mbs.CreateRigidBody(inertia=inertia, referenceRotationMatrix=turned, initialAngularVelocity=[0.0, 0.0, speed])
    hub = mbs.AddMarker(MarkerBodyRigid(bodyNumber=body))
    joint = mbs.AddObject((RevoluteJoint2D if kind == "planar" else RevoluteJointZ)(markerNumbers=[ground, hub]))
    mbs.AddLoad(Torque(markerNumber=hub, loadVector=[0.0, 0.0, load]))
    contact = add_joint_friction(mbs, joint, COULOMB, radius=0.1, normal_force=50.0)
    mbs.Assemble()
    return mbs, body, contact


@pytest.mark.parametrize("kind", ["planar", "spatial"])
@pytest.mark.parametrize("angle", [0.0, 0.5 * np.pi, 2.5])
def test_a_pin_holds_up_to_mu_s(kind: str, angle: float) -> None:
    """mu_s N r = 2 N m, mu_k N r = 1.5 N m."""
    mbs, body, contact = wheel(kind, angle, 0.0, 1.99)
    solve(mbs, 1e-3, 0.3)
    assert contact.stick
    assert contact.torque == pytest.approx(-1.99, rel=1e-9)
    assert abs(mbs.GetObjectOutputBody(body, OUT.AngularVelocity, [0.0] * 3)[2]) <= 1e-12
    mbs, body, contact = wheel(kind, angle, 0.0, 2.01)
    solve(mbs, 1e-3, 0.3)
    assert contact.torque == pytest.approx(-1.5, rel=1e-9)
    # it lets go within the first step
    assert mbs.GetObjectOutputBody(body, OUT.AngularVelocity, [0.0] * 3)[2] == pytest.approx(0.51 / 0.2 * 0.2995, abs=2e-3)


@pytest.mark.parametrize("kind", ["planar", "spatial"])
def test_a_wheel_on_a_pin_stops_and_stays(kind: str) -> None:
    mbs, body, contact = wheel(kind, 0.3, 3.0, 0.0)
    solve(mbs, 1e-3, 0.7)
    assert contact.stick
    assert abs(mbs.GetObjectOutputBody(body, OUT.AngularVelocity, [0.0] * 3)[2]) <= 1e-12
    # w^2/(2 a) with a = mu_k N r/I = 7.5 rad/s^2
    assert mbs.GetObjectOutput(contact.object, OUT.Rotation) - 0.3 == pytest.approx(3.0**2 / 15.0, abs=1e-6)


@pytest.mark.parametrize(("load", "holds"), [(3.99, True), (4.01, False)])
def test_a_slide_holds_up_to_mu_s(load: float, holds: bool) -> None:
    mbs = exudyn.SystemContainer().AddSystem()
    turned = RotationMatrixZ(0.4)
    ground = mbs.AddMarker(
        MarkerBodyRigid(bodyNumber=mbs.AddObject(ObjectGround()), localHT=HomogeneousTransformation(turned, np.zeros(3)))
    )
    body = mbs.CreateRigidBody(inertia=RigidBodyInertia(1.0, 0.1 * np.eye(3)), referenceRotationMatrix=turned)
    slider = mbs.AddMarker(MarkerBodyRigid(bodyNumber=body))
    joint = mbs.AddObject(
        GenericJoint(
            markerNumbers=[ground, slider],
            constrainedAxes=[0, 1, 1, 1, 1, 1],
        )
    )
    mbs.AddLoad(Force(markerNumber=slider, loadVector=list(load * turned[:, 0])))
    contact = add_joint_friction(mbs, joint, COULOMB, normal_force=10.0)
    mbs.Assemble()
    solve(mbs, 1e-3, 0.3)
    speed = np.linalg.norm(mbs.GetObjectOutputBody(body, OUT.Velocity, [0.0] * 3))
    if holds:
        assert contact.force == pytest.approx(-load, rel=1e-9)
        assert speed <= 1e-12
    else:
        assert contact.force == pytest.approx(-3.0, rel=1e-9)
        assert speed == pytest.approx(1.01 * 0.2995, abs=1e-3)
