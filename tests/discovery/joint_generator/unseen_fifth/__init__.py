"""A fifth set of forms for a report alone: other shapes again, by an author who has not read the method nor what it missed.
The literature stands beside each.

known     effects of the vocabulary: by speed, direction, load, place, time, chance; of a sensor or a motor
link      springs and gaps between motor and load, where the motor's encoder is what is recorded
nameless  what no effect of the vocabulary describes
null      nothing is missing
PAIRS     two effects at once

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 5 --seeds 51..51 --out DIR
"""

from . import known, link, nameless, null
from .enter import UNSEEN_FIFTH

PAIRS = (
    "viscous_friction.ellis+position_dependent_force.centred_by_springs",
    "velocity_weakening.cubic_step+position_dependent_friction.sleeve",
    "friction_drift.oiler_comes_on+quadratic_damping.steep_fan",
    "temperature_drift.lining_fades+direction_asymmetry.stribeck_one_way",
    "harmonic_force.feeder+viscous_friction.ellis",
    "joint_compliance.gear_and_arm+position_dependent_friction.sleeve",
    "backlash.rack_and_pinion+viscous_friction.ellis",
    "load_dependence.least_friction+position_dependent_force.centred_by_springs",
)
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_FIFTH", "known", "link", "nameless", "null"]
