"""Friction in Exudyn where the counter-surface or the body turns: each case against its closed form."""

# ruff: noqa: E402  (the adapter can be imported only where exudyn is)

from __future__ import annotations

import math

import numpy as np
import pytest

exudyn = pytest.importorskip("exudyn", reason="exudyn is not installed")

from exudyn.itemInterface import (
    CoordinateConstraint,
    Force,
    MarkerBodyPosition,
    MarkerBodyRigid,
    MarkerNodeCoordinate,
    MassPoint,
    NodePoint,
    NodePointGround,
    NodeRigidBody2D,
    ObjectGround,
    RigidBody2D,
)
from exudyn.rigidBodyUtilities import RotationVector2RotationMatrix
from exudyn.utilities import RigidBodyInertia

from stochfric_mb.errors import InputError
from stochfric_mb.exudyn import add_friction, silent_settings, solve_dynamic
from stochfric_mb.laws import make_law

G = 10.0
RXYZ = exudyn.NodeType.RotationRxyz
"""Explicit solvers cannot run Euler parameters."""


def even(mu: float):
    """An elastic stick without a drop from stick to slip."""
    return make_law("elastic_stick", mu_s=mu, mu_k=mu, decay_velocity=0.0)


def free_body(mbs, mass: float, inertia: float, **motion):
    """A body in space with the same inertia about all axes."""
    tensor = RigidBodyInertia(mass=mass, inertiaTensor=np.eye(3) * inertia)
    return mbs.CreateRigidBody(inertia=tensor, nodeType=RXYZ, **motion)


def position_of(mbs, body):
    return mbs.AddMarker(MarkerBodyPosition(bodyNumber=body))


def coordinates(mbs, body):
    """Velocity and angular velocity of a body, global."""
    output = exudyn.OutputVariableType
    return mbs.GetObjectOutputBody(body, output.Velocity), mbs.GetObjectOutputBody(body, output.AngularVelocity)


# --- rolling ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("shape", "share"), [("disc", 0.5), ("sphere", 0.4)])
@pytest.mark.parametrize("solver", ["rk44", "dopri5", "velocity_verlet", "generalized_alpha"])
def test_sliding_becomes_rolling(shape: str, share: float, solver: str) -> None:
    """With I = share m r^2 the slip v - r omega falls by (1 + 1/share) mu g, from v_0 to 0; v is then v_0/(1 + share)."""
    v_0, mass, radius, mu, dt = 0.6, 2.0, 0.05, 0.3, 1e-4
    inertia = share * mass * radius**2
    rolls = v_0 / ((1.0 + 1.0 / share) * mu * G)  # v_0/(3 mu g) for the disc, 2 v_0/(7 mu g) for the sphere
    assert rolls == pytest.approx(v_0 / (3 * mu * G) if shape == "disc" else 2 * v_0 / (7 * mu * G))
    mbs = exudyn.SystemContainer().AddSystem()
    ground = mbs.AddObject(ObjectGround())
    if shape == "disc":
        node = mbs.AddNode(NodeRigidBody2D(initialVelocities=[v_0, 0.0, 0.0]))
        body = mbs.AddObject(RigidBody2D(nodeNumber=node, mass=mass, inertia=inertia))
    else:
        body = free_body(mbs, mass, inertia, initialVelocity=[v_0, 0.0, 0.0])
    markers = [position_of(mbs, b) for b in (ground, body)]
    felt = 1.0 / (1.0 / mass + radius**2 / inertia)
    options = {"normal": (0.0, 1.0, 0.0), "normal_force": mass * G, "radius": radius, "effective_mass": felt}
    contact = add_friction(mbs, *markers, even(mu), **options)
    mbs.Assemble()
    rows = contact.record(np.arange(0.0, 1.5 * rolls, dt))
    solve_dynamic(mbs, silent_settings(dt, math.ceil(1.5 * rolls / dt) * dt), solver=solver)
    slides = rows[:, 0] < rolls - 2.0 * dt
    np.testing.assert_allclose(-rows[slides, 2], v_0 * (1.0 - rows[slides, 0] / rolls), atol=1e-9)
    np.testing.assert_allclose(-rows[slides, 1], v_0 * (rows[slides, 0] - rows[slides, 0] ** 2 / (2 * rolls)), atol=1e-9)
    begins = rows[rows[:, 6] == 1.0, 0][0]
    assert rolls - dt < begins < rolls + 2.0 * dt  # the law sticks where slip turns back, within a step of it
    velocity, omega = coordinates(mbs, body)
    np.testing.assert_allclose(velocity, [v_0 / (1.0 + share), 0.0, 0.0], atol=1e-5)
    assert omega[2] == pytest.approx(-velocity[0] / radius, rel=1e-5)  # it rolls
    assert contact.stick
    # rolling goes on at the same speed: no creep, no force
    solve_dynamic(mbs, silent_settings(dt, 10.0 * round(rolls / dt) * dt), solver=solver)
    np.testing.assert_allclose(coordinates(mbs, body)[0], [v_0 / (1.0 + share), 0.0, 0.0], atol=1e-6)
    assert np.linalg.norm(contact.force) < 1e-4 * mu * mass * G


