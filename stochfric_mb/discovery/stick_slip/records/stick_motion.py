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
    a = (bb[best] * ar[best] - ab[best] * br[best]) / determinant[best]
    b = (aa[best] * br[best] - ab[best] * ar[best]) / determinant[best]
    angles = (2.0 * np.pi * grid[best] * t for t in times)
    return [p - _levelled((a * np.cos(angle) + b * np.sin(angle))[None])[0] for p, angle in zip(phases, angles, strict=True)]


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
