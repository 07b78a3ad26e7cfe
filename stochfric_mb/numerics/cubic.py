"""Cubics through the values and slopes at two points, and what is asked of them; parabolas through three points."""

from __future__ import annotations

import math

from stochfric_mb.compile import compiled, compiled_inline
from stochfric_mb.numerics.root import bracket, is_wide, narrowed, trial

FINE = 1.0e-16
"""Part of the interval to which a change of sign is located."""


@compiled_inline
def hermite(h, u_0, v_0, u_1, v_1):
    """Return the coefficients (c0, c1, c2, c3) of the cubic in s from u_0 at s = 0 to u_1 at s = 1.

    Args:
        h: length of the interval [s].
        u_0: value at its start.
        v_0: slope at its start [1/s].
        u_1: value at its end.
        v_1: slope at its end [1/s].
    """
    a, b, d = h * v_0, h * v_1, u_1 - u_0
    return u_0, a, 3.0 * d - 2.0 * a - b, a + b - 2.0 * d


@compiled_inline
def value(c, s):
    """Return the cubic at s, from 0 to 1."""
    return c[0] + s * (c[1] + s * (c[2] + s * c[3]))


@compiled_inline
def slope(c, s):
    """Return the derivative of the cubic by s; over h it is the one by time."""
    return c[1] + s * (2.0 * c[2] + 3.0 * s * c[3])


@compiled
def sign_change(c, low, high):
    """Return where the cubic changes sign between low and high, just behind it; infinity if it does not."""
    at_low, at_high = value(c, low), value(c, high)
    if (at_low > 0.0) == (at_high > 0.0):
        return math.inf
    sign = 1.0 if at_low > 0.0 else -1.0
    b = bracket(low, sign * at_low, high, sign * at_high)
    while is_wide(b, FINE * high):
        s = trial(b, FINE * high)
        b = narrowed(b, s, sign * value(c, s))
    return max(b.positive, b.negative)


@compiled_inline
def turning_point(t_0, g_0, t_1, g_1, t_2, g_2):
    """Return (t, g) where the parabola through three points, t_0 < t_1 < t_2, is level; t is infinite on a straight line."""
    first = (g_1 - g_0) / (t_1 - t_0)
    bend = ((g_2 - g_1) / (t_2 - t_1) - first) / (t_2 - t_0)
    if bend == 0.0:
        return math.inf, g_1
    t = 0.5 * (t_0 + t_1 - first / bend)
    return t, g_1 - bend * (t - t_1) * (t - t_1)
