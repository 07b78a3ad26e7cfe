"""Weak form: every term of the equation of motion seen through the same smooth window, at centres along a run.

The window is differentiated, not the record (`stochfric_mb.measurement.smoothing`). Inertia, drive and friction pass the same
window, so that what it takes away is taken away on both sides of the balance.
"""

from __future__ import annotations

import dataclasses
import functools
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view
from scipy.sparse import csr_array

from stochfric_mb.errors import InputError
from stochfric_mb.measurement.run import Run
from stochfric_mb.measurement.smoothing import smooth, window

Array = npt.NDArray[np.float64]

NARROWEST = 8
"""Half width of the narrowest window [sample intervals]."""
SHORTEST = 3
"""The same of a record so short that it would hold fewer than `RECORD` over two of them: a slide of some 40 samples."""
WIDER = 2.0**0.5
"""Ratio of half widths that are tried."""
QUIET = 0.05
"""Noise of the balance over the stated friction [-] below which no wider window is taken."""
LONGER = 1.5
"""Half widths that noise may ask for at most, over those that suit the record [-]: chosen."""
LOUD = 0.3
"""The same above which windows grow beyond what the record would have: nothing could be seen through narrower ones."""
RECORD = 24.0
"""Half widths of the widest window in a record: chosen, so that a dozen windows share no samples."""
FINE = 12
"""Samples of a half width by which the mean of a signal over a window is taken: by trapezoids, the window being smooth at both
ends, more of them change it by less than 1e-6 of what a signal varies by within a window [-]."""
FEWEST = 8
"""Fewest centres of windows in a run."""
OVERLAP = 2.0
"""Centres of windows in one half width."""


@dataclasses.dataclass(frozen=True)
class Window:
    """A window and where it is put along a run."""

    half_width: float
    """Half its length [s]."""
    interval: float
    """Distance between samples [s]."""
    count: int
    """Samples of the run."""

    @functools.cached_property
    def taps(self) -> Array:
        """Its samples, shape (2 m + 1,), of sum 1."""
        return window(self.half_width, self.interval)

    @functools.cached_property
    def centres(self) -> npt.NDArray[np.int64]:
        """Samples at which it is put; the outermost leave room for it twice, since motion is smoothed by it too."""
        margin = len(self.taps)
        stride = max(1, round(self.half_width / self.interval / OVERLAP))
        return np.arange(margin, self.count - margin, stride, dtype=np.int64)

    def through(self, signal: Array, derivative: int = 0, shift: float = 0.0) -> Array:
        """Return a signal, shape (count,), or a derivative of it through the window, delayed by ``shift`` [s]."""
        return smooth(signal, self.half_width, self.interval, derivative=derivative, shift=shift)

    def covered(self, shift: float) -> npt.NDArray[np.bool_]:
        """Return at which centres a signal delayed by ``shift`` [s] is known all through the window, shape (n_centres,)."""
        whole, half = shift / self.interval, len(self.taps) // 2 + 1  # a window may be put between two samples
        return (self.centres - half >= whole) & (self.centres + half < self.count + whole)

    def sampled(self, signal: Array, shift: float = 0.0) -> Array:
        """Return a signal smoothed no more than `means` needs it, delayed by ``shift`` [s], shape (count,)."""
        fine = max(self.stride, SHORTEST) * self.interval
        edge = len(window(fine, self.interval)) + int(abs(shift) / self.interval)
        seen = smooth(signal, fine, self.interval, shift=shift)
        seen[:edge], seen[len(seen) - edge :] = signal[:edge], signal[len(seen) - edge :]
        return seen

    @property
    def inside(self) -> tuple[int, int]:
        """First sample around which a whole window fits into the record, and the one after the last."""
        edge = len(self.taps) // 2
        return edge, self.count - edge

    def held(self, seen: Array) -> Array:
        """Return what was seen `through` the window, shape (count,), held at both ends, where the window reaches out."""
        edge = len(self.taps) // 2
        inside = seen[edge : len(seen) - edge]
        return np.r_[np.full(edge, inside[0]), inside, np.full(edge, inside[-1])]

    def at_centres(self, signal: Array) -> Array:
        """Return the mean of a signal, shape (count,), over each window, shape (n_centres,)."""
        return self.views(signal) @ self.taps

    @functools.cached_property
    def stride(self) -> int:
        """Samples from one to the next at which a smooth signal is enough to know, for its mean over windows."""
        return max(1, (len(self.taps) // 2) // FINE)

    @functools.cached_property
    def means(self) -> Any:
        """Sparse matrix by which every ``stride``-th sample of a signal becomes its mean over each window."""
        m, every = len(self.taps) // 2, self.stride
        first = -((m - self.centres) // every)  # of the samples kept, the first within each window
        known = first[:, None] + np.arange(2 * m // every + 1)
        offset = every * known - self.centres[:, None] + m
        weights = np.where(offset <= 2 * m, self.taps[np.minimum(offset, 2 * m)], 0.0)
        weights /= weights.sum(axis=1, keepdims=True)
        starts = np.arange(len(first) + 1) * known.shape[1]
        shape = len(first), -(-self.count // every)
        return csr_array((weights.ravel(), np.minimum(known, shape[1] - 1).ravel(), starts), shape=shape)

    def views(self, signal: Array) -> Array:
        """Return the samples of a signal in each window, shape (n_centres, 2 m + 1)."""
        m = len(self.taps) // 2
        return sliding_window_view(signal, len(self.taps))[self.centres - m]

    def gain(self, derivative: int) -> float:
        """Return by how much white noise is multiplied on its way through [1/s^derivative]."""
        return float(np.linalg.norm(window(self.half_width, self.interval, derivative=derivative)))


def narrowest(run: Run) -> Window:
    """Return the narrowest window that a run is seen through."""
    return Window(least_width(len(run.time)) * run.sample_interval, run.sample_interval, len(run.time))


def least_width(count: int) -> float:
    """Return the half width of the narrowest window in a record of ``count`` samples [sample intervals]."""
    return float(np.clip(2.0 * count / RECORD, SHORTEST, NARROWEST))


def window_of(run: Run, noise: dict[int, float], friction: float, samples: int | None) -> Window:
    """Return the window through which a place is seen in a run: of half width ``samples``, or else the one of `chosen_window`.

    Raises:
        InputError: the run is too short.
    """
    h, count = run.sample_interval, len(run.time)
    window = chosen_window(h, count, noise, friction) if samples is None else Window(samples * h, h, count)
    if len(window.centres) < FEWEST:
        raise InputError(
            f"run {run.name!r}: {count} samples are too few for windows of {window.half_width:.3g} s; record longer"
        )
    return window


def chosen_window(interval: float, count: int, noise: dict[int, float], friction: float) -> Window:
    """Return the narrowest window through which noise is quiet against friction, as far as the record allows.

    It goes by noise and not by samples: of a record with more samples a second, as much noise is averaged out.

    Args:
        interval: distance between samples [s].
        count: samples of the run.
        noise: derivative -> noise of what enters the balance with that derivative (coefficients included).
        friction: stated size of the friction [N or N m].
    """
    half = least_width(count) * interval
    widest = count * interval / RECORD
    loudest = min(count * interval / NARROWEST, LONGER * widest)
    while True:
        seen = Window(half, interval, count)
        noise_left = np.sqrt(sum((seen.gain(d) * s) ** 2 for d, s in noise.items())) / friction
        wider = WIDER * half
        if noise_left <= QUIET or wider > loudest or (wider > widest and noise_left <= LOUD):
            return seen
        half = wider
