"""Readings that are not what the sensor saw then: repeated ones, and single ones that are far off.

Both show in the record itself. A bus that drops telegrams repeats a position, to the last digit, while the joint moves on,
and then jumps by what it has missed; an encoder without noise repeats positions too, but then moves on by one step. A stray
reading is far from a curve through its neighbours. Both are replaced by a smooth curve through the readings around them, so
that they do not enter the noise of the balance, and are findings of their own.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import position_columns, with_column
from stochfric_mb.discovery.inference.noise import white_noise
from stochfric_mb.effects import Effect, kind_with_signature, make_effect
from stochfric_mb.effects.traits import REPEATED_READING
from stochfric_mb.effects.traits import STRAY as STRAY_READING
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run
from stochfric_mb.numerics.robust import deviation

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

FEW = 14
"""Fewest samples of a run that is checked."""
STRAY = 12.0
"""Standard deviations from which a reading is far off [-]: of normal noise one in 1e32, and noise that is not quite normal has
some at 8."""
REPEATED = 3
"""Fewest readings that are the same to the last digit."""
MISSED = 4.0
"""Jump after them over the usual change between samples and over the resolution, from which the joint has moved on [-]."""
FEWEST = 5
"""Fewest of either for a finding: fewer are accidents."""
CURVE, REACH = 3, 1.5
"""Degree of the curve that replaces readings, and how far to both sides it is fitted, over the length of the gap [-]."""
LEAST = 8
"""Readings on each side at least."""


@dataclasses.dataclass(frozen=True)
class Readings:
    """What was wrong with the positions of a dataset."""

    repeated: int = 0
    """Stretches of repeated readings."""
    stale: float = 0.0
    """Share of the samples that they are [-]."""
    longest: float = 0.0
    """The longest of them [s]."""
    stray: int = 0
    """Readings that are far off."""
    fraction: float = 0.0
    """Share of the samples that these are [-]."""
    size: float = 0.0
    """Their distance from where they should be, rms [m or rad]."""
    rate: float = 0.0
    """Stretches of repeated readings per second of a column [1/s]."""

    @property
    def effects(self) -> tuple[Effect, ...]:
        """Return the effects that they mean."""
        effects: list[Effect] = []
        if self.repeated >= FEWEST:
            effects.append(make_effect(kind_with_signature(REPEATED_READING), rate=self.rate, duration=self.stale / self.rate))
        if self.stray >= FEWEST:
            effects.append(make_effect(kind_with_signature(STRAY_READING), fraction=self.fraction, size=self.size))
        return tuple(effects)


def mended(dataset: Dataset) -> tuple[Dataset, Readings]:
    """Return a dataset of a driven joint with repeated and stray positions replaced, and what they were."""
    runs: list[Run] = []
    stretches, strays, away = list[float](), 0, list[Array]()
    samples, duration = 0, 0.0
    for given in dataset.runs:
        run = given
        for name in position_columns(dataset.scenario.mechanism):
            values = run.channels.get(name, run.covariates.get(name))
            if values is None or len(values) < FEW or np.ptp(values) == 0.0:
                continue
            samples, duration = samples + len(values), duration + len(values) * run.sample_interval
            held = repeated(values)
            off = stray(without(values, held, np.zeros(len(values), dtype=bool)))
            stretches += [(end - start) * run.sample_interval for start, end in held]
            strays += int(off.sum())
            better = without(values, held, off)
            away.append((values - better)[off])
            if held or off.any():
                run = with_column(run, name, better)
        runs.append(run)
    distances = np.concatenate([*away, np.zeros(0)])
    readings = Readings(
        len(stretches),
        sum(stretches) / max(duration, 1.0e-300),
        max(stretches, default=0.0),
        strays,
        strays / max(samples, 1),
        float(np.sqrt(np.mean(distances**2))) if len(distances) else 0.0,
        len(stretches) / max(duration, 1.0e-300),
    )
    return (dataclasses.replace(dataset, runs=tuple(runs)) if stretches or strays else dataset), readings


def repeated(values: Array) -> list[tuple[int, int]]:
    """Return the stretches in which a position is repeated though the joint moves on: first repeated one, and next new one."""
    same = np.diff(values) == 0.0
    edges = np.flatnonzero(np.diff(np.r_[0, same.astype(np.int8), 0]))
    moved = np.abs(np.diff(values))
    step = float(np.min(moved[moved > 0.0], initial=np.inf))  # the resolution, where there is one
    stretches: list[tuple[int, int]] = []
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        end = last + 1
        if end - first < REPEATED or end >= len(values):
            continue
        reach = LEAST + 2 * (end - first)
        near = np.r_[moved[max(first - reach, 0) : first], moved[end : end + reach]]
        usual = float(np.median(near)) if len(near) else np.inf
        if moved[last] > MISSED * max(usual, step) and np.count_nonzero(near == 0.0) < 0.5 * len(near):
            stretches.append((int(first) + 1, int(end)))
    return stretches


def stray(values: Array) -> Mask:
    """Return which readings are far off from a cubic through the next two on each side: one pulls its neighbours along.

    One that is off by A leaves A there and -2/3 A at both neighbours; a jump that stays, or an oscillation, does not.
    """
    away = values - np.convolve(values, np.array([-1.0, 4.0, 0.0, 4.0, -1.0]) / 6.0, mode="same")
    away[:2] = away[-2:] = 0.0
    moved = np.abs(np.diff(values))
    step = float(np.min(moved[moved > 0.0], initial=0.0))
    level = max(deviation(away, about=0.0), white_noise(values), step, 1.0e-300)
    alone = np.abs(away) > STRAY * level
    for neighbour in (np.roll(away, 1), np.roll(away, -1)):
        alone &= np.abs(neighbour + away / 1.5) < np.abs(away) / 3.0
    return alone


def without(values: Array, held: Sequence[tuple[int, int]], off: Mask) -> Array:
    """Return the readings with what is repeated or far off replaced by a curve through those around it."""
    bad = off.copy()
    for start, end in held:
        bad[start:end] = True
    edges = np.flatnonzero(np.diff(np.r_[0, bad.astype(np.int8), 0]))
    good, better = np.flatnonzero(~bad), values.copy()
    for start, end in zip(edges[::2], edges[1::2], strict=True):
        at = int(np.searchsorted(good, start))
        reach = max(LEAST, round(REACH * (end - start)))
        known = good[max(at - reach, 0) : at + reach]
        gap = np.arange(start, end)
        curve = np.polynomial.Polynomial.fit(known.astype(np.float64), values[known], CURVE)
        better[start:end] = curve(gap.astype(np.float64))
    return better