def test_a_disc_rolls_under_the_reaction_of_a_constraint() -> None:
    v_0, mass, radius, mu, dt = 0.6, 2.0, 0.05, 0.3, 1e-4
    mbs = exudyn.SystemContainer().AddSystem()
    ground = mbs.AddObject(ObjectGround())
    node = mbs.AddNode(NodeRigidBody2D(initialVelocities=[v_0, 0.0, 0.0]))
    body = mbs.AddObject(RigidBody2D(nodeNumber=node, mass=mass, inertia=0.5 * mass * radius**2))
    markers = [position_of(mbs, b) for b in (ground, body)]
    fixed = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=mbs.AddNode(NodePointGround()), coordinate=0))
    height = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=1))
    mbs.AddObject(CoordinateConstraint(name="floor", markerNumbers=[fixed, height]))
    mbs.AddLoad(Force(markerNumber=markers[1], loadVector=[0.0, -mass * G, 0.0]))
    options = {"normal": (0.0, 1.0, 0.0), "normal_force": "floor", "radius": radius, "effective_mass": mass / 3.0}
    contact = add_friction(mbs, *markers, even(mu), **options)
    mbs.Assemble()
    rolls = v_0 / (3.0 * mu * G)
    rows = contact.record(np.arange(0.0, rolls, 1e-3))
    solve_dynamic(mbs, silent_settings(dt, 0.1), solver="generalized_alpha")
    slides = rows[:, 0] < rolls - 2.0 * dt
    np.testing.assert_allclose(-rows[slides, 2], v_0 * (1.0 - rows[slides, 0] / rolls), atol=1e-8)  # from the first step on
    np.testing.assert_allclose(rows[1:, 7], mass * G, rtol=1e-9)
    np.testing.assert_allclose(coordinates(mbs, body)[0], [2.0 / 3.0 * v_0, 0.0, 0.0], atol=1e-5)


