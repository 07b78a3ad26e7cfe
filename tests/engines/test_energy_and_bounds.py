"""Twenty-five systems of both engines: friction stays within mu_s N, and systems that nothing drives never gain energy."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from stochfric_mb import Friction, Knots
from stochfric_mb.laws import make_law

MU_S, MU_K, G = 0.4, 0.3, 9.81
LAW = make_law("elastic_stick", mu_s=MU_S, mu_k=MU_K)
COULOMB = make_law("coulomb", mu_s=MU_S, mu_k=MU_K)
LUGRE = make_law("lugre", mu_s=MU_S, mu_k=MU_K, sigma_1=0.0)  # sigma_1 dz/dt comes on top of mu_s N: that is the law
RANDOM = Friction(LAW, Knots(sigma_s=0.02, sigma_k=0.02, spacing=0.01))
ROUNDING = 1.0e-9


@dataclasses.dataclass
class Outcome:
    """What a system did."""

    force: Any
    """Friction force over mu_s N of each contact and sample [-]."""
    energy: Any
    """Mechanical energy [J] at each sample; None: the system is driven."""
    start: float
    """Kinetic energy at the start [J]."""
    slack: float
    """Energy that the contacts may give back [J], mu_s N e_lim/2 of a loaded elastic stick, and the engine's own error."""


def check(run: Outcome) -> None:
    assert run.force.size
    assert np.all(np.isfinite(run.force))
    assert np.max(run.force) > 0.1  # friction acts
    assert np.max(run.force) <= 1.0 + ROUNDING
    if run.energy is not None:
        gained = run.energy - np.minimum.accumulate(run.energy)
        assert np.max(gained) <= run.slack
        assert run.energy[-1] < run.energy[0] - 0.01 * run.start  # and dissipates


# --- Exudyn ------------------------------------------------------------------------------------------------------------


def exudyn_run(
    mbs: Any,
    contacts: list[Any],
    energy: Callable[[], float] | None,
    *,
    solver: str = "rk44",
    duration: float = 0.4,
    dt: float = 1.0e-3,
    error: float = 1.0e-6,
) -> Outcome:
    """Run a system; ``error``: the solver's own gain of energy over that at the start."""
    from stochfric_mb.exudyn import silent_settings, solve_dynamic

    mbs.Assemble()
    times = dt * np.arange(1, round(duration / dt) + 1)
    rows = [contact.record(times) for contact in contacts]
    seen: list[float] = []
    start = energy() if energy is not None else 1.0
    if energy is not None:
        mbs.SetPostStepUserFunction(lambda mbs, t: seen.append(energy()) or True)
    solve_dynamic(mbs, silent_settings(dt, duration), solver=solver)
    table = np.array(rows)
    normal = table[:, :, 7]
    force = np.hypot(table[:, :, 3], table[:, :, 10])[normal > 0.0] / (table[:, :, 4] * normal)[normal > 0.0]
    stored = sum(0.5 * MU_S * float(np.max(n)) * 1.0e-5 for n in normal)
    return Outcome(force, np.array(seen) if seen else None, abs(start), stored + error * abs(start))


def line(law: Any, *, spring: float = 0.0, solver: str = "rk44", surface: float = 0.0, load: bool = False) -> Outcome:
    from exudyn.itemInterface import CoordinateSpringDamper

    from stochfric_mb.exudyn import add_friction, add_friction_load
    from tests.engines.exudyn_systems import block

    mbs, _, ground, slide = block(0.5, 2.0)
    if spring:
        mbs.AddObject(CoordinateSpringDamper(markerNumbers=[ground, slide], stiffness=spring))
    options: dict[str, Any] = {"normal_force": 20.0, "seed": 1, "surface_velocity": surface}
    contact = add_friction_load(mbs, slide, law, **options) if load else add_friction(mbs, ground, slide, law, **options)

    def energy() -> float:
        x, v = mbs.systemData.GetODE2Coordinates()[0], mbs.systemData.GetODE2Coordinates_t()[0]
        return float(v**2 + 0.5 * spring * x**2)

    return exudyn_run(mbs, [contact], None if surface else energy, solver=solver)


def clutch(law: Any) -> Outcome:
    """Two flywheels that a clutch brings to one speed."""
    from exudyn.itemInterface import MarkerNodeCoordinate, Mass1D, Node1D

    from stochfric_mb.exudyn import add_friction
    from tests.engines.exudyn_systems import block

    mbs, _, _, first = block(3.0, 2.0)
    node = mbs.AddNode(Node1D(referenceCoordinates=[0.0]))
    mbs.AddObject(Mass1D(nodeNumber=node, mass=1.0))
    second = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    contact = add_friction(mbs, first, second, law, normal_force=20.0, seed=2)

    def energy() -> float:
        v = mbs.systemData.GetODE2Coordinates_t()
        return float(v[0] ** 2 + 0.5 * v[1] ** 2)

    solver = "generalized_alpha" if law is COULOMB else "rk44"
    return exudyn_run(mbs, [contact], energy, solver=solver)


