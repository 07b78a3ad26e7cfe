"""Velocity weakening: sliding friction that falls with speed."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

from stochfric_mb.effects.contract import MU_K, SPEED, Effect, parameter


@dataclasses.dataclass(frozen=True, kw_only=True)
class VelocityWeakening(Effect):
    """mu_k(v) = mu_k + amplitude exp(-abs(v)/decay_velocity).

    Reference: B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30, 1994, 1083-1138,
    doi 10.1016/0005-1098(94)90209-7, eq. 7.
    """

    amplitude: float = parameter("-", "rise of mu_k towards zero speed", scale=0.05)
    """Rise of mu_k towards zero speed [-]."""
    decay_velocity: float = parameter("m/s", "speed over which it falls to 1/e", scale=5.0e-3, low=0.0, strict=True)
    """Speed over which it falls to 1/e [m/s]."""

    kind: ClassVar[str] = "velocity_weakening"
    equation: ClassVar[str] = "mu_k(v) = mu_k + amplitude exp(-abs(v)/decay_velocity)"
    source: ClassVar[str] = "Bo and Pavelescu 1982; Armstrong-Helouvry, Dupont and Canudas de Wit 1994, eq. 7"
    group: ClassVar[str] = "friction law"
    order: ClassVar[int] = 1


def friction(world, memory, rates, p):
    """Raise mu_k at low speed."""
    world[MU_K] += p[0] * math.exp(-world[SPEED] / p[1])
