"""Backlash: a gap in the spring's line of force."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import LOAD, POSITION, STIFFNESS, Effect, parameter
from stochfric_mb.effects.marks import Array, Hypothesis, Slips
from stochfric_mb.effects.traits import POSITIVE, SHAPES_SLIPS


@dataclasses.dataclass(frozen=True, kw_only=True)
class Backlash(Effect):
    """Spring force k x - k (min(max(x - position, 0), gap) - share_below gap): it stays the same while x passes the gap.

    Above the gap the spring is shifted by (1 - share_below) gap, below it by -share_below gap: where the spring counts
    as unloaded depends on the side on which the position was set to zero.

    Reference: M. Nordin, P.-O. Gutman, Automatica 38, 2002, 1633-1649, doi 10.1016/S0005-1098(02)00047-X.
    """

    gap: float = parameter("m", "width of the gap", scale=1.0e-4, low=0.0)
    """Width of the gap [m]."""
    position: float = parameter("m", "position at which the gap opens", scale=1.0e-3)
    """Position at which the gap opens [m]."""
    share_below: float = parameter("-", "share of the gap by which the spring is shifted below it", scale=0.5, default=0.0)
    """Share of the gap by which the spring is shifted below it [-]."""

    kind: ClassVar[str] = "backlash"
    equation: ClassVar[str] = "spring force k x - k (min(max(x - position, 0), gap) - share_below gap)"
    source: ClassVar[str] = "Nordin and Gutman 2002"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({SHAPES_SLIPS, POSITIVE})
    separated_by: ClassVar[Mapping[str, str]] = {
        "second_mode": "a free decay or an impact test of the box, lifted off the belt",
        "nonlinear_stiffness": "a quasi-static load test of the spring",
    }
    form_axis: ClassVar[str] = "position"
    shows_on: ClassVar[str] = "position of the box"
    shows: ClassVar[str] = "the restoring force has a dead zone"

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return the spring force that a narrow dead zone takes away, for places of the zone along the slip.

        Where directions or loads differ, so does the friction that a shift of the whole spring would look like: the side of
        the gap on which the spring counts as unloaded is then left open.
        """
        width = 0.02 * float(np.median(slips.typical_onset))
        if width <= 0.0:
            return []
        stiffness = slips.per_run(lambda s: s.record.mechanism.stiffness)
        back = slips.direction < 0
        low, high = np.quantile(slips.typical_position, (0.08, 0.92))
        places = list(np.linspace(low, high, 16))
        if back.any():
            places += list(-np.linspace(low, high, 16) - width)
        shift = slips.column(*(2 * [-slips.direction * stiffness * width]))
        shifted = back.any() or np.ptp(slips.normal_force) > 0.05 * slips.normal_force.mean()

        def passed(x: Array, place: float) -> Array:
            """Return how much of the gap is passed, seen in the mirrored frame of runs with a reversed belt."""
            away = back if x.ndim == 1 else back[:, None]
            return np.where(away, np.clip(x + place + width, 0.0, width) - width, np.clip(x - place, 0.0, width))

        def start(b: Array, place: float) -> dict[str, float]:
            table = {"gap": float(abs(b[0]) * width), "position": place}
            return table | ({"share_below": float(np.clip(b[1] / b[0], 0.05, 0.95))} if len(b) > 1 and b[0] != 0.0 else {})

        hypotheses: list[Hypothesis] = []
        for place in map(float, places):
            nodes = stiffness[:, None] * passed(slips.typical_position, place)
            columns = [slips.column(stiffness * passed(slips.typical_onset, place), nodes)]
            columns += [shift] if shifted else []
            hypotheses.append(Hypothesis(cls.kind, columns, (place,), lambda b, place=place: start(b, place)))
        return hypotheses


def surroundings(world, memory, rates, p):
    """Take the force that the gap does not pass on."""
    world[LOAD] += world[STIFFNESS] * (min(max(world[POSITION] - p[1], 0.0), p[0]) - p[2] * p[0])
