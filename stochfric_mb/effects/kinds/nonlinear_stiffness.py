"""Nonlinear stiffness: a quadratic and a cubic part of the spring force."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import LOAD, POSITION, Effect, parameter
from stochfric_mb.effects.marks import Array, Hypothesis, Slips
from stochfric_mb.effects.traits import SHAPES_SLIPS


@dataclasses.dataclass(frozen=True, kw_only=True)
class NonlinearStiffness(Effect):
    """Spring force k x + quadratic x abs(x) + cubic x^3; beyond ``reach`` it goes on along its tangent.

    A polynomial says nothing of deflections beyond those that it was fitted to: a spring that softens there would run away.

    Reference: G. Duffing, Erzwungene Schwingungen bei veraenderlicher Eigenfrequenz, Vieweg 1918.
    """

    cubic: float = parameter("N/m^3", "spring force per cube of the deflection", scale=1.0e8)
    """Spring force per cube of the deflection [N/m^3]."""
    quadratic: float = parameter("N/m^2", "spring force per square of the deflection", scale=2.0e5, default=0.0, optional=True)
    """Spring force per square of the deflection [N/m^2]."""
    reach: float = parameter(
        "m", "deflection beyond which the force goes on along its tangent", scale=0.01, low=0.0, strict=True, infinite=True,
        default=math.inf, fit_prior=0.0,
    )  # fmt: skip
    """Deflection beyond which the force goes on along its tangent [m]."""

    kind: ClassVar[str] = "nonlinear_stiffness"
    equation: ClassVar[str] = "spring force k x + quadratic x abs(x) + cubic x^3, along its tangent beyond reach"
    source: ClassVar[str] = "Duffing 1918"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({SHAPES_SLIPS})
    answers_to: ClassVar[str] = "position"
    frees: ClassVar[tuple[str, ...]] = ("stiffness",)
    form_axis: ClassVar[str] = "position"
    shows_on: ClassVar[str] = "position of the box"
    shows: ClassVar[str] = "the restoring force is not linear in position"

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return -x^3, and -x|x| with it, in stick and slip, along the typical slip; the stiffness at rest is left open.

        Over a short slip the three are nearly alike, and a fit from their sum need not find the cube alone: two variants.
        """
        onset, position = slips.typical_onset, slips.typical_position
        scale = float(np.median(np.abs(onset)))
        reach = float(max(np.abs(onset).max(), np.abs(position).max()))
        stiffness = slips.per_run(lambda s: s.record.mechanism.stiffness)
        linear = slips.column(-onset * stiffness, -position * stiffness[:, None])
        # sides of the spring, not of the mirrored record: both parts are odd, so that a mirrored run looks the same
        square, cube = (
            slips.column(-np.sign(onset) * np.abs(onset / scale) ** n, -np.sign(position) * np.abs(position / scale) ** n)
            for n in (2, 3)
        )

        def start(b: Array) -> dict[str, float]:
            more = {"quadratic": float(b[2] / scale**2)} if len(b) > 2 else {}
            return {"cubic": float(b[0] / scale**3), "stiffness": float(b[1]), "reach": reach} | more

        return [
            Hypothesis(cls.kind, [cube, linear], (), start),
            Hypothesis(cls.kind, [cube, linear, square], (), start, variant="with a square"),
        ]


def surroundings(world, memory, rates, p):
    """Add the parts that are not linear."""
    x = min(max(world[POSITION], -p[2]), p[2])
    straight = 0.0 if x == world[POSITION] else (2.0 * p[1] * abs(x) + 3.0 * p[0] * x * x) * (world[POSITION] - x)
    world[LOAD] -= (p[1] * abs(x) + p[0] * x * x) * x + straight
