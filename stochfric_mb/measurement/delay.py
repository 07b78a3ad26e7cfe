"""Delay between two measured signals, such as a force and the motion that follows it.

A force that is recorded 10 ms early looks like damping of the wrong sign, or like friction that depends on acceleration.
"""

from __future__ import annotations

import dataclasses
import importlib
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.errors import InputError, require_number
from stochfric_mb.measurement.smoothing import smooth

Array = npt.NDArray[np.float64]

STEPS = 4
"""Points of the grid of delays in one sample interval; the window is smooth over them."""
SEGMENTS = 24
"""Pieces of the record that are drawn again and again for the interval; fewer where they would be too short."""
RESAMPLES = 400
"""Bootstrap resamples."""
MIN_SEGMENTS = 6
"""Fewest pieces that give an interval."""


@dataclasses.dataclass(frozen=True)
class Delay:
    """By how much a response comes after its driver."""

    seconds: float
    """The delay [s]; negative: the response comes first."""
    low: float
    """Lower end of the 95 % interval [s]."""
    high: float
    """Upper end of the 95 % interval [s]."""
    explained: float
    """Part of the driver's variance that the response explains at that delay, 0 to 1 [-]."""
    explained_without: float
    """The same without any delay [-]."""


@dataclasses.dataclass(frozen=True)
class Term:
    """One signal that, with a factor to be estimated, makes up the response."""

    signal: Array
    """float64[n]."""
    derivative: int = 0
    """Which derivative of it is meant [-]; it is taken in weak form."""


def estimate_delay(
    driver: Array,
    response: Array | Sequence[Term],
    sample_interval: float,
    *,
    max_delay: float | None = None,
    half_width: float | None = None,
    seed: int = 0,
) -> Delay:
    """Return the delay T at which driver(t - T) = sum of factors times the terms of the response fits best.

    T minimises the part of the driver's variance that the terms leave, both seen through one smooth window
    (`stochfric_mb.measurement.smoothing`), which is shifted between samples instead of the noisy driver being interpolated.
    The factors are least squares at each T. The interval is a bootstrap over pieces of the record. For a hinge pendulum
    m l^2 q'' + b q' + m g l sin q = torque, the driver is the torque, and the terms are q twice differentiated, q once
    differentiated, and sin q.

    Args:
        driver: float64[n], uniform samples of what comes first.
        response: float64[n], or the terms of which a combination follows the driver.
        sample_interval: distance between samples [s].
        max_delay: largest delay that is looked for, either way [s]; None: 40 sample intervals.
        half_width: half the length of the window [s]; None: 20 sample intervals. Longer against noise, shorter for
            signals that change within it.
        seed: of the bootstrap.

    Raises:
        InputError: lengths differ, a signal is constant or not finite, the record is too short for ``max_delay``, or the
            best delay is the largest that was looked for.
    """
    require_number("sample_interval", sample_interval, above=0.0, unit="s")
    reach = 40.0 * sample_interval if max_delay is None else require_number("max_delay", max_delay, above=0.0, unit="s")
    w = 20.0 * sample_interval if half_width is None else half_width
    require_number("half_width", w, low=3.0 * sample_interval, unit="s")
    terms = [Term(response)] if isinstance(response, np.ndarray) else list(response)
    _require_usable(driver, terms)
    margin = int(np.ceil((w + reach) / sample_interval)) + 2
    bounds = _segments(driver.size, margin)
    lags = np.arange(-round(STEPS * reach / sample_interval), round(STEPS * reach / sample_interval) + 1) / STEPS
    centred = driver - driver.mean()
    x = np.array([smooth(t.signal - t.signal.mean(), w, sample_interval, derivative=t.derivative) for t in terms])
    x /= np.sqrt(np.mean(x[:, margin:-margin] ** 2, axis=1, keepdims=True))
    x = np.vstack([x, np.ones(driver.size)])
    y = np.array([smooth(centred, w, sample_interval, shift=lag * sample_interval) for lag in lags])
    yy, xy, xx = (_sums(a, bounds) for a in (y * y, x[:, None] * y, x[:, None] * x))
    total = np.full((1, len(bounds) - 1), 1.0)
    left = _unexplained(total, yy, xy, xx)[0]
    best = int(np.argmin(left))
    if best in (0, lags.size - 1):
        raise InputError(
            f"the delay is not within max_delay = {reach:g} s: the fit is best at its end; raise max_delay, or give other terms"
        )
    draws = np.random.default_rng(seed).multinomial(total.size, np.full(total.size, 1.0 / total.size), size=RESAMPLES)
    spread = [_lowest(lags, curve) for curve in _unexplained(draws.astype(np.float64), yy, xy, xx)]
    lowest = _lowest(lags, left)
    low, high = lowest + _few(total.size) * (np.quantile(spread, (0.025, 0.975)) - lowest)
    zero = int(np.argmin(np.abs(lags)))
    return Delay(
        seconds=lowest * sample_interval,
        low=min(float(low), lowest) * sample_interval,
        high=max(float(high), lowest) * sample_interval,
        explained=1.0 - float(left[best]),
        explained_without=1.0 - float(left[zero]),
    )


