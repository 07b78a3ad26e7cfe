"""The first zero of a curve whose value and slope are known functions: where a contact in closed form switches."""

from __future__ import annotations

import math
from types import ModuleType
from typing import Any

from stochfric_mb.compile import compiled
from stochfric_mb.numerics.root import bracket, is_wide, narrowed, trial

AHEAD = 1.0e-3
"""Part of the interval after which a curve that starts at zero is looked at again [-]."""
LEVEL = 1.0e-9
"""Part of the interval to which an extremum is found [-]: its value is then known to the square of that."""


def first_zero_of(curves: ModuleType, resolution: float) -> Any:
    """Return the compiled function (g, low, high): the first time after which the curve g is negative, or infinity.

    A curve that starts at or below zero and rises counts as positive until it comes back. It has at most one extremum
    between ``low`` and ``high``.

    Args:
        curves: module with the compiled functions ``value(g, t)`` and ``slope(g, t)``.
        resolution: part of the interval to which the zero is found, on its later side; 0: down to rounding.
    """
    value, slope, file = curves.value, curves.slope, str(curves.__file__)

    def zero(g, positive, at_positive, negative, at_negative):
        fine = resolution * abs(negative - positive)
        b = bracket(positive, at_positive, negative, at_negative)
        while is_wide(b, fine):
            t = trial(b, fine)
            b = narrowed(b, t, value(g, t))
        return b.negative

    def level(g, rising, falling):
        b = bracket(rising, slope(g, rising), falling, slope(g, falling))
        fine = LEVEL * abs(falling - rising)
        while is_wide(b, fine):
            t = trial(b, fine)
            b = narrowed(b, t, slope(g, t))
        return b.negative

    def first_zero(g, low, high):
        here, there = value(g, low), value(g, high)
        if here <= 0.0:
            start, low = low, low + AHEAD * (high - low)
            here = value(g, low)
            if here <= 0.0:
                if not slope(g, start) > 0.0 > slope(g, high):
                    return start
                low = turning(g, start, high)
                here = value(g, low)
                if here <= 0.0:
                    return start
        if there < 0.0:
            return crossing(g, low, here, high, there)
        if slope(g, low) < 0.0 < slope(g, high):
            bottom = turning(g, high, low)
            there = value(g, bottom)
            if there < 0.0:
                return crossing(g, low, here, bottom, there)
        return math.inf

    crossing, turning = compiled(zero, parts=file), compiled(level, parts=file)
    return compiled(first_zero, parts=file)