@pytest.mark.parametrize("normal", [(0.0, 0.0, 1.0), (1.0, 2.0, -3.0)])
def test_a_spinning_ball_moves_along_a_parabola_and_then_straight(normal) -> None:
    """Coriolis' ball: friction keeps the direction of the slip; in the end v = (5 v_0 + 2 r omega_0 x n)/7."""
    n = np.array(normal) / np.linalg.norm(normal)
    a = np.cross(n, [1.0, 1.0, 0.0])
    a /= np.linalg.norm(a)
    b = np.cross(n, a)
    v_0, omega_0, radius, mass, mu = 0.4 * a + 0.1 * b, 30.0 * a - 20.0 * b + 5.0 * n, 0.03, 1.0, 0.25
    mbs = exudyn.SystemContainer().AddSystem()
    ground, ball = (
        mbs.AddObject(ObjectGround()),
        free_body(
            mbs,
            mass,
            0.4 * mass * radius**2,
            initialVelocity=v_0,
            initialAngularVelocity=omega_0,
            gravity=-G * n,
            referencePosition=radius * n,
        ),
    )
    markers = [position_of(mbs, b) for b in (ground, ball)]
    stiffness = 1e6
    contact = add_friction(
        mbs,
        *markers,
        even(mu),
        normal=normal,
        contact_stiffness=stiffness,
        contact_damping=2.0 * math.sqrt(stiffness * mass),
        radius=radius,
        effective_mass=mass / 3.5,
    )
    mbs.Assemble()
    slip = v_0 - radius * np.cross(omega_0, n)
    rolls = 2.0 * np.linalg.norm(slip) / (7.0 * mu * G)
    rows = contact.record([0.5 * rolls])
    # the ball falls by m g/k = 1e-5 m at first: within 5 ms N is m g, and its integral differs by 1e-5 of v
    solve_dynamic(mbs, silent_settings(5e-5, math.ceil(rolls / 5e-5) * 5e-5 * 0.5))
    direction = slip / np.linalg.norm(slip)
    velocity, omega = coordinates(mbs, ball)
    t = math.ceil(rolls / 5e-5) * 5e-5 * 0.5
    np.testing.assert_allclose(velocity, v_0 - mu * G * t * direction, atol=2e-4)
    np.testing.assert_allclose(omega @ n, 5.0, rtol=1e-6)  # friction has no torque about the normal
    assert rows[0, 7] == pytest.approx(mass * G, rel=1e-3)
    solve_dynamic(mbs, silent_settings(5e-5, math.ceil(rolls / 5e-5) * 1e-4))
    velocity, omega = coordinates(mbs, ball)
    final = (5.0 * v_0 + 2.0 * radius * np.cross(omega_0, n)) / 7.0
    np.testing.assert_allclose(velocity, final, atol=5e-5)
    np.testing.assert_allclose(velocity - radius * np.cross(omega, n), 0.0, atol=5e-5)


@pytest.mark.parametrize("mu", [0.1, 0.3])
@pytest.mark.parametrize("solver", ["rk44", "generalized_alpha"])
def test_a_ball_rolls_or_slides_down_an_incline_on_ground(mu: float, solver: str) -> None:
    """Rolling, 5/7 g sin(theta), as long as mu_s > 2/7 tan(theta); otherwise g (sin(theta) - mu cos(theta))."""
    slope, mass, radius = 0.5, 2.0, 0.05
    tilt = RotationVector2RotationMatrix(np.array([0.0, 0.0, -slope]))  # x down the slope, y its normal
    mbs = exudyn.SystemContainer().AddSystem()
    place = exudyn.HT(rotation=tilt, translation=[0.3, 0.1, 0.0])
    incline = mbs.AddMarker(MarkerBodyRigid(bodyNumber=mbs.AddObject(ObjectGround()), localHT=place))
    down, n = tilt[:, 0], tilt[:, 1]
    stiffness = 1e6
    centre = np.array([0.3, 0.1, 0.0]) + (radius - mass * G * math.cos(slope) / stiffness) * n
    ball = free_body(mbs, mass, 0.4 * mass * radius**2, referencePosition=centre, gravity=[0.0, -G, 0.0])
    contact = add_friction(
        mbs,
        incline,
        position_of(mbs, ball),
        even(mu),
        normal=(0, 1, 0),
        radius=radius,
        contact_stiffness=stiffness,
        contact_damping=math.sqrt(stiffness * mass),
        effective_mass=mass / 3.5,
    )
    mbs.Assemble()
    solve_dynamic(mbs, silent_settings(2e-4, 0.3), solver=solver)
    rolls = mu > 2.0 / 7.0 * math.tan(slope)
    acceleration = 5.0 / 7.0 * G * math.sin(slope) if rolls else G * (math.sin(slope) - mu * math.cos(slope))
    velocity, omega = coordinates(mbs, ball)
    # the elastic stick takes up its load within its first swing, which is worth e_lim omega_n = 3 mm/s at most
    np.testing.assert_allclose(velocity, acceleration * 0.3 * down, atol=3e-3)
    if rolls:
        assert contact.stick
        assert omega[2] == pytest.approx(-(velocity @ down) / radius, rel=2e-3)
    assert contact.normal_force == pytest.approx(mass * G * math.cos(slope), rel=1e-4)
    np.testing.assert_allclose(contact.force, -mass * (G * math.sin(slope) - acceleration) * down, rtol=2e-2, atol=2e-2)


