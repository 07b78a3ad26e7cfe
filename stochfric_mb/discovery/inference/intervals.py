"""95 % intervals that stay where a parameter can be.

A fit gives a value and a standard deviation; value -+ 1.96 deviations may reach to where no such parameter exists, a
negative mass or amplitude. The likelihood is taken as normal, N(value, deviation), and cut to the physical range [low,
high], every value in which is held possible. The interval is the narrowest that holds 95 % of what is left: the usual
one where the bounds are far away; at a bound it ends there, and reaches as far to the other side as 95 % need.
"""

from __future__ import annotations

import numpy as np
from scipy.special import ndtr, ndtri

from stochfric_mb.discovery.result import Interval

CONFIDENCE = 0.95
"""Probability that an interval holds the parameter [-]."""


def confidence_interval(value: float, deviation: float, unit: str, low: float = -np.inf, high: float = np.inf) -> Interval:
    """Return a fitted number with its 95 % interval.

    Args:
        value: fitted value; one that lies beyond a bound, by rounding, counts as on it.
        deviation: its standard deviation, >= 0; if it is 0 or not finite the number was not fitted.
        unit: its unit.
        low: smallest value that makes sense.
        high: largest one.
    """
    value = float(min(max(value, low), high))
    if not 0.0 < deviation < np.inf:
        return Interval(value, value, value, unit)
    down, up = (low - value) / deviation, (high - value) / deviation
    below, above = float(ndtr(down)), float(ndtr(up))
    held = CONFIDENCE * (above - below)
    half = float(ndtri(0.5 * (1.0 + held)))
    if half > -down:
        return Interval(value, float(low), value + deviation * min(float(ndtri(below + held)), up), unit)
    if half > up:
        return Interval(value, value + deviation * max(float(ndtri(above - held)), down), float(high), unit)
    return Interval(value, value - deviation * half, value + deviation * half, unit)
