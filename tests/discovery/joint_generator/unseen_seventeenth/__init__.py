"""A seventeenth set of forms for a report alone: other shapes again, by authors who have not read the method.
The literature stands beside each.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once, drawn by lot

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 17 --seeds 1701..1701 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_SEVENTEENTH

PAIRS = (
    "direction_asymmetry.wing_on_the_carriage+quadratic_damping.ball_towed_through_water",
    "stale_samples.telegrams_lost_by_chance+viscous_friction.melt_in_a_rotary_damper",
    "payload.triangular_gusset+viscous_friction.rubber_solution_in_a_seal",
    "sensor_outliers.multiplexer_at_the_drive+harmonic_force.neighbour_picks_and_places",
)
"""Two effects at once, each to the other's mechanisms; drawn by lot (numpy's default_rng of 1717)."""

__all__ = ["PAIRS", "UNSEEN_SEVENTEENTH", "law", "mechanism", "nameless", "null", "sensor"]
