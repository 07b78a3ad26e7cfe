"""Temperature drift: coefficients that change with a measured temperature."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import MU_K, MU_S, TEMPERATURE, Array, Effect, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Hypothesis, Slips, apart, levels
from stochfric_mb.effects.traits import COURSE_OF_RUN


@dataclasses.dataclass(frozen=True, kw_only=True)
class TemperatureDrift(Effect):
    """mu_k (and mu_s, by its share) times 1 + rate d + curvature d^2, d = T - reference_temperature.

    Reference: A. C. Bittencourt, S. Gunnarsson, J. Dyn. Sys., Meas., Control 134, 2012, 051013, doi 10.1115/1.4006589
    (friction of robot joints against temperature); the curvature stands for laws such as Arrhenius' over a range of
    temperatures.
    """

    rate: float = parameter("1/K", "relative change per kelvin", scale=1.0e-2)
    """Relative change per kelvin [1/K]."""
    reference_temperature: float = parameter("degC", "temperature at which nothing changes", scale=10.0, default=20.0)
    """Temperature at which nothing changes [degC]."""
    static_share: float = parameter("-", "share of the change that mu_s takes", scale=1.0, default=1.0)
    """Share of the change that mu_s takes [-]: 1, both coefficients alike; 0, mu_k alone."""
    curvature: float = parameter("1/K^2", "relative change per kelvin squared", scale=1.0e-4, default=0.0, optional=True)
    """Relative change per kelvin squared [1/K^2]."""

    kind: ClassVar[str] = "temperature_drift"
    equation: ClassVar[str] = "mu_k times 1 + rate d + curvature d^2, d = T - reference_temperature, mu_s by its share"
    source: ClassVar[str] = "Bittencourt and Gunnarsson 2012 (friction of robot joints)"
    group: ClassVar[str] = "friction varies"
    traits: ClassVar[frozenset[str]] = frozenset({COURSE_OF_RUN})
    answers_to: ClassVar[str] = "temperature"
    shows_on: ClassVar[str] = "temperature"
    shows: ClassVar[str] = "friction changes with temperature"
    order: ClassVar[int] = 3
    reads: ClassVar[tuple[str, ...]] = ("temperature",)

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return friction along the measured temperature, straight and curved, where it changes."""
        held, rubbing = levels(slips)
        warm, warmer = slips.temperature(slips.onset_time), slips.temperature(slips.mean_time)
        if warm is None or warmer is None or not np.ptp(warm):
            return []
        middle, width = float(np.median(warm)), float(np.ptp(warm))
        above, later = (warm - middle) / width, (warmer - middle) / width
        both = [slips.column(held * above**power, rubbing * later**power) for power in (1, 2)]

        def curved(b: Array) -> dict[str, float]:
            return {"rate": float(b[0] / width), "reference_temperature": middle, "curvature": float(b[1] / width**2)}

        straight = apart(cls.kind, held * above, rubbing * later, slips, "rate", {"reference_temperature": middle}, 1.0 / width)
        return [*straight, Hypothesis(cls.kind, both, (), curved, variant="curved")]

    @classmethod
    def at_joint(cls, span: JointSpan) -> tuple[JointSignature, ...]:
        """Return a drift of a hundredth over the temperatures measured, straight and curved."""
        if span.temperature is None:
            return ()
        middle, width = span.temperature
        straight = cls(rate=0.01 / width, reference_temperature=middle)
        bent = dataclasses.replace(straight, curvature=0.01 / width**2)
        return JointSignature((straight,), "temperature", 1), JointSignature((bent,), "temperature", 2)


def friction(world, memory, rates, p):
    """Multiply both coefficients by the drift."""
    above = world[TEMPERATURE] - p[1]
    changed = (p[0] + p[3] * above) * above
    world[MU_S] *= 1.0 + p[2] * changed
    world[MU_K] *= 1.0 + changed
