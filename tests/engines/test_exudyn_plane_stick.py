"""Laws with true stick in a plane: each step is repeated until the friction that holds is found."""

# ruff: noqa: E402  (the adapter can be imported only where exudyn is)

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

exudyn = pytest.importorskip("exudyn", reason="exudyn is not installed")

from exudyn.itemInterface import CartesianSpringDamper, Force, MarkerBodyPosition, MarkerBodyRigid, ObjectGround
from exudyn.utilities import RigidBodyInertia

from stochfric_mb import reference
from stochfric_mb.coefficients import Knots
from stochfric_mb.errors import InputError
from stochfric_mb.exudyn import add_friction, add_friction_load, silent_settings, solve_dynamic
from stochfric_mb.friction import Friction
from stochfric_mb.laws import make_law
from stochfric_mb.scenario import load_scenario

COULOMB = make_law("coulomb", mu_s=0.4, mu_k=0.3)
UP, OBLIQUE = (0.0, 0.0, 1.0), np.array([0.6, 0.8, 0.0])


def solve(mbs: Any, dt: float, duration: float) -> None:
    solve_dynamic(mbs, silent_settings(dt, duration), solver="generalized_alpha")


def point(velocity: Any = (0.0, 0.0, 0.0), load: Any = None, law: Any = COULOMB, **options: Any) -> tuple[Any, Any]:
    """A mass point of 1 kg on the plane z = 0, pressed with 10 N if nothing else is said."""
    mbs: Any = exudyn.SystemContainer().AddSystem()
    ground = mbs.AddMarker(MarkerBodyPosition(bodyNumber=mbs.AddObject(ObjectGround())))
    gravity = options.pop("gravity", [0.0, 0.0, 0.0])
    body = mbs.CreateMassPoint(mass=1.0, initialVelocity=list(velocity), gravity=gravity)
    marker = mbs.AddMarker(MarkerBodyPosition(bodyNumber=body))
    if load is not None:

        def function(mbs: Any, t: float, loadVector: Any) -> Any:
            return list(load(t))

        mbs.AddLoad(Force(markerNumber=marker, loadVector=[0.0] * 3, loadVectorUserFunction=function))
    contact = add_friction(mbs, ground, marker, law, **{"normal": UP, "normal_force": 10.0, **options})
    mbs.Assemble()
    return mbs, contact


def coordinates(mbs: Any) -> Any:
    return np.array(mbs.systemData.GetODE2Coordinates())


def test_a_thrown_point_stops_and_stays() -> None:
    mbs, contact = point(velocity=OBLIQUE)
    solve(mbs, 1e-3, 0.5)
    assert coordinates(mbs)[:2] == pytest.approx(OBLIQUE[:2] / 6.0, abs=1e-9)  # v^2/(2 mu_k g)
    assert np.max(np.abs(mbs.systemData.GetODE2Coordinates_t())) == 0.0
    assert contact.stick
    assert np.linalg.norm(contact.force) < 1e-9


@pytest.mark.parametrize(("load", "holds"), [(3.99, True), (4.01, False)])
def test_the_threshold_is_mu_s_in_any_direction(load: float, holds: bool) -> None:
    mbs, contact = point(load=lambda t: load * OBLIQUE)
    solve(mbs, 1e-3, 1.0)
    assert contact.stick is holds
    if holds:
        assert np.max(np.abs(coordinates(mbs))) == 0.0  # no creep
        assert contact.force == pytest.approx(-load * OBLIQUE, rel=1e-9)
    else:
        assert np.linalg.norm(coordinates(mbs)) == pytest.approx(0.5 * (load - 3.0), abs=2e-3)  # lets go in the first step


def test_a_load_that_grows_breaks_it_away_in_time() -> None:
    mbs, contact = point(load=lambda t: 2.0 * t * OBLIQUE)
    rows = contact.record(1e-3 * np.arange(1, 3001))
    solve(mbs, 1e-3, 3.0)
    # from 2 s on a = 2 t - 3: 1/2 + 1/3 m after 1 s; located to 1e-3 of a step, here 2e-7 s of 1 m/s^2 over 1 s
    assert np.linalg.norm(coordinates(mbs)) == pytest.approx(0.5 + 1.0 / 3.0, abs=1e-6)
    assert np.max(np.hypot(rows[:, 3], rows[:, 10]) / (rows[:, 4] * rows[:, 7])) <= 1.0 + 1e-9


def test_a_load_that_turns_below_the_limit_moves_nothing() -> None:
    mbs, _ = point(load=lambda t: (3.9 * math.cos(20.0 * t), 3.9 * math.sin(20.0 * t), 0.0))
    solve(mbs, 1e-3, 1.0)
    assert np.max(np.abs(coordinates(mbs))) < 1e-15


