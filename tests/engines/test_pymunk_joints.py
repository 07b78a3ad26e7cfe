"""Friction in pymunk's joints and on surfaces seen from above, against closed forms."""

# ruff: noqa: E402  (the adapter can be imported only where pymunk is)

from __future__ import annotations

import math
from typing import Any

import pytest

pymunk: Any = pytest.importorskip("pymunk", reason="pymunk is not installed")

from stochfric_mb import Friction, Knots
from stochfric_mb.errors import InputError
from stochfric_mb.laws import make_law
from stochfric_mb.pymunk import add_joint_friction, add_surface_friction

LAW = make_law("coulomb", mu_s=0.4, mu_k=0.3)
DT = 1.0e-3


def run(space: Any, duration: float, dt: float = DT) -> None:
    for _ in range(round(duration / dt)):
        space.step(dt)


def flywheel(spin: float, **options: Any) -> tuple[Any, Any, Any]:
    """A wheel of 2 kg, 0.5 kg m^2 on a pin of 20 mm, pressed by its weight, 20 N."""
    space = pymunk.Space()
    space.gravity = (0.0, -10.0)
    wheel = pymunk.Body(2.0, 0.5)
    wheel.angular_velocity = spin
    hinge = pymunk.PivotJoint(space.static_body, wheel, (0.0, 0.0), (0.0, 0.0))
    space.add(wheel, hinge)
    return space, wheel, add_joint_friction(space, hinge, LAW, radius=0.02, **options)


@pytest.mark.parametrize(
    "options", [{}, {"normal_force": 20.0}, {"normal_force": lambda t: 20.0}], ids=["own", "number", "function"]
)
@pytest.mark.parametrize("spin", [1.0, -1.0])
def test_a_pin_brakes_a_flywheel(spin: float, options: dict[str, Any]) -> None:
    space, wheel, friction = flywheel(spin, **options)
    rate = 0.3 * 20.0 * 0.02 / 0.5  # mu_k N r/I = 0.24 rad/s^2
    run(space, 2.0)
    # the joint's own reaction is known from the second step on
    assert wheel.angular_velocity == pytest.approx(spin - math.copysign(rate * 2.0, spin), abs=2.0 * rate * DT)
    assert friction.force == pytest.approx(6.0, rel=1e-6)
    run(space, 3.0)
    assert abs(wheel.angular_velocity) <= 1e-12
    assert friction.stick


@pytest.mark.parametrize(("share", "holds"), [(0.99, True), (1.01, False)])
def test_a_pin_lets_go_at_mu_s(share: float, holds: bool) -> None:
    space, wheel, friction = flywheel(0.0, normal_force=20.0)
    torque = share * 0.4 * 20.0 * 0.02
    for _ in range(2000):
        wheel.torque = torque
        space.step(DT)
    if holds:
        assert abs(wheel.angle) <= 1e-12  # no creep
        assert friction.force == pytest.approx(share * 8.0, rel=1e-9)
    else:
        # it counts as sliding at 5 % of what the cap does in a step, after 5 steps of 1 %; two more to see and to commit it
        late = 7.0 * DT * (0.4 - 0.3) * 20.0 * 0.02 / 0.5
        assert wheel.angular_velocity == pytest.approx((torque - 0.3 * 20.0 * 0.02) / 0.5 * 2.0, abs=late)


@pytest.mark.parametrize("kind", ["groove", "slide"])
def test_a_slide_stops_where_mu_k_says_and_stays(kind: str) -> None:
    space = pymunk.Space()
    block: Any = pymunk.Body(2.0, 0.1)
    block.position, block.velocity = (0.3, 0.0), (1.0, 0.0)
    if kind == "groove":
        joint = pymunk.GrooveJoint(space.static_body, block, (-5.0, 0.0), (5.0, 0.0), (0.0, 0.0))
    else:
        joint = pymunk.SlideJoint(space.static_body, block, (0.0, 0.0), (0.0, 0.0), 0.0, 9.0)
    space.add(block, joint)
    friction = add_joint_friction(space, joint, LAW, normal_force=20.0)
    run(space, 0.2)
    assert block.velocity.x == pytest.approx(1.0 - 3.0 * 0.2, abs=1e-9)
    assert friction.force == pytest.approx(6.0, rel=1e-12)
    run(space, 0.5)
    # pymunk drifts before it kicks: v dt/2 further
    assert block.position.x - 0.3 == pytest.approx(1.0 / 6.0 + 0.5 * DT, abs=2e-6)
    assert abs(block.velocity.x) <= 1e-12
    assert friction.stick


