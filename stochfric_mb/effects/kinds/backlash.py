"""Backlash: a gap in the spring's line of force, or between the motor of a joint and its load."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import LOAD, POSITION, STIFFNESS, Effect, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.load_side import Link, MotorMotion, load_force
from stochfric_mb.effects.marks import Array, Hypothesis, Slips
from stochfric_mb.effects.traits import POSITIVE, ROUGH, SHAPES_SLIPS

GAPS = (0.003, 0.15, 18)
"""Gaps from which fits begin at joints, over the stroke [-], and their number: two next to each other differ by a quarter, as
the moment at which a gap is crossed decides what comes after."""
SHARES = (0.4, 0.65, 0.85)
"""Shares of the inertia from which they begin [-]."""
SEEN, SMEARED = (0.3, 0.6), (0.1, 0.5)
"""Frequencies of the contact from which they begin times the half width of the windows, and its damping ratios [-]: impacts
that ring quicker are not seen, and how often they bounce no record says of another."""
RUBS = (0.05, 0.4)
"""Shares of friction behind the gap from which they begin [-]: at the motor, or on the load's own guide, which then stays where
it is while the gap is crossed."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Backlash(Effect):
    """Spring force k x - k (min(max(x - position, 0), gap) - share_below gap): it stays the same while x passes the gap.

    Above the gap the spring is shifted by (1 - share_below) gap, below it by -share_below gap: where the spring counts
    as unloaded depends on the side on which the position was set to zero.

    At a driven joint, whose motor is measured, the load follows only through a gap: J_l q_l'' = link - load_friction
    sign(q_l') - gravity, link = k b + d b' with the motor's lead beyond the gap b = s - min(max(s, -gap/2), gap/2),
    s = q_m - q_l, and 0 within the gap; J_l = load_share J, J being the inertia of motor and load that the mechanism states,
    k = J_l (2 pi contact_frequency)^2 and d = 2 damping_ratio sqrt(k J_l). The motor bears the reaction. The gap has no place
    of its own then.

    Reference: M. Nordin, P.-O. Gutman, Automatica 38, 2002, 1633-1649, doi 10.1016/S0005-1098(02)00047-X.
    """

    gap: float = parameter("m", "width of the gap", scale=1.0e-4, low=0.0)
    """Width of the gap [m]."""
    position: float = parameter("m", "position at which the gap opens", scale=1.0e-3, default=0.0)
    """Position at which the gap opens [m]."""
    share_below: float = parameter("-", "share of the gap by which the spring is shifted below it", scale=0.5, default=0.0)
    """Share of the gap by which the spring is shifted below it [-]."""

    load_share: float = parameter(
        "-", "at a joint: share of the inertia behind the gap", scale=0.0, low=0.0, high=1.0, default=0.0, optional=True,
        fit_low=0.01, fit_high=0.95,
    )  # fmt: skip
    """At a joint: share of the inertia behind the gap [-]; 0: the gap is in the spring of a box."""
    contact_frequency: float = parameter(
        "Hz", "at a joint: frequency of the load on its flank", scale=30.0, low=0.0, strict=True, default=30.0, optional=True,
        fit_low=1.0e-3,
    )  # fmt: skip
    """At a joint: natural frequency of the load on its flank, the motor held [Hz]."""
    damping_ratio: float = parameter(
        "-", "at a joint: damping ratio of the same", scale=0.3, low=0.0, high=10.0, default=0.0, optional=True
    )
    """At a joint: damping ratio of the same [-]."""
    load_friction: float = parameter(
        "N", "at a joint: Coulomb friction behind the gap", scale=0.0, low=0.0, default=0.0, optional=True
    )
    """At a joint: Coulomb friction behind the gap, part of that of the joint [N]."""

    kind: ClassVar[str] = "backlash"
    equation: ClassVar[str] = (
        "spring force k x - k (min(max(x - position, 0), gap) - share_below gap); at a joint: the load, load_share J, is "
        "carried only beyond gap/2 to either side of the motor"
    )
    source: ClassVar[str] = "Nordin and Gutman 2002"
    group: ClassVar[str] = "mechanism"
    traits: ClassVar[frozenset[str]] = frozenset({SHAPES_SLIPS, POSITIVE, ROUGH})
    separated_by: ClassVar[Mapping[str, str]] = {
        "second_mode": "a free decay or an impact test of the box, lifted off the belt",
        "nonlinear_stiffness": "a quasi-static load test of the spring",
        "joint_compliance": "small motions about a load that is held: a gap gives way without force",
    }
    form_axis: ClassVar[str] = "position"
    shows_on: ClassVar[str] = "position of the box"
    shows: ClassVar[str] = "the restoring force has a dead zone"

    @property
    def moves_load(self) -> bool:
        """Whether the gap is that of a joint."""
        return self.load_share > 0.0

    def load_force(self, motor: MotorMotion) -> Array | None:
        """Return the force of the load that moves by itself [N or N m], shape (count,); as `Effect.load_force`."""
        if not self.moves_load:
            return None
        inertia = self.load_share * motor.inertia
        return load_force(motor, Link(inertia, self.contact_frequency, self.damping_ratio, self.gap, self.load_friction))

    @classmethod
    def at_joint(cls, span: JointSpan) -> JointSignature | None:
        """Return gaps of parts of the stroke, and shares of the inertia behind them, of a joint whose inertia is stated."""
        if span.inertia <= 0.0 or not span.both_ways:
            return None
        starts = tuple(
            cls(
                gap=float(part) * span.stroke, load_share=share, contact_frequency=quick / span.window,
                damping_ratio=ratio, load_friction=rubs * span.friction,
            )
            for part, ratio, share, quick, rubs in itertools.product(np.geomspace(*GAPS), SMEARED, SHARES, SEEN, RUBS)
        )  # fmt: skip
        return JointSignature(starts, "motion of the load", 5)

    @classmethod
    def hypotheses(cls, slips: Slips) -> list[Hypothesis]:
        """Return the spring force that a narrow dead zone takes away, for places of the zone along the slip.

        Where directions or loads differ, so does the friction that a shift of the whole spring would look like: the side of
        the gap on which the spring counts as unloaded is then left open.
        """
        width = 0.02 * float(np.median(slips.typical_onset))
        if width <= 0.0:
            return []
        stiffness = slips.per_run(lambda s: s.record.mechanism.stiffness)
        back = slips.direction < 0
        low, high = np.quantile(slips.typical_position, (0.08, 0.92))
        places = list(np.linspace(low, high, 16))
        if back.any():
            places += list(-np.linspace(low, high, 16) - width)
        shift = slips.column(*(2 * [-slips.direction * stiffness * width]))
        shifted = back.any() or np.ptp(slips.normal_force) > 0.05 * slips.normal_force.mean()

        def passed(x: Array, place: float) -> Array:
            """Return how much of the gap is passed, seen in the mirrored frame of runs with a reversed belt."""
            away = back if x.ndim == 1 else back[:, None]
            return np.where(away, np.clip(x + place + width, 0.0, width) - width, np.clip(x - place, 0.0, width))

        def start(b: Array, place: float) -> dict[str, float]:
            table = {"gap": float(abs(b[0]) * width), "position": place}
            return table | ({"share_below": float(np.clip(b[1] / b[0], 0.05, 0.95))} if len(b) > 1 and b[0] != 0.0 else {})

        hypotheses: list[Hypothesis] = []
        for place in map(float, places):
            nodes = stiffness[:, None] * passed(slips.typical_position, place)
            columns = [slips.column(stiffness * passed(slips.typical_onset, place), nodes)]
            columns += [shift] if shifted else []
            hypotheses.append(Hypothesis(cls.kind, columns, (place,), lambda b, place=place: start(b, place)))
        return hypotheses


def surroundings(world, memory, rates, p):
    """Take the force that the gap does not pass on."""
    world[LOAD] += world[STIFFNESS] * (min(max(world[POSITION] - p[1], 0.0), p[0]) - p[2] * p[0])
