"""A fifteenth set of forms for a report alone: other shapes again, by an author who has not read the method.
The literature stands beside each; about half of them a robotics, hydraulics or machine-tool engineer meets every week.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 15 --seeds 1501..1501 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_FIFTEENTH

PAIRS = (
    "quadratic_damping.flaps_bend_back+position_dependent_force.bridge_sags_under_its_trolley",
    "viscous_friction.open_wet_brake+joint_compliance.limb_in_an_exoskeleton",
    "friction_drift.oil_sets_in_the_cold+position_dependent_friction.rail_is_corrugated_behind_a_weld",
    "temperature_drift.two_transitions_of_ptfe+harmonic_force.geneva_wheel_on_the_frame",
)
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_FIFTEENTH", "law", "mechanism", "nameless", "null", "sensor"]
