"""Controllers that were in the loop while data were taken, so that the loop can be closed again in simulation."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, cast

from stochfric_mb.errors import InputError, require_name, require_number, require_text


@dataclasses.dataclass(frozen=True, kw_only=True)
class Cascade:
    """Voltage = clip(velocity_gain (position_gain (reference - q) - q') + added, -limit, limit).

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
    added: str = ""
    """Covariate that is added to the output, such as pulses [V]; empty: nothing is."""

    kind: ClassVar[str] = "cascade"

    def __post_init__(self) -> None:
        require_number("controller.position_gain", self.position_gain, above=0.0, unit="1/s")
        require_number("controller.velocity_gain", self.velocity_gain, above=0.0, unit="V s/m")
        require_number("controller.limit", self.limit, above=0.0, unit="V")

    def to_dict(self) -> dict[str, Any]:
        """Return the controller as the ``[controller]`` table of a scenario."""
        return {"kind": self.kind} | {k: v for k, v in dataclasses.asdict(self).items() if k != "added" or v}


@dataclasses.dataclass(frozen=True, kw_only=True)
class JointLoop:
    """u = clip(factor (position_gain (reference - q) - velocity_gain q') + added, -limit, limit) of one joint.

    u is the first column of the joint's drive; what it is multiplied with there, such as a supply voltage, stays as measured.
    """

    position_gain: float
    """Position gain [unit of the drive's column per m or rad], > 0."""
    reference: str
    """Covariate that holds the reference position [m or rad]."""
    velocity_gain: float = 0.0
    """Velocity gain [unit of the drive's column per m/s or rad/s], >= 0."""
    limit: float = math.inf
    """Largest u [unit of the drive's column], > 0."""
    factor: str = ""
    """Constant of each run that multiplies both gains, such as a setting of the firmware; empty: 1."""
    added: str = ""
    """Covariate that is added to the output, such as pulses [unit of the drive's column]; empty: nothing is."""

    def to_dict(self) -> dict[str, Any]:
        """Return the loop as a table."""
        table = dataclasses.asdict(self)
        return {
            k: v for k, v in table.items() if not (k == "limit" and math.isinf(self.limit)) and not (k == "added" and not v)
        }


@dataclasses.dataclass(frozen=True, kw_only=True)
class ProportionalDerivative:
    """Proportional-derivative control, joint by joint, of an MJCF model."""

    joints: Mapping[str, JointLoop]
    """Joint -> its loop; joints without one have their measured drive."""
    period: float = 0.0
    """Time for which an output is held [s]; 0: it acts all the time."""

    kind: ClassVar[str] = "proportional_derivative"

    def __post_init__(self) -> None:
        if not self.joints:
            raise InputError(
                'controller.joints names no joint; write joints.elbow = { position_gain = 60.0, reference = "target" }'
            )
        require_number("controller.period", self.period, low=0.0, unit="s")
        for joint, loop in self.joints.items():
            where = f"controller.joints.{joint}"
            require_number(f"{where}.position_gain", loop.position_gain, above=0.0)
            require_number(f"{where}.velocity_gain", loop.velocity_gain, low=0.0)
            if not loop.limit > 0.0:
                raise InputError(f"{where}.limit = {loop.limit:g}; it must be > 0, or left out")

    def to_dict(self) -> dict[str, Any]:
        """Return the controller as the ``[controller]`` table of a scenario."""
        return {"kind": self.kind, "period": self.period, "joints": {k: v.to_dict() for k, v in self.joints.items()}}


Controller = Cascade | ProportionalDerivative

KINDS: tuple[type[Controller], ...] = (Cascade, ProportionalDerivative)
"""Controllers that a scenario can have."""


def controller_from_dict(table: Mapping[str, Any]) -> Controller:
    """Return the controller of a ``[controller]`` table.

    Raises:
        InputError: unknown kind or key, missing key, or value out of range.
    """
    kind = require_name("controller", str(table.get("kind", "")), [c.kind for c in KINDS])
    return _cascade(table) if kind == Cascade.kind else _joints(table)


def _cascade(table: Mapping[str, Any]) -> Cascade:
    fields = [f.name for f in dataclasses.fields(Cascade)]
    words = [k for k in ("reference", "added") if k in table]
    _require_keys(table, "controller.", [*fields, "kind"], [f for f in fields if f != "added"])
    texts = {k: require_text(f"controller.{k}", table[k]) for k in words}
    numbers = {k: require_number(f"controller.{k}", table[k]) for k in fields if k in table and k not in words}
    return Cascade(**texts, **numbers)  # type: ignore[arg-type]


def _joints(table: Mapping[str, Any]) -> ProportionalDerivative:
    _require_keys(table, "controller.", ["kind", "joints", "period"], ["joints"])
    joints = table["joints"]
    if not isinstance(joints, Mapping):
        raise InputError(f"controller.joints = {joints!r} is not a table of joints; write [controller.joints.elbow]")
    loops: dict[str, JointLoop] = {}
    for joint, loop in cast(Mapping[str, Any], joints).items():
        where = f"controller.joints.{joint}."
        if not isinstance(loop, Mapping):
            raise InputError(f"{where[:-1]} = {loop!r} is not a table; give position_gain and reference")
        entry = cast(Mapping[str, Any], loop)
        fields = [f.name for f in dataclasses.fields(JointLoop)]
        _require_keys(entry, where, fields, ["position_gain", "reference"])
        words = {k: require_text(where + k, entry[k]) for k in ("reference", "factor", "added") if k in entry}
        numbers = {k: require_number(where + k, v) for k, v in entry.items() if k not in words}
        loops[str(joint)] = JointLoop(**words, **numbers)  # type: ignore[arg-type]
    return ProportionalDerivative(joints=loops, period=require_number("controller.period", table.get("period", 0.0)))


def _require_keys(table: Mapping[str, Any], where: str, known: Sequence[str], needed: Sequence[str]) -> None:
    for key in table:
        require_name(f"key {where}", key, known)
    for key in needed:
        if key not in table:
            raise InputError(f"key {where}{key} is missing; add it to [{where[:-1]}]")
