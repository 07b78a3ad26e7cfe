"""A spring slider: a block pulled so slowly through a spring that inertia plays no part."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

from stochfric_mb.errors import require_number


@dataclasses.dataclass(frozen=True, kw_only=True)
class SpringSlider:
    """mu' = stiffness (v_load_point - v), quasi-static: the spring's force per normal force is the friction coefficient.

    The channels are ``position`` (of the load point) and the covariate ``friction_coefficient``, or ``friction_force``
    over ``normal_force``. Reference: Dieterich, J. Geophys. Res. 84, 1979, 2161-2168, doi 10.1029/JB084iB05p02161.
    """

    stiffness: float
    """Stiffness of machine and sample per normal force [1/m], > 0."""
    normal_force: float = 1.0
    """Normal force [N]; 1 where friction coefficients are measured, > 0."""

    kind: ClassVar[str] = "spring_slider"
    rotational: ClassVar[bool] = False

    def __post_init__(self) -> None:
        require_number("stiffness", self.stiffness, above=0.0, unit="1/m")
        require_number("normal_force", self.normal_force, above=0.0, unit="N")

    def to_dict(self) -> dict[str, Any]:
        """Return the mechanism as the ``[mechanism]`` table of a scenario."""
        return {"kind": self.kind} | dataclasses.asdict(self)
