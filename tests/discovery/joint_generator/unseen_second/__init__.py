"""A second set of forms for a report alone, written when the first had been reported: other shapes, by an author who has read
neither the method nor what it missed. The literature stands beside each.

law       friction depends on speed, direction, load or what went before
place     friction, or another force, depends on where the joint is
time      friction changes with time, distance or temperature, or is random; forces of time
drive     what lies between command and load: springs, play, pistons, amplifiers; numbers that are far off
sensor    positions or drives that are late, stale or off
slider    friction of a spring slider
thrown    friction of short slides
nameless  what no effect of the vocabulary describes
null      nothing is missing
"""

from . import drive, law, nameless, null, place, sensor, slider, thrown, time
from .enter import UNSEEN_SECOND

__all__ = ["UNSEEN_SECOND", "drive", "law", "nameless", "null", "place", "sensor", "slider", "thrown", "time"]
