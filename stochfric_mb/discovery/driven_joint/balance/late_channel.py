"""One late encoder of several: a delay of a single position column, which no delay of the drives can stand in for."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.discovery.driven_joint.balance.timing import MATERIAL, Timing, sought
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.discovery.driven_joint.mjcf.measured_columns import column, position_columns, with_column
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run


def late_channel(source: Any, places: Sequence[PlaceOutcome]) -> tuple[str, Timing] | None:
    """Return the position column that is late by itself, and by how much; None: none is.

    It is asked for where several joints are measured and most is left above the noise.

    Args:
        source: the balances of a dataset.
        places: the outcomes without a delay of one column.
    """
    dataset = source.dataset
    columns = position_columns(dataset.scenario.mechanism)
    worst = max(places, key=lambda p: p.selected.final.rms / p.floor)
    if len(columns) < 2 or (1.0 - MATERIAL) * worst.selected.final.rms <= worst.floor or any(p.late for p in places):
        return None
    name = worst.place or next(iter(source.places))
    interval = dataset.fit[0].sample_interval
    width = round(float(np.median([s.window.half_width for s in worst.fit])) / interval)

    def made(late: str, delay: float) -> list[ForceBalance]:
        moved = brought_forward(dataset, late, delay)
        return dataclasses.replace(source, dataset=moved, remembered={}).balances(name, "fit", source.stated_delay, width)

    numbers = [n.name for n in worst.nuisances]
    seen = [(c, sought(lambda d, c=c: made(c, d), numbers, generous=True, width=width)) for c in columns]
    named = [(c, t) for c, t in seen if t.shows]
    return max(named, key=lambda pair: pair[1].score) if named else None


def brought_forward(dataset: Dataset, late: str, delay: float) -> Dataset:
    """Return the dataset with a column earlier by ``delay`` [s]; its ends are held."""

    def moved(run: Run) -> Run:
        at = np.arange(len(run.time))
        return with_column(run, late, np.interp(at + delay / run.sample_interval, at, column(run, late)))

    return dataclasses.replace(dataset, runs=tuple(map(moved, dataset.runs)))
