"""A user's own MuJoCo model, with the joints and tendons in which friction acts and the channels mapped to it."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar, cast

from stochfric_mb.errors import InputError, require_name, require_number


@dataclasses.dataclass(frozen=True, kw_only=True)
class Drive:
    """A measured driving force: gain times the product of columns."""

    columns: tuple[str, ...]
    """Channels or covariates that are multiplied, such as duty cycle and supply voltage."""
    gain: float = 1.0
    """Force or torque per unit of the product."""

    def to_dict(self) -> dict[str, Any]:
        """Return the drive as a table."""
        return {"columns": list(self.columns), "gain": self.gain}


@dataclasses.dataclass(frozen=True, kw_only=True)
class Mjcf:
    """Any MuJoCo model: inverse dynamics by ``mj_inverse``, friction in the joints and tendons that are named.

    Every joint that moves needs a measured position; friction is sought where ``friction`` names a load.
    """

    file: Path
    """The MJCF file."""
    friction: Mapping[str, float]
    """Joint or tendon in which friction acts -> its load [N, for a hinge N m]: friction is mu times load."""
    positions: Mapping[str, str]
    """Joint -> channel or covariate of its position [m or rad]."""
    drives: Mapping[str, Drive]
    """Joint or tendon -> what drives it, as measured; one that is not named is not driven."""
    tendons: tuple[str, ...] = ()
    """Tendons that may be named in the place of joints."""
    damping: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Joint -> damping beyond the model's own, such as back-EMF [N s/m or N m s/rad]."""
    offset: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Joint or tendon -> constant force against its coordinate [N or N m]."""
    factors: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """``mass``, ``armature`` -> factor on the model's own, as corrected by data [-]."""
    effects_in: tuple[str, ...] = ()
    """Joints and tendons in which the scenario's effects act; empty: all that have friction."""

    kind: ClassVar[str] = "mjcf"
    rotational: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if not self.friction:
            raise InputError("mechanism.friction names no joint; write friction = { elbow = 1.0 } (joint and its load)")
        for joint, load in self.friction.items():
            require_number(f"mechanism.friction.{joint}", load, above=0.0, unit="N or N m")
            require_name(
                "joint of mechanism.friction (a joint of mechanism.positions, or one of mechanism.tendons)", joint, self.known
            )
        for name, factor in self.factors.items():
            require_name("key mechanism.factors.", name, ("mass", "armature"))
            require_number(f"mechanism.factors.{name}", factor, low=0.0)
        for joint in self.damping:
            require_name("joint (a joint of mechanism.positions)", joint, self.positions)
        for place in (*self.drives, *self.offset, *self.effects_in):
            require_name("joint (a joint of mechanism.positions, or one of mechanism.tendons)", place, self.known)

    @property
    def known(self) -> list[str]:
        """Joints and tendons by name."""
        return [*self.positions, *self.tendons]

    @property
    def normal_force(self) -> float:
        """Load of the first joint with friction [N or N m]."""
        return next(iter(self.friction.values()))

    @classmethod
    def from_table(cls, table: Mapping[str, Any], folder: Path) -> Mjcf:
        """Return the mechanism of a ``[mechanism]`` table; its file is relative to ``folder``.

        Raises:
            InputError: unknown, missing or unusable key.
        """
        fields = [f.name for f in dataclasses.fields(cls)]
        if "pairs" in table:
            raise InputError(
                f"mechanism.pairs = {table['pairs']!r}: friction is sought in joints and tendons, not in contact pairs, whose "
                "normal force no record holds; give the joint along which the bodies slide, and the load as its friction"
            )
        for key in table:
            require_name("key mechanism.", key, [*fields, "kind"])
        for key in ("file", "friction", "positions"):
            if key not in table:
                raise InputError(f"key mechanism.{key} is missing; add it to [mechanism]")
        return cls(
            file=(folder / str(table["file"])).resolve(),
            friction=_numbers(table, "friction"),
            positions={k: str(v) for k, v in _table(table, "positions").items()},
            drives={k: _drive(k, v) for k, v in _table(table, "drives").items()},
            tendons=_names(table, "tendons"),
            effects_in=_names(table, "effects_in"),
            **{key: _numbers(table, key) for key in ("damping", "offset", "factors")},
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the mechanism as the ``[mechanism]`` table of a scenario."""
        return {
            "kind": self.kind,
            "file": str(self.file),
            "friction": dict(self.friction),
            "positions": dict(self.positions),
            "drives": {joint: drive.to_dict() for joint, drive in self.drives.items()},
            "damping": dict(self.damping),
            "offset": dict(self.offset),
            "factors": dict(self.factors),
            "tendons": list(self.tendons),
            "effects_in": list(self.effects_in),
        }


def _table(table: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    value = table.get(key, {})
    if not isinstance(value, Mapping):
        raise InputError(f"mechanism.{key} = {value!r} is not a table of joints; write {key} = {{ elbow = ... }}")
    return cast(Mapping[str, Any], value)


def _names(table: Mapping[str, Any], key: str) -> tuple[str, ...]:
    value = table.get(key, [])
    if not isinstance(value, list):
        raise InputError(f'mechanism.{key} = {value!r} is not a list of names; write {key} = ["cable"]')
    return tuple(str(name) for name in cast(list[Any], value))


def _numbers(table: Mapping[str, Any], key: str) -> dict[str, float]:
    return {k: require_number(f"mechanism.{key}.{k}", v) for k, v in _table(table, key).items()}


def _drive(joint: str, value: Any) -> Drive:
    table: Mapping[str, Any] = {"columns": [value]} if isinstance(value, str) else value
    columns = table.get("columns") if isinstance(table, Mapping) else None
    if not isinstance(columns, list) or not columns:
        raise InputError(
            f'mechanism.drives.{joint} = {value!r}; give a channel, or {{ columns = ["duty", "voltage"], gain = 0.4 }}'
        )
    for key in table:
        require_name(f"key mechanism.drives.{joint}.", key, ("columns", "gain"))
    return Drive(
        columns=tuple(str(c) for c in cast(list[Any], columns)),
        gain=require_number(f"mechanism.drives.{joint}.gain", table.get("gain", 1.0)),
    )
