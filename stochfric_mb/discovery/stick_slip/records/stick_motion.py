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


def tones(time: Array, frequency: float, count: int) -> list[Array]:
    """Return cosine and sine of so many tones of a wave."""
    angles = (2.0 * np.pi * k * frequency * time for k in range(1, count + 1))
    return [f(angle) for angle in angles for f in (np.cos, np.sin)]


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
    means = [(_averaged(t), _averaged(p)) for t, p in zip(times, phases, strict=True) if len(p) >= 4 * STRIDE]
    if len(means) < criteria.FEWEST_PHASES:
        return None
    duration = float(means[-1][0][-1] - means[0][0][0])
    grid = np.arange(2.0 / duration, FASTEST * natural / (2.0 * np.pi), 1.0 / (4.0 * duration))
    if not grid.size:  # no wave as slow as that fits into the record twice
        return None
    # Gram matrix of cosine and sine, and their products with the phases, at each frequency
    aa, bb, ab, ar, br = np.zeros((5, len(grid)))
    for t, p in means:
        angle = 2.0 * np.pi * grid[:, None] * t
        cosine, sine = _levelled(np.cos(angle)), _levelled(np.sin(angle))
        aa += (cosine**2).sum(axis=1)
        bb += (sine**2).sum(axis=1)
        ab += (cosine * sine).sum(axis=1)
        ar += cosine @ p
        br += sine @ p
    determinant = np.maximum(aa * bb - ab**2, 1.0e-12 * np.maximum(aa, 1.0e-150) ** 2)
    gains = (bb * ar**2 - 2.0 * ab * ar * br + aa * br**2) / determinant
    best = int(np.argmax(gains))
    if gains[best] < criteria.WAVE_EXPLAINED * sum(float(p @ p) for _, p in means):
        return None

    def left(way: tuple[float, int]) -> float:
        return sum(float(p @ p) for p in _less_tones(means, means, *way))

    ways = shapes(float(grid[best]), duration)
    one, shaped = (min((w for w in ways if w[1] == count), key=left) for count in (1, TONES))
    more = left(shaped) < (1.0 - criteria.TONES_EXPLAIN) * left(one)
    return _less_tones(means, list(zip(times, phases, strict=True)), *(shaped if more else (float(grid[best]), 1)))


def _less_tones(seen: Sequence[tuple[Array, Array]], of: Sequence[tuple[Array, Array]], rate: float, count: int) -> list[Array]:
    """Return phases less the tones of a wave, of the size that others show.

    Args:
        seen: times [s] and residuals [m] of the phases that show it.
        of: the same of those from which it is taken.
        rate: rate of the wave [Hz].
        count: number of its tones.
    """
    columns = np.concatenate([_levelled(np.stack(tones(t, rate, count))) for t, _ in seen], axis=1).T
    size = np.linalg.lstsq(columns, np.concatenate([_levelled(p[None])[0] for _, p in seen]), rcond=None)[0]
    return [p - size @ _levelled(np.stack(tones(t, rate, count))) for t, p in of]


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


def _levelled(waves: Array) -> Array:
    """Return rows less their mean and their line."""
    place = np.linspace(-1.0, 1.0, waves.shape[1])
    waves = waves - waves.mean(axis=1, keepdims=True)
    return waves - np.outer(waves @ place, place) / (place @ place)
