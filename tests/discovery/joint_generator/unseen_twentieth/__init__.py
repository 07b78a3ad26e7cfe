"""A twentieth set of forms for a report alone: as laboratories meet them, none had to be new, by authors who have not read
the method.
The literature stands beside each.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once, drawn by lot

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 20 --seeds 2001..2001 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_TWENTIETH

PAIRS = (
    "viscous_friction.grease_that_yields+position_dependent_force.magnets_cog_at_the_slots",
    "direction_asymmetry.wiper_leans_one_way+load_dependence.teeth_bear_the_torque",
    "direction_asymmetry.wiper_leans_one_way+distance_drift.asperities_run_in",
    "direction_asymmetry.wiper_leans_one_way+correlated_coefficients.third_body_comes_and_goes",
    "direction_asymmetry.wiper_leans_one_way+effective_area.brake_chamber_at_its_end",
    "load_dependence.teeth_bear_the_torque+payload.workpiece_left_in_the_chuck",
    "friction_drift.gearbox_from_cold+position_dependent_force.magnets_cog_at_the_slots",
    "distance_drift.asperities_run_in+payload.workpiece_left_in_the_chuck",
    "drive_gain_change.phases_not_of_one_strength+harmonic_force.compressor_on_the_same_base",
    "drive_gain_change.phases_not_of_one_strength+sensor_outliers.one_bit_of_a_word_flips",
)
"""Two effects at once, each to the other's mechanisms; drawn by lot with seed 20 among the known forms."""

__all__ = ["PAIRS", "UNSEEN_TWENTIETH", "law", "mechanism", "nameless", "null", "sensor"]
