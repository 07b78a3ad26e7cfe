"""An eleventh set of forms for a report alone: other shapes again, by an author who has not read the method.
The literature stands beside each; about half of them a robotics, hydraulics or machine-tool engineer meets every week.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 11 --seeds 1101..1101 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_ELEVENTH

PAIRS = (
    "viscous_friction.damper_without_its_field+position_dependent_force.spring_with_a_helper",
    "velocity_weakening.lining_in_a_code+position_dependent_friction.rail_bent_in_an_s",
    "direction_asymmetry.band_brake+harmonic_force.pump_of_three_plungers",
    "temperature_drift.clearance_closes+constant_force.web_under_tension",
)
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_ELEVENTH", "law", "mechanism", "nameless", "null", "sensor"]