# --- a counter-surface that turns -------------------------------------------------------------------------------------


def heavy_plate(mbs, *, spin, axis=(0.0, 0.0, 1.0), angle: float = 0.0):
    """A plate that no friction can slow down, turning at a constant rate about an axis through the origin."""
    start = RotationVector2RotationMatrix(angle * np.array(axis))
    rate = {"initialAngularVelocity": spin * np.array(axis), "referenceRotationMatrix": start}
    return free_body(mbs, 1e9, 1e9, **rate)


@pytest.mark.parametrize("with_stiffness", [False, True])
@pytest.mark.parametrize("solver", ["rk44", "generalized_alpha"])
def test_the_angle_at_which_a_mass_breaks_away_from_a_tilting_plate(with_stiffness: bool, solver: str) -> None:
    """At rest on the plate: g sin(theta) - spin^2 x = mu_s (g cos(theta)), with x the distance up the plate."""
    mass, mu, spin, x, dt = 0.5, 0.4, 0.5, 0.2, 1e-4
    # sin(theta - phi) = spin^2 x cos(phi)/g with tan(phi) = mu_s
    breaks = math.atan(mu) + math.asin(spin**2 * x * math.cos(math.atan(mu)) / G)
    start = breaks - 0.2  # at once loaded with half of what it can hold
    mbs = exudyn.SystemContainer().AddSystem()
    plate = heavy_plate(mbs, spin=spin, angle=start)
    place = np.array([math.cos(start), math.sin(start), 0.0]) * x
    velocity = spin * np.array([-place[1], place[0], 0.0])
    node = mbs.AddNode(NodePoint(referenceCoordinates=list(place), initialVelocities=list(velocity)))
    body = mbs.AddObject(MassPoint(nodeNumber=node, mass=mass))
    markers = [position_of(mbs, b) for b in (plate, body)]
    mbs.AddLoad(Force(markerNumber=markers[1], loadVector=[0.0, -mass * G, 0.0]))
    options = {"normal": (0.0, 1.0, 0.0), "effective_mass": mass}
    law = make_law("elastic_stick", mu_s=mu, mu_k=0.9 * mu, decay_velocity=0.0)
    if with_stiffness:
        options |= {"contact_stiffness": 1e5, "contact_damping": 2.0 * math.sqrt(1e5 * mass)}
    else:

        def press(t: float) -> float:
            return mass * G * math.cos(start + spin * t)

        options |= {"normal_force": press}
        # the plate carries the mass along: its normal force, and twice the rate across, act on the mass
        mbs.AddLoad(
            Force(
                markerNumber=markers[1],
                loadVector=[0.0] * 3,
                loadVectorUserFunction=lambda mbs, t, f: [
                    -press(t) * math.sin(start + spin * t),
                    press(t) * math.cos(start + spin * t),
                    0.0,
                ],
            )
        )
    contact = add_friction(mbs, *markers, law, **options)
    mbs.Assemble()
    duration = 0.44
    rows = contact.record(np.arange(0.0, duration, 1e-3))
    solve_dynamic(mbs, silent_settings(dt, duration), solver=solver)
    slips = rows[:, 6] == 0.0
    slips[:50] = False  # the elastic stick takes up its load
    angle = start + spin * rows[slips, 0][0]
    assert angle == pytest.approx(breaks, abs=2e-3 * spin)  # a sample each ms
    stuck = rows[:, 0] < rows[slips, 0][0] - 1e-3
    assert np.all(rows[stuck, 6][50:] == 1.0)
    turned = start + spin * rows[stuck, 0]
    if with_stiffness:
        np.testing.assert_allclose(rows[stuck, 7][50:], mass * G * np.cos(turned[50:]), rtol=1e-3)
    np.testing.assert_allclose(
        np.hypot(rows[stuck, 3], rows[stuck, 10])[50:], mass * (G * np.sin(turned[50:]) - spin**2 * x), rtol=2e-2
    )
    assert np.max(np.abs(rows[stuck, 1] - rows[0, 1])) < 1.1e-5  # e_lim: it has stayed on the plate


