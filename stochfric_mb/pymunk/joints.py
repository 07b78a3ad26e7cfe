"""Friction in pymunk's joints: the pin of a hinge, the slide of a groove, and a surface seen from above.

pymunk's own solver applies it, with the law's cap as the largest force of a constraint (a motor that brakes the hinge, a pivot
that holds a body to the surface): stick is exact there, whatever else holds the bodies. Along a groove there is no such
constraint; there the force that would stop the sliding within the step, no larger than the cap, is written into the bodies
before the solve.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pymunk
from pymunk.constraints import Constraint, GrooveJoint, PivotJoint, SimpleMotor, SlideJoint

from stochfric_mb.contact import Contact
from stochfric_mb.errors import InputError, require_number
from stochfric_mb.friction import Friction, as_friction
from stochfric_mb.laws import Law

NormalForce = float | Callable[[float], float] | None
ENDLESS = 1.0e12
"""A load no friction can hold, in normal forces: it asks a law for its cap."""
SATURATED = 1.0 - 1.0e-9
"""Part of the cap from which on a friction counts as given in."""
FAST = 2.0
"""Speed beyond which sliding cannot stop within the step, in the same unit as `SLOW`."""
SLOW = 0.05
"""Speed up to which one at its cap still holds, in changes of speed by the cap in one step: where several hold a body, the
solver loads them one after the other, and one may be at its cap while the others hold."""


class JointFriction:
    """Friction in a joint, or on a surface; made by `add_joint_friction` and `add_surface_friction`."""

    def __init__(
        self,
        space: pymunk.Space,
        constraint: Constraint,
        friction: Law | Friction,
        normal: NormalForce,
        address: dict[str, int],
    ) -> None:
        law = as_friction(friction).law
        if not law.needs_holding_force or law.kind == "karnopp":
            raise InputError(
                f"friction in joints is for laws that stick truly and slide at any speed, coulomb and stribeck; {law.kind} "
                "is none"
            )
        self.space, self.constraint = space, constraint
        self._normal = normal
        self.time = 0.0
        """Time of the force last applied [s]; the coefficients run along it."""
        self.force, self.normal_force, self.speed = 0.0, 0.0, 0.0
        """Size of the friction force [N], normal force [N] and sliding speed [m/s] of the last step."""
        self._contact = Contact(friction, effective_mass=1.0, **address)
        self._way, self._cap, self._pushed, self._started = 0.0, 0.0, 0.0, False
        self._others = constraint.pre_solve, constraint.post_solve
        constraint.pre_solve, constraint.post_solve = self._before, self._after

    @property
    def stick(self) -> bool:
        """Whether the joint sticks."""
        return self._contact.stick

    @property
    def mu_s(self) -> float:
        """Static coefficient [-]."""
        return self._contact.mu_s

    @property
    def mu_k(self) -> float:
        """Kinetic coefficient [-]."""
        return self._contact.mu_k

    def remove(self) -> None:
        """Take the friction away."""
        self.constraint.pre_solve, self.constraint.post_solve = self._others

    def _motion(self, dt: float) -> float:
        """Return the sliding speed [m/s] before the solve, >= 0."""
        raise NotImplementedError

    def _mass_felt(self) -> float:
        """Return the mass that the sliding feels [kg], other constraints aside."""
        raise NotImplementedError

    def _press(self, dt: float) -> float:
        """Return the normal force [N]."""
        raise NotImplementedError

    def _apply(self, cap: float, dt: float) -> None:
        """Let the friction act in this step, at most ``cap`` [N]."""
        raise NotImplementedError

    def _result(self, dt: float) -> float:
        """Return the size of the friction force [N] after the solve."""
        raise NotImplementedError

    def _before(self, constraint: Constraint, space: pymunk.Space) -> None:
        dt = space.current_time_step
        speed, normal = self._motion(dt), self._press(dt)
        known = self._started or self._normal is not None
        held = self._started and (self.force < SATURATED * self._cap or speed <= SLOW * self._cap * dt / self._mass_felt())
        hold = min(self.force, SATURATED * self._contact.mu_s * normal) if held else ENDLESS * normal
        self.speed, self.normal_force = speed, normal
        self._way += speed * dt
        if self._started:
            self._contact.commit(self.time, self._way, 0.0 if held else speed, normal, hold=hold)
        else:
            self._contact.start(self.time, self._way, speed, normal)
            self._started = True
        self._cap = abs(self._contact.force(self.time, self._way, speed, normal, hold=ENDLESS * normal))
        if not known and speed == 0.0:
            self._cap = math.inf  # what stands still is held until the reaction is known
        self._apply(self._cap, dt)
        if self._others[0] is not None:
            self._others[0](constraint, space)

    def _after(self, constraint: Constraint, space: pymunk.Space) -> None:
        dt = space.current_time_step
        self.force = self._result(dt)
        self.time += dt
        if self._others[1] is not None:
            self._others[1](constraint, space)


class PinFriction(JointFriction):
    """Friction of a hinge's pin: a motor of rate 0 brakes it, pressed by the hinge's own reaction or by a given force."""

    def __init__(
        self, space: pymunk.Space, hinge: PivotJoint, friction: Law | Friction, radius: float, normal: NormalForce, address: Any
    ) -> None:
        self._hinge, self._radius = hinge, radius
        motor = SimpleMotor(hinge.a, hinge.b, 0.0)
        motor.max_force = 0.0
        super().__init__(space, motor, friction, normal, address)
        space.add(motor)

    def remove(self) -> None:
        """Take the friction away."""
        super().remove()
        self.space.remove(self.constraint)

    def _mass_felt(self) -> float:
        inverse = _inverse(self._hinge.a.moment) + _inverse(self._hinge.b.moment)
        return 1.0 / (inverse * self._radius**2) if inverse > 0.0 else math.inf

    def _motion(self, dt: float) -> float:
        return self._radius * abs(self._hinge.b.angular_velocity - self._hinge.a.angular_velocity)

    def _press(self, dt: float) -> float:
        return self._hinge.impulse / dt if self._normal is None else _at(self._normal, self.time)

    def _apply(self, cap: float, dt: float) -> None:
        self.constraint.max_force = cap * self._radius

    def _result(self, dt: float) -> float:
        return self.constraint.impulse / dt / self._radius


class SurfaceFriction(JointFriction):
    """Friction of a body on a surface seen from above: a pivot that gives way at the cap, a force while it slides."""

    def __init__(
        self,
        space: pymunk.Space,
        surface: pymunk.Body,
        body: pymunk.Body,
        anchor: Any,
        friction: Any,
        normal: Any,
        address: Any,
    ) -> None:
        self._surface, self._body, self._anchor = surface, body, anchor
        pivot = PivotJoint(surface, body, surface.world_to_local(body.local_to_world(anchor)), anchor)
        pivot.max_bias = pivot.max_force = 0.0
        super().__init__(space, pivot, friction, normal, address)
        space.add(pivot)

    def remove(self) -> None:
        """Take the friction away."""
        super().remove()
        self.space.remove(self.constraint)

    def _mass_felt(self) -> float:
        arm = (pymunk.Vec2d(*self._anchor) - self._body.center_of_gravity).length
        return 1.0 / (_inverse(self._body.mass) + arm**2 * _inverse(self._body.moment) + _inverse(self._surface.mass))

    def _motion(self, dt: float) -> float:
        point = self._body.local_to_world(self._anchor)
        pivot: Any = self.constraint
        pivot.anchor_a = self._surface.world_to_local(point)
        self._velocity = self._surface.velocity_at_world_point(point) - self._body.velocity_at_local_point(self._anchor)
        return float(self._velocity.length)

    def _press(self, dt: float) -> float:
        return _at(self._normal, self.time)

    def _apply(self, cap: float, dt: float) -> None:
        """Hold with the pivot, and slide with a force against the motion: a pivot off the centre of mass pulls aside."""
        self._pushed = cap if not self.stick and self.speed > FAST * cap * dt / self._mass_felt() else 0.0
        self.constraint.max_force = 0.0 if self._pushed else cap
        if self._pushed:
            point, force = self._body.local_to_world(self._anchor), self._velocity * (cap / self.speed)
            self._body.apply_force_at_world_point(force, point)
            self._surface.apply_force_at_world_point(-force, point)

    def _result(self, dt: float) -> float:
        return self._pushed or self.constraint.impulse / dt


class SlideFriction(JointFriction):
    """Friction along a groove, or along the line between the anchors of a slide joint."""

    def __init__(self, space: pymunk.Space, joint: Any, friction: Any, normal: Any, address: Any) -> None:
        self._past = 0.0
        self._ready = False
        super().__init__(space, joint, friction, normal, address)

    def _mass_felt(self) -> float:
        return self._mass

    def _motion(self, dt: float) -> float:
        joint, a, b = self._joint, self.constraint.a, self.constraint.b
        point = b.local_to_world(joint.anchor_b)
        if isinstance(joint, GrooveJoint):
            self._axis = (a.local_to_world(joint.groove_b) - a.local_to_world(joint.groove_a)).normalized()
            other = point
        else:
            other = a.local_to_world(joint.anchor_a)
            self._axis = (point - other).normalized()
        self._points = other, point
        self._velocity = float((b.velocity_at_world_point(point) - a.velocity_at_world_point(other)).dot(self._axis))
        arms = ((other - a.local_to_world(a.center_of_gravity), a), (point - b.local_to_world(b.center_of_gravity), b))
        inverse = sum(_inverse(body.mass) + _inverse(body.moment) * self._axis.cross(arm) ** 2 for arm, body in arms)
        self._mass = 1.0 / inverse if inverse > 0.0 else math.inf
        return abs(self._velocity)

    @property
    def _joint(self) -> Any:
        return self.constraint

    def _press(self, dt: float) -> float:
        return self.constraint.impulse / dt if self._normal is None else _at(self._normal, self.time)

    def _apply(self, cap: float, dt: float) -> None:
        """Push against the sliding: what would stop it within the step, by what it did in the last one, within the cap."""
        v = self._velocity
        free = (v - self._past) / dt - self._pushed / self._mass if self._ready else self._loads()
        needed = -self._mass * (v / dt + free) if math.isfinite(self._mass) else 0.0
        self._pushed = max(-cap, min(cap, needed))
        self._past, self._ready = v, True
        force = self._pushed * self._axis
        self.constraint.b.apply_force_at_world_point(force, self._points[1])
        self.constraint.a.apply_force_at_world_point(-force, self._points[0])

    def _loads(self) -> float:
        """Return the relative acceleration [m/s^2] along the axis by gravity and applied forces."""
        a, b = (
            body.force * _inverse(body.mass) + self.space.gravity * float(body.body_type == pymunk.Body.DYNAMIC)
            for body in (self.constraint.a, self.constraint.b)
        )
        return float((b - a).dot(self._axis))

    def _result(self, dt: float) -> float:
        return abs(self._pushed)


def add_joint_friction(
    space: pymunk.Space,
    joint: Constraint,
    friction: Law | Friction,
    *,
    normal_force: NormalForce = None,
    radius: float | None = None,
    seed: int = 0,
    sample: int = 0,
    contact: int = 0,
) -> JointFriction:
    """Return the friction that now acts in a joint.

    Args:
        space: the space that the joint is in.
        joint: a `PivotJoint`, whose pin slides by ``radius`` times the angle; a `GrooveJoint`, along its groove; or a
            `SlideJoint`, along the line between its anchors.
        friction: coulomb or stribeck, or one of them with random coefficients.
        normal_force: normal force [N]: a number, a function of time [s], or None for the joint's own reaction in the last
            step (in the first a joint at rest holds, one that moves is free). A slide joint, which pulls only at its ends,
            needs one.
        radius: radius of a hinge's pin [m], > 0.
        seed: first part of the address of the coefficient path.
        sample: second part.
        contact: third part, different for each joint.

    Raises:
        InputError: another joint or law, a joint that is not in the space, no radius, or no normal force.
    """
    address = {"seed": seed, "sample": sample, "contact": contact}
    if not isinstance(joint, PivotJoint | GrooveJoint | SlideJoint):
        raise InputError(f"{joint!r}: friction in joints is for a PivotJoint, a GrooveJoint or a SlideJoint")
    if joint not in space.constraints:
        raise InputError(f"{joint!r} is not in this space; add it before its friction")
    _check(normal_force)
    if isinstance(joint, PivotJoint):
        if radius is None:
            raise InputError(
                "a PivotJoint needs radius, that of its pin [m]; for a surface seen from above use add_surface_friction"
            )
        return PinFriction(space, joint, friction, require_number("radius", radius, above=0.0, unit="m"), normal_force, address)
    if isinstance(joint, SlideJoint) and normal_force is None:
        raise InputError("a SlideJoint presses nothing together; give normal_force")
    return SlideFriction(space, joint, friction, normal_force, address)


def add_surface_friction(
    space: pymunk.Space,
    body: pymunk.Body,
    friction: Law | Friction,
    *,
    normal_force: float | Callable[[float], float],
    anchor: tuple[float, float] = (0.0, 0.0),
    surface: pymunk.Body | None = None,
    seed: int = 0,
    sample: int = 0,
    contact: int = 0,
) -> JointFriction:
    """Return the friction of one point of a body on a surface seen from above, such as a tyre's, in any direction.

    Args:
        space: the space.
        body: the body.
        friction: coulomb or stribeck, or one of them with random coefficients.
        normal_force: normal force [N]: a number or a function of time [s].
        anchor: the point, in the body's own coordinates [m].
        surface: the body of the surface; the space's static body if not given.
        seed: first part of the address of the coefficient path.
        sample: second part.
        contact: third part, different for each point.

    Raises:
        InputError: another law, or a body that is not in the space.
    """
    if body not in space.bodies:
        raise InputError(f"{body!r} is not in this space; add it before its friction")
    _check(normal_force)
    address = {"seed": seed, "sample": sample, "contact": contact}
    return SurfaceFriction(space, surface or space.static_body, body, anchor, friction, normal_force, address)


def _check(normal_force: NormalForce) -> None:
    if normal_force is not None and not callable(normal_force):
        require_number("normal_force", normal_force, low=0.0, unit="N")


def _at(normal: Any, t: float) -> float:
    if not callable(normal):
        return float(normal)
    return max(require_number(f"normal_force at t = {t:g} s", normal(t), unit="N"), 0.0)


def _inverse(value: float) -> float:
    return 1.0 / value if 0.0 < value < math.inf else 0.0
