"""A hinge with a pendulum: a point mass on an arm, driven about a horizontal axis."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

from stochfric_mb.errors import require_number


@dataclasses.dataclass(frozen=True, kw_only=True)
class HingePendulum:
    """(m l^2 + J) q'' + c q' + m g l sin q + offset = driving torque - friction, q = 0 hanging.

    The driving torque is the channel ``torque``, or ``voltage`` times ``torque_gain``, times ``drive_factor``. Friction is mu N
    with N in N m: the load times the radius at which it rubs.
    """

    mass: float
    """Mass m [kg], > 0."""
    length: float
    """Distance l of the mass from the axis [m], > 0."""
    normal_force: float
    """Load on the bearing or gear times the radius at which it rubs [N m], > 0: friction is mu N."""
    inertia: float = 0.0
    """Further inertia J: rotor seen through the gear, arm [kg m^2], >= 0."""
    gravity: float = 9.81
    """Acceleration of gravity g [m/s^2], >= 0."""
    torque_gain: float = 0.0
    """Driving torque per volt [N m/V]; 0: the torque itself is measured."""
    drive_factor: float = 1.0
    """True driving torque over the recorded one [-], > 0: another motor constant, or scale of a sensor, than was assumed."""
    damping: float = 0.0
    """Damping c, a motor's back-EMF included [N m s/rad], >= 0."""
    offset: float = 0.0
    """Constant torque against q [N m]; its uncertainty is in N m."""
    initial_position: float = 0.0
    """Angle q at t = 0 [rad]."""
    initial_velocity: float = 0.0
    """Rate q' at t = 0 [rad/s]."""

    kind: ClassVar[str] = "hinge_pendulum"
    rotational: ClassVar[bool] = True

    def __post_init__(self) -> None:
        require_number("mass", self.mass, above=0.0, unit="kg")
        require_number("length", self.length, above=0.0, unit="m")
        require_number("normal_force", self.normal_force, above=0.0, unit="N m")
        require_number("inertia", self.inertia, low=0.0, unit="kg m^2")
        require_number("gravity", self.gravity, low=0.0, unit="m/s^2")
        require_number("torque_gain", self.torque_gain, unit="N m/V")
        require_number("drive_factor", self.drive_factor, above=0.0)
        require_number("damping", self.damping, low=0.0, unit="N m s/rad")
        require_number("offset", self.offset, unit="N m")
        require_number("initial_position", self.initial_position, unit="rad")
        require_number("initial_velocity", self.initial_velocity, unit="rad/s")

    def to_dict(self) -> dict[str, Any]:
        """Return the mechanism as the ``[mechanism]`` table of a scenario."""
        return {"kind": self.kind} | dataclasses.asdict(self)
