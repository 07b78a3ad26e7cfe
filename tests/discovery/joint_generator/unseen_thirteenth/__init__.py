"""A thirteenth set of forms for a report alone: other shapes again, by an author who has not read the method.
The literature stands beside each; about half of them a robotics, hydraulics or machine-tool engineer meets every week.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 13 --seeds 1301..1301 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_THIRTEENTH

PAIRS = (
    "viscous_friction.short_journal_bearing+position_dependent_friction.telescope_drawn_out",
    "velocity_weakening.wheels_aquaplane+position_dependent_force.float_dips_in",
    "direction_asymmetry.over_a_counterbalance_valve+temperature_drift.rails_fit_at_one_temperature",
    "quadratic_damping.rough_boom_in_water+drive_gain_change.tank_between_two_switch_points",
)
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_THIRTEENTH", "law", "mechanism", "nameless", "null", "sensor"]
