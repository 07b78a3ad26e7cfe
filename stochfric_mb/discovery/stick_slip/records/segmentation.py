"""Stick and slip, distinguished by the smoothed velocity relative to the belt, with hysteresis."""

from __future__ import annotations

import functools

import numpy as np
from scipy.signal import savgol_coeffs

from stochfric_mb.discovery.stick_slip.records.record import Array, Noise, Record

SMOOTHING_ANGLE = 0.55
"""Width of the smoothing window as an angle of the natural oscillation [rad]."""
ENTER, LEAVE = 1.2, 0.5
"""Relative velocities over the belt velocity at which a slip is seen and to which it is followed [-]."""
ENTER_NOISE, LEAVE_NOISE = 8.0, 4.0
"""The same, at least, as multiples of the velocity's noise [-]."""


def relative_velocity(record: Record, noise: Noise | None = None) -> tuple[Array, float]:
    """Return the smoothed relative velocity v_b - x' [m/s], shape (n,), and the standard deviation of its noise.

    Args:
        record: the record.
        noise: its noise, where that is known; a colour, which third differences do not show, makes the velocity noisier.
    """
    width = max(record.samples(SMOOTHING_ANGLE) | 1, 5)
    velocity = _slopes(record.position, width) * record.rate
    deviation = float(record.noise * np.sqrt(12.0 / width**3))
    if noise is not None and noise.coloured > 0.0:
        slope = savgol_coeffs(width, 2, deriv=1)
        place = np.arange(width)
        correlation = noise.memory ** np.abs(place[:, None] - place)
        coloured = noise.coloured**2 * float(slope @ correlation @ slope)
        deviation = max(deviation, float(np.sqrt(noise.white**2 * float(slope @ slope) + coloured)))
    return record.mechanism.belt_velocity - velocity, deviation * record.rate


def _slopes(values: Array, width: int) -> Array:
    """Return the slopes of parabolas through ``width`` samples around each [1/sample]; at the ends, of the outermost one."""
    first, middle, last = _weights(width)
    return np.concatenate((first @ values[:width], np.correlate(values, middle, mode="valid"), last @ values[-width:]))


@functools.lru_cache(maxsize=8)
def _weights(width: int) -> tuple[Array, Array, Array]:
    """Return the weights of the samples of a window in the slopes before, at and after its middle."""
    half = width // 2
    rows = [np.asarray(savgol_coeffs(width, 2, deriv=1, pos=p, use="dot"), dtype=np.float64) for p in range(width)]
    return np.array(rows[:half]), rows[half], np.array(rows[half + 1 :])


def slips_of(record: Record, noise: Noise | None = None) -> list[tuple[int, int]]:
    """Return the slips of a record as pairs of sample numbers (break-away, re-stick), rough to a few samples.

    Args:
        record: the record.
        noise: its noise, where that is known.
    """
    relative, deviation = relative_velocity(record, noise)
    belt = record.mechanism.belt_velocity
    enter = max(ENTER_NOISE * deviation, ENTER * belt)
    leave = max(LEAVE_NOISE * deviation, LEAVE * belt)
    shortest, apart = record.samples(0.64), record.samples(0.3)
    ends = np.flatnonzero(np.diff(np.concatenate(([False], relative > leave, [False]))))
    seen = np.logical_or.reduceat(relative > enter, ends[::2]) if len(ends) else np.zeros(0, dtype=bool)
    slips: list[list[int]] = []
    for begin, end in zip(ends[::2][seen].tolist(), (ends[1::2][seen] - 1).tolist(), strict=True):
        if slips and begin - slips[-1][1] < apart:
            slips[-1][1] = end
        else:
            slips.append([begin, end])
    return [(a, b) for a, b in slips if b - a > shortest]
