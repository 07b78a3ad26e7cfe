"""What can be read of a friction while the model runs."""

from __future__ import annotations

import dataclasses


@dataclasses.dataclass(frozen=True)
class Reading:
    """One contact as its friction saw it at the last evaluation at a step's start."""

    time: float
    """Time [s]."""
    body: str
    """Geom on which ``force`` acts; a joint's or tendon's name."""
    surface: str
    """The counter-surface; empty for a joint or tendon."""
    force: tuple[float, float, float]
    """Friction force on the body [N], world axes; for a joint or tendon, along its coordinate [N or N m], 0, 0."""
    normal_force: float
    """Normal force that the law was given [N]."""
    mu_s: float
    """Static coefficient [-]."""
    mu_k: float
    """Kinetic coefficient [-]."""
    stick: bool
    """Whether the contact sticks."""
    displacement: tuple[float, float]
    """Relative displacement, surface minus body, in the contact's tangent frame [m]."""
    velocity: tuple[float, float]
    """Relative velocity, likewise [m/s]."""
    effective_mass: float
    """Mass that the contact feels [kg], 0 for laws that do not use it."""
    stick_phases: int
    """How many times the contact has begun to stick since it was made."""
    dissipated: float
    """Energy dissipated since the contact was made [J]."""
