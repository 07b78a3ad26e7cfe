"""A sixth set of forms for a report alone: other shapes again, by an author who has not read the method nor what it missed.
The literature stands beside each.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 6 --seeds 61..61 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_SIXTH

PAIRS = (
    "viscous_friction.carreau+position_dependent_force.gap_that_widens",
    "velocity_weakening.between_cut_offs+friction_drift.scuffs",
    "quadratic_damping.rolling_ship+position_dependent_friction.swinging_pitch",
    "harmonic_force.planet_gear+temperature_drift.liquid_crystal",
    "joint_compliance.oil_column+direction_asymmetry.slanted_dimples",
    "backlash.slack_chain+viscous_friction.carreau",
)
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_SIXTH", "law", "mechanism", "nameless", "null", "sensor"]
