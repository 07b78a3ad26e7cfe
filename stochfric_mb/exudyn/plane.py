"""Friction between positions of two bodies: a tangent plane, and a normal force that is given or made by contact."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from exudyn.advancedUtilities import CreateSymbolicUserFunction
from exudyn.itemInterface import CartesianSpringDamper

from stochfric_mb.errors import InputError, require_number
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn.contact import OUTPUT, FrictionContact
from stochfric_mb.exudyn.expression import Value, apply, choose, variable
from stochfric_mb.exudyn.normal import ConstantNormal, Normal
from stochfric_mb.exudyn.symbolic import (
    DISPLACEMENT,
    DISPLACEMENT_2,
    NORMAL_FORCE,
    NORMAL_LINE,
    TIME,
    VELOCITY,
    VELOCITY_2,
    lower,
    normal_line,
    plane_force_expression,
)
from stochfric_mb.friction import Friction
from stochfric_mb.laws import Law

_DISTANCE, _RATE = ("d_0", "d_1", "d_2"), ("w_0", "w_1", "w_2")
"""Variables: position and velocity of marker 1 relative to marker 0."""


class PlaneContact(FrictionContact):
    """Friction between positions of two bodies; made by `add_friction`."""

    def __init__(
        self,
        mbs: Any,
        markers: tuple[Any, Any],
        friction: Law | Friction,
        normal_force: Normal | None,
        penalty: tuple[float, float, float] | None,
        normal: Sequence[float] | None,
        surface_velocity: Any,
        **options: Any,
    ) -> None:
        super().__init__(mbs, friction, normal_force or ConstantNormal(0.0), **options)
        self._markers = markers
        set_plane(self, penalty, normal, surface_velocity)
        self._words[at.ASK_FIRST] = 1
        self._distance = self._numbers[at.DISTANCE : at.DISTANCE + 3]
        self._rate = self._numbers[at.RATE : at.RATE + 3]
        self._connector()

    def _connector(self) -> None:
        """Hang the force on a connector."""
        expression = plane_force_expression(self.friction.law, self.friction.process, self.given_mass)
        n = penalty_expression(self._numbers) if self._words[at.PENALTY] else self._given_normal()
        names = expression.names + (() if self._words[at.PENALTY] or not self._normal.changes else NORMAL_LINE)
        self._make_symbols(names)
        function = self._function((expression.force, expression.force_2), n)
        self.object = self._mbs.AddObject(
            CartesianSpringDamper(markerNumbers=list(self._markers), springForceUserFunction=function)
        )
        self._begin(names)

    def _given_normal(self) -> Value:
        return normal_line() if self._normal.changes else self._normal.at(0.0)

    @property
    def force(self) -> Any:
        """The friction force [N] on marker 1 that the engine applies now, a vector in global axes."""
        return self._forces() @ self._axes[:2]

    def _forces(self) -> Any:
        return -self._axes[:2] @ np.asarray(self._mbs.GetObjectOutput(self.object, OUTPUT.Force))

    @property
    def _axes(self) -> Any:
        return self._numbers[at.AXIS_1 : at.AXIS_1 + 9].reshape(3, 3)

    def _read_motion(self) -> None:
        """Take position and velocity of marker 1 relative to marker 0 (the connector would evaluate its force to tell)."""
        marker, (first, second) = self._mbs.GetMarkerOutput, self._markers
        np.subtract(marker(second, OUTPUT.Position), marker(first, OUTPUT.Position), out=self._distance)
        np.subtract(marker(second, OUTPUT.Velocity), marker(first, OUTPUT.Velocity), out=self._rate)

    def _function(self, forces: tuple[Value, Value], normal: Value) -> Any:
        """Return the symbolic user function: what pulls marker 1 back, minus the friction and the normal force."""
        numbers, press = self._numbers, bool(self._words[at.PENALTY])
        axes = self._axes

        def minus_forces(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):
            given = {TIME: t, **self._symbols}
            given |= {name: displacement[i] for i, name in enumerate(_DISTANCE)}
            given |= {name: velocity[i] for i, name in enumerate(_RATE)}
            n = lower(normal, given)
            u, v, u_2, v_2 = (lower(e, given) for e in relative_motion(numbers))
            given |= {DISPLACEMENT: u, VELOCITY: v, DISPLACEMENT_2: u_2, VELOCITY_2: v_2, NORMAL_FORCE: n}
            parts = [choose(apply("gt", variable(NORMAL_FORCE), 0.0), f, 0.0) for f in forces]
            parts.append(variable(NORMAL_FORCE) if press else 0.0)
            return [lower(apply("neg", along(axes[:, i], parts)), given) for i in range(3)]

        return CreateSymbolicUserFunction(
            self._mbs,
            function=minus_forces,
            userFunctionName="springForceUserFunction",
            itemTypeName="ObjectConnectorCartesianSpringDamper",
        )


def set_plane(
    contact: FrictionContact, penalty: tuple[float, float, float] | None, normal: Sequence[float] | None, surface_velocity: Any
) -> None:
    """Set a contact's tangent plane, the motion of its counter-surface and its normal contact.

    The first direction of the plane is that of the surface velocity where there is one, otherwise the global axis that
    lies nearest to the plane.

    Raises:
        InputError: no normal, or numbers out of range.
    """
    if normal is None:
        raise InputError("friction between positions needs normal, the direction from the counter-surface to the body")
    n = _vector("normal", normal)
    if np.linalg.norm(n) == 0.0:
        raise InputError("normal = (0, 0, 0) has no direction; give the one from the counter-surface to the body")
    n /= np.linalg.norm(n)
    w = _vector(
        "surface_velocity", (0.0, 0.0, 0.0) if np.ndim(surface_velocity) == 0 and surface_velocity == 0.0 else surface_velocity
    )
    w -= n * (n @ w)
    first = w if np.linalg.norm(w) > 0.0 else np.eye(3)[np.argmin(np.abs(n))]
    first = first - n * (n @ first)
    first /= np.linalg.norm(first)
    numbers, words = contact._numbers, contact._words
    numbers[at.AXIS_1 : at.AXIS_1 + 9] = np.concatenate([first, np.cross(n, first), n])
    numbers[[at.SURFACE_VELOCITY, at.SURFACE_VELOCITY_2]] = first @ w, 0.0
    words[at.PLANE] = 1
    if penalty is not None:
        numbers[at.STIFFNESS] = require_number("contact_stiffness", penalty[0], above=0.0, unit="N/m")
        numbers[at.DAMPING] = require_number("contact_damping", penalty[1], low=0.0, unit="N s/m")
        numbers[at.TOUCH] = require_number("touch", penalty[2], unit="m")
        words[at.PENALTY] = 1


def penalty_expression(numbers: Any) -> Value:
    """Return the unilateral normal force of `contact_force.penalty` as an expression."""
    n = numbers[at.NORMAL : at.NORMAL + 3]
    depth = apply("sub", float(numbers[at.TOUCH]), along(n, list(map(variable, _DISTANCE))))
    closing = apply("mul", float(numbers[at.DAMPING]), along(n, list(map(variable, _RATE))))
    force = apply("max", apply("sub", apply("mul", float(numbers[at.STIFFNESS]), depth), closing), 0.0)
    return choose(apply("gt", depth, 0.0), force, 0.0)


def relative_motion(numbers: Any) -> tuple[Value, Value, Value, Value]:
    """Return displacement and velocity along the first axis, then along the second, as `contact_force.kinematics` has them."""
    result: list[Value] = []
    for axis, speed in ((at.AXIS_1, at.SURFACE_VELOCITY), (at.AXIS_2, at.SURFACE_VELOCITY_2)):
        e, w = numbers[axis : axis + 3], float(numbers[speed])
        result.append(apply("sub", apply("mul", w, variable(TIME)), along(e, list(map(variable, _DISTANCE)))))
        result.append(apply("sub", w, along(e, list(map(variable, _RATE)))))
    return result[0], result[1], result[2], result[3]


def along(factors: Any, values: Sequence[Value]) -> Value:
    """Return the sum of factors times values; factors that are rounding of 0 are left out."""
    products = [apply("mul", float(f), v) for f, v in zip(factors, values, strict=True) if abs(f) > 1.0e-15]
    add: Callable[[Value, Value], Value] = functools.partial(apply, "add")
    return functools.reduce(add, products, 0.0)


def _vector(name: str, value: Any) -> Any:
    entries = np.asarray(value, dtype=np.float64)
    if entries.shape != (3,):
        raise InputError(f"{name} = {value!r} is no vector; give three numbers in global axes")
    return np.array([require_number(f"{name}[{i}]", e) for i, e in enumerate(entries)])
