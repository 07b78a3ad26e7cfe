"""A sixteenth set of forms for a report alone: other shapes again, by authors who have not read the method.
The literature stands beside each; about half of them a robotics, hydraulics or machine-tool engineer meets every week.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 16 --seeds 1601..1601 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_SIXTEENTH

PAIRS = (
    "position_dependent_friction.planks_of_a_deck+harmonic_force.bell_swings_in_the_frame",
    "quadratic_damping.oar_draws_air+temperature_drift.tallow_on_the_ways",
    "drive_gain_change.dirty_bars_of_a_commutator+friction_drift.limescale_closes_a_gap",
    "viscous_friction.soft_close_of_a_drawer+distance_drift.coats_of_paint",
)
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_SIXTEENTH", "law", "mechanism", "nameless", "null", "sensor"]
