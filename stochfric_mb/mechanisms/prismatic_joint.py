"""A prismatic joint: a mass that a measured force drives along a line."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

from stochfric_mb.errors import require_number


@dataclasses.dataclass(frozen=True, kw_only=True)
class PrismaticJoint:
    """m q'' + c q' + p A + offset = driving force - friction, friction mu N against q'.

    The driving force is the channel ``force``, or ``voltage`` times ``force_gain``, times ``drive_factor``; p is the channel
    ``pressure``. With mass 0 the motion is prescribed and slow: the force is what it takes to move.
    """

    mass: float
    """Moving mass m, rotors included [kg], >= 0."""
    normal_force: float
    """Load N on the rubbing surfaces [N], > 0: friction is mu N."""
    force_gain: float = 0.0
    """Driving force per volt [N/V]; 0: the force itself is measured."""
    drive_factor: float = 1.0
    """True driving force over the recorded one [-], > 0: another motor constant, or scale of a load cell, than was assumed."""
    damping: float = 0.0
    """Damping c [N s/m], >= 0."""
    piston_area: float = 0.0
    """Area A on which the pressure acts, against q [m^2], >= 0."""
    offset: float = 0.0
    """Constant force against q: weight, or zero of a force sensor [N]; its uncertainty is in N."""
    initial_position: float = 0.0
    """Position q at t = 0 [m]."""
    initial_velocity: float = 0.0
    """Velocity q' at t = 0 [m/s]."""

    kind: ClassVar[str] = "prismatic_joint"
    rotational: ClassVar[bool] = False

    def __post_init__(self) -> None:
        require_number("mass", self.mass, low=0.0, unit="kg")
        require_number("normal_force", self.normal_force, above=0.0, unit="N")
        require_number("force_gain", self.force_gain, unit="N/V")
        require_number("drive_factor", self.drive_factor, above=0.0)
        require_number("damping", self.damping, low=0.0, unit="N s/m")
        require_number("piston_area", self.piston_area, low=0.0, unit="m^2")
        require_number("offset", self.offset, unit="N")
        require_number("initial_position", self.initial_position, unit="m")
        require_number("initial_velocity", self.initial_velocity, unit="m/s")

    def to_dict(self) -> dict[str, Any]:
        """Return the mechanism as the ``[mechanism]`` table of a scenario."""
        return {"kind": self.kind} | dataclasses.asdict(self)
