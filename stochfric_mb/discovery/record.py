"""A run as discovery sees it: cleaned, with its noise, and mirrored so that the belt always moves forward."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import numpy.typing as npt
from scipy.ndimage import median_filter
from scipy.signal import lfilter

from stochfric_mb.mechanisms import BeltBox

Array = npt.NDArray[np.float64]

MEDIAN_WIDTH = 7
"""Width of the running median against which outliers are seen [samples]."""
LINE_WINDOW = 128
"""Samples of the pieces in which a line of the noise is looked for."""
OUTLIER_DEVIATIONS = 5.5
"""A sample further from the running median than this many standard deviations is an outlier [-]."""


@dataclasses.dataclass(frozen=True)
class Noise:
    """White noise plus a first-order autoregressive part, as the stick phases show it."""

    deviation: float
    """Standard deviation of all of it [m]."""
    coloured: float = 0.0
    """Standard deviation of the coloured part [m]."""
    memory: float = 0.0
    """Correlation of the coloured part from sample to sample [-]."""

    @property
    def white(self) -> float:
        """Standard deviation of the white part [m]."""
        return math.sqrt(max(self.deviation**2 - self.coloured**2, 0.0))

    def draw(self, n: int, generator: np.random.Generator) -> Array:
        """Return ``n`` samples of such noise [m]."""
        noise = self.white * generator.standard_normal(n)
        if self.coloured > 0.0:
            steps = self.coloured * math.sqrt(1.0 - self.memory**2) * generator.standard_normal(n + 400)
            noise += np.asarray(lfilter([1.0], [1.0, -self.memory], steps))[400:]
        return noise


@dataclasses.dataclass(frozen=True)
class Record:
    """One run, ready for analysis; arrays have shape (n,)."""

    name: str
    """Name of the run's file."""
    time: Array
    """Time from the start of the record [s]."""
    position: Array
    """Cleaned position [m], mirrored where the belt moves backwards."""
    raw: Array
    """Position as measured [m], mirrored alike."""
    outlier: npt.NDArray[np.bool_]
    """Where the sample was replaced by the running median."""
    noise: float
    """Standard deviation of the white part of the noise [m], from third differences."""
    mechanism: BeltBox
    """The mechanism under the run's operating conditions, mirrored alike: its belt velocity is positive."""
    stated: BeltBox
    """The mechanism as stated, not mirrored."""
    direction: int
    """-1 where the run was mirrored, otherwise 1."""

    @property
    def rate(self) -> float:
        """Samples a second [Hz]."""
        return (len(self.time) - 1) / (self.time[-1] - self.time[0])

    @property
    def angular_frequency(self) -> float:
        """Natural angular frequency sqrt(k/m) [rad/s]."""
        return math.sqrt(self.mechanism.stiffness / self.mechanism.mass)

    def samples(self, angle: float) -> int:
        """Return how many samples the natural oscillation takes to turn by ``angle`` [rad]."""
        return max(round(angle / self.angular_frequency * self.rate), 1)

    def excitation(self, time: Array) -> Array:
        """Return the known force k u_0 cos(W t) [N] at ``time``."""
        box = self.mechanism
        return box.stiffness * box.excitation_amplitude * np.cos(box.excitation_angular_frequency * time)


def make_record(name: str, time: Array, position: Array, mechanism: BeltBox) -> Record:
    """Return the cleaned record of one run.

    Args:
        name: name of the run.
        time: uniform time [s], shape (n,); the record's excitation phase counts from its zero.
        position: position [m], shape (n,).
        mechanism: the mechanism under the run's operating conditions.
    """
    direction = -1 if mechanism.belt_velocity < 0.0 else 1
    stated = mechanism
    raw = direction * position
    if direction < 0:
        mechanism = dataclasses.replace(
            mechanism,
            belt_velocity=-mechanism.belt_velocity,
            excitation_amplitude=-mechanism.excitation_amplitude,
        )
    noise = white_noise(raw)
    median = median_filter(raw, MEDIAN_WIDTH, mode="nearest")
    away = np.abs(raw - median)
    # a sensor that smooths or holds its samples has smaller third differences than deviations
    outlier = away > OUTLIER_DEVIATIONS * max(noise, float(np.quantile(away, 0.85)) / 1.44)
    # single samples alone: what lasts longer is motion
    crowd = np.convolve(outlier.astype(np.float64), np.ones(MEDIAN_WIDTH), mode="same")
    outlier &= crowd <= MEDIAN_WIDTH // 2
    return Record(name, time, np.where(outlier, median, raw), raw, outlier, noise, mechanism, stated, direction)


def white_noise(position: Array) -> float:
    """Return the standard deviation of white noise from the third differences of a record (their variance is 20 times)."""
    third = np.diff(position, 3)
    return float(max(np.median(np.abs(third)) / 0.6745 / math.sqrt(20.0), 1.0e-12))


def line_in(residuals: list[Array], rate: float) -> tuple[float, float, float]:
    """Return frequency [Hz], amplitude [m] and strength [-] of the strongest line in the noise of the stick phases.

    The strength is the line's power over its neighbours', less 1, over the standard deviation of that without a line.
    """
    pieces = [r[i : i + LINE_WINDOW] for r in residuals for i in range(0, len(r) - LINE_WINDOW + 1, LINE_WINDOW)]
    if len(pieces) < 8:
        return 0.0, 0.0, 0.0
    window = np.hanning(LINE_WINDOW)
    power = np.mean([np.abs(np.fft.rfft(window * (p - p.mean()))) ** 2 for p in pieces], axis=0)
    ratio = power / np.maximum(median_filter(power, 15, mode="nearest"), 1.0e-300)
    ratio[:4] = 0.0
    best = int(np.argmax(ratio))
    amplitude = 2.0 * math.sqrt(float(power[best])) / window.sum()
    return best * rate / LINE_WINDOW, amplitude, float((ratio[best] - 1.0) * math.sqrt(len(pieces)))


def noise_of(residuals: list[Array], white: float) -> Noise:
    """Return the noise that residuals of stick phases show (a line was taken out of each).

    Fits an autocovariance of lags 0 to 8: white + coloured * memory**lag.
    """
    usable = [r - r.mean() for r in residuals if len(r) > 40]
    if sum(map(len, usable)) < 400:
        return Noise(white)
    lags = np.arange(9)
    pairs = np.array([sum(len(r) - lag for r in usable) for lag in lags], dtype=np.float64)
    covariance = np.array([sum(float(r[lag:] @ r[: len(r) - lag]) for r in usable) for lag in lags]) / pairs
    deviation = math.sqrt(max(covariance[0], white**2 * 0.25))
    # the autocorrelation at lag 1..8 of pure white noise scatters by 1/sqrt(n); four of those count as colour
    if covariance[1:4].mean() < 4.0 * covariance[0] / math.sqrt(pairs[0]):
        return Noise(deviation)
    memories = np.linspace(0.05, 0.99, 48)
    shapes = memories[:, None] ** lags[None, 1:]
    strength = (shapes @ covariance[1:]) / (shapes**2).sum(axis=1)
    misfit = ((covariance[1:] - strength[:, None] * shapes) ** 2).sum(axis=1)
    best = int(np.argmin(misfit))
    coloured = math.sqrt(min(max(strength[best], 0.0), covariance[0]))
    return Noise(deviation, coloured, float(memories[best]))
