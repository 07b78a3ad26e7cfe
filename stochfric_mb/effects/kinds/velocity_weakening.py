"""Velocity weakening: sliding friction that falls with speed."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import MU_K, SPEED, Effect, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Array, Hypothesis, Slips
from stochfric_mb.effects.traits import POSITIVE, RATE, SHAPES_SLIPS


@dataclasses.dataclass(frozen=True, kw_only=True)
class VelocityWeakening(Effect):
    """mu_k(v) = mu_k + amplitude exp(-(abs(v)/decay_velocity)^shape_exponent).

    Reference: B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30, 1994, 1083-1138,
    doi 10.1016/0005-1098(94)90209-7, eq. 7; the exponent: L. C. Bo, D. Pavelescu, Wear 82, 1982, 277-289,
    doi 10.1016/0043-1648(82)90223-X.
    """

    amplitude: float = parameter("-", "rise of mu_k towards zero speed", scale=0.05, fit_low=0.0)
    """Rise of mu_k towards zero speed [-]."""
    decay_velocity: float = parameter("m/s", "speed over which it falls to 1/e", scale=5.0e-3, low=0.0, strict=True)
    """Speed over which it falls to 1/e [m/s]."""
    shape_exponent: float = parameter("-", "exponent of the speed", scale=1.0, low=0.25, high=4.0, default=1.0)
    """Exponent of the speed [-]: 1, exponential; 2, a Gaussian curve."""

    kind: ClassVar[str] = "velocity_weakening"
    equation: ClassVar[str] = "mu_k(v) = mu_k + amplitude exp(-(abs(v)/decay_velocity)^shape_exponent)"
    source: ClassVar[str] = "Bo and Pavelescu 1982; Armstrong-Helouvry, Dupont and Canudas de Wit 1994, eq. 7"
    group: ClassVar[str] = "friction law"
    traits: ClassVar[frozenset[str]] = frozenset({SHAPES_SLIPS, POSITIVE})
    signatures: ClassVar[tuple[str, ...]] = (RATE,)
    answers_to: ClassVar[str] = "speed"
    separated_by: ClassVar[Mapping[str, str]] = {
        "quadratic_damping": "runs at other belt speeds and normal loads",
    }
    form_axis: ClassVar[str] = "speed"
    shows_on: ClassVar[str] = "relative velocity"
    shows: ClassVar[str] = "friction falls as the sliding velocity rises"
    order: ClassVar[int] = 1

    @classmethod
    def at_joint(cls, span: JointSpan) -> JointSignature:
        """Return a fall of friction over a small, a middling and a large part of the speed."""
        size = 0.1 * span.friction / span.stated_load
        return JointSignature(
            tuple(cls(amplitude=size, decay_velocity=part * span.speed) for part in (0.05, 0.2, 0.6)), "speed", 2
        )

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return N exp(-(v/v_w)**a) in the slip, for decay velocities v_w about the belt's and the slips', and exponents a."""
        speed = slips.relative_velocity
        load = slips.normal_force[:, None]
        fastest = float(np.median(speed.max(axis=1)))
        items: list[Hypothesis] = []
        for exponent, variant in ((1.0, "exponential"), (0.5, "shaped"), (2.0, "shaped")):
            for decay in fastest * np.array([0.05, 0.1, 0.2, 0.4, 0.8]):

                def start(b: Array, decay: float = float(decay), exponent: float = exponent) -> dict[str, float]:
                    return {"amplitude": float(b[0]), "decay_velocity": decay, "shape_exponent": exponent}

                columns = [slips.column(None, load * np.exp(-((speed / decay) ** exponent)))]
                items.append(Hypothesis(cls.kind, columns, (float(decay), exponent), start, variant=variant))
        return items


def friction(world, memory, rates, p):
    """Raise mu_k at low speed."""
    world[MU_K] += p[0] * math.exp(-((world[SPEED] / p[1]) ** p[2]))
