"""Parts of a user's own MuJoCo model: what drives it, pairs of geoms in which friction acts, and their tables."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, cast

from stochfric_mb.errors import InputError, require_name, require_number, require_text


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
class Pair:
    """Two geoms that slide on each other along one line."""

    geoms: tuple[str, str]
    """Geom of the body that slides, and of the surface on which it does; the line is fixed to the latter."""
    normal_force: str = ""
    """Channel or covariate of the normal force [N]; empty: from the balance of the joints, which the contact holds."""

    def to_dict(self) -> dict[str, Any]:
        """Return the pair as a table."""
        return {"geoms": list(self.geoms)} | ({"normal_force": self.normal_force} if self.normal_force else {})


def pair_from(name: str, value: Any) -> Pair:
    """Return the pair that a table describes."""
    table: Mapping[str, Any] = {"geoms": value} if isinstance(value, list) else value
    geoms = table.get("geoms") if isinstance(table, Mapping) else None
    if not isinstance(geoms, list) or len(cast(list[Any], geoms)) != 2:
        raise InputError(
            f'mechanism.pairs.{name} = {value!r} names no two geoms; write {name} = {{ geoms = ["block", "rail"] }}'
        )
    for key in table:
        require_name(f"key of mechanism.pairs.{name}", key, ("geoms", "normal_force"))
    body, surface = (str(g) for g in cast(list[Any], geoms))
    return Pair(geoms=(body, surface), normal_force=str(table.get("normal_force", "")))


def positions_from(table: Mapping[str, Any]) -> dict[str, str | float]:
    """Return the column of each joint's position, or the number where a joint stays."""
    return {
        k: require_number(f"mechanism.positions.{k}", v) if isinstance(v, int | float) else str(v)
        for k, v in table_of(table, "positions").items()
    }


OF_MODEL = {"factors": ("factors", "mass = 1.1"), "payload": ("masses", "end = 0.5")}
"""Tables whose keys are no joints -> what they hold, and an example."""


def table_of(table: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    """Return a table, of joints mostly; an empty one if there is none."""
    value = table.get(key, {})
    if not isinstance(value, Mapping):
        of, example = OF_MODEL.get(key, ("joints", "elbow = ..."))
        raise InputError(f"mechanism.{key} = {value!r} is not a table of {of}; write {key} = {{ {example} }}")
    return cast(Mapping[str, Any], value)


def names_of(table: Mapping[str, Any], key: str) -> tuple[str, ...]:
    """Return a list of names; an empty one if there is none."""
    value = table.get(key, [])
    if not isinstance(value, list):
        raise InputError(f'mechanism.{key} = {value!r} is not a list of names; write {key} = ["cable"]')
    return tuple(require_text(f"mechanism.{key}", name) for name in cast(list[Any], value))


def numbers_of(table: Mapping[str, Any], key: str) -> dict[str, float]:
    """Return a table of numbers."""
    return {k: require_number(f"mechanism.{key}.{k}", v) for k, v in table_of(table, key).items()}


def drive_from(joint: str, value: Any) -> Drive:
    """Return the drive that a column or a table describes."""
    table: Mapping[str, Any] = {"columns": [value]} if isinstance(value, str) else value
    columns = table.get("columns") if isinstance(table, Mapping) else None
    if not isinstance(columns, list) or not columns:
        raise InputError(
            f'mechanism.drives.{joint} = {value!r}; give a channel, or {{ columns = ["duty", "voltage"], gain = 0.4 }}'
        )
    for key in table:
        require_name(f"key of mechanism.drives.{joint}", key, ("columns", "gain"))
    return Drive(
        columns=tuple(require_text(f"mechanism.drives.{joint}.columns", c) for c in cast(list[Any], columns)),
        gain=require_number(f"mechanism.drives.{joint}.gain", table.get("gain", 1.0)),
    )
