"""An eighteenth set of forms for a report alone: as laboratories meet them, none had to be new, by authors who have not read
the method.
The literature stands beside each.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once, drawn by lot

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 18 --seeds 1801..1801 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_EIGHTEENTH

PAIRS = (
    "load_dependence.teeth_rub_by_their_torque+frictional_lag.junctions_let_go_over_a_way",
    "velocity_weakening.ways_float_up_on_oil+payload.gripper_nobody_entered",
    "drive_gain_change.torque_constant_fades_as_it_warms+sensor_outliers.sparks_of_a_welder",
    "frictional_lag.junctions_let_go_over_a_way+drive_gain_change.torque_constant_fades_as_it_warms",
)
"""Two effects at once, each to the other's mechanisms; drawn by lot with seed 18 among the known forms."""

__all__ = ["PAIRS", "UNSEEN_EIGHTEENTH", "law", "mechanism", "nameless", "null", "sensor"]
