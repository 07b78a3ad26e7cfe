"""Waves in stick phases: how much of what the phases show a cosine and a sine of each frequency would explain."""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.compile import compiled


@compiled
def wave_gains(grid, time, segment, line, rest):
    """Return the fall of chi^2 by a cosine and a sine of each frequency, shape (len(grid),).

    Both are taken less their mean in each phase, and less their part along the line.

    Args:
        grid: frequencies [Hz], shape (f,).
        time: times of the samples [s], shape (n,).
        segment: number of each sample's phase, rising, shape (n,).
        line: unit vector of the belt's line, shape (n,), less its mean in each phase.
        rest: what the line leaves of the samples, shape (n,), likewise.
    """
    n = len(time)
    gains = np.zeros(len(grid))
    a, b = np.empty(n), np.empty(n)
    for i in range(len(grid)):
        pace = 2.0 * math.pi * grid[i]
        first = 0
        while first < n:
            last, total_a, total_b = first, 0.0, 0.0
            while last < n and segment[last] == segment[first]:
                a[last], b[last] = math.cos(pace * time[last]), math.sin(pace * time[last])
                total_a, total_b = total_a + a[last], total_b + b[last]
                last += 1
            for j in range(first, last):
                a[j] -= total_a / (last - first)
                b[j] -= total_b / (last - first)
            first = last
        along_a = along_b = 0.0
        for j in range(n):
            along_a += line[j] * a[j]
            along_b += line[j] * b[j]
        aa = bb = ab = ar = br = 0.0
        for j in range(n):
            x, y = a[j] - line[j] * along_a, b[j] - line[j] * along_b
            aa, bb, ab = aa + x * x, bb + y * y, ab + x * y
            ar, br = ar + x * rest[j], br + y * rest[j]
        determinant = aa * bb - ab * ab
        if determinant > 1.0e-9 * aa * bb:
            gains[i] = (bb * ar * ar - 2.0 * ab * ar * br + aa * br * br) / determinant
    return gains
