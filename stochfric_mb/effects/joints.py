"""What the motion of a driven joint covers, which says whether an effect can show there."""

from __future__ import annotations

import dataclasses

WAVES_ON_STROKE = (3.0, 25.0)
"""Waves on a stroke that are looked for one by one [-]; of fewer a grid of wavelengths leaves no peak out."""


@dataclasses.dataclass(frozen=True)
class JointSpan:
    """What the motion of a joint covers."""

    speed: float
    """High speed: its 95 % quantile [m/s or rad/s]."""
    stroke: float
    """Distance between the outermost positions [m or rad]."""
    lowest: float
    """The lowest of them [m or rad]."""
    duration: float
    """Longest record [s]."""
    load: float
    """Median load that the joint transmits, or normal force of a contact [N or N m]; 0: not known, or it does not vary."""
    both_ways: bool
    """Whether it slides in both directions."""
    friction: float
    """Stated friction [N or N m]."""
    distance: float
    """Longest distance slid in a record [m or rad]."""
    temperature: tuple[float, float] | None
    """Middle of the temperatures and what they span; None: not measured, or constant."""
    contact: bool
    """Whether the place is a contact, whose normal force is known."""
    stated_load: float
    """Load by which coefficients are multiplied [N or N m]."""
    drive: bool = False
    """Whether the driving force is known, and not 0 throughout."""
    pressure: float = 0.0
    """Median size of the pressure on a piston [Pa]; 0: none was measured."""
    window: float = 0.0
    """Half width of the windows through which it is seen [s]."""
    inertia: float = 0.0
    """Inertia of motor and load together as stated [kg or kg m^2]; 0: none is known of one body that moves."""
    least_load: float = 0.0
    """Least load that the joint transmits, or normal force of a contact, while it slides [N or N m]."""
    load_range: float = 0.0
    """What that ranges over [N or N m]."""
