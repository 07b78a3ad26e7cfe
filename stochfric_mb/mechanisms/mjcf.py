"""A user's own MuJoCo model, with the joints, tendons or pair in which friction acts and the channels mapped to it."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar

from stochfric_mb.errors import InputError, require_name, require_number, require_text
from stochfric_mb.mechanisms.mjcf_parts import (
    Drive,
    Pair,
    drive_from,
    names_of,
    numbers_of,
    pair_from,
    positions_from,
    table_of,
)

CORRECTED = {"mass": "-", "armature": "-", "gain": "-", "damping": "-", "offset": "N"}
"""What data may correct: factors on masses, armature, drive and damping of the joint, and an offset of its drive."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Mjcf:
    """Any MuJoCo model: inverse dynamics by ``mj_inverse``, friction in the joints, tendons or pair that are named.

    Every joint that moves needs a measured position; friction is sought where ``friction`` names a load.
    """

    file: Path
    """The MJCF file."""
    friction: Mapping[str, float]
    """Joint, tendon or pair in which friction acts -> its load [N, for a hinge N m]: friction is mu times load."""
    positions: Mapping[str, str | float]
    """Joint -> channel or covariate of its position [m or rad], or the position at which it stays."""
    drives: Mapping[str, Drive]
    """Joint or tendon -> what drives it, as measured; one that is not named is not driven."""
    tendons: tuple[str, ...] = ()
    """Tendons that may be named in the place of joints."""
    pairs: Mapping[str, Pair] = dataclasses.field(default_factory=dict[str, Pair])
    """Name of a pair, as ``friction`` has it -> its geoms. Its load: the normal force at which coefficients are stated."""
    damping: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Joint -> damping beyond the model's own, such as back-EMF [N s/m or N m s/rad]."""
    offset: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Joint or tendon -> constant force against its coordinate [N or N m]."""
    factors: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """``mass``, ``armature`` -> factor on the model's own, as corrected by data [-]."""
    payload: Mapping[str, float] = dataclasses.field(default_factory=dict[str, float])
    """Mass beside the model's own in the body at the end of the longest chain of joints [kg], as points: ``centre``, at its
    centre of mass, and ``end``, at the far end of its geoms."""
    effects_in: tuple[str, ...] = ()
    """Joints and tendons in which the scenario's effects act; empty: all that have friction."""

    kind: ClassVar[str] = "mjcf"
    rotational: ClassVar[bool | None] = None

    def __post_init__(self) -> None:
        if not self.friction:
            raise InputError("mechanism.friction names no joint; write friction = { elbow = 1.0 } (joint and its load)")
        for joint, load in self.friction.items():
            require_number(f"mechanism.friction.{joint}", load, above=0.0, unit="N or N m")
            require_name(
                "joint of mechanism.friction (a joint of mechanism.positions, or one of mechanism.tendons or mechanism.pairs)",
                joint,
                self.known,
            )
        if set(self.friction) & set(self.pairs) and len(self.friction) > 1:
            raise InputError(
                f"mechanism.friction names {', '.join(self.friction)}: friction in a pair is sought by itself; leave one of "
                "them, and give what is known of others as damping"
            )
        for name, factor in self.factors.items():
            require_name("key of mechanism.factors", name, ("mass", "armature"))
            require_number(f"mechanism.factors.{name}", factor, low=0.0)
        for name, mass in self.payload.items():
            require_name("key of mechanism.payload", name, ("centre", "end"))
            require_number(f"mechanism.payload.{name}", mass, low=0.0, unit="kg")
        for joint in self.damping:
            require_name("joint (a joint of mechanism.positions)", joint, self.positions)
        for place in self.drives:
            require_name(
                "joint (a joint of mechanism.positions, or one of mechanism.tendons)", place, [*self.positions, *self.tendons]
            )
        for place in (*self.offset, *self.effects_in):
            require_name("joint (a joint of mechanism.positions, or one of mechanism.tendons)", place, self.known)

    @property
    def known(self) -> list[str]:
        """Joints, tendons and pairs by name."""
        return [*self.positions, *self.tendons, *self.pairs]

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
        for key in table:
            require_name("key of mechanism", key, [*fields, "kind"])
        for key in ("file", "friction", "positions"):
            if key not in table:
                raise InputError(f"key mechanism.{key} is missing; add it to [mechanism]")
        return cls(
            file=(folder / require_text("mechanism.file", table["file"])).resolve(),
            friction=numbers_of(table, "friction"),
            positions=positions_from(table),
            drives={k: drive_from(k, v) for k, v in table_of(table, "drives").items()},
            tendons=names_of(table, "tendons"),
            pairs={k: pair_from(k, v) for k, v in table_of(table, "pairs").items()},
            effects_in=names_of(table, "effects_in"),
            **{key: numbers_of(table, key) for key in ("damping", "offset", "factors", "payload")},
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
            "payload": dict(self.payload),
            "tendons": list(self.tendons),
            "pairs": {name: pair.to_dict() for name, pair in self.pairs.items()},
            "effects_in": list(self.effects_in),
        }
