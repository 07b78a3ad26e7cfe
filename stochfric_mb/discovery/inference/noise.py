"""Noise of a signal, and how many independent numbers a coloured one is worth."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.signal import correlate

from stochfric_mb.numerics.robust import deviation

Array = npt.NDArray[np.float64]


def white_noise(signal: Array) -> float:
    """Return the standard deviation of white noise on a smooth signal, from the median size of its third differences.

    The variance of a third difference of white noise is 1 + 9 + 9 + 1 = 20 times that of the noise.
    """
    return float(deviation(np.diff(signal, 3), about=0.0) / np.sqrt(20.0))


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
