"""An eighth set of forms for a report alone: other shapes again, by an author who has not read the method.
The literature stands beside each; about half of them a robotics or hydraulics engineer meets every week.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 8 --seeds 81..81 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_EIGHTH

PAIRS = (
    "viscous_friction.sisko+position_dependent_friction.bent_screw",
    "direction_asymmetry.spiral_grooves+position_dependent_force.rubber_cord",
    "temperature_drift.peak_of_a_rubber+harmonic_force.compressor_strokes",
    "drive_gain.effective_for_peak_value+quadratic_damping.disc_in_a_housing",
)
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_EIGHTH", "law", "mechanism", "nameless", "null", "sensor"]
