"""A third set of forms for a report alone: other shapes again, by an author who has read neither the method nor what it missed.
The literature stands beside each.

known     effects of the vocabulary: by speed, direction, load, place, time, chance; of the drive and of sensors
nameless  what no effect of the vocabulary describes
brief     spring sliders and short slides
null      nothing is missing

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 3 --seeds 31..31 --out DIR
"""

from . import brief, known, nameless, null
from .enter import UNSEEN_THIRD

__all__ = ["UNSEEN_THIRD", "brief", "known", "nameless", "null"]
