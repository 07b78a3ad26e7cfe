"""Velocity weakening: sliding friction that falls with speed."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import itertools
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
    """mu_k(v) = mu_k + amplitude exp(-s), s = (abs(v)/decay_velocity)^shape_exponent.

    With a tail it is mu_k + amplitude (1 + tail s)^(-1/tail), from which a tail of 0 is the limit.

    Reference: B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30, 1994, 1083-1138,
    doi 10.1016/0005-1098(94)90209-7, eq. 7; the exponent: L. C. Bo, D. Pavelescu, Wear 82, 1982, 277-289,
    doi 10.1016/0043-1648(82)90223-X; 1/(1 + s): D. P. Hess, A. Soom, J. Tribol. 112, 1990, 147-152, doi 10.1115/1.2920220
    (exponent 2), N. Hinrichs, M. Oestreich, K. Popp, J. Sound Vib. 216, 1998, 435-459, doi 10.1006/jsvi.1998.1736 (exponent 1).
    """

    amplitude: float = parameter("-", "rise of mu_k towards zero speed", scale=0.05, fit_low=0.0)
    """Rise of mu_k towards zero speed [-]."""
    decay_velocity: float = parameter("m/s", "speed over which it falls to 1/e", scale=5.0e-3, low=0.0, strict=True)
    """Speed over which it falls to 1/e, with a tail of 1 to one half [m/s]."""
    shape_exponent: float = parameter("-", "exponent of the speed", scale=1.0, low=0.25, high=4.0, default=1.0)
    """Exponent of the speed [-]: 1, exponential; 2, a Gaussian curve."""
    tail: float = parameter(
        "-", "how slowly it levels off: 0, as an exponential; 1, as 1/(1 + s)", scale=1.0, low=0.0, high=4.0, default=0.0
    )
    """How slowly it levels off [-]: 0, as exp(-s); 1, as 1/(1 + s)."""

    kind: ClassVar[str] = "velocity_weakening"
    equation: ClassVar[str] = (
        "mu_k(v) = mu_k + amplitude exp(-s), s = (abs(v)/decay_velocity)^shape_exponent, or amplitude (1 + tail s)^(-1/tail)"
    )
    source: ClassVar[str] = (
        "Bo and Pavelescu 1982; Armstrong-Helouvry, Dupont and Canudas de Wit 1994, eq. 7; Hess and Soom 1990"
    )
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
        """Return a fall of friction over a small, a middling and a large part of the speed, exponential or as 1/(1 + s)."""
        size = 0.1 * span.friction / span.stated_load
        parts = itertools.product((0.05, 0.2, 0.6), (0.0, 1.0))
        falls = tuple(cls(amplitude=size, decay_velocity=part * span.speed, tail=tail) for part, tail in parts)
        return JointSignature(falls, "speed", 2)

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return N exp(-(v/v_w)^a) and N/(1 + v/v_w) in the slip, for v_w up to the speed of the slips, and exponents a."""
        speed = slips.relative_velocity
        load = slips.normal_force[:, None]
        fastest = float(np.median(speed.max(axis=1)))
        items: list[Hypothesis] = []
        for exponent, tail, variant in (
            (1.0, 0.0, "exponential"),
            (1.0, 1.0, "hyperbolic"),
            (0.5, 0.0, "shaped"),
            (2.0, 0.0, "shaped"),
        ):
            for decay in fastest * np.array([0.05, 0.1, 0.2, 0.4, 0.8]):
                form = {"decay_velocity": float(decay), "shape_exponent": exponent, "tail": tail}
                fall = cls(amplitude=1.0, **form)

                def start(b: Array, form: dict[str, float] = form) -> dict[str, float]:
                    return {"amplitude": float(b[0])} | form

                columns = [slips.column(None, load * fall.curve(speed))]
                items.append(Hypothesis(cls.kind, columns, (float(decay), exponent, tail), start, variant=variant))
        return items

    def curve(self, speed: Array) -> Array:
        """Return the rise of mu_k at speeds [m/s], of the same shape [-]."""
        fall = (speed / self.decay_velocity) ** self.shape_exponent
        return self.amplitude * np.exp(-fall if self.tail == 0.0 else -np.log1p(self.tail * fall) / self.tail)


def friction(world, memory, rates, p):
    """Raise mu_k at low speed."""
    fall = (world[SPEED] / p[1]) ** p[2]
    # (1 + tail s)^(-1/tail), to rounding for any tail
    world[MU_K] += p[0] * math.exp(-fall if p[3] <= 0.0 else -math.log1p(p[3] * fall) / p[3])
