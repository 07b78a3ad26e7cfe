"""Joint compliance: a spring between a motor, whose motion is measured, and its load."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from stochfric_mb.effects.contract import Array, Effect, JointSignature, parameter
from stochfric_mb.effects.joints import JointSpan
from stochfric_mb.effects.load_side import Link, MotorMotion, load_force

SHARE, RUBS, LOUD = 0.5, 0.05, 0.02
"""Where fits begin: share of the inertia, of friction, and force of a free oscillation over friction [-]."""
DAMPING_RATIOS = (0.05, 0.3)
"""Damping ratios from which fits begin [-]: metal, and rubber."""
MOST_DAMPED = 0.5
"""Damping ratio up to which a compliance is looked for [-]: rubber has a quarter of the critical damping, and a load that does
not swing could stand for any filter."""
FREQUENCIES = 12
"""Frequencies from which they begin."""
SLOWEST, QUICKEST = 0.7, 0.5
"""The lowest of them over speed/stroke, and the highest times the half width of the windows [-]: a load that is slower does not
follow at all, and one that is quicker swings within a window."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class JointCompliance(Effect):
    """J_l q_l'' = k (q_m - q_l) + d (q_m' - q_l') - load_friction sign(q_l') - load_damping q_l' - gravity.

    The motor bears the reaction. J_l = load_share J, k = J_l (2 pi frequency)^2, d = 2 damping_ratio sqrt(k J_l). J is the
    inertia of motor and load together, which the mechanism states; q_m, the motor's position, is measured. ``load_friction``
    and ``load_damping`` are part of the friction and of the damping of the joint. A load that swings when a record begins is
    the record's own: ``start_in_phase`` and ``start_quadrature``.

    References: M. W. Spong, J. Dyn. Syst. Meas. Control 109, 1987, 310-319, doi 10.1115/1.3143860, eqs. 1-2; A. De Luca,
    W. Book, Robots with flexible elements, in Springer Handbook of Robotics, 2nd ed. 2016, section 11.1.
    """

    load_share: float = parameter(
        "-", "share of the inertia on the load's side", scale=0.5, low=0.0, high=1.0, strict=True, fit_low=0.01, fit_high=0.95
    )
    """Share of the inertia on the load's side [-]."""
    frequency: float = parameter(
        "Hz", "natural frequency of the load with the motor held", scale=10.0, low=0.0, strict=True, fit_low=1.0e-3
    )
    """Natural frequency of the load with the motor held [Hz]."""
    damping_ratio: float = parameter(
        "-", "damping ratio of the same", scale=0.05, low=0.0, high=10.0, default=0.0, fit_high=MOST_DAMPED
    )
    """Damping ratio of the same [-]."""
    load_friction: float = parameter("N", "Coulomb friction at the load", scale=0.1, low=0.0, default=0.0)
    """Coulomb friction at the load [N]."""
    load_damping: float = parameter("N s/m", "viscous friction at the load", scale=0.1, low=0.0, default=0.0)
    """Viscous friction at the load, part of that of the joint [N s/m]."""
    start_in_phase: float = parameter("N", "free oscillation at the record's start, in phase", scale=0.1, default=0.0)
    """What the spring carries beyond equilibrium when the record begins [N]."""
    start_quadrature: float = parameter("N", "the same, a quarter of a period ahead", scale=0.1, default=0.0)
    """The same a quarter of a period ahead: its rate over 2 pi frequency [N]."""

    kind: ClassVar[str] = "joint_compliance"
    equation: ClassVar[str] = (
        "J_l q_l'' = k (q_m - q_l) + d (q_m' - q_l') - load_friction sign(q_l') - load_damping q_l', J_l = load_share J, "
        "k = J_l (2 pi frequency)^2"
    )
    source: ClassVar[str] = "Spong 1987, eqs. 1-2; De Luca and Book 2016"
    group: ClassVar[str] = "mechanism"
    separated_by: ClassVar[Mapping[str, str]] = {
        "backlash": "small motions about a load that is held: a gap gives way without force",
        "sensor_delay": "a second sensor at the load",
    }
    shows_on: ClassVar[str] = "motion of the load"
    shows: ClassVar[str] = "the load swings behind the motor on a spring"

    @property
    def own_to_run(self) -> tuple[str, ...]:
        """How the load swings when a record begins."""
        return "start_in_phase", "start_quadrature"

    @property
    def moves_load(self) -> bool:
        """It does."""
        return True

    def load_force(self, motor: MotorMotion) -> Array:
        """Return the force of the load that swings by itself [N or N m], shape (count,); as `Effect.load_force`."""
        link = Link(
            self.load_share * motor.inertia, self.frequency, self.damping_ratio, friction=self.load_friction,
            damping=self.load_damping, start=(self.start_in_phase, self.start_quadrature),
        )  # fmt: skip
        return load_force(motor, link)

    def seen_at_joint(self, span: JointSpan) -> bool:
        """Return whether the load swings once at least in the longest record: one that is slower does not follow at all."""
        return self.frequency * span.duration >= 1.0

    @classmethod
    def at_joint(cls, span: JointSpan) -> JointSignature | None:
        """Return loads that swing at frequencies which the motion excites and the windows show, from the start of a record.

        A joint that nothing drives has no motor that they could swing behind.
        """
        if span.inertia <= 0.0 or not span.drive:
            return None
        low, high = SLOWEST * span.speed / span.stroke, QUICKEST / span.window
        own = LOUD * span.friction
        starts = tuple(
            cls(
                load_share=SHARE, frequency=float(f), damping_ratio=ratio, load_friction=RUBS * span.friction,
                load_damping=RUBS * span.friction / span.speed, start_in_phase=own, start_quadrature=own,
            )
            for f in np.geomspace(low, max(high, 2.0 * low), FREQUENCIES)
            for ratio in DAMPING_RATIOS
        )  # fmt: skip
        return JointSignature(starts, cls.shows_on, 6)
