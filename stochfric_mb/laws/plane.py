"""Small vector steps in the tangent plane that several laws share."""

# pyright: standard
# (compiled functions are typed by numba)

from __future__ import annotations

import math

from stochfric_mb.compile import compiled, compiled_inline


@compiled_inline
def length(x, y):
    """Return the length of (x, y): what ``math.hypot`` returns, to rounding, and cheaper."""
    if y == 0.0:
        return abs(x)
    square = x * x + y * y
    if 1.0e-280 < square < 1.0e280:  # the squares neither underflow nor overflow
        return math.sqrt(square)
    return math.hypot(x, y)


@compiled
def along(magnitude, vx, vy):
    """Return the vector of length ``magnitude`` along (vx, vy); zero where v is zero, not a number where v is not."""
    speed = length(vx, vy)
    if speed == 0.0:
        return 0.0, 0.0
    return magnitude * (vx / speed), magnitude * (vy / speed)


@compiled
def slip_direction(vx, vy, dx, dy):
    """Return the unit vector along v while v keeps to the side of the committed direction d, otherwise d."""
    speed = length(vx, vy)
    if vx * dx + vy * dy > 0.0 and speed > 0.0:
        return vx / speed, vy / speed
    return dx, dy


@compiled
def clipped(fx, fy, limit):
    """Return (fx, fy) shortened to length ``limit`` where it is longer (return mapping)."""
    size = length(fx, fy)
    if size > limit:
        return fx * (limit / size), fy * (limit / size)
    return fx, fy
