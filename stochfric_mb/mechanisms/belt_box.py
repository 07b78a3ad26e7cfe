"""A box on a moving belt: the mechanism of Kang, Choi and Yoo 2015."""

from __future__ import annotations

import dataclasses
import math
from typing import Any, ClassVar, NamedTuple

from stochfric_mb.errors import require_number


class BoxNumbers(NamedTuple):
    """A belt-box as compiled code takes it."""

    mass: float
    """m [kg]; then c [N s/m], k [N/m], N [N], k u_0 [N], W [rad/s], v_b [m/s]."""
    damping: float
    stiffness: float
    normal_force: float
    drive: float
    frequency: float
    belt_velocity: float


@dataclasses.dataclass(frozen=True, kw_only=True)
class BeltBox:
    """A box on a moving belt, held by a spring and a damper.

    m x'' + c x' + k x = F + k u_0 cos(W t), friction force F on the box along v_rel = v_b - x'.

    Reference: Kang, Choi and Yoo 2015, eqs. 7-9, doi 10.1007/s12206-015-0808-4 (eq. 7 leaves out c u', 0.2 %).
    """

    mass: float
    """Mass m of the box [kg], > 0."""
    damping: float
    """Damping c [N s/m], >= 0."""
    stiffness: float
    """Stiffness k [N/m], > 0."""
    normal_force: float
    """Normal force N between box and belt [N], > 0."""
    belt_velocity: float
    """Belt velocity v_b [m/s]."""
    excitation_amplitude: float = 0.0
    """Amplitude u_0 of the spring's foot [m]."""
    excitation_angular_frequency: float = 0.0
    """Angular frequency W of the excitation [rad/s], >= 0."""
    initial_position: float = 0.0
    """Position x at t = 0 [m]."""
    initial_velocity: float = 0.0
    """Velocity x' at t = 0 [m/s]."""

    kind: ClassVar[str] = "belt_box"

    def __post_init__(self) -> None:
        require_number("mass", self.mass, above=0.0, unit="kg")
        require_number("damping", self.damping, low=0.0, unit="N s/m")
        require_number("stiffness", self.stiffness, above=0.0, unit="N/m")
        require_number("normal_force", self.normal_force, above=0.0, unit="N")
        require_number("belt_velocity", self.belt_velocity, unit="m/s")
        require_number("excitation_amplitude", self.excitation_amplitude, unit="m")
        require_number("excitation_angular_frequency", self.excitation_angular_frequency, low=0.0, unit="rad/s")
        require_number("initial_position", self.initial_position, unit="m")
        require_number("initial_velocity", self.initial_velocity, unit="m/s")

    @property
    def fastest(self) -> float:
        """The fastest part of its motion [rad/s]: its own, the excitation's or its damping's."""
        return max(math.sqrt(self.stiffness / self.mass), self.excitation_angular_frequency, self.damping / self.mass)

    def numbers(self) -> BoxNumbers:
        """Return the numbers that compiled code needs."""
        return BoxNumbers(
            self.mass, self.damping, self.stiffness, self.normal_force, self.stiffness * self.excitation_amplitude,
            self.excitation_angular_frequency, self.belt_velocity,
        )  # fmt: skip

    def excitation_force(self, t: float) -> float:
        """Return k u_0 cos(W t) [N]."""
        return self.stiffness * self.excitation_amplitude * math.cos(self.excitation_angular_frequency * t)

    def to_dict(self) -> dict[str, Any]:
        """Return the mechanism as the ``[mechanism]`` table of a scenario."""
        return {"kind": self.kind} | dataclasses.asdict(self)
