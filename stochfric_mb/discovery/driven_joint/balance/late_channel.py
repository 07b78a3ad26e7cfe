"""One late encoder of several: a delay of a single position column, which no delay of the drives can stand in for."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np

from stochfric_mb.discovery.driven_joint.balance.force_balance import ForceBalance
from stochfric_mb.discovery.driven_joint.balance.timing import MATERIAL, Timing, of_channel
from stochfric_mb.discovery.driven_joint.joint_result import PlaceOutcome
from stochfric_mb.measurement.dataset import Dataset
from stochfric_mb.measurement.run import Run
from stochfric_mb.mechanisms import Mjcf


def late_channel(source: Any, places: Sequence[PlaceOutcome]) -> tuple[str, Timing] | None:
    """Return the position column that is late by itself, and by how much; None: none is.

    It is asked for where several joints are measured and most is left above the noise.

    Args:
        source: the balances of a dataset.
        places: the outcomes without a delay of one column.
    """
    dataset, mechanism = source.dataset, source.dataset.scenario.mechanism
    columns = [c for c in mechanism.positions.values() if isinstance(c, str)] if isinstance(mechanism, Mjcf) else []
    worst = max(places, key=lambda p: p.selected.final.rms / p.floor)
    if len(columns) < 2 or (1.0 - MATERIAL) * worst.selected.final.rms <= worst.floor or any(p.late for p in places):
        return None
    name = worst.place or source.places[0][0]
    interval = dataset.fit[0].sample_interval
    width = round(float(np.median([s.window.half_width for s in worst.fit])) / interval)

    def made(column: str, delay: float) -> list[ForceBalance]:
        moved = brought_forward(dataset, column, delay)
        return dataclasses.replace(source, dataset=moved, remembered={}).balances(name, "fit", source.stated_delay, width)

    seen = [(c, of_channel(lambda d, c=c: made(c, d), worst.nuisances, interval, width)) for c in columns]
    named = [(c, t) for c, t in seen if t is not None]
    return max(named, key=lambda pair: pair[1].score) if named else None


def brought_forward(dataset: Dataset, column: str, delay: float) -> Dataset:
    """Return the dataset with a column earlier by ``delay`` [s]; its ends are held."""
    return dataclasses.replace(dataset, runs=tuple(_moved(r, column, delay) for r in dataset.runs))


def _moved(run: Run, column: str, delay: float) -> Run:
    where = "channels" if column in run.channels else "covariates"
    values = getattr(run, where)[column]
    at = np.arange(len(values)) + delay / run.sample_interval
    moved = np.interp(at, np.arange(len(values)), values)
    return dataclasses.replace(run, **{where: {**getattr(run, where), column: moved}})
