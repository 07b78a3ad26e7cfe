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

PAIRS: tuple[str, ...] = ()
"""Two effects at once, each to the other's mechanisms."""

__all__ = ["PAIRS", "UNSEEN_FIFTEENTH", "law", "mechanism", "nameless", "null", "sensor"]
