"""A fourteenth set of forms for a report alone: other shapes again, by an author who has not read the method.
The literature stands beside each; about half of them a robotics, hydraulics or machine-tool engineer meets every week.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 14 --seeds 1401..1401 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_FOURTEENTH

PAIRS = (
    "viscous_friction.rollers_of_polyurethane+temperature_drift.rails_sweat",
    "velocity_weakening.cast_iron_slideway+harmonic_force.splice_of_a_belt_passes",
    "direction_asymmetry.scraper_of_a_clarifier+position_dependent_friction.nut_out_of_line",
    "quadratic_damping.float_makes_waves+position_dependent_force.follower_on_a_cam",
)
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_FOURTEENTH", "law", "mechanism", "nameless", "null", "sensor"]
