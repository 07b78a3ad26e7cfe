"""A ninth set of forms for a report alone: other shapes again, by an author who has not read the method.
The literature stands beside each; about half of them a robotics or hydraulics engineer meets every week.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 9 --seeds 91..91 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_NINTH

PAIRS = (
    "velocity_weakening.film_over_rough_surfaces+position_dependent_force.scissor_lift",
    "viscous_friction.film_heats_itself+drive_gain_change.rope_winds_on_itself",
    "direction_asymmetry.leading_and_trailing_shoe+harmonic_force.diesel_at_idle",
    "position_dependent_friction.rails_cross+sensor_delay.running_median",
)
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_NINTH", "law", "mechanism", "nameless", "null", "sensor"]
