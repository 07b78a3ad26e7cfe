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
from stochfric_mb.discovery.inference.noise import changes, resolution, white_noise
from stochfric_mb.discovery.inference.stray_readings import LEAST, in_a_row, without
from stochfric_mb.effects import Effect, kind_with_signature, make_effect
from stochfric_mb.effects.traits import REPEATED_READING
from stochfric_mb.effects.traits import STRAY as STRAY_READING
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run
from stochfric_mb.numerics.robust import deviation
from stochfric_mb.numerics.stretches import stretches

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
AFTER = 5
"""Readings after such a jump that tell where the joint is: up to two of them may be wild."""
LOST = 0.01
"""Share of the changes that may be smaller than the resolution [-]."""
FEWEST = 5
"""Fewest of either for a finding: fewer are accidents."""


def mended(dataset: Dataset) -> tuple[Dataset, tuple[Effect, ...]]:
    """Return a dataset of a driven joint with repeated and stray positions replaced, and the effects that these mean."""
    runs: list[Run] = []
    lengths, away = list[float](), [np.zeros(0)]
    samples, duration = 0, 0.0
    for given in dataset.runs:
        run = given
        for name in position_columns(dataset.scenario.mechanism):
            values = run.channels.get(name, run.covariates.get(name))
            if values is None or len(values) < FEW or np.ptp(values) == 0.0:
                continue
            samples, duration = samples + len(values), duration + len(values) * run.sample_interval
            held = repeated(values)
            off = stray(without(values, held, np.zeros(len(values), dtype=bool))) & ~_beside(held, len(values))
            lengths += [(end - start) * run.sample_interval for start, end in held]
            better = without(values, held, off)
            away.append((values - better)[off])
            if held or off.any():
                run = with_column(run, name, better)
        runs.append(run)
    distances, effects = np.concatenate(away), list[Effect]()
    if len(lengths) >= FEWEST:
        numbers = {"rate": len(lengths) / duration, "duration": sum(lengths) / len(lengths)}
        effects.append(make_effect(kind_with_signature(REPEATED_READING), **numbers))
    if len(distances) >= FEWEST:
        size = float(np.sqrt(np.mean(distances**2)))
        effects.append(make_effect(kind_with_signature(STRAY_READING), fraction=len(distances) / samples, size=size))
    return (dataclasses.replace(dataset, runs=tuple(runs)) if lengths or len(distances) else dataset), tuple(effects)


def _beside(held: Sequence[tuple[int, int]], count: int) -> Mask:
    """Return which readings are replaced, or so near that these are seen in what tells stray ones, shape (count,)."""
    seen = np.zeros(count, dtype=np.bool_)
    for start, end in held:
        seen[max(start - 2, 0) : end + 2] = True
    return seen


def repeated(values: Array) -> list[tuple[int, int]]:
    """Return the stretches in which a position is repeated though the joint moves on: first repeated one, and next new one."""
    moved = changes(values)
    # the resolution, where there is one: rows that were lost and interpolated are fractions of it
    step = float(np.quantile(moved[moved > 0.0], LOST)) if moved.any() else np.inf
    still = stretches(moved == 0.0)
    if _slower(moved, step):
        return [(first + 1, last + 1) for first, last in still]
    found: list[tuple[int, int]] = []
    for first, last in still:
        end = last + 1
        if end - first < REPEATED or end >= len(values):
            continue
        reach = LEAST + 2 * (end - first)
        near = np.r_[moved[max(first - reach, 0) : first], moved[end : end + reach]]
        usual = float(np.median(near)) if len(near) else np.inf
        # a joint that has moved on stays away; a wild reading comes back
        missed = min(moved[last], abs(float(np.median(values[end : end + AFTER])) - values[first]))
        if missed > MISSED * max(usual, step) and np.count_nonzero(near == 0.0) < 0.5 * len(near):
            found.append((first + 1, end))
    return found


def _slower(moved: Array, step: float) -> bool:
    """Return whether a position is mostly old news, as a camera's beside a faster record or one behind a bus that goes round.

    When news comes does not matter: what moves by several steps of its resolution at a time has moved between, too.

    Args:
        moved: changes from sample to sample, shape (n,).
        step: least of them: a coarse encoder moves by one, whenever it does.
    """
    new = np.flatnonzero(moved)
    if len(new) < FEW:
        return False
    return bool(np.median(np.diff(new)) >= REPEATED and np.median(moved[new]) > MISSED * step)


def stray(values: Array) -> Mask:
    """Return which readings are far off from a cubic through the next two on each side, single ones or a few in a row.

    One that is off by A leaves A there and -2/3 A at both neighbours; a jump that stays, a kick or an oscillation does not.
    """
    away = values - np.convolve(values, np.array([-1.0, 4.0, 0.0, 4.0, -1.0]) / 6.0, mode="same")
    away[:2] = away[-2:] = 0.0
    level = max(deviation(away, about=0.0), white_noise(values), resolution(values), 1.0e-300)
    far = np.abs(away) > STRAY * level
    alone = far.copy()
    for neighbour in (np.roll(away, 1), np.roll(away, -1)):
        alone &= np.abs(neighbour + away / 1.5) < np.abs(away) / 4.0  # a jump that stays misses that by a third
    return alone | in_a_row(values, far, STRAY, level)
