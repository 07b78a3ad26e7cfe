"""Friction between positions of two bodies: a tangent plane, and a normal force that is given or made by contact."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from exudyn.itemInterface import CartesianSpringDamper

from stochfric_mb.errors import InputError, require_number
from stochfric_mb.exudyn import layout as at
from stochfric_mb.exudyn import pointers
from stochfric_mb.exudyn.contact import OUTPUT, FrictionContact
from stochfric_mb.exudyn.normal import ConstantNormal, Normal
from stochfric_mb.friction import Friction
from stochfric_mb.laws import Law


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
        self.route = pointers.route()
        self.object = self._mbs.AddObject(
            CartesianSpringDamper(
                markerNumbers=list(self._markers),
                stiffness=[self.where, 0.0, 0.0],
                springForceUserFunction=pointers.plane_function(),
            )
        )
        self._begin()

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


def _vector(name: str, value: Any) -> Any:
    entries = np.asarray(value, dtype=np.float64)
    if entries.shape != (3,):
        raise InputError(f"{name} = {value!r} is no vector; give three numbers in global axes")
    return np.array([require_number(f"{name}[{i}]", e) for i, e in enumerate(entries)])