@pytest.mark.parametrize("solver", ["rk44", "generalized_alpha"])
def test_a_turntable_carries_a_mass_round_and_round(solver: str) -> None:
    mass, mu, spin, x = 0.5, 0.5, 4.0, 0.2  # needs spin^2 x = 3.2 of mu g = 5 m/s^2
    mbs = exudyn.SystemContainer().AddSystem()
    table = heavy_plate(mbs, spin=spin)
    node = mbs.AddNode(NodePoint(referenceCoordinates=[x, 0, 0], initialVelocities=[0, spin * x, 0]))
    body = mbs.AddObject(MassPoint(nodeNumber=node, mass=mass))
    markers = [position_of(mbs, b) for b in (table, body)]
    contact = add_friction(mbs, *markers, even(mu), normal=(0, 0, 1), normal_force=mass * G, effective_mass=mass)
    mbs.Assemble()
    turns = 2.5
    solve_dynamic(mbs, silent_settings(5e-4, round(turns * 2 * math.pi / spin, 3)), solver=solver)
    t = round(turns * 2 * math.pi / spin, 3)
    place = x * np.array([math.cos(spin * t), math.sin(spin * t), 0.0])
    # it hangs back by 3.2/5 of e_lim; GeneralizedAlpha turns by (spin dt)^2/12 of the angle less: 1e-6 m here
    np.testing.assert_allclose(np.array([x, 0, 0]) + mbs.systemData.GetODE2Coordinates()[-3:], place, atol=1.2e-5)
    assert contact.stick
    np.testing.assert_allclose(contact.force, -mass * spin**2 * place, rtol=2e-3, atol=5e-3)


def test_a_turntable_too_fast_loses_the_mass() -> None:
    mass, mu, spin, x = 0.5, 0.5, 6.0, 0.2  # needs 7.2 m/s^2
    mbs = exudyn.SystemContainer().AddSystem()
    table = heavy_plate(mbs, spin=spin)
    node = mbs.AddNode(NodePoint(referenceCoordinates=[x, 0, 0], initialVelocities=[0, spin * x, 0]))
    markers = [position_of(mbs, b) for b in (table, mbs.AddObject(MassPoint(nodeNumber=node, mass=mass)))]
    contact = add_friction(mbs, *markers, even(mu), normal=(0, 0, 1), normal_force=mass * G, effective_mass=mass)
    mbs.Assemble()
    solve_dynamic(mbs, silent_settings(1e-4, 0.3))
    place = np.array([x, 0, 0]) + mbs.systemData.GetODE2Coordinates()[-3:]
    assert np.linalg.norm(place) > 0.25
    assert np.linalg.norm(contact.force) == pytest.approx(mu * mass * G, rel=1e-6)


