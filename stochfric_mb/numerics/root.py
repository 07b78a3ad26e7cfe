"""Where a function turns from positive to not positive, between two points: false position, halved where it is slow.

The caller evaluates:

>>> b = bracket(0.0, 1.0, 2.0, -1.0)  # 1 - x^3/4 at 0 and at 2
>>> while is_wide(b, 1e-12):
...     x = trial(b, 1e-12)
...     b = narrowed(b, x, 1.0 - 0.25 * x**3)
>>> round(b.positive, 9), round(b.negative, 9)
(1.587401052, 1.587401052)

after which ``b.positive`` and ``b.negative`` are the two sides of the change. It works for a jump as well, which it halves.

Reference: N. Anderson, A. Bjorck, A new high order method of regula falsi type for computing a root of an equation, BIT 13,
1973, 253-264, doi 10.1007/BF01951936.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from stochfric_mb.compile import compiled_inline

SLOW = 3
"""Trials in a row that each leave more than half of the bracket, after which it is halved [-]: 2 to 4 do about as well on
nine functions, 3 best on the worst of them."""
ROUNDING = 2.3e-16
"""Relative distance of neighbouring numbers [-]."""


class Bracket(NamedTuple):
    """Two points, in any order, between which a function turns from positive to not positive."""

    positive: float
    """Where it is positive."""
    negative: float
    """Where it is not."""
    at_positive: float
    """Weight of the first point: the value there, lessened each time that the point stays a second time."""
    at_negative: float
    """Weight of the second point."""
    moved: int
    """1 if the first point was moved last, -1 if the second was, 0 at the start."""
    slow: int
    """Trials in a row that have each left more than half of the bracket."""


@compiled_inline
def bracket(positive, at_positive, negative, at_negative):
    """Return a bracket from a point where the function is positive and one where it is not, with the values there."""
    return Bracket(positive, negative, at_positive, at_negative, 0, 0)


@compiled_inline
def is_wide(b, resolution):
    """Return whether there is a point to try: the bracket is wider than ``resolution`` and than its rounding."""
    middle = 0.5 * (b.positive + b.negative)
    return abs(b.negative - b.positive) > resolution and middle not in (b.positive, b.negative)


@compiled_inline
def trial(b, resolution):
    """Return the next point to evaluate, at least half of ``resolution`` within the bracket, so that both ends close in."""
    p, n = b.positive, b.negative
    middle = 0.5 * (p + n)
    if b.slow >= SLOW or not b.at_positive > 0.0:  # a search may start on a zero: where a switch has just been
        return middle
    low, high = min(p, n), max(p, n)
    within = max(0.5 * resolution, ROUNDING * max(abs(p), abs(n)))
    x = min(max(p + (n - p) * (b.at_positive / (b.at_positive - b.at_negative)), low + within), high - within)
    return x if low < x < high else middle  # not so where a value is infinite or not a number


@compiled_inline
def narrowed(b, x, value):
    """Return the bracket with the point x, at which the function has ``value``, in place of one of its ends."""
    width = abs(b.negative - b.positive)
    if value > 0.0:
        slow = b.slow % SLOW + 1 if abs(b.negative - x) > 0.5 * width else 0
        return Bracket(x, b.negative, value, b.at_negative * (_less(value, b.at_positive) if b.moved == 1 else 1.0), 1, slow)
    slow = b.slow % SLOW + 1 if abs(x - b.positive) > 0.5 * width else 0
    return Bracket(b.positive, x, b.at_positive * (_less(value, b.at_negative) if b.moved == -1 else 1.0), value, -1, slow)


@compiled_inline
def _less(value, last):
    """Return what the weight of an end that stays is multiplied by, where the value at the other fell from ``last``."""
    part = 1.0 - value / last if last != 0.0 else 0.0
    return part if part > 0.0 else 0.5


@compiled_inline
def least_armed(before, now):
    """Return the least value of ``now`` among those that were positive ``before``, infinity if none was.

    Where several guards of a law may turn within a step, this turns with the first of them.
    """
    least = math.inf
    for i in range(len(before)):
        if before[i] > 0.0:
            least = min(least, now[i])
    return least
