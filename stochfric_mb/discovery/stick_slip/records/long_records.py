"""Long records: every slip gives its features, but what is simulated stands for a stretch in the middle."""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery.stick_slip.records.slips import Slips

SIMULATED = 128
"""Slips in the stretch that is simulated: they tell a deviation to 6 %, and no record of the tests has more."""
FORECAST = 256
"""Forecasts of a run that are scored, spread evenly: they tell a mean error to 5 % where single ones scatter by 80 %."""


def middle(slips: Slips) -> Slips:
    """Return the slips in the middle of a long record, with that stretch of the record; those of a short one as they are."""
    n = len(slips)
    if n <= SIMULATED:
        return slips
    first = (n - SIMULATED) // 2
    kept = slice(first, first + SIMULATED)
    arrays = {
        f.name: getattr(slips, f.name)[kept]
        for f in dataclasses.fields(slips)
        if isinstance(getattr(slips, f.name), np.ndarray)
    }
    record = slips.record
    # half a cycle on either side, so that the first and the last slip lie within
    half = 0.5 * slips.cycle
    span = arrays["onset_time"][0] - half, arrays["restick_time"][-1] + half
    rows = slice(*np.searchsorted(record.time, span))
    cut = dataclasses.replace(
        record, time=record.time[rows], position=record.position[rows], raw=record.raw[rows], outlier=record.outlier[rows],
        temperature=None if record.temperature is None else record.temperature[rows],
    )  # fmt: skip
    inside = (slips.stick.time >= span[0]) & (slips.stick.time <= span[1])
    return dataclasses.replace(slips, record=cut, stick=slips.stick.part(inside), **arrays)
