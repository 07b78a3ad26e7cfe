"""Laws too stiff for the step: refused wherever they would be unstable, or held by pymunk's own solver where told to."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pymunk
import pytest
from pymunk.constraints import GearJoint, PivotJoint

from stochfric_mb import Friction, Knots
from stochfric_mb.errors import InputError, StabilityError
from stochfric_mb.laws import make_law
from stochfric_mb.pymunk import ContactFriction, add_friction

STEP = 1.0e-3
MU_S, MU_K = 0.5, 0.4
RANDOM = Knots(sigma_s=0.02, sigma_k=0.02, spacing=0.01)
STIFF = ["elastic_stick", "havsin", "lugre", "dahl", "tanh", "smooth", "piecewise_linear"]
ONE_LEVEL = ("dahl", "tanh")
"""Laws whose one level is mu_k."""


def law(kind: str) -> Any:
    return make_law(kind, mu_s=MU_S, mu_k=MU_K)


def level(kind: str) -> float:
    """Return the largest steady friction of a law below ten stick speeds [-]."""
    if kind == "smooth":
        v = np.geomspace(1.0e-7, 1.0e-2, 2000)
        return float(np.max(2.0 / np.pi * np.arctan(v / 1.0e-5) * (MU_K + (MU_S - MU_K) / (1.0 + (v / law(kind).v_d) ** 2))))
    return MU_K if kind in ONE_LEVEL else MU_S


def pressed_box(friction: Any, share: float, *, n: int = 100, **options: Any) -> tuple[pymunk.Body, ContactFriction]:
    """Pull a box of 50 g, pressed on a floor with 200 N, with ``share`` of 200 N for ``n`` steps of 1 ms."""
    space = pymunk.Space()
    space.collision_slop = 1.0e-5
    floor = pymunk.Segment(space.static_body, (-9.0, 0.0), (9.0, 0.0), 0.0)
    body = pymunk.Body(0.05, math.inf)
    body.position = (0.0, 0.05 - 0.5e-5)
    box = pymunk.Poly.create_box(body, (0.1, 0.1))
    space.add(floor, body, box)
    handle = add_friction(space, box, floor, friction, **options)
    for _ in range(n):
        body.apply_force_at_local_point((200.0 * share, -200.0))
        space.step(STEP)
    return body, handle


def crate(friction: Any, **options: Any) -> tuple[pymunk.Body, ContactFriction]:
    """Leave a crate of 20 kg on two blocks of 100 g on an incline of 10 degrees for 1 s."""
    space = pymunk.Space()
    space.iterations = 30
    angle = math.radians(10.0)
    space.gravity = (9.81 * math.sin(angle), -9.81 * math.cos(angle))
    space.collision_slop = 1.0e-5
    space.add(pymunk.Segment(space.static_body, (-9.0, 0.0), (9.0, 0.0), 0.0))
    for x, y, m, size in ((-0.3, 0.05, 0.1, (0.1, 0.1)), (0.3, 0.05, 0.1, (0.1, 0.1)), (0.0, 0.3, 20.0, (0.8, 0.4))):
        body = pymunk.Body(m, pymunk.moment_for_box(m, size))
        body.position = (x, y)
        space.add(body, pymunk.Poly.create_box(body, size))
    handle = add_friction(space, "*", "*", friction, **options)
    for _ in range(1000):
        space.step(STEP)
    return body, handle


def car(friction: Any, **options: Any) -> tuple[pymunk.Body, ContactFriction]:
    """Let a car of 12 kg with two driven wheels of 1 kg stand with its brakes on at 10 degrees for 1 s."""
    space = pymunk.Space()
    space.iterations = 50
    angle = math.radians(10.0)
    space.gravity = (9.81 * math.sin(angle), -9.81 * math.cos(angle))
    space.collision_slop = 1.0e-5
    floor = pymunk.Segment(space.static_body, (-9.0, 0.0), (9.0, 0.0), 0.0)
    chassis = pymunk.Body(10.0, pymunk.moment_for_box(10.0, (1.0, 0.2)))
    chassis.position = (0.0, 0.1)
    space.add(floor, chassis)
    wheels = []
    for x in (-0.4, 0.4):
        wheel = pymunk.Body(1.0, pymunk.moment_for_circle(1.0, 0.0, 0.1))
        wheel.position = (x, 0.1)
        wheels.append(pymunk.Circle(wheel, 0.1))
        space.add(wheel, wheels[-1], PivotJoint(chassis, wheel, (x, 0.1)), GearJoint(chassis, wheel, 0.0, 1.0))
    handle = add_friction(space, wheels, floor, friction, **options)
    for _ in range(1000):
        space.step(STEP)
    return chassis, handle


@pytest.mark.parametrize("process", [None, RANDOM], ids=["fixed", "random"])
@pytest.mark.parametrize("kind", STIFF)
def test_an_unstable_contact_is_refused_however_fast_it_is(kind: str, process: Knots | None) -> None:
    with pytest.raises(StabilityError, match=r"N/m_eff = 4e\+03 N/kg.*beyond_limit=.cap."):
        pressed_box(Friction(law(kind), process), 0.4 * MU_S)


@pytest.mark.parametrize("process", [None, RANDOM], ids=["fixed", "random"])
@pytest.mark.parametrize("scene", [crate, car])
def test_an_unstable_pile_or_car_is_refused(scene: Any, process: Knots | None) -> None:
    with pytest.raises(StabilityError, match=r"beyond the stability limit"):
        scene(Friction(law("elastic_stick"), process))


@pytest.mark.parametrize("kind", STIFF)
def test_with_the_cap_a_pressed_box_is_held_below_its_level(kind: str) -> None:
    body, handle = pressed_box(law(kind), 0.99 * level(kind), beyond_limit="cap")
    reading = handle.readings()[0]
    assert reading.rigid
    assert abs(body.position.x) <= 1.0e-12  # rigid: rounding of the solver
    assert abs(reading.force) == pytest.approx(200.0 * 0.99 * level(kind), rel=1.0e-9)


@pytest.mark.parametrize("kind", STIFF)
def test_with_the_cap_a_box_pulled_harder_slides_as_mu_k_says(kind: str) -> None:
    n, share = 50, 1.01 * MU_S
    body, handle = pressed_box(law(kind), share, n=n, beyond_limit="cap")
    sliding = MU_K if kind != "smooth" else handle.readings()[0].force / 200.0
    speed = (share - abs(sliding)) * 200.0 / 0.05 * n * STEP
    # break-away and the law's way down to mu_k take a few steps, each worth (mu_s - mu_k) N/m dt
    assert body.velocity.x == pytest.approx(speed, abs=4.0 * (MU_S - MU_K) * 200.0 / 0.05 * STEP)
    assert handle.readings()[0].rigid


@pytest.mark.parametrize("scene", [crate, car])
def test_with_the_cap_piles_and_cars_stand(scene: Any) -> None:
    rigid, _ = scene(law("coulomb"))
    body, handle = scene(law("elastic_stick"), beyond_limit="cap")
    # both settle by what pymunk's own solver gives way, some 20 um, when the bodies meet
    assert abs(body.position.x - rigid.position.x) <= 2.0e-5
    assert any(x.rigid for x in handle.readings())
    for x in handle.readings():
        assert abs(x.force) <= MU_S * x.normal_force * (1.0 + 1.0e-9)


def test_the_cap_is_for_stiff_contacts_alone() -> None:
    """A box under its own weight is within the limit at 1 ms: both ways are the same to the bit."""
    ends = []
    ways: list[dict[str, Any]] = [{}, {"beyond_limit": "cap"}]
    for options in ways:
        space = pymunk.Space()
        space.gravity = (3.0, -9.81)
        floor = pymunk.Segment(space.static_body, (-9.0, 0.0), (9.0, 0.0), 0.0)
        body = pymunk.Body(2.0, math.inf)
        body.position = (0.0, 0.05)
        box = pymunk.Poly.create_box(body, (0.1, 0.1))
        space.add(floor, body, box)
        handle = add_friction(space, box, floor, law("elastic_stick"), **options)
        for _ in range(200):
            space.step(STEP)
        assert not handle.readings()[0].rigid
        ends.append((body.position.x, body.velocity.x))
    assert ends[0] == ends[1]


def test_an_unknown_way_is_named() -> None:
    with pytest.raises(InputError, match=r"unknown beyond_limit 'ignore'.*cap, raise"):
        pressed_box(law("elastic_stick"), 0.1, beyond_limit="ignore")
