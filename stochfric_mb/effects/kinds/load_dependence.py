"""Load dependence: coefficients that change with the normal force."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import math
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import MU_K, MU_S, NORMAL_FORCE, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.marks import Array, Hypothesis, Slips, apart
from stochfric_mb.effects.shapes.course import LeveledCourse, courses_at_joint
from stochfric_mb.effects.shapes.splines import along
from stochfric_mb.effects.traits import BETWEEN_POINTS, READS_LOAD

LOOSE = 4.0
"""Reference load of a fit's beginning over the stated friction, where the joint transmits no more than that [-]."""
MOST_ADHESIVE = 0.9
"""Largest share of the friction at the reference load that a fit may begin with [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class LoadDependence(LeveledCourse):
    """mu_s and mu_k times (N/N_0)^exponent (1 + A/N)/(1 + A/N_0) (1 + course c((N - begin)/span)).

    N_0 is the reference load, A the adhesion. Elastic contact of a sphere has exponent -1/3; surfaces that adhere rub as if
    pressed together by A more; c, a sum of cubic B-splines, lets friction follow any smooth shape along the load, as that of a
    soft liner which shears from one load on.

    References: J. F. Archard, Proc. R. Soc. A 243, 1957, 190-205, doi 10.1098/rspa.1957.0214; B. V. Derjaguin, Z. Phys. 88,
    1934, 661-675, doi 10.1007/BF01333114 (adhesion); F. P. Bowden, D. Tabor, The Friction and Lubrication of Solids, Oxford
    1950, chapter 5 (films and liners).
    """

    span: float = parameter(
        "N", "range of normal forces over which the course runs", scale=10.0, low=0.0, strict=True, infinite=True,
        default=math.inf, fit_prior=0.0, optional=True,
    )  # fmt: skip
    """Range of normal forces over which the course runs [N]; nothing changes below and above it."""
    begin: float = parameter(
        "N", "normal force at which the course begins", scale=10.0, default=0.0, fit_prior=0.0, optional=True
    )
    """Normal force at which the course begins [N]."""
    exponent: float = parameter("-", "exponent of the normal force", scale=0.2, low=-2.0, high=2.0)
    """Exponent of the normal force [-]."""
    reference_load: float = parameter("N", "normal force at which nothing changes", scale=10.0, low=0.0, strict=True)
    """Normal force at which nothing changes [N]."""
    static_share: float = parameter("-", "exponent of mu_s over that of mu_k", scale=1.0, default=1.0)
    """Exponent of mu_s over that of mu_k [-]: 1, both coefficients alike; 0, mu_k alone."""
    adhesion: float = parameter("N", "force by which the surfaces attract each other", scale=5.0, low=0.0, default=0.0)
    """Force by which the surfaces attract each other [N]; it acts on both coefficients alike."""
    course: float = parameter("-", "relative size of a course of any shape", scale=0.03, default=0.0, optional=True)
    """Relative size of a course of any shape, of both coefficients alike [-]."""

    kind: ClassVar[str] = "load_dependence"
    equation: ClassVar[str] = (
        "mu_k times (N/reference_load)^exponent, mu_s times (N/reference_load)^(static_share exponent), "
        "both times (1 + adhesion/N)/(1 + adhesion/reference_load) (1 + course c((N - begin)/span)), c of splines"
    )
    source: ClassVar[str] = "Derjaguin 1934; Bowden and Tabor 1950; Archard 1957"
    group: ClassVar[str] = "friction law"
    traits: ClassVar[frozenset[str]] = frozenset({BETWEEN_POINTS, READS_LOAD})
    answers_to: ClassVar[str] = "load"
    form_axis: ClassVar[str] = "load"
    shows_on: ClassVar[str] = "normal load"
    shows: ClassVar[str] = "friction is not proportional to the normal load"
    order: ClassVar[int] = 3

    def kept_at_joints(self, contact: bool) -> tuple[str, ...]:
        """Return the exponent at a joint, whose friction grows with what it transmits beyond a preload; else the preload.

        Of a contact the exponent is fitted, or the adhesion, or the course.
        """
        if self.any_shape:
            return *super().kept_at_joints(contact), "reference_load", "exponent"
        return ("reference_load", *(("exponent",) if self.adhesion > 0.0 else ())) if contact else ("exponent",)

    @classmethod
    def at_joint(cls, span: JointSpan) -> JointSignature | tuple[JointSignature, ...] | None:
        """Return a power of a contact's normal force, adhesion and any shape; or what a joint transmits beyond its preload."""
        if not span.load:
            return None
        if span.contact:  # mu_k holds at the stated load, and the exponent or the adhesion is searched
            powers = tuple(cls(exponent=x, reference_load=span.stated_load) for x in (-0.3, 0.3))
            pulls = tuple(cls(exponent=0.0, reference_load=span.stated_load, adhesion=x * span.stated_load) for x in (0.1, 1.0))
            flat = cls(exponent=0.0, reference_load=span.stated_load, span=span.load_range, begin=span.least_load)
            return (
                JointSignature(powers, "normal force", 1),
                JointSignature(pulls, "normal force", 1),
                *courses_at_joint(flat, "normal force", leveled=True),
            )
        loads = [part * span.load for part in (0.3, 1.0, 4.0)]
        # where friction grows as fast as the drive the joint locks itself, and no motion is left to be explained
        loose = [x for x in loads if x > span.friction] or [LOOSE * span.friction]
        return JointSignature(tuple(cls(exponent=1.0, reference_load=x) for x in loose), "load", 1)

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return ln(N/N_0) and, as another form, N_0/N - 1 times the friction, where the load differs between runs."""
        if np.ptp(slips.normal_force) < 0.05 * slips.normal_force.mean():
            return []
        reference = float(slips.normal_force[0])
        change = np.log(slips.normal_force / reference)
        more = {"reference_load": reference}
        power = apart(cls.kind, slips.static * change, slips.kinetic * change, slips, "exponent", more)[:1]
        less = reference / slips.normal_force - 1.0

        def adhesive(b: Array) -> dict[str, float]:
            share = float(np.clip(b[0], 0.0, MOST_ADHESIVE))
            return more | {"exponent": 0.0, "adhesion": reference * share / (1.0 - share)}

        column = slips.column(slips.static * less, slips.kinetic * less)
        return [*power, Hypothesis(cls.kind, [column], (), adhesive, variant="adhesion")]


def friction(world, memory, rates, p):
    """Multiply both coefficients by the power of the load, by what adhesion adds and by the course."""
    if world[NORMAL_FORCE] > 0.0:
        more = (1.0 + p[25] / world[NORMAL_FORCE]) / (1.0 + p[25] / p[23])
        if p[26] != 0.0:
            more *= 1.0 + p[26] * (p[21] + along(p, (world[NORMAL_FORCE] - p[20]) / p[19]))
        world[MU_S] *= more * (world[NORMAL_FORCE] / p[23]) ** (p[22] * p[24])
        world[MU_K] *= more * (world[NORMAL_FORCE] / p[23]) ** p[22]
