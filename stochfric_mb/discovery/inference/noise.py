"""Noise of a signal, and how many independent numbers a coloured one is worth."""

from __future__ import annotations

import hashlib
import itertools

import numpy as np
import numpy.typing as npt
from scipy.signal import correlate, welch

from stochfric_mb.numerics.robust import deviation

Array = npt.NDArray[np.float64]


PIECE = 512
"""Samples of the pieces of which a spectrum is made."""
REPEATED = 1.0e-3
"""Share of readings that are those before, from which the spectrum says nothing [-]: jumps after them are level, too."""
BANDS, LEVEL, EVEN = 12, 4, 2.0
"""Half octaves that are looked at, from half of the sample rate down, and how many of them in a row are level within which
factor where the spectrum is that of noise [-]: that of a motion that jumps in its acceleration falls by 64 an octave."""


FEW_STEPS, ON_STEP, MOST_ON_STEP, LEAST_ROUGH = 5.5, 0.15, 0.99, 0.01
"""Steps below which changes of a signal are looked at, how far off from whole ones they may be where it comes in steps, and the
share that must be [-]: a file's digits round a count by less, and a third of all changes of a smooth signal are. And the share
of third differences that must be rough."""


ARITHMETIC = 1.0e-13
"""Change over the signal's size up to which an interpolation of equal readings errs [-]: some hundred rounding errors."""


_LEVELS: dict[bytes, float] = {}
"""Digest of a signal -> its `noise_level`: a record is asked for once for each delay that is tried and each window."""
MOST_LEVELS = 4096
"""Levels that are kept."""


def white_noise(signal: Array) -> float:
    """Return the standard deviation of white noise on a smooth signal, from the median size of its third differences.

    The variance of a third difference of white noise is 1 + 9 + 9 + 1 = 20 times that of the noise.
    """
    return float(deviation(np.diff(signal, 3), about=0.0) / np.sqrt(20.0))


def noise_level(signal: Array) -> float:
    """Return the standard deviation of white noise as strong as what means over several samples see of a signal's own.

    Where readings were interpolated, or smoothed, differences between samples show next to nothing: the spectrum ends below
    half of the sample rate. It is then that of the quickest two octaves in which it is level, as no motion's is.
    """
    digest = hashlib.blake2b(np.ascontiguousarray(signal, dtype=np.float64).data).digest()
    if digest not in _LEVELS:
        if len(_LEVELS) >= MOST_LEVELS:
            _LEVELS.clear()
        _LEVELS[digest] = _noise_level(signal)
    return _LEVELS[digest]


def changes(signal: Array) -> Array:
    """Return the sizes of the changes from sample to sample, shape (n - 1,); what arithmetic leaves of none is none."""
    moved = np.abs(np.diff(signal))
    return np.where(moved > ARITHMETIC * np.max(np.abs(signal), initial=0.0), moved, 0.0)


def resolution(signal: Array) -> float:
    """Return the step in which a signal comes; 0: it comes in none, or moves so evenly that none shows."""
    each = changes(signal)
    moved = each[each > 0.0]
    if not len(moved) or len(each) < 3:
        return 0.0
    step = float(moved.min())
    few = moved[moved < FEW_STEPS * step] / step
    between = bool(np.any((each[1:-1] == 0.0) & (each[:-2] > 0.0) & (each[2:] > 0.0)))
    if np.mean(np.abs(few - np.round(few)) < ON_STEP) < MOST_ON_STEP or not (between or np.ptp(np.round(few)) >= 1.0):
        return 0.0
    # a parabola comes in steps, too
    rough = np.count_nonzero((np.abs(np.diff(signal, 3)) > 0.5 * step) & (each[1:-1] > 0.0))
    return step if rough > LEAST_ROUGH * len(moved) else 0.0


def rounding_noise(signal: Array) -> float:
    """Return the standard deviation of the rounding error of a signal that comes in steps, step/sqrt(12); 0: in none.

    Differences between its samples do not show it where the signal rests, or moves by nearly as many steps each time.

    Reference: B. Widrow, I. Kollar, Quantization Noise, Cambridge 2008, section 4.2 (Sheppard's correction).
    """
    return resolution(signal) / float(np.sqrt(12.0))


def _noise_level(signal: Array) -> float:
    white = max(white_noise(signal), rounding_noise(signal))
    if len(signal) < 2 * PIECE or white <= 0.0 or np.mean(np.diff(signal) == 0.0) > REPEATED:
        return white
    # third differences leave little of the motion, which would leak into all frequencies; stray readings are in few pieces
    frequency, power = welch(np.diff(signal, 3), nperseg=PIECE, detrend="constant", average="median")
    with np.errstate(divide="ignore", invalid="ignore"):
        density = power / (2.0 * np.sin(np.pi * frequency)) ** 6
    edges = 0.5 / np.sqrt(2.0) ** np.arange(BANDS + 1)
    bands = np.array([np.median(density[(frequency > low) & (frequency <= high)]) for high, low in itertools.pairwise(edges)])
    level = (bands[i : i + LEVEL] for i in range(BANDS - LEVEL + 1))
    first = next((part for part in level if part.max() <= EVEN * part.min()), np.zeros(1))
    slow = float(np.sqrt(np.median(first) / 2.0))  # of white noise the density is twice the variance, up to half the rate
    return slow if slow > EVEN * white else white


def independent_count(values: Array) -> float:
    """Return to how many independent numbers a series is worth: n over its integrated autocorrelation.

    The sum ends where the autocorrelation first falls below two standard errors of white noise.
    """
    n = len(values)
    if n < 8:
        return float(n)
    x = values - values.mean()
    correlation = correlate(x, x, method="fft")[n - 1 : n - 1 + n // 2]
    if correlation[0] <= 0.0:
        return float(n)
    correlation = correlation / correlation[0]
    end = int(np.argmax(correlation < 2.0 / np.sqrt(n))) or len(correlation)
    return float(n / max(1.0 + 2.0 * correlation[1:end].sum(), 1.0))
