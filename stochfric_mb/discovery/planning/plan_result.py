"""What is said of planned runs (schema ``stochfric.planned/1``)."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

SCHEMA = "stochfric.planned/1"
"""Schema of ``plan.json``."""


@dataclasses.dataclass(frozen=True)
class Limit:
    """The size from which on an effect would be named."""

    kind: str
    """The effect."""
    parameter: str
    """The parameter that is its size."""
    unit: str
    """Its unit."""
    value: float
    """The detection limit."""
    beside: Mapping[str, float | str]
    """Other numbers that it belongs to [SI]."""
    units_beside: Mapping[str, str]
    """Units of those that are not words."""
    at_most: bool = False
    """Whether the limit is an upper bound."""


@dataclasses.dataclass(frozen=True)
class Pair:
    """Two effects that the runs do not distinguish."""

    first: str
    """One of them."""
    second: str
    """The other."""
    told_apart_from: float | None
    """Size over the detection limit from which on they are distinguished [-]; None: at no size."""


@dataclasses.dataclass(frozen=True)
class ExtraRun:
    """A run beside the planned ones, and what it adds."""

    text: str
    """What to do."""
    settings: Mapping[str, float]
    """Numbers of the run that differ from those of the first planned one."""
    shows: tuple[str, ...]
    """Effects that could be seen with it and not without."""
    separates: tuple[tuple[str, str], ...]
    """Pairs that are distinguished with it and not without."""
    limits: float
    """Detection limits with it over those without, geometric mean [-]."""


@dataclasses.dataclass(frozen=True)
class Plan:
    """What planned runs could show."""

    runs: tuple[dict[str, Any], ...]
    """The runs, as they were simulated."""
    limits: tuple[Limit, ...]
    """Detection limits, by kind."""
    unseen: Mapping[str, str]
    """Effect that the runs cannot show at any size -> what would show it."""
    no_limit: tuple[str, ...]
    """Effects that discovery looks for by a detector, for which no limit is computed."""
    pairs: tuple[Pair, ...]
    """Effects that the runs do not distinguish."""
    extra: tuple[ExtraRun, ...]
    """Further runs, the most useful one first."""
    rotational: bool = False
    """Whether friction acts about an axis: strokes are in rad and forces in N m."""
    notes: tuple[str, ...] = ()
    """What a reader should know: numbers that were assumed."""

    def to_dict(self) -> dict[str, Any]:
        """Return the content of ``plan.json``."""
        return {"schema": SCHEMA} | dataclasses.asdict(self) | {"unseen": dict(self.unseen)}
