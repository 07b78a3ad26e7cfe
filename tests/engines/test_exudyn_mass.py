"""The mass that a contact feels, from the system's mass matrix and constraints."""

# ruff: noqa: E402  (the adapter can be imported only where exudyn is)

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

exudyn = pytest.importorskip("exudyn", reason="exudyn is not installed")

from exudyn.itemInterface import (
    CoordinateConstraint,
    MarkerBodyRigid,
    MarkerNodeCoordinate,
    Mass1D,
    MassPoint,
    Node1D,
    NodePoint,
    NodeRigidBody2D,
    ObjectGround,
    RigidBody2D,
)

from stochfric_mb.errors import InputError
from stochfric_mb.exudyn import add_friction, add_joint_friction, silent_settings, solve_dynamic
from stochfric_mb.laws import make_law
from tests.engines.exudyn_systems import block, four_bar

LAW = make_law("elastic_stick", mu_s=0.4, mu_k=0.3)


def felt(mbs: Any, contact: Any) -> float:
    """Return the mass [kg] that a contact has taken from the system."""
    from stochfric_mb.exudyn import layout

    mbs.Assemble()
    contact.prepare(1e-3, 0.0)
    return float(contact._numbers[layout.MASS])


def test_two_masses_on_a_line() -> None:
    mbs, _, _, slide = block(1.0, 2.0)
    node = mbs.AddNode(Node1D(referenceCoordinates=[0.0]))
    mbs.AddObject(Mass1D(nodeNumber=node, mass=3.0))
    other = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    contact = add_friction(mbs, slide, other, LAW, normal_force=1.0)
    assert felt(mbs, contact) == pytest.approx(1.0 / (1.0 / 2.0 + 1.0 / 3.0), rel=1e-12)


def test_masses_coupled_by_a_constraint() -> None:
    """A wheel on the same line by x_2 = 3 x_1: m_1 + 9 m_2."""
    mbs, _, ground, slide = block(1.0, 2.0)
    node = mbs.AddNode(Node1D(referenceCoordinates=[0.0], initialVelocities=[3.0]))
    mbs.AddObject(Mass1D(nodeNumber=node, mass=0.5))
    other = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    mbs.AddObject(CoordinateConstraint(markerNumbers=[other, slide], factor1=3.0))
    contact = add_friction(mbs, ground, slide, LAW, normal_force=1.0)
    assert felt(mbs, contact) == pytest.approx(2.0 + 9.0 * 0.5, rel=1e-9)


def test_a_corner_of_a_planar_body() -> None:
    """1/m_eff = 1/m + r^2/I across the arm; the lighter direction counts."""
    mbs = exudyn.SystemContainer().AddSystem()
    ground = mbs.AddObject(ObjectGround())
    node = mbs.AddNode(NodeRigidBody2D(referenceCoordinates=[0.0, 0.0, 0.0]))
    body = mbs.AddObject(RigidBody2D(nodeNumber=node, mass=2.0, inertia=0.05))
    on_ground, corner = (mbs.AddMarker(MarkerBodyRigid(bodyNumber=b, localPosition=[0.0, -0.3, 0.0])) for b in (ground, body))
    contact = add_friction(mbs, on_ground, corner, LAW, normal_force=1.0, normal=(0.0, 1.0, 0.0))
    assert felt(mbs, contact) == pytest.approx(1.0 / (1.0 / 2.0 + 0.3**2 / 0.05), rel=1e-9)


def test_a_joint_of_a_closed_chain() -> None:
    """The crank's own joint: twice the kinetic energy of the whole four-bar over the square of its sliding speed."""
    system = four_bar(LAW, speed=4.0, radius=0.05)
    contact = add_joint_friction(system.mbs, system.contacts[0]._normal._object, LAW, radius=0.05, normal_force=1.0)
    mass = felt(system.mbs, contact)
    still = four_bar(LAW, speed=0.0, radius=0.05)
    still.mbs.Assemble()
    kinetic = system.energy() - still.energy()
    assert mass == pytest.approx(2.0 * kinetic / (4.0 * 0.05) ** 2, rel=1e-9)


def test_the_damper_of_elastic_stick_follows() -> None:
    """Runs without a mass and with the right one are the same."""
    ends = []
    ways: list[dict[str, Any]] = [{}, {"effective_mass": 2.0}]
    for options in ways:
        mbs, _, ground, slide = block(0.05, 2.0)
        add_friction(mbs, ground, slide, LAW, normal_force=10.0, **options)
        mbs.Assemble()
        solve_dynamic(mbs, silent_settings(1e-4, 0.1))
        ends.append(float(mbs.systemData.GetODE2Coordinates()[0]))
    assert ends[0] == pytest.approx(ends[1], rel=1e-9)


@pytest.mark.parametrize("solver", ["rk44", "generalized_alpha"])
def test_a_mass_that_is_far_too_large_is_refused(solver: str) -> None:
    mbs, _, ground, slide = block(1.0)
    add_friction(mbs, ground, slide, LAW, normal_force=10.0, effective_mass=100.0)
    mbs.Assemble()
    with pytest.raises(InputError, match=r"effective_mass = 100 kg, but this contact feels 1 kg by the system's mass matrix"):
        solve_dynamic(mbs, silent_settings(1e-3, 0.1), solver=solver)
    with pytest.raises(InputError, match=r"feels 1 kg"):
        mbs.SolveDynamic(silent_settings(1e-3, 0.1), solverType=exudyn.DynamicSolverType.RK44)


def test_a_system_keeps_its_state_while_the_mass_is_sought() -> None:
    mbs = exudyn.SystemContainer().AddSystem()
    node = mbs.AddNode(NodePoint(initialCoordinates=[0.1, 0.2, 0.3], initialVelocities=[1.0, 2.0, 3.0]))
    mbs.AddObject(MassPoint(nodeNumber=node, mass=1.5))
    markers = [mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=i)) for i in (0, 1)]
    contact = add_friction(mbs, markers[0], markers[1], LAW, normal_force=1.0)  # between two coordinates of one body: both move
    mass = felt(mbs, contact)
    assert mass == pytest.approx(0.75, rel=1e-12)
    np.testing.assert_array_equal(mbs.systemData.GetODE2Coordinates(), [0.1, 0.2, 0.3])
    np.testing.assert_array_equal(mbs.systemData.GetODE2Coordinates_t(), [1.0, 2.0, 3.0])
    assert contact.normal_force == 1.0
    assert math.isfinite(contact.force)
