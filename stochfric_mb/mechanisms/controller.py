"""Controllers that were in the loop while data were taken, so that the loop can be closed again in simulation."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, ClassVar

from stochfric_mb.errors import InputError, require_name, require_number


@dataclasses.dataclass(frozen=True, kw_only=True)
class Cascade:
    """Voltage = clip(velocity_gain (position_gain (reference - q) - q'), -limit, limit).

    Reference: Janot, Gautier, Brunot, Data Set and Reference Models of EMPS, 2019.
    """

    position_gain: float
    """Gain k_p of the position loop [1/s], > 0."""
    velocity_gain: float
    """Gain k_v of the velocity loop [V s/m or V s/rad], > 0."""
    limit: float
    """Largest voltage [V], > 0."""
    reference: str
    """Covariate that holds the reference position [m or rad]."""

    kind: ClassVar[str] = "cascade"

    def __post_init__(self) -> None:
        require_number("controller.position_gain", self.position_gain, above=0.0, unit="1/s")
        require_number("controller.velocity_gain", self.velocity_gain, above=0.0, unit="V s/m")
        require_number("controller.limit", self.limit, above=0.0, unit="V")

    def to_dict(self) -> dict[str, Any]:
        """Return the controller as the ``[controller]`` table of a scenario."""
        return {"kind": self.kind} | dataclasses.asdict(self)


def controller_from_dict(table: Mapping[str, Any]) -> Cascade:
    """Return the controller of a ``[controller]`` table.

    Raises:
        InputError: unknown kind or key, missing key, or value out of range.
    """
    require_name("controller", str(table.get("kind", "")), (Cascade.kind,))
    fields = [f.name for f in dataclasses.fields(Cascade)]
    for key in table:
        require_name("key controller.", key, [*fields, "kind"])
    for key in fields:
        if key not in table:
            raise InputError(f"key controller.{key} is missing; add it to [controller]")
    numbers = {k: require_number(f"controller.{k}", table[k]) for k in fields if k != "reference"}
    return Cascade(reference=str(table["reference"]), **numbers)
