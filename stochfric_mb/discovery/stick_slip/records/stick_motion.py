"""Motion in the stick phases that must not be taken for slow noise: a wave of the belt, or what every phase repeats.

A belt whose speed ripples carries the stuck box along. By its correlations alone a wave of some hertz looks like
noise with a memory of some tens of milliseconds. But a wave keeps its phase over the whole record, so that one cosine and
one sine explain much of all stick phases together. A contact that rings after each re-stick, or creeps before each
break-away, does so alike in all of them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.records.record import Array

STRIDE = 20
"""Samples that are averaged; the waves looked for are slower by far."""
FASTEST = 1.23
"""Highest frequency that is looked for, over the natural one [-]."""

MAINS, TONES = (1, 2, 3), 6
"""Of which of its tones the best wave may be one, and tones of a wave of any shape."""
NEAR = 12
"""Rates that are tried to either side of the best one, up to the next of the grid: the last tone is then off by a fifth of a
radian at most, at the ends of a record."""


CHUNK = 64
"""Rates that are looked at together."""


def tones(time: Array, frequency: float, count: int) -> list[Array]:
    """Return cosine and sine of so many tones of a wave."""
    turned = np.exp(2.0j * np.pi * frequency * time)
    powers = np.cumprod(np.broadcast_to(turned, (count, len(time))), axis=0)
    return [part for power in powers for part in (power.real, power.imag)]


def shapes(frequency: float, duration: float) -> list[tuple[float, int]]:
    """Return the rates [Hz] at which a wave of which one tone is seen may come back, each with its number of tones.

    One tone and a wave of any shape are tried at the same rates: what a better rate explains is no merit of further tones.
    """
    near = frequency + np.arange(-NEAR, NEAR + 1) / (NEAR * 4.0 * duration)
    whole = [float(f) / k for k in MAINS if k == 1 or frequency / k > 2.0 / duration for f in near]
    return [*((float(f), 1) for f in near), *((f, TONES) for f in whole)]


def without_wave(phases: Sequence[Array], times: Sequence[Array], natural: float) -> list[Array] | None:
    """Return the phases without the wave that is in them; None where there is none.

    Args:
        phases: residuals of stick phases [m], their mean and line taken out.
        times: time of their samples [s], alike.
        natural: natural angular frequency of the rig [rad/s].
    """
    if len(phases) < criteria.FEWEST_PHASES:
        return None
    long = [(t, p) for t, p in zip(times, phases, strict=True) if len(p) >= 4 * STRIDE]
    if len(long) < criteria.FEWEST_PHASES:
        return None
    seen = _Stretches([_averaged(t) for t, _ in long])
    rest = np.concatenate([_averaged(p) for _, p in long])
    duration = float(seen.time[-1] - seen.time[0])
    grid = np.arange(2.0 / duration, FASTEST * natural / (2.0 * np.pi), 1.0 / (4.0 * duration))
    if not grid.size:  # no wave as slow as that fits into the record twice
        return None
    gains = _of_one_tone(seen, rest, grid)
    best = int(np.argmax(gains))
    total = float(rest @ rest)
    if gains[best] < criteria.WAVE_EXPLAINED * total:
        return None
    ways = shapes(float(grid[best]), duration)
    explained = {way: _explained(seen, rest, *way) for way in ways}
    one, shaped = (max((w for w in ways if w[1] == count), key=explained.__getitem__) for count in (1, TONES))
    more = total - explained[shaped] < (1.0 - criteria.TONES_EXPLAIN) * (total - explained[one])
    return _less_tones(seen, rest, times, phases, *(shaped if more else (float(grid[best]), 1)))


class _Stretches:
    """Times of samples, stretch by stretch."""

    def __init__(self, times: Sequence[Array]) -> None:
        self.time = np.concatenate(times)
        """Times [s], shape (n,)."""
        self.counts = np.array([len(t) for t in times])
        """Samples of each stretch."""
        self.ends = np.cumsum(self.counts)
        """Number of the sample after the last one of each."""
        self._place = np.concatenate([np.linspace(-1.0, 1.0, n) for n in self.counts])
        self._square = self._sums(self._place**2)

    def _sums(self, values: Array) -> Array:
        return np.asarray(np.add.reduceat(values, self.ends - self.counts, axis=-1), dtype=np.float64)

    def levelled(self, rows: Array) -> Array:
        """Return rows, shape (m, n), less their mean and their line in each stretch."""
        rows = rows - np.repeat(self._sums(rows) / self.counts, self.counts, axis=-1)
        slopes = self._sums(rows * self._place) / self._square
        return rows - np.repeat(slopes, self.counts, axis=-1) * self._place


def _of_one_tone(seen: _Stretches, rest: Array, grid: Array) -> Array:
    """Return what `_explained` does of one tone, at each of the rates ``grid`` [Hz], shape (f,)."""
    gains = np.empty(len(grid))
    for first in range(0, len(grid), CHUNK):
        angle = 2.0 * np.pi * grid[first : first + CHUNK, None] * seen.time
        cosine, sine = seen.levelled(np.cos(angle)), seen.levelled(np.sin(angle))
        aa, bb, ab = (np.einsum("ij,ij->i", *pair) for pair in ((cosine, cosine), (sine, sine), (cosine, sine)))
        ar, br = cosine @ rest, sine @ rest
        determinant = np.maximum(aa * bb - ab**2, 1.0e-12 * np.maximum(aa, 1.0e-150) ** 2)
        gains[first : first + CHUNK] = (bb * ar**2 - 2.0 * ab * ar * br + aa * br**2) / determinant
    return gains


def _explained(seen: _Stretches, rest: Array, rate: float, count: int) -> float:
    """Return the fall of the squares [m^2] of samples ``rest`` [m], shape (n,), by the tones of a wave."""
    columns = seen.levelled(np.stack(tones(seen.time, rate, count)))
    products = columns @ rest
    return float(products @ np.linalg.lstsq(columns @ columns.T, products, rcond=None)[0])


def _less_tones(
    seen: _Stretches, rest: Array, times: Sequence[Array], phases: Sequence[Array], rate: float, count: int
) -> list[Array]:
    """Return phases less the tones of a wave, of the size that their means show.

    Args:
        seen: times of means.
        rest: means of the residuals [m], shape (n,).
        times: times of the samples of the phases [s].
        phases: residuals of the phases [m].
        rate: rate of the wave [Hz].
        count: number of its tones.
    """
    size = np.linalg.lstsq(seen.levelled(np.stack(tones(seen.time, rate, count))).T, rest, rcond=None)[0]
    every = _Stretches(times)
    wave = size @ every.levelled(np.stack(tones(every.time, rate, count)))
    return [p - w for p, w in zip(phases, np.split(wave, every.ends[:-1]), strict=True)]


def without_pattern(phases: Sequence[Array]) -> list[Array] | None:
    """Return the phases without what they share, counted from their begin or from their end; None where that is little.

    Args:
        phases: residuals of stick phases [m], their mean and line taken out.
    """
    if len(phases) < criteria.FEWEST_PHASES:
        return None
    left = [p[::-1] for p in _less_mean(phases)]
    left = [p[::-1] for p in _less_mean(left)]
    before, after = (sum(float(p @ p) for p in parts) for parts in (phases, left))
    # two means of n phases take 2/n of noise with them
    return left if after < (1.0 - criteria.WAVE_EXPLAINED - 2.0 / len(phases)) * before else None


def _less_mean(phases: Sequence[Array]) -> list[Array]:
    """Return phases less their mean, sample by sample from the begin, as far as most of them reach."""
    length = int(np.median([len(p) for p in phases]))
    long = [p[:length] for p in phases if len(p) >= length]
    mean = np.mean(long, axis=0)
    arrays: list[Array] = []
    for p in phases:
        p = p.copy()  # noqa: PLW2901
        reach = min(len(p), length)
        p[:reach] -= mean[:reach]
        arrays.append(p)
    return arrays


def _averaged(values: Array) -> Array:
    """Return means of `STRIDE` samples."""
    count = len(values) // STRIDE
    return values[: count * STRIDE].reshape(count, STRIDE).mean(axis=1)
