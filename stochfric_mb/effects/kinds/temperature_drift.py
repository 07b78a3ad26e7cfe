"""Temperature drift: coefficients that change with a measured temperature."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import MU_K, MU_S, TEMPERATURE, Array, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Hypothesis, Slips, apart, levels
from stochfric_mb.effects.shapes.course import Course, courses_at_joint, friction_along
from stochfric_mb.effects.shapes.splines import along
from stochfric_mb.effects.traits import COURSE_OF_RUN


@dataclasses.dataclass(frozen=True, kw_only=True)
class TemperatureDrift(Course):
    """mu_k (and mu_s, by its share) times 1 + rate d + curvature d^2 + change s(d/span), d = T - reference_temperature.

    Reference: A. C. Bittencourt, S. Gunnarsson, J. Dyn. Sys., Meas., Control 134, 2012, 051013, doi 10.1115/1.4006589
    (friction of robot joints against temperature); the curvature stands for laws such as Arrhenius' over a range of
    temperatures, s, a sum of cubic B-splines, for one of any smooth shape, as where a lubricant melts.
    """

    span: float = parameter(
        "K", "range of temperatures over which the course runs", scale=10.0, low=0.0, strict=True, infinite=True,
        default=math.inf, fit_prior=0.0, optional=True,
    )  # fmt: skip
    """Range of temperatures over which the course runs [K], from the reference temperature on; nothing changes beyond it."""
    rate: float = parameter("1/K", "relative change per kelvin", scale=1.0e-2, default=0.0, optional=True)
    """Relative change per kelvin [1/K]."""
    reference_temperature: float = parameter("degC", "temperature at which nothing changes", scale=10.0, default=20.0)
    """Temperature at which nothing changes [degC]."""
    static_share: float = parameter("-", "share of the change that mu_s takes", scale=1.0, default=1.0)
    """Share of the change that mu_s takes [-]: 1, both coefficients alike; 0, mu_k alone."""
    curvature: float = parameter("1/K^2", "relative change per kelvin squared", scale=1.0e-4, default=0.0, optional=True)
    """Relative change per kelvin squared [1/K^2]."""
    change: float = parameter("-", "relative size of a course of any shape", scale=0.03, default=0.0, optional=True)
    """Relative size of a course of any shape [-]."""

    kind: ClassVar[str] = "temperature_drift"
    equation: ClassVar[str] = (
        "mu_k times 1 + rate d + curvature d^2 + change s(d/span), d = T - reference_temperature, s of splines; mu_s by share"
    )
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
        """Return friction along the measured temperature, where it changes: straight, curved, or of any smooth shape."""
        # in the slips at every node: one reading of a thermometer is noisier than their mean
        warm, warmer = slips.temperature(slips.onset_time), slips.temperature(slips.node_time)
        if warm is None or warmer is None or not np.ptp(warm):
            return []
        held, kinetic = levels(slips)
        rubbing = kinetic[:, None]
        middle, coldest, width = float(np.median(warm)), float(np.min(warm)), float(np.ptp(warm))
        above, later = (warm - middle) / width, (warmer - middle) / width
        both = [slips.column(held * above**power, rubbing * later**power) for power in (1, 2)]

        def curved(b: Array) -> dict[str, float]:
            return {"rate": float(b[0] / width), "reference_temperature": middle, "curvature": float(b[1] / width**2)}

        straight = apart(cls.kind, held * above, rubbing * later, slips, "rate", {"reference_temperature": middle}, 1.0 / width)
        more = {"reference_temperature": coldest, "rate": 0.0}
        bent = friction_along(cls.kind, (warm - coldest) / width, (warmer - coldest) / width, width, slips, more)
        return [*straight, Hypothesis(cls.kind, both, (), curved, variant="curved"), *bent]

    @classmethod
    def at_joint(cls, span: JointSpan) -> tuple[JointSignature, ...]:
        """Return a drift of a hundredth over the temperatures measured, straight and curved."""
        if span.temperature is None:
            return ()
        middle, width = span.temperature
        straight = cls(rate=0.01 / width, reference_temperature=middle)
        bent = dataclasses.replace(straight, curvature=0.01 / width**2)
        coldest = cls(span=width, reference_temperature=middle - 0.5 * width)
        return (
            JointSignature((straight,), "temperature", 1),
            JointSignature((bent,), "temperature", 2),
            *courses_at_joint(coldest, "temperature"),
        )


def friction(world, memory, rates, p):
    """Multiply both coefficients by the drift."""
    above, span, rate, share, curvature, change = world[TEMPERATURE] - p[21], p[19], p[20], p[22], p[23], p[24]
    changed = (rate + curvature * above) * above
    if change != 0.0:
        changed += change * along(p, above / span)
    world[MU_S] *= 1.0 + share * changed
    world[MU_K] *= 1.0 + changed