def _require_usable(driver: Array, terms: Sequence[Term]) -> None:
    for name, values in [("driver", driver), *((f"term {i}", t.signal) for i, t in enumerate(terms))]:
        if values.shape != driver.shape or values.ndim != 1:
            raise InputError(f"{name} has shape {values.shape} but the driver {driver.shape}; give signals of one length")
        if not np.isfinite(values).all():
            raise InputError(f"{name} is not finite everywhere; remove or correct the samples")
        if np.ptp(values) == 0.0:
            raise InputError(f"{name} is constant: it has no delay; leave it out, a constant is always among the terms")


def _segments(n: int, margin: int) -> npt.NDArray[np.int64]:
    """Return the bounds of the pieces of the samples that window and shift leave, int64[pieces + 1]."""
    usable = n - 2 * margin
    count = min(SEGMENTS, usable // margin)
    if count < MIN_SEGMENTS:
        raise InputError(
            f"{n} samples are too few for an interval of the delay: at least {(MIN_SEGMENTS + 2) * margin} are needed; lower "
            "max_delay or half_width, or record longer"
        )
    return np.linspace(margin, n - margin, count + 1).astype(np.int64)


def _sums(values: Array, bounds: npt.NDArray[np.int64]) -> Array:
    """Return the sums of ``values`` over the pieces: float64[..., n] -> float64[..., pieces]."""
    return np.add.reduceat(values[..., : bounds[-1]], bounds[:-1], axis=-1)


def _unexplained(weights: Array, yy: Array, xy: Array, xx: Array) -> Array:
    """Return the part of the driver's mean square that the terms leave.

    Args:
        weights: how often each piece counts, float64[draws, pieces].
        yy: sums of squares of the driver, float64[lags, pieces].
        xy: sums of products with the terms, float64[terms, lags, pieces].
        xx: sums of products of the terms, float64[terms, terms, pieces].

    Returns:
        float64[draws, lags].
    """
    square: Array = np.matmul(weights, yy.T)
    cross: Array = np.moveaxis(np.matmul(xy, weights.T), -1, 0)
    gram: Array = np.moveaxis(np.matmul(xx, weights.T), -1, 0)
    ridge: Array = 1.0e-12 * np.trace(gram, axis1=1, axis2=2)[:, None, None] * np.eye(gram.shape[1])  # dependent terms
    factors: Array = np.asarray(np.linalg.solve(gram + ridge, cross), dtype=np.float64)
    explained: Array = np.sum(cross * factors, axis=1)
    return (square - explained) / square


def _few(pieces: int) -> float:
    """Return the factor by which percentiles of a bootstrap over few pieces are too narrow: Student's t against normal."""
    special: Any = importlib.import_module("scipy.special")
    return float(special.stdtrit(pieces - 1, 0.975) / special.ndtri(0.975) * np.sqrt(pieces / (pieces - 1)))


def _lowest(lags: Array, curve: Array) -> float:
    """Return where a curve is lowest, by the parabola through its lowest point and the two beside it [samples]."""
    i = int(np.argmin(curve))
    if i in (0, lags.size - 1):
        return float(lags[i])
    before, here, after = curve[i - 1 : i + 2]
    bend = before - 2.0 * here + after
    return float(lags[i] + (0.5 * (before - after) / bend if bend > 0.0 else 0.0) * (lags[1] - lags[0]))
