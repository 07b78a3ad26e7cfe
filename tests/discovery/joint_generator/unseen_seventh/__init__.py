"""A seventh set of forms for a report alone: other shapes again, by an author who has not read the method nor what it missed.
The literature stands beside each.

law        effects of the vocabulary: by speed, direction, load, time, temperature, chance
mechanism  effects of the vocabulary: by place; forces; links, numbers and motors
sensor     effects of the vocabulary: what records say is late, repeated or off
nameless   what no effect of the vocabulary describes
null       nothing is missing
PAIRS      two effects at once

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 7 --seeds 71..71 --out DIR
"""

from . import law, mechanism, nameless, null, sensor
from .enter import UNSEEN_SEVENTH

PAIRS = (
    "viscous_friction.papanastasiou+position_dependent_friction.triangle",
    "velocity_weakening.thomsen_cubic+position_dependent_force.conical_spring",
    "friction_drift.parabola+quadratic_damping.hull",
    "harmonic_force.gantry+random_coefficients.each_stroke_leaning_triangle",
    "backlash.nut_of_a_screw+temperature_drift.two_lines",
)
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_SEVENTH", "law", "mechanism", "nameless", "null", "sensor"]