def linkage() -> Outcome:
    from tests.engines.exudyn_systems import four_bar

    system = four_bar(LAW, speed=4.0, radius=0.05)
    return exudyn_run(system.mbs, system.contacts, system.energy, solver="generalized_alpha", error=1e-4)  # the rule's own


def thrown_point(*, plane: bool) -> Outcome:
    """A point mass on a floor in space, pressed by a number, or falling on a unilateral contact."""
    import exudyn
    from exudyn.itemInterface import Force, MarkerBodyPosition, MassPoint, NodePoint, ObjectGround

    from stochfric_mb.exudyn import add_friction

    mbs = exudyn.SystemContainer().AddSystem()
    node = mbs.AddNode(NodePoint(referenceCoordinates=[0.0, 0.0, 0.0], initialVelocities=[0.6, 0.3, 0.0]))
    body = mbs.AddObject(MassPoint(nodeNumber=node, mass=2.0))
    marker = mbs.AddMarker(MarkerBodyPosition(bodyNumber=body))
    ground = mbs.AddMarker(MarkerBodyPosition(bodyNumber=mbs.AddObject(ObjectGround())))
    options: dict[str, Any] = {"normal_force": 20.0} if plane else {"contact_stiffness": 1e5, "contact_damping": 400.0}
    if not plane:
        mbs.AddLoad(Force(markerNumber=marker, loadVector=[0.0, 0.0, -2.0 * G]))
    contact = add_friction(mbs, ground, marker, LAW, normal=(0.0, 0.0, 1.0), **options)

    def energy() -> float:
        x, v = mbs.systemData.GetODE2Coordinates(), mbs.systemData.GetODE2Coordinates_t()
        pressed = 0.0 if plane else 2.0 * G * x[2] + 0.5e5 * min(x[2], 0.0) ** 2
        return float(v @ v + pressed)

    return exudyn_run(mbs, [contact], energy, dt=2.5e-4, error=1e-5)


def ball() -> Outcome:
    """A ball thrown on a floor slides, then rolls."""
    import exudyn
    from exudyn.itemInterface import MarkerBodyRigid, ObjectGround
    from exudyn.utilities import InertiaSphere

    from stochfric_mb.exudyn import add_friction

    mbs = exudyn.SystemContainer().AddSystem()
    inertia = InertiaSphere(1.0, 0.1)
    body = mbs.CreateRigidBody(
        inertia=inertia, initialVelocity=[1.0, 0.0, 0.0], nodeType=exudyn.NodeType.RotationRotationVector
    )
    marker = mbs.AddMarker(MarkerBodyRigid(bodyNumber=body))
    ground = mbs.AddMarker(MarkerBodyRigid(bodyNumber=mbs.AddObject(ObjectGround()), localPosition=[0.0, -0.1, 0.0]))
    contact = add_friction(mbs, ground, marker, LAW, normal=(0.0, 1.0, 0.0), normal_force=10.0, radius=0.1)

    def energy() -> float:
        get, out = mbs.GetObjectOutputBody, exudyn.OutputVariableType
        v, w = (np.asarray(get(body, what, [0.0] * 3)) for what in (out.Velocity, out.AngularVelocity))
        return float(0.5 * v @ v + 0.5 * inertia.GetInertia6D()[0] * (w @ w))

    return exudyn_run(mbs, [contact], energy, dt=2.5e-4)


EXUDYN: dict[str, Callable[[], Outcome]] = {
    "block": lambda: line(LAW),
    "block, implicit": lambda: line(LAW, solver="generalized_alpha"),
    "block, random": lambda: line(RANDOM),
    "block, LuGre": lambda: line(LUGRE, solver="generalized_alpha"),
    "oscillator": lambda: line(LAW, spring=400.0),
    "oscillator, true stick": lambda: line(COULOMB, spring=400.0, solver="generalized_alpha"),
    "oscillator, load": lambda: line(LAW, spring=400.0, load=True),
    "belt": lambda: line(RANDOM, spring=400.0, surface=0.1),
    "clutch": lambda: clutch(LAW),
    "clutch, true stick": lambda: clutch(COULOMB),
    "four-bar": linkage,
    "point on a plane": lambda: thrown_point(plane=True),
    "point on a floor": lambda: thrown_point(plane=False),
    "ball": ball,
}


@pytest.mark.parametrize("name", EXUDYN)
def test_exudyn(name: str) -> None:
    pytest.importorskip("exudyn", reason="exudyn is not installed")
    check(EXUDYN[name]())


# --- pymunk ------------------------------------------------------------------------------------------------------------


