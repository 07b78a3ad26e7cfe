"""Bristles of contacts that are born in motion: a body thrown on a floor stops where mu_k says, from the first step on."""

from __future__ import annotations

import math
from typing import Any

import pytest

from stochfric_mb.contact import Contact
from stochfric_mb.laws import make_law

SPEED, GRAVITY, MU_S, MU_K = 1.0, 10.0, 0.4, 0.3
STOP = SPEED**2 / (2.0 * MU_K * GRAVITY)
"""Where a body of 1 m/s comes to rest [m]: 1/6."""
RISE = 1.0e-5
"""What the rise from mu_k to mu_s in the last mm/s, and the bristle, take off that way, at most [m]:
(mu_s - mu_k)/mu_k (1 mm/s)^2/(2 mu_k g) + mu_s/sigma_0 = 5.1 um."""


def law(kind: str) -> Any:
    return make_law(kind, mu_s=MU_S, mu_k=MU_K)


@pytest.mark.parametrize("kind", ["lugre", "dahl"])
@pytest.mark.parametrize("speed", [2.0e-3, 0.1, 1.0, 30.0])
def test_the_force_at_birth_is_that_of_steady_sliding(kind: str, speed: float) -> None:
    contact = Contact(law(kind), effective_mass=1.0)
    contact.start(0.0, 0.3, -speed, 10.0)
    g = MU_K + (MU_S - MU_K) * math.exp(-((speed / 1.0e-3) ** 2)) if kind == "lugre" else MU_K
    assert contact.force(0.0, 0.3, -speed, 10.0) == pytest.approx(
        -g * 10.0, abs=1e-14 + 4e-16 * 100.0 * speed * 10.0
    )  # rounding, of sigma_1 v too


@pytest.mark.parametrize("kind", ["lugre", "dahl"])
def test_at_rest_a_bristle_is_not_deflected(kind: str) -> None:
    contact = Contact(law(kind), effective_mass=1.0)
    contact.start(0.0, 0.3, 1.0e-9, 10.0)
    assert abs(contact.force(0.0, 0.3, 1.0e-9, 10.0)) <= 1.1e-9 * 100.0 * 10.0  # sigma_1 v N


@pytest.mark.parametrize("kind", ["lugre", "dahl"])
@pytest.mark.parametrize("dt", [1.0e-3, 1.0e-4])
@pytest.mark.parametrize("solver", ["rk44", "dopri5", "generalized_alpha"])
def test_exudyn(solver: str, dt: float, kind: str) -> None:
    pytest.importorskip("exudyn")
    import exudyn
    from exudyn.itemInterface import MarkerNodeCoordinate, Mass1D, Node1D, NodePointGround

    from stochfric_mb.exudyn import add_friction, silent_settings, solve_dynamic

    mbs: Any = exudyn.SystemContainer().AddSystem()
    node = mbs.AddNode(Node1D(referenceCoordinates=[0.0], initialCoordinates=[0.0], initialVelocities=[SPEED]))
    mbs.AddObject(Mass1D(nodeNumber=node, mass=1.0))
    ground = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=mbs.AddNode(NodePointGround()), coordinate=0))
    slide = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    add_friction(mbs, ground, slide, law(kind), normal_force=GRAVITY, effective_mass=1.0)
    mbs.Assemble()
    solve_dynamic(mbs, silent_settings(dt, 0.5), solver=solver)
    assert mbs.GetNodeOutput(node, exudyn.OutputVariableType.Coordinates) == pytest.approx(STOP, abs=RISE)


@pytest.mark.parametrize("kind", ["lugre", "dahl"])
@pytest.mark.parametrize("dt", [1.0e-3, 1.0e-4])
def test_pymunk(dt: float, kind: str) -> None:
    pymunk = pytest.importorskip("pymunk")
    from stochfric_mb.pymunk import add_friction

    space = pymunk.Space()
    space.gravity = (0.0, -GRAVITY)
    floor = pymunk.Segment(space.static_body, (-5.0, 0.0), (5.0, 0.0), 0.0)
    body: Any = pymunk.Body(1.0, math.inf)
    body.position, body.velocity = (0.0, 0.05), (SPEED, 0.0)
    box = pymunk.Poly.create_box(body, (0.1, 0.1))
    space.add(floor, body, box)
    handle = add_friction(space, box, floor, law(kind))
    for _ in range(round(0.5 / dt)):
        space.step(dt)
        assert all(abs(x.force) <= MU_S * x.normal_force * (1.0 + 1e-9) for x in handle.readings() if x.velocity > 0.1)
    # pymunk drifts before it kicks: v dt/2 further
    assert body.position[0] == pytest.approx(STOP + 0.5 * SPEED * dt, abs=RISE)
