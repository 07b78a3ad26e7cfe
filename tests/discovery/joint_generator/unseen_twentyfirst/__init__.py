"""A twenty-first set of forms for a report alone: as laboratories meet them, none had to be new, by authors who have not read
the method.
The literature stands beside each.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once, drawn by lot

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 21 --seeds 2101..2101 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_TWENTYFIRST

PAIRS = (
    "friction_drift.gearbox_from_a_cold_start+position_dependent_friction.shaft_bent_and_oval",
    "viscous_friction.grease_churned_by_a_reducer+direction_asymmetry.motor_of_two_directions",
    "temperature_drift.joint_is_heated_and_aired+harmonic_force.unbalanced_fan_on_the_frame",
    "random_coefficients.each_stroke_has_its_own+drive_gain_change.flux_falls_as_magnets_warm",
    "direction_asymmetry.motor_of_two_directions+payload.workpiece_in_the_gripper",
    "correlated_coefficients.film_comes_and_goes+backlash.play_of_a_spur_gear",
    "quadratic_damping.vane_broadside_to_the_air+stale_samples.link_sends_again",
    "frictional_lag.static_level_dies_with_the_way+sensor_outliers.wiper_lifts_off_its_track",
    "sensor_delay.cycles_of_a_field_bus+sensor_outliers.wiper_lifts_off_its_track",
    "quadratic_damping.vane_broadside_to_the_air+frictional_lag.static_level_dies_with_the_way",
)
"""Two effects at once, each to the other's mechanisms; drawn by lot with seed 21 among the known forms."""

__all__ = ["PAIRS", "UNSEEN_TWENTYFIRST", "law", "mechanism", "nameless", "null", "sensor"]
