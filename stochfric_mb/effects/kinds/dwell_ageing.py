"""Dwell ageing: static friction that grows with the time in stick."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import DWELL, MU_S, Effect, parameter
from stochfric_mb.effects.marks import Hypothesis, Slips
from stochfric_mb.effects.traits import BETWEEN_POINTS, POSITIVE

ONSETS = (0.765, 2.55, 7.65, 25.5)
"""Dwells at which growth may set in, as angles of the natural oscillation [rad]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class DwellAgeing(Effect):
    """mu_s = mu_s + rate ln(1 + dwell/time_constant).

    Reference: J. H. Dieterich, J. Geophys. Res. 77, 1972, 3690-3697, doi 10.1029/JB077i020p03690.
    """

    rate: float = parameter("-", "growth per e-fold of dwell", scale=0.02)
    """Growth per e-fold of dwell [-]."""
    time_constant: float = parameter("s", "dwell at which growth sets in", scale=0.1, low=0.0, strict=True, default=0.1)
    """Dwell at which growth sets in [s]."""

    kind: ClassVar[str] = "dwell_ageing"
    equation: ClassVar[str] = "mu_s = mu_s + rate ln(1 + dwell/time_constant)"
    source: ClassVar[str] = "Dieterich 1972; Ruina 1983"
    group: ClassVar[str] = "friction law"
    answers_to: ClassVar[str] = "dwell"
    traits: ClassVar[frozenset[str]] = frozenset({BETWEEN_POINTS, POSITIVE})
    shows_on: ClassVar[str] = "dwell"
    shows: ClassVar[str] = "the force at break-away depends on how long the contact has stuck"
    order: ClassVar[int] = 1

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return N ln(1 + dwell/tau) at the onset, where the dwell differs enough between slips to show it."""
        if np.std(np.log(slips.dwell)) < 0.08:
            return []
        return [
            Hypothesis(
                cls.kind,
                [slips.column(slips.normal_force * np.log1p(slips.dwell / tau), None)],
                (float(tau),),
                lambda b, tau=tau: {"rate": float(b[0]), "time_constant": float(tau)},
            )
            for tau in np.array(ONSETS) / slips.slips[0].record.angular_frequency
        ]


def friction(world, memory, rates, p):
    """Raise mu_s with the dwell."""
    world[MU_S] += p[0] * math.log(1.0 + world[DWELL] / p[1])
