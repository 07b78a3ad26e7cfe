"""A run as discovery sees it: cleaned, with its noise, and mirrored so that the belt always moves forward."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
from scipy.ndimage import median_filter
from scipy.signal import lfilter, savgol_filter

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.noise import white_noise
from stochfric_mb.discovery.inference.stray_readings import in_a_row, without
from stochfric_mb.mechanisms import BeltBox
from stochfric_mb.reference.augmented_model import TEMPERATURES

Array = npt.NDArray[np.float64]

MEDIAN_WIDTH = 7
"""Width of the running median against which outliers are seen, at most [samples]."""
MEDIAN_ANGLE = 0.4
"""The same as an angle of the natural oscillation, at most [rad]; but at least three samples."""
SMOOTHING_ANGLE = 0.4
"""Width of the window in which the motion is smoothed, as an angle of the natural oscillation [rad]."""
LINE_WINDOW = 128
"""Samples of the pieces in which a line of the noise is looked for."""
LEAST_NOISE = 1.0e-10
"""Noise that is always allowed, over the span of the record [-]: rounding of the sums."""
CORRECTED = ("stiffness", "mass", "damping")
"""Parameters of the mechanism that recalibration may correct."""
LEAST_CORRECTION = -0.95
"""Least relative correction of each of them [-]: no rig is without mass, stiffness or any damping. What a regression, which is
linear, takes beyond belongs to an effect: friction that falls with speed looks like damping below zero."""
LAGS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96)
"""Lags at which the colour of the noise is looked at [samples]."""
MEMORIES = 1.0 - np.geomspace(0.95, 0.003, 48)
"""Correlations from sample to sample that are tried [-]."""
RESTLESS = 8.0
"""Variance of a stick phase over that of the others beyond which it holds more than noise; even noise that is as slow as
a fifth of a phase stays below it in 999 of 1000 [-]."""


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

    def of_mean(self, count: int) -> float:
        """Return the standard deviation of the mean of so many samples [m], with the coloured part at its long-run strength."""
        slow = self.coloured**2 * (1.0 + self.memory) / (1.0 - self.memory)
        return math.sqrt((self.white**2 + slow) / count)

    def draw(self, n: int, generator: np.random.Generator) -> Array:
        """Return ``n`` samples of such noise [m]."""
        noise = self.white * generator.standard_normal(n)
        if self.coloured > 0.0:
            steps = self.coloured * math.sqrt(1.0 - self.memory**2) * generator.standard_normal(n + 400)
            noise += np.asarray(lfilter([1.0], [1.0, -self.memory], steps))[400:]
        return noise


def corrections_of(coefficients: Array) -> dict[str, float]:
    """Return the relative corrections of the mechanism [-] that a regression estimates, shape (3,), as far as one can be so."""
    return dict(zip(CORRECTED, map(float, np.maximum(coefficients, LEAST_CORRECTION)), strict=True))


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
    """The mechanism that forces are taken with, under the run's operating conditions, mirrored alike: its belt velocity is
    positive."""
    stated: BeltBox
    """The mechanism as stated, not mirrored."""
    direction: int
    """-1 where the run was mirrored, otherwise 1."""
    temperature: Array | None = None
    """Measured temperature [degC]; None: none was."""

    @property
    def duration(self) -> float:
        """Length of the record [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def rate(self) -> float:
        """Samples a second [Hz]."""
        return (len(self.time) - 1) / self.duration

    @property
    def angular_frequency(self) -> float:
        """Natural angular frequency sqrt(k/m) [rad/s]."""
        return math.sqrt(self.mechanism.stiffness / self.mechanism.mass)

    @property
    def deflection(self) -> float:
        """Deflection N/k of the spring under the normal force [m]: the length that is the rig's own."""
        return self.mechanism.normal_force / self.mechanism.stiffness

    @functools.cached_property
    def motion(self) -> tuple[Array, Array]:
        """Smoothed position [m] and velocity [m/s], shape (n,) each, not mirrored."""
        width = max(self.samples(SMOOTHING_ANGLE) | 1, 5)
        step = 1.0 / self.rate
        smooth, velocity = (savgol_filter(self.position, width, 3, deriv=d, delta=step) for d in (0, 1))
        return self.direction * np.asarray(smooth, dtype=np.float64), self.direction * np.asarray(velocity, dtype=np.float64)

    @functools.cached_property
    def temperatures(self) -> tuple[Array, Array] | None:
        """Times [s] and temperatures there [degC], means over as many even parts of the record, shape (TEMPERATURES,) each."""
        if self.temperature is None:
            return None
        parts = np.array_split(np.arange(len(self.time)), TEMPERATURES)
        middle = np.array([(p[0] + p[-1]) / 2.0 for p in parts]) / self.rate + self.time[0]
        means = np.array([self.temperature[p].mean() for p in parts])
        even = np.linspace(middle[0], middle[-1], TEMPERATURES)
        return even, np.interp(even, middle, means)

    @property
    def corrections(self) -> dict[str, float]:
        """Relative difference of the mechanism that forces are taken with from the stated one [-], by name."""
        pairs = {name: (getattr(self.mechanism, name), getattr(self.stated, name)) for name in CORRECTED}
        return {name: here / stated - 1.0 if stated else 0.0 for name, (here, stated) in pairs.items()}

    def corrected(self, corrections: Mapping[str, float]) -> Record:
        """Return the record with forces to be taken with a mechanism that differs from the stated one by ``corrections``."""
        numbers = {name: getattr(self.stated, name) * (1.0 + value) for name, value in corrections.items()}
        return dataclasses.replace(self, mechanism=dataclasses.replace(self.mechanism, **numbers))

    def showing(self, position: Array) -> Record:
        """Return the record as it would be had the sensor shown ``position`` [m], shape (n,), not mirrored."""
        return make_record(self.name, self.time, position, self.stated, self.temperature).corrected(self.corrections)

    def samples(self, angle: float) -> int:
        """Return how many samples the natural oscillation takes to turn by ``angle`` [rad]."""
        return max(round(angle / self.angular_frequency * self.rate), 1)

    def excitation(self, time: Array) -> Array:
        """Return the known force k u_0 cos(W t) [N] at ``time``."""
        box = self.mechanism
        return box.stiffness * box.excitation_amplitude * np.cos(box.excitation_angular_frequency * time)


def make_record(name: str, time: Array, position: Array, mechanism: BeltBox, temperature: Array | None = None) -> Record:
    """Return the cleaned record of one run.

    Args:
        name: name of the run.
        time: uniform time [s], shape (n,); the record's excitation phase counts from its zero.
        position: position [m], shape (n,).
        mechanism: the mechanism under the run's operating conditions.
        temperature: measured temperature [degC], shape (n,); None: none was.
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
    noise = max(white_noise(raw), LEAST_NOISE * float(np.ptp(raw)))
    # no wider than the motion allows: across a corner of few samples a median is far off
    turn = math.sqrt(mechanism.stiffness / mechanism.mass) * (time[-1] - time[0]) / (len(time) - 1)
    width = min(MEDIAN_WIDTH, max((int(MEDIAN_ANGLE / turn) - 1) // 2 * 2 + 1, 3))
    median = median_filter(raw, width, mode="nearest")
    away = np.abs(raw - median)
    # a sensor that smooths or holds its samples has smaller third differences than deviations
    outlier = away > criteria.OUTLIER_DEVIATIONS * max(noise, float(np.quantile(away, 0.85)) / 1.44) + _bend(
        median, turn, width
    )
    # what lasts longer than single samples is motion, unless it comes back to the curve that it left
    row = in_a_row(raw, outlier, criteria.OUTLIER_DEVIATIONS, noise)
    crowd = np.convolve(outlier.astype(np.float64), np.ones(width), mode="same")
    outlier &= (crowd <= width // 2) & ~row
    cleaned = without(np.where(outlier, median, raw), [], row)
    return Record(name, time, cleaned, raw, outlier | row, noise, mechanism, stated, direction, temperature)


def _bend(motion: Array, turn: float, width: int) -> float:
    """Return how far a sample is from the running median where the motion turns round [m].

    The box turns with the acceleration a of a slip's ends, omega^2 times half the way of a slip. Of the parabola a t^2/2 the
    median is the value at half the window's half width.

    Args:
        motion: position, its outliers taken out [m].
        turn: angle of the natural oscillation in a sample [rad].
        width: of the median [samples].
    """
    reach = (width // 2 + 1) // 2
    return float(0.25 * np.ptp(motion) * (turn * reach) ** 2)


def line_in(residuals: list[Array], rate: float) -> tuple[float, float, float]:
    """Return frequency [Hz], amplitude [m] and strength [-] of the strongest line in the noise of the stick phases.

    The strength is the line's power over its neighbours', less 1, over the standard deviation of that without a line.
    """
    pieces = [r[i : i + LINE_WINDOW] for r in residuals for i in range(0, len(r) - LINE_WINDOW + 1, LINE_WINDOW)]
    if len(pieces) < 8:
        return 0.0, 0.0, 0.0
    window = np.hanning(LINE_WINDOW)
    power = np.mean([np.abs(np.fft.rfft(window * (p - p.mean()))) ** 2 for p in pieces], axis=0)
    around = median_filter(power, 15, mode="nearest")
    ratio = power / np.maximum(around, 1.0e-300)
    ratio[:4] = 0.0
    best = int(np.argmax(ratio))
    # all of the main lobe: a line that falls between two frequencies stands in both
    lobe = slice(max(best - 2, 0), best + 3)
    above = float(np.maximum(power[lobe] - around[lobe], 0.0).sum())
    amplitude = 2.0 * math.sqrt(above / (LINE_WINDOW * float(window @ window)))
    return best * rate / LINE_WINDOW, amplitude, float((ratio[best] - 1.0) * math.sqrt(len(pieces)))


def noise_of(residuals: list[Array], white: float) -> Noise:
    """Return the noise that residuals of stick phases show (a line was taken out of each).

    Fits half the mean squared difference of samples a lag apart, white + coloured (1 - memory**lag): a difference does
    not know the mean that was taken out of a phase, which hides noise slower than the phase from its autocovariance.
    Phases that scatter far more than the others hold a motion, and are left out.
    """
    usable = [r - r.mean() for r in residuals if len(r) > 40]
    if sum(map(len, usable)) < 400:
        return Noise(white)
    typical = float(np.median([np.var(r) for r in usable]))
    usable = [r for r in usable if np.var(r) <= RESTLESS * typical]
    lags = np.arange(4)
    pairs = np.array([sum(len(r) - lag for r in usable) for lag in lags], dtype=np.float64)
    covariance = np.array([sum(float(r[lag:] @ r[: len(r) - lag]) for r in usable) for lag in lags]) / pairs
    deviation = math.sqrt(max(covariance[0], white**2 * 0.25))
    # the autocorrelation at lag 1..3 of pure white noise scatters by 1/sqrt(n); four of those count as colour
    if covariance[1:].mean() < 4.0 * covariance[0] / math.sqrt(pairs[0]):
        return Noise(deviation)
    return _coloured(usable)


def _coloured(usable: list[Array]) -> Noise:
    """Return white and coloured noise that fit half the mean squared differences best."""
    longest = float(np.median([len(r) for r in usable])) / 3.0
    apart = np.array([lag for lag in LAGS if lag < longest])
    halves = np.array([_half_difference(usable, lag) for lag in apart])
    best = (np.inf, 0.0, 0.0, 0.0)
    for memory in MEMORIES:
        shape = 1.0 - memory**apart
        for columns in (np.stack([np.ones(len(apart)), shape], axis=1), shape[:, None]):
            strengths = np.linalg.lstsq(columns, halves, rcond=None)[0]
            misfit = float(np.sum((halves - columns @ strengths) ** 2))
            if (strengths >= 0.0).all() and misfit < best[0]:
                best = (misfit, float(memory), float(strengths[-1]), float(strengths[0]) if len(strengths) > 1 else 0.0)
    _, memory, coloured, rest = best
    return Noise(math.sqrt(coloured + rest), math.sqrt(coloured), memory)


def _half_difference(pieces: list[Array], lag: int) -> float:
    """Return half the mean squared difference of samples ``lag`` apart [m^2]."""
    longer = [p for p in pieces if len(p) > lag]
    count = sum(len(p) - lag for p in longer)
    return 0.5 * sum(float(np.sum((p[lag:] - p[:-lag]) ** 2)) for p in longer) / max(count, 1)