@pytest.mark.parametrize("turns_with", ["space", "marker1"])
@pytest.mark.parametrize("solver", ["rk44", "generalized_alpha"])
def test_a_brake_pad_stops_a_drum(turns_with: str, solver: str) -> None:
    """The drum passes by below the pad: sliding speed omega R, torque mu_k N R, stopped after omega_0 I/(mu_k N R)."""
    inertia, radius, press, mu, omega = 0.4, 0.15, 50.0, 0.35, 12.0
    mbs = exudyn.SystemContainer().AddSystem()
    drum = free_body(mbs, 3.0, inertia, initialAngularVelocity=[0.0, 0.0, omega], referencePosition=[0.1, 0.2, 0.0])
    ground = mbs.AddObject(ObjectGround())
    pad = mbs.AddMarker(MarkerBodyRigid(bodyNumber=ground, localPosition=[0.1, 0.2 + radius, 0.0]))
    centre = position_of(mbs, drum)
    mbs.CreateCartesianSpringDamper(  # bearing
        itemNumbers=[ground, drum],
        localPosition0=[0.1, 0.2, 0.0],
        stiffness=[1e6] * 3,
        damping=[2e3] * 3,
    )
    options = {"normal": (0, 1, 0), "normal_turns_with": turns_with, "normal_force": press}
    contact = add_friction(mbs, centre, pad, even(mu), **options)
    mbs.Assemble()
    stops = omega * inertia / (mu * press * radius)
    rows = contact.record([0.25 * stops, 0.5 * stops])
    solve_dynamic(mbs, silent_settings(stops / 2000, 0.5 * stops), solver=solver)
    _, turning = coordinates(mbs, drum)
    # the bearing gives way by mu N/k = 2e-5 m, of a radius of 0.15 m
    assert turning[2] == pytest.approx(0.5 * omega, rel=1e-3)
    assert abs(rows[0, 2]) == pytest.approx(0.75 * omega * radius, rel=1e-3)
    np.testing.assert_allclose(contact.force, [-mu * press, 0.0, 0.0], rtol=1e-6, atol=1e-6)
    solve_dynamic(mbs, silent_settings(stops / 2000, 1.2 * stops), solver=solver)
    assert abs(coordinates(mbs, drum)[1][2]) < 1e-3
    assert contact.stick


@pytest.mark.parametrize("turns_with", ["marker0", "marker1", "space"])
@pytest.mark.parametrize("solver", ["rk44", "generalized_alpha"])
def test_two_free_bodies_keep_momentum_and_angular_momentum(turns_with: str, solver: str) -> None:
    mbs = exudyn.SystemContainer().AddSystem()
    masses, inertias = (1.0, 2.0), (0.02, 0.01)
    places, velocities = ([0.0, 0.0, 0.0], [0.3, 0.1, 0.2]), ([0.5, 0.1, 0.0], [-0.2, 0.0, 0.3])
    spins = ([1.0, -2.0, 0.5], [0.0, 3.0, 1.0])
    bodies = [
        free_body(mbs, m, i, referencePosition=p, initialVelocity=v, initialAngularVelocity=w)
        for m, i, p, v, w in zip(masses, inertias, places, velocities, spins, strict=True)
    ]
    markers = [position_of(mbs, b) for b in bodies]
    options = {"normal": (0, 1, 0), "radius": 0.1, "touch": 0.12, "contact_stiffness": 1e3, "effective_mass": 0.3}
    contact = add_friction(mbs, *markers, even(0.4), normal_turns_with=turns_with, **options)
    mbs.Assemble()

    def momenta(initial: bool):
        linear, angular = np.zeros(3), np.zeros(3)
        for body, m, i, *start in zip(bodies, masses, inertias, places, velocities, spins, strict=True):
            place = mbs.GetObjectOutputBody(body, exudyn.OutputVariableType.Position)
            p, v, w = map(np.array, start if initial else (place, *coordinates(mbs, body)))
            linear += m * v
            angular += m * np.cross(p, v) + i * w
        return np.concatenate([linear, angular])

    before = momenta(True)
    rows = contact.record(np.linspace(0.0, 0.05, 51))
    solve_dynamic(mbs, silent_settings(1e-4, 0.05), solver=solver)
    assert rows[:, 7].max() > 1.0  # they press on each other
    # RK44 is exact to 1e-12 here; GeneralizedAlpha keeps angular momentum to its second order
    np.testing.assert_allclose(momenta(False), before, atol=1e-10 if solver == "rk44" else 1e-5)


