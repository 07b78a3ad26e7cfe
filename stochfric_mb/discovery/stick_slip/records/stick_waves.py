"""Waves in stick phases: how much of what the phases show each frequency would explain, and whether slips hold a wave as well.

A sensor shows its own waves all along; a belt moves no sliding box.
"""

# pyright: reportMissingParameterType=false, reportUnknownParameterType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownMemberType=false
# (compiled functions are typed by numba)

from __future__ import annotations

import math

import numpy as np

from stochfric_mb.compile import compiled
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import Slips
from stochfric_mb.discovery.stick_slip.records.stick_motion import tones

SPACED = 1.0e-9
"""Share by which two distances between samples may differ to be the same [-]: a hundred such steps turn a wave by 1e-7."""
FEWEST = 12
"""Samples below which a slip says nothing of a wave beside its own motion."""
EDGE = 0.1
"""Share of a slip at either end that is left out: its edges are not known so well [-]."""


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


def centred(column: Array, segment: np.ndarray) -> Array:
    """Return a column less its mean in each phase; ``segment``: the phase of each sample."""
    return column - (np.bincount(segment, column) / np.maximum(np.bincount(segment), 1))[segment]


def wave_in_stick(slips: Slips, frequency: float, count: int = 1) -> Array:
    """Return the amplitudes of cosine and sine of a wave's tones in the position [m], as stick shows them, shape (count, 2)."""
    samples = slips.stick
    columns = [centred(c, samples.segment) for c in (*tones(samples.time, frequency, count), samples.time)]
    wave = np.linalg.lstsq(np.stack(columns, axis=1), centred(samples.residual, samples.segment), rcond=None)[0][:-1]
    return np.asarray(wave, dtype=np.float64).reshape(count, 2)


def in_slips_too(slips: Slips, frequency: float) -> float:
    """Return twice the log likelihood ratio of the stick phases' wave being in the slips as well, to there being none [-].

    A slip's own motion, a free oscillation about a level that may drift, is fitted beside it in each slip.
    """
    record = slips.record
    wave, total = wave_in_stick(slips, frequency)[0], 0.0
    half = np.pi * frequency * slips.stick.bin_size / record.rate  # means over bins show less of it
    wave = wave / max(np.sinc(half / np.pi), 0.1)
    for begin, end in zip(slips.onset_time, slips.restick_time, strict=True):
        edge = EDGE * (end - begin)
        first, last = np.searchsorted(record.time, (begin + edge, end - edge))
        if last - first < FEWEST:
            continue
        time = record.time[first:last]
        turned, angle = record.angular_frequency * (time - time[0]), 2.0 * np.pi * frequency * time
        own = np.stack([np.ones_like(time), time - time[0], np.cos(turned), np.sin(turned)], axis=1)
        basis = np.linalg.qr(own)[0]
        added = np.cos(angle) * wave[0] + np.sin(angle) * wave[1]
        shown, added = (x - basis @ (basis.T @ x) for x in (record.position[first:last], added))
        total += float(shown @ shown - (shown - added) @ (shown - added))
    return total / slips.noise.deviation**2
