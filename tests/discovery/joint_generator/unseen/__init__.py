"""Forms for a report alone: written from the literature by an author who has not read the method, and in no suite for tuning.

law       friction depends on speed, direction, load or what went before
place     friction, or another force, depends on where the joint is
time      friction changes with time or temperature, or is random
numbers   a number of the mechanism is far off; sensors are late
slider    friction of a spring slider
thrown    friction of short slides
nameless  what no effect of the vocabulary describes
null      nothing is missing
"""

from . import law, nameless, null, numbers, place, slider, thrown, time
from .enter import UNSEEN

__all__ = ["UNSEEN", "law", "nameless", "null", "numbers", "place", "slider", "thrown", "time"]