def test_exudyns_own_solve_gives_the_same_and_repeats() -> None:
    ends = []
    for own in (True, True, False):
        if not ends or not own:
            mbs = exudyn.SystemContainer().AddSystem()
            places, velocities = ([0.0, 0.0, 0.0], [0.3, 0.099, 0.0]), ([0.0, 0.0, 0.0], [0.6, 0.0, 0.2])
            bodies = [
                free_body(mbs, m, 0.02, referencePosition=p, initialVelocity=v)
                for m, p, v in zip((5.0, 1.0), places, velocities, strict=True)
            ]
            markers = [position_of(mbs, b) for b in bodies]
            options = {"normal": (0, 1, 0), "radius": 0.1, "contact_stiffness": 1e4, "effective_mass": 0.3}
            contact = add_friction(mbs, *markers, even(0.4), **options)
            mbs.Assemble()
        settings = silent_settings(1e-3, 0.05)
        if own:
            settings.timeIntegration.computeLoadsJacobian = 2
            kind = exudyn.DynamicSolverType.GeneralizedAlpha
            assert mbs.SolveDynamic(settings, solverType=kind, showHints=False)
        else:
            solve_dynamic(mbs, settings, solver="generalized_alpha", locate=False)
        ends.append(mbs.systemData.GetODE2Coordinates())
    assert contact.state.size
    assert np.array_equal(ends[0], ends[1])
    np.testing.assert_allclose(ends[0], ends[2], atol=1e-8)  # tolerances of Newton's method


def test_a_rigid_body_at_rest_on_ground_keeps_the_fast_route() -> None:
    mbs = exudyn.SystemContainer().AddSystem()
    ground, body = mbs.AddObject(ObjectGround()), free_body(mbs, 1.0, 0.1)
    fixed, moving = (position_of(mbs, b) for b in (ground, body))
    plane = {"normal": (0, 1, 0), "normal_force": 1.0, "effective_mass": 1.0}
    kinds = []
    for markers, options in (((fixed, moving), {}), ((moving, fixed), {}), ((fixed, moving), {"radius": 0.1})):
        contact = add_friction(mbs, *markers, even(0.5), **plane, **options)
        kinds.append(mbs.GetObject(contact.object)["objectType"])
    assert kinds == ["ConnectorCartesianSpringDamper", *["ConnectorRigidBodySpringDamper"] * 2]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"radius": 0.1}, "radius = 0.1 m: marker 1 is on something without orientation"),
        ({"radius": -0.1}, "radius"),
        ({"normal_turns_with": "marker1"}, "normal_turns_with = 'marker1': marker 1 has no orientation"),
        ({"normal_turns_with": "plate"}, "normal_turns_with.*marker0"),
    ],
)
def test_what_cannot_turn_is_named(options: dict, message: str) -> None:
    mbs = exudyn.SystemContainer().AddSystem()
    node = mbs.AddNode(NodePoint())
    bodies = [mbs.AddObject(ObjectGround()), mbs.AddObject(MassPoint(nodeNumber=node, mass=1.0))]
    markers = [position_of(mbs, b) for b in bodies]
    with pytest.raises(InputError, match=message):
        add_friction(mbs, *markers, even(0.5), normal=(0, 1, 0), normal_force=1.0, effective_mass=1.0, **options)
