"""An effect of your own: a polished spot on the rail on which the box slides, found by discovery like those of the package.

One file: the equation, the parameters with units, what it does to the friction, and the marks it leaves in the slips. In a
package of your own, an entry point makes it known to every command::

    [project.entry-points."stochfric_mb.effects"]
    rail_spot = "my_rig.effect_rail_spot:RailSpot"

In a script, ``stochfric_mb.effects.register_effect(RailSpot)`` does the same.
"""

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import MU_K, MU_S, POSITION, Effect, parameter
from stochfric_mb.effects.marks import Hypothesis, Slips


@dataclasses.dataclass(frozen=True, kw_only=True)
class RailSpot(Effect):
    """mu_s and mu_k times 1 - depth exp(-((x - place)/width)^2/2)."""

    depth: float = parameter("-", "share of the friction that the spot lacks", scale=0.1, low=0.0, high=0.9)
    place: float = parameter("m", "where it is", scale=1e-3)
    width: float = parameter("m", "how wide it is", scale=1e-4, low=0.0, strict=True)

    kind: ClassVar[str] = "rail_spot"
    equation: ClassVar[str] = "mu_s and mu_k times 1 - depth exp(-((x - place)/width)^2/2)"
    source: ClassVar[str] = "my rig, 2026"
    group: ClassVar[str] = "friction varies"
    order: ClassVar[int] = 3
    shows_on: ClassVar[str] = "position of the box"
    shows: ClassVar[str] = "friction is low where the rail is polished"

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return what a shallow spot takes from the friction, for places and widths along the slip."""
        low, high = np.quantile(slips.typical_position, (0.02, 0.98))
        hypotheses: list[Hypothesis] = []
        for place in np.linspace(low, high, 24):
            for width in (high - low) * np.array([0.06, 0.12, 0.24]):
                onset = np.exp(-0.5 * ((slips.typical_onset - place) / width) ** 2)
                in_slip = np.exp(-0.5 * ((slips.typical_position - place) / width) ** 2)
                column = slips.column(-slips.static * onset, -slips.kinetic[:, None] * in_slip)
                start = lambda b, at=place, w=width: {"depth": float(b[0]), "place": float(at), "width": float(w)}  # noqa: E731
                hypotheses.append(Hypothesis(cls.kind, [column], (place, width), start))
        return hypotheses


def friction(world, memory, rates, p):
    """Take the friction of the spot away; called by every engine, so plain numbers and ``math`` only."""
    share = 1.0 - p[0] * math.exp(-0.5 * ((world[POSITION] - p[1]) / p[2]) ** 2)
    world[MU_S] *= share
    world[MU_K] *= share
