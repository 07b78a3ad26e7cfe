"""Viscous friction: a part of the friction force in proportion to the relative speed."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import NORMAL_FORCE, SPEED, VISCOUS_FORCE, Effect, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Array, Hypothesis, Slips
from stochfric_mb.effects.traits import MORE_DAMPING, POSITIVE, SHAPES_SLIPS


@dataclasses.dataclass(frozen=True, kw_only=True)
class ViscousFriction(Effect):
    """F = mu N + coefficient v_sat (1 - exp(-abs(v_rel)/v_sat)), along v_rel; mu N + coefficient abs(v_rel) for infinite v_sat.

    Reference: O. Reynolds, Phil. Trans. R. Soc. 177, 1886, 157-234, doi 10.1098/rstl.1886.0005.
    """

    coefficient: float = parameter("N s/m", "force per relative speed", scale=5.0, low=0.0)
    """Force per relative speed [N s/m]."""
    saturation_velocity: float = parameter(
        "m/s", "speed at which the film thins and the force levels off", scale=0.01, low=0.0, strict=True, infinite=True,
        default=math.inf,
    )  # fmt: skip
    """Speed at which the film thins and the force levels off [m/s]."""
    reference_load: float = parameter(
        "N", "normal force at which the coefficient holds, if the force grows with it", scale=10.0, low=0.0, default=0.0
    )
    """Normal force at which the coefficient holds, the force being proportional to it [N]; 0: the load does not matter."""

    kind: ClassVar[str] = "viscous_friction"
    equation: ClassVar[str] = (
        "F = (mu N + coefficient abs(v_rel)) sign(v_rel), levelling off beyond the saturation velocity, or proportional to N"
    )
    source: ClassVar[str] = "Reynolds 1886; Armstrong-Helouvry, Dupont and Canudas de Wit 1994, eq. 6"
    group: ClassVar[str] = "friction law"
    traits: ClassVar[frozenset[str]] = frozenset({SHAPES_SLIPS, POSITIVE})
    signatures: ClassVar[tuple[str, ...]] = (MORE_DAMPING,)
    answers_to: ClassVar[str] = "speed"
    separated_by: ClassVar[Mapping[str, str]] = {
        "quadratic_damping": "runs at other belt speeds and normal loads",
        "velocity_weakening": "runs at other belt speeds and normal loads",
    }
    form_axis: ClassVar[str] = "speed"
    shows_on: ClassVar[str] = "relative velocity"
    shows: ClassVar[str] = "friction rises with the sliding velocity"

    @property
    def linear_damping(self) -> float:
        """The coefficient, where the force is in proportion to the speed and nothing else."""
        return self.coefficient if self.saturation_velocity == math.inf and self.reference_load == 0.0 else 0.0

    @classmethod
    def at_joint(cls, span: JointSpan) -> tuple[JointSignature, ...]:
        """Return a force in proportion to the speed, and one that levels off early or late."""
        slope = 0.5 * span.friction / span.speed
        thins = tuple(cls(coefficient=slope / part, saturation_velocity=part * span.speed) for part in (0.15, 0.5))
        return JointSignature((cls(coefficient=slope),), "speed", 1), JointSignature(thins, "speed", 2)

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return the relative velocity in the slip, linear or levelling off, proportional to the load or not."""
        speed = slips.relative_velocity
        fastest = float(np.median(speed.max(axis=1)))
        reference = float(slips.normal_force[0])
        items: list[Hypothesis] = []
        loads = [(np.ones(len(slips.run)), 0.0)]
        if np.ptp(slips.normal_force) > 0.05 * reference:
            loads.append((slips.normal_force / reference, reference))
        for load, name in loads:
            more = {"reference_load": name} if name else {}

            def curved(b: Array, knee: float, more: dict[str, float] = more) -> dict[str, float]:
                return more | {"coefficient": float(b[0]), "saturation_velocity": float(knee)}

            def linear(b: Array, more: dict[str, float] = more) -> dict[str, float]:
                return more | {"coefficient": float(b[0])}

            items.append(Hypothesis(cls.kind, [slips.column(None, speed * load[:, None])], (), linear, variant="linear"))
            for knee in fastest * np.array([0.15, 0.4]):
                columns = [slips.column(None, -knee * np.expm1(-speed / knee) * load[:, None])]
                start = functools.partial(curved, knee=knee)
                items.append(Hypothesis(cls.kind, columns, (knee,), start, variant="levelling off"))
        return items


def friction(world, memory, rates, p):
    """Add the viscous force."""
    speed = world[SPEED] if p[1] > 1.0e300 else -p[1] * math.expm1(-world[SPEED] / p[1])
    load = world[NORMAL_FORCE] / p[2] if p[2] > 0.0 else 1.0
    world[VISCOUS_FORCE] += p[0] * speed * load
