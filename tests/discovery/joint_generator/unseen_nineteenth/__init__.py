"""A nineteenth set of forms for a report alone: as laboratories meet them, none had to be new, by authors who have not read
the method.
The literature stands beside each.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once, drawn by lot

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 19 --seeds 1901..1901 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_NINETEENTH

PAIRS = (
    "quadratic_damping.paddle_stirs_water+payload.workpiece_left_in_the_gripper",
    "payload.workpiece_left_in_the_gripper+sensor_outliers.laser_sees_a_glint",
    "temperature_drift.rail_grease_by_a_thermometer+constant_force.rolled_band_pulls_evenly",
    "load_dependence.gear_rubs_by_the_weight_it_holds+constant_force.rolled_band_pulls_evenly",
)
"""Two effects at once, each to the other's mechanisms; drawn by lot with seed 19 among the known forms."""

__all__ = ["PAIRS", "UNSEEN_NINETEENTH", "law", "mechanism", "nameless", "null", "sensor"]