@pytest.mark.parametrize(("share", "holds"), [(0.99, True), (1.01, False)])
def test_a_groove_under_its_own_reaction_lets_go_at_atan_mu_s(share: float, holds: bool) -> None:
    space, tilt = pymunk.Space(), math.atan(share * 0.4)
    space.gravity = (10.0 * math.sin(tilt), -10.0 * math.cos(tilt))
    block: Any = pymunk.Body(2.0, 0.1)
    joint = pymunk.GrooveJoint(space.static_body, block, (-9.0, 0.0), (9.0, 0.0), (0.0, 0.0))
    space.add(block, joint)
    friction = add_joint_friction(space, joint, LAW)
    run(space, 2.0)
    if holds:  # two steps of free fall before the reaction and the load are known, which friction then makes good
        assert abs(block.position.x) <= 3.0 * 10.0 * math.sin(tilt) * DT**2
        assert abs(block.velocity.x) <= 1e-9
        assert friction.force == pytest.approx(20.0 * math.sin(tilt), rel=1e-6)
    else:
        assert block.velocity.x == pytest.approx(10.0 * (math.sin(tilt) - 0.3 * math.cos(tilt)) * 2.0, rel=0.01)


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.0])
def test_a_puck_seen_from_above_stops_in_a_straight_line(angle: float) -> None:
    space = pymunk.Space()
    puck: Any = pymunk.Body(0.5, 0.01)
    puck.position, puck.velocity = (1.0, 2.0), (math.cos(angle), math.sin(angle))
    space.add(puck)
    friction = add_surface_friction(space, puck, LAW, normal_force=5.0)
    run(space, 0.5)
    way = puck.position - pymunk.Vec2d(1.0, 2.0)
    assert way.length == pytest.approx(1.0 / 6.0 + 0.5 * DT, abs=2e-6)
    assert way.angle == pytest.approx(angle if angle <= math.pi else angle - 2.0 * math.pi, abs=1e-9)
    assert puck.velocity.length <= 1e-12
    assert friction.stick


def test_the_tyres_of_a_car_seen_from_above_hold_a_bend() -> None:
    """Four tyres hold a car pulled sideways with 80 % of mu_s N, and not with 101 %.

    Between them some push against each other, as in any indeterminate hold: the last 10 % of mu_s N are not to be had.
    """
    speeds = []
    for share in (0.8, 1.01):
        space = pymunk.Space()
        space.iterations = 50
        car = pymunk.Body(800.0, 900.0)
        space.add(car)
        for i, anchor in enumerate(((1.2, 0.7), (1.2, -0.7), (-1.2, 0.7), (-1.2, -0.7))):
            add_surface_friction(space, car, LAW, normal_force=2000.0, anchor=anchor, contact=i)
        for _ in range(500):
            car.apply_force_at_local_point((0.0, share * 0.4 * 8000.0))
            space.step(DT)
        speeds.append(car.velocity.length)
    assert speeds[0] <= 1e-9
    assert speeds[1] == pytest.approx((1.01 * 0.4 - 0.3) * 10.0 * 0.5, rel=0.02)


def test_random_coefficients_and_removal() -> None:
    space = pymunk.Space()
    puck: Any = pymunk.Body(0.5, 0.01)
    puck.velocity = (3.0, 0.0)
    space.add(puck)
    friction = Friction(LAW, Knots(sigma_s=0.02, sigma_k=0.02, spacing=0.01))
    handle = add_surface_friction(space, puck, friction, normal_force=5.0, seed=2, contact=7)
    for n in range(100):
        space.step(DT)
        mu_k = friction.path(2, 0, 7).at(n * DT)[1]
        assert handle.force == pytest.approx(5.0 * mu_k, rel=1e-9)
    handle.remove()
    before = puck.velocity
    run(space, 0.1)
    assert puck.velocity == before
    assert not space.constraints


def test_what_has_no_friction_is_named() -> None:
    space = pymunk.Space()
    body = pymunk.Body(1.0, 1.0)
    pin = pymunk.PinJoint(space.static_body, body)
    hinge = pymunk.PivotJoint(space.static_body, body, (0.0, 0.0))
    slide = pymunk.SlideJoint(space.static_body, body, (0.0, 0.0), (0.0, 0.0), 0.0, 1.0)
    with pytest.raises(InputError, match="is not in this space"):
        add_joint_friction(space, hinge, LAW, radius=0.1)
    space.add(body, pin, hinge, slide)
    with pytest.raises(InputError, match="PivotJoint, a GrooveJoint or a SlideJoint"):
        add_joint_friction(space, pin, LAW)
    with pytest.raises(InputError, match="needs radius"):
        add_joint_friction(space, hinge, LAW)
    with pytest.raises(InputError, match="give normal_force"):
        add_joint_friction(space, slide, LAW)
    with pytest.raises(InputError, match="coulomb and stribeck; havsin is none"):
        add_joint_friction(space, hinge, make_law("havsin", mu_s=0.4, mu_k=0.3), radius=0.1)
    with pytest.raises(InputError, match="is not in this space"):
        add_surface_friction(space, pymunk.Body(1.0, 1.0), LAW, normal_force=1.0)
