"""A twelfth set of forms for a report alone: other shapes again, by an author who has not read the method.
The literature stands beside each; about half of them a robotics, hydraulics or machine-tool engineer meets every week.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 12 --seeds 1201..1201 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_TWELFTH

PAIRS = (
    "viscous_friction.drilling_mud+position_dependent_force.air_shut_in_on_both_sides",
    "velocity_weakening.heights_are_normal+friction_drift.bush_swells",
    "direction_asymmetry.cylinder_out_and_in+harmonic_force.indexer_on_the_frame",
    "quadratic_damping.exhaust_throttles+position_dependent_friction.sheath_round_a_bend",
)
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_TWELFTH", "law", "mechanism", "nameless", "null", "sensor"]
