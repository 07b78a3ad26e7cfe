"""A tenth set of forms for a report alone: other shapes again, by an author who has not read the method.
The literature stands beside each; about half of them a robotics, hydraulics or machine-tool engineer meets every week.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 10 --seeds 1001..1001 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_TENTH

PAIRS = (
    "viscous_friction.bearing_catalogue+position_dependent_friction.telescopic_covers",
    "velocity_weakening.seal_of_a_cylinder+constant_force.null_of_the_servo_valve",
    "direction_asymmetry.digressive_and_progressive+position_dependent_force.dress_pack",
    "quadratic_damping.laminar_to_turbulent+harmonic_force.milling_cutter",
)
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_TENTH", "law", "mechanism", "nameless", "null", "sensor"]
