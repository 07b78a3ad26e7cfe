"""A fourth set of forms for a report alone: other shapes again, by an author who has not read the method nor what it missed.
The literature stands beside each.

known     effects of the vocabulary: by speed, direction, load, place, time, chance; of a sensor
nameless  what no effect of the vocabulary describes
null      nothing is missing

A report runs it once::

    nice python -m tests.discovery.joint_suite --unseen 4 --seeds 41..41 --out DIR
"""

from . import known, nameless, null
from .enter import UNSEEN_FOURTH

__all__ = ["UNSEEN_FOURTH", "known", "nameless", "null"]
