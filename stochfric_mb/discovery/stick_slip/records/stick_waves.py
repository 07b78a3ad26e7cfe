"""Waves in stick phases: how much of what the phases show a cosine and a sine of each frequency would explain."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.compile import compiled

SPACED = 1.0e-9
"""Share by which two distances between samples may differ to be the same [-]: a hundred such steps turn a wave by 1e-7."""


@compiled
def wave_gains(grid, time, segment, line, rest):
    """Return the fall of chi^2 by a cosine and a sine of each frequency, shape (len(grid),).

    Both are taken less their mean in each phase, and less their part along the line. Samples of a phase are evenly spaced but
    where some are left out: from one to the next the wave is turned by a constant angle, which costs no cosine.

    Args:
        grid: frequencies [Hz], shape (f,).
        time: times of the samples [s], shape (n,).
        segment: number of each sample's phase, rising, shape (n,).
        line: vector of the belt's line, shape (n,).
        rest: what the line leaves of the samples, shape (n,).
    """
    n = len(time)
    gains = np.zeros(len(grid))
    for i in range(len(grid)):
        pace = 2.0 * math.pi * grid[i]
        spacing, turn_a, turn_b = 0.0, 1.0, 0.0
        aa = bb = ab = la = lb = ll = ar = br = lr = 0.0
        first = 0
        while first < n:
            last, a, b = first, 0.0, 0.0
            sum_a = sum_b = sum_l = sum_r = 0.0
            while last < n and segment[last] == segment[first]:
                if last > first and abs(time[last] - time[last - 1] - spacing) <= SPACED * spacing:
                    a, b = a * turn_a - b * turn_b, b * turn_a + a * turn_b
                else:
                    a, b = math.cos(pace * time[last]), math.sin(pace * time[last])
                    ahead = time[last + 1] - time[last] if last + 1 < n and segment[last + 1] == segment[first] else 0.0
                    if abs(ahead - spacing) > SPACED * spacing and ahead > 0.0:
                        spacing, turn_a, turn_b = ahead, math.cos(pace * ahead), math.sin(pace * ahead)
                x, r = line[last], rest[last]
                sum_a, sum_b, sum_l, sum_r = sum_a + a, sum_b + b, sum_l + x, sum_r + r
                aa, bb, ab = aa + a * a, bb + b * b, ab + a * b
                la, lb, ll = la + x * a, lb + x * b, ll + x * x
                ar, br, lr = ar + a * r, br + b * r, lr + x * r
                last += 1
            m = last - first
            aa, bb, ab = aa - sum_a * sum_a / m, bb - sum_b * sum_b / m, ab - sum_a * sum_b / m
            la, lb, ll = la - sum_l * sum_a / m, lb - sum_l * sum_b / m, ll - sum_l * sum_l / m
            ar, br, lr = ar - sum_a * sum_r / m, br - sum_b * sum_r / m, lr - sum_l * sum_r / m
            first = last
        if ll > 0.0:
            aa, bb, ab = aa - la * la / ll, bb - lb * lb / ll, ab - la * lb / ll
            ar, br = ar - la * lr / ll, br - lb * lr / ll
        determinant = aa * bb - ab * ab
        if determinant > 1.0e-9 * aa * bb:
            gains[i] = (bb * ar * ar - 2.0 * ab * ar * br + aa * br * br) / determinant
    return gains