def pymunk_run(space: Any, handle: Any, *, driven: bool = False, duration: float = 0.6, dt: float = 1.0e-3) -> Outcome:
    """Run a space; friction of one step belongs to the normal force that came out of it."""

    bodies = [b for b in space.bodies if b.body_type == b.DYNAMIC]

    def kinetic() -> float:
        turning = sum(0.5 * b.moment * b.angular_velocity**2 for b in bodies if math.isfinite(b.moment))
        return turning + sum(0.5 * b.mass * b.velocity.dot(b.velocity) for b in bodies)

    def energy() -> float:
        return kinetic() - sum(b.mass * space.gravity.dot(b.position) for b in bodies)

    start, weight = kinetic(), sum(b.mass for b in bodies) * max(space.gravity.length, 1.0)
    forces: list[float] = []
    energies: list[float] = [energy()]
    for _ in range(round(duration / dt)):
        space.step(dt)
        energies.append(energy())
        # a force that is written into the bodies belongs to the load that was expected: compared where that came out
        steady = [x for x in handle.readings() if x.normal_force > 0.05 * weight]
        forces += [abs(x.force) / (x.mu_s * x.normal_force) for x in steady]
    # pymunk drifts before it kicks: a g dt of speed is worth v g dt of height a step; overlap is pushed out at up to 0.1 mm
    slack = 0.5 * MU_S * weight * 1.0e-5 + weight * (1.0e-4 + 2.0 * math.sqrt(2.0 * max(start, 1e-6) / (weight / G)) * dt)
    return Outcome(np.array(forces), None if driven else np.array(energies), max(start, 1e-12), slack)


def space_with_floor(angle: float = 0.0) -> tuple[Any, Any]:
    import pymunk

    space = pymunk.Space()
    space.gravity = (G * math.sin(angle), -G * math.cos(angle))
    space.collision_slop = 1.0e-5
    space.iterations = 30
    floor = pymunk.Segment(space.static_body, (-9.0, 0.0), (9.0, 0.0), 0.0)
    space.add(floor)
    return space, floor


def boxes(
    law: Any, n: int, *, speed: float = 0.8, turns: bool = False, angle: float = 0.0, belt: float = 0.0, **options: Any
) -> Outcome:
    import pymunk

    from stochfric_mb.pymunk import add_friction

    space, floor = space_with_floor(angle)
    floor.surface_velocity = (belt, 0.0)
    for i in range(n):
        body = pymunk.Body(1.0 + i, pymunk.moment_for_box(1.0 + i, (0.2, 0.1)) if turns else math.inf)
        body.position, body.velocity = (0.3 * i, 0.05), (speed, 0.0)
        space.add(body, pymunk.Poly.create_box(body, (0.2, 0.1)))
    return pymunk_run(space, add_friction(space, "*", floor, law, seed=3, **options), driven=bool(belt) or angle > 0.0)


def discs(law: Any, *, height: float = 0.0, elasticity: float = 0.0) -> Outcome:
    import pymunk

    from stochfric_mb.pymunk import add_friction

    space, floor = space_with_floor()
    body = pymunk.Body(1.0, pymunk.moment_for_circle(1.0, 0.0, 0.1))
    body.position, body.velocity = (0.0, 0.1 + height), (1.0, 0.0)
    disc = pymunk.Circle(body, 0.1)
    disc.elasticity = floor.elasticity = elasticity
    space.add(body, disc)
    return pymunk_run(space, add_friction(space, disc, floor, law), duration=1.0)


def stack(law: Any, **options: Any) -> Outcome:
    import pymunk

    from stochfric_mb.pymunk import add_friction

    space, _ = space_with_floor(math.radians(10.0))
    for i in range(3):
        body = pymunk.Body(2.0, pymunk.moment_for_box(2.0, (0.4, 0.1)))
        body.position = (0.0, 0.05 + 0.1 * i)
        space.add(body, pymunk.Poly.create_box(body, (0.4, 0.1)))
    return pymunk_run(space, add_friction(space, "*", "*", law, **options), driven=True)


PYMUNK: dict[str, Callable[[], Outcome]] = {
    "box": lambda: boxes(LAW, 1),
    "box, random": lambda: boxes(RANDOM, 1),
    "box, LuGre": lambda: boxes(LUGRE, 1),
    "box, coulomb": lambda: boxes(COULOMB, 1),
    "box that may turn": lambda: boxes(LAW, 1, turns=True),
    "five boxes": lambda: boxes(LAW, 5),
    "conveyor": lambda: boxes(RANDOM, 5, belt=0.5, speed=0.0),
    "incline": lambda: boxes(LAW, 2, angle=0.3, speed=0.0),
    "disc": lambda: discs(LAW),
    "bouncing disc": lambda: discs(LAW, height=0.05, elasticity=0.5),
    "stack, coulomb": lambda: stack(COULOMB),
}


@pytest.mark.parametrize("name", PYMUNK)
def test_pymunk(name: str) -> None:
    pytest.importorskip("pymunk", reason="pymunk is not installed")
    check(PYMUNK[name]())


def test_there_are_twenty_five() -> None:
    assert len(EXUDYN) + len(PYMUNK) == 25