@pytest.mark.parametrize(("angle", "holds"), [(21.7, True), (21.9, False)])
def test_a_point_on_an_incline_lets_go_at_atan_mu_s(angle: float, holds: bool) -> None:
    """On a unilateral contact, already pressed; atan 0.4 = 21.80 degrees."""
    a = math.radians(angle)
    normal = np.array([0.6 * math.sin(a), 0.8 * math.sin(a), math.cos(a)])
    options: dict[str, Any] = {
        "contact_stiffness": 1e5,
        "contact_damping": 100.0,
        "normal_force": None,
        "normal": tuple(normal),
    }
    mbs, contact = point(gravity=[0.0, 0.0, -9.81], touch=9.81 * math.cos(a) / 1e5, **options)
    solve(mbs, 1e-3, 0.5)
    along = coordinates(mbs) - normal * (normal @ coordinates(mbs))
    exact = 0.0 if holds else 0.125 * 9.81 * (math.sin(a) - 0.3 * math.cos(a))
    assert contact.stick is holds
    assert np.linalg.norm(along) == pytest.approx(exact, abs=1e-9)


@pytest.mark.parametrize(
    ("kind", "name", "process"),
    [  # measured 0.2, 0.1, 0.2 and 0.7 um, as along a line
        ("coulomb", "kang2015_table1", Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01)),
        ("coulomb", "kang2015_table2_13_8", None),
        ("karnopp", "kang2015_table1", None),
        ("stribeck", "kang2015_table1", Knots(sigma_s=0.015, sigma_k=0.023, spacing=0.01)),
    ],
)
def test_the_belt_box_across_the_axes_follows_the_reference(kind: str, name: str, process: Any) -> None:
    s = dataclasses.replace(load_scenario(name, law=kind), duration=3.0, process=process)
    m = s.mechanism
    mbs: Any = exudyn.SystemContainer().AddSystem()
    ground = mbs.AddMarker(MarkerBodyPosition(bodyNumber=mbs.AddObject(ObjectGround())))
    box = mbs.AddMarker(MarkerBodyPosition(bodyNumber=mbs.CreateMassPoint(mass=m.mass)))
    mbs.AddObject(CartesianSpringDamper(markerNumbers=[ground, box], stiffness=[m.stiffness] * 3, damping=[m.damping] * 3))

    def push(mbs: Any, t: float, loadVector: Any) -> Any:
        size = m.stiffness * m.excitation_amplitude * math.cos(m.excitation_angular_frequency * t)
        return list(size * OBLIQUE)

    mbs.AddLoad(Force(markerNumber=box, loadVector=[0.0] * 3, loadVectorUserFunction=push))
    options: dict[str, Any] = {"normal": UP, "normal_force": m.normal_force, "seed": 1}
    contact = add_friction(
        mbs, ground, box, Friction(s.law, process), surface_velocity=tuple(m.belt_velocity * OBLIQUE), **options
    )
    mbs.Assemble()
    rows = contact.record(s.output_times())
    solve(mbs, 1e-3, s.duration)
    exact = reference.simulate(s, seed=1)
    assert np.max(np.abs(m.belt_velocity * rows[:, 0] - rows[:, 1] - exact.position)) <= 2e-6
    assert np.mean(rows[:, 6]) == pytest.approx(np.mean(exact.stick), abs=1e-3)
    assert np.all(np.hypot(rows[:, 3], rows[:, 10]) <= rows[:, 4] * rows[:, 7] * (1.0 + 1e-9))
    assert np.ptp(rows[rows[:, 6] == 1.0, 2]) <= 1e-8  # stuck is at rest on the belt (the step that lets go has begun to move)


def test_two_contacts_that_hold_one_body_are_refused() -> None:
    mbs: Any = exudyn.SystemContainer().AddSystem()
    ground = mbs.AddObject(ObjectGround())
    body = mbs.CreateRigidBody(inertia=RigidBodyInertia(2, np.diag([0.02, 0.02, 0.03])))
    for x in (-0.1, 0.1):
        places = [mbs.AddMarker(MarkerBodyRigid(bodyNumber=b, localPosition=[x, 0.0, 0.0])) for b in (ground, body)]
        add_friction(mbs, places[0], places[1], COULOMB, normal=UP, normal_force=10.0)
    mbs.Assemble()
    with pytest.raises(InputError, match=r"hold the same bodies.*elastic_substitute"):
        solve(mbs, 1e-3, 0.1)


def test_what_is_not_held_in_a_plane_is_named() -> None:
    mbs, _ = point()
    with pytest.raises(InputError, match="solver='generalized_alpha'"):
        solve_dynamic(mbs, silent_settings(1e-3, 0.1), solver="rk44")
    with pytest.raises(InputError, match="a static solution has none"):
        mbs.SolveStatic(exudyn.SimulationSettings(), showHints=False)
    ground, body = (mbs.AddMarker(MarkerBodyPosition(bodyNumber=i)) for i in (0, 1))
    with pytest.raises(InputError, match="or the body turns"):
        add_friction_load(mbs, body, COULOMB, normal=UP, normal_force=1.0)
    with pytest.raises(InputError, match="cannot be the reaction of another"):
        add_friction(mbs, ground, body, COULOMB, normal=UP, normal_force=_constraint(mbs, body))


def _constraint(mbs: Any, body: Any) -> Any:
    from exudyn.itemInterface import SphericalJoint

    other = mbs.AddMarker(MarkerBodyPosition(bodyNumber=mbs.CreateMassPoint(mass=1.0)))
    return mbs.AddObject(SphericalJoint(markerNumbers=[other, body]))
