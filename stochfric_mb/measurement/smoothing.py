"""Weak form: signals and their derivatives seen through a smooth window, without differentiating noise.

phi * x'' = phi'' * x for a window phi that vanishes with its derivatives at its ends (partial integration): the derivative
is taken of the window, which is known, and not of the record, which is noisy. The window is symmetric, so that it delays
nothing, and may be placed between samples, so that a signal is shifted without being interpolated.
"""

from __future__ import annotations

import functools

import numpy as np
import numpy.typing as npt
from numpy.polynomial import Polynomial

from stochfric_mb.errors import InputError

Array = npt.NDArray[np.float64]

POWER = 6
"""Power p of the window (1 - (t/w)^2)^p: p - 1 derivatives vanish at its ends."""


@functools.lru_cache(maxsize=256)
def window(half_width: float, sample_interval: float, *, derivative: int = 0, shift: float = 0.0) -> Array:
    """Return samples of a derivative of the window phi(t) = (1 - (t/w)^2)^6 / norm, of integral 1, for convolution.

    Args:
        half_width: w [s], at least three sample intervals.
        sample_interval: distance between samples [s].
        derivative: order of the derivative [-], 0 to 4.
        shift: time by which convolution with the window delays a signal [s]; below one sample interval.

    Returns:
        float64[2 m + 1], centred on the middle sample, times the sample interval, in 1/s^derivative; to be read only.
    """
    taps = _window(half_width, sample_interval, derivative, shift)
    taps.flags.writeable = False  # it is remembered
    return taps


def _window(half_width: float, sample_interval: float, derivative: int, shift: float) -> Array:
    m = int(np.ceil(half_width / sample_interval)) + 1
    s = (np.arange(-m, m + 1) * sample_interval - shift) / half_width
    shape = Polynomial([1.0, 0.0, -1.0]) ** POWER
    norm = half_width * (shape.integ()(1.0) - shape.integ()(-1.0))
    inside = np.abs(s) < 1.0
    plain = np.where(inside, shape(s), 0.0) * sample_interval / norm
    if derivative == 0:
        return plain / plain.sum()
    values = np.where(inside, shape.deriv(derivative)(s), 0.0) * sample_interval / (norm * half_width**derivative)
    return values - values.sum() * plain  # a constant has no derivative, also as a sum over samples


def smooth(values: Array, half_width: float, sample_interval: float, *, derivative: int = 0, shift: float = 0.0) -> Array:
    """Return ``values`` (or a derivative of them) through the window, delayed by ``shift`` [s].

    Args:
        values: float64[n], uniform samples.
        half_width: half the length of the window [s].
        sample_interval: distance between samples [s].
        derivative: order of the derivative [-].
        shift: delay [s]; any size and sign.

    Returns:
        float64[n]; the samples nearer to an end than half the window (and the shift) are not to be used.

    Raises:
        InputError: fewer samples than the window has.
    """
    whole = int(np.floor(shift / sample_interval))
    taps = window(half_width, sample_interval, derivative=derivative, shift=shift - whole * sample_interval)
    if taps.size > values.size:
        raise InputError(f"{values.size} samples are fewer than the window of {taps.size} holds; give a shorter half_width")
    return np.roll(np.convolve(values, taps, mode="same"), whole)
