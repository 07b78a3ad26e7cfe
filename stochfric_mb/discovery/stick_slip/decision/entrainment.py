"""Waves to which the slips keep: they shape all slips alike, and only simulating them tells them from other shapes.

A wave faster than the slips makes the box break away near its crests, so that each cycle takes a whole number of waves and
nothing differs from slip to slip. To first order the waves of many orders look alike; simulated, hardly two of them do.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.decision.cases import Case
from stochfric_mb.discovery.stick_slip.decision.confirmation import Confirmed, confirm
from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.screening.hypotheses import waves_in
from stochfric_mb.discovery.stick_slip.screening.naming import with_candidate
from stochfric_mb.discovery.stick_slip.screening.screen import Candidate
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.effects import kinds_with
from stochfric_mb.effects.marks import ENTRAINED, Hypothesis, Wave
from stochfric_mb.effects.traits import ALONG_BELT, FORCE_IN_TIME
from stochfric_mb.numerics.robust import deviation

COARSE = (2, 4, 6, 8)
"""Orders that are tried first; then the neighbours of the best one."""
EVALUATIONS = 10
"""Most Gauss-Newton steps of a trial: a wave has two numbers that no other candidate has."""

Trial = tuple[Candidate, Confirmed]


def entrained(study: Study, model: Model, cases: Sequence[Case]) -> list[Trial]:
    """Return the best wave of each kind to which the slips may keep, simulated; none where slips come at no regular intervals.

    Args:
        study: what was measured.
        model: the stated model.
        cases: slips to be predicted.
    """
    rate = _common_rate(study.pool)
    waves = waves_in(study.pool)
    first = next((kind for kind in kinds_with(FORCE_IN_TIME) if kind in waves), None)
    if rate is None or first is None:
        return []
    fastest = 1.0 / float(np.median(study.pool.restick_time - study.pool.onset_time))
    most = max(round(fastest / rate), 1)
    tried: dict[int, Trial] = {}

    def attempt(kind: str, order: int) -> Trial:
        return _tried(kind, waves[kind], order * rate, study, model, cases)

    def best() -> int:
        return min(tried, key=lambda order: tried[order][1].criterion)

    for order in COARSE:
        if order <= most:
            tried[order] = attempt(first, order)
    if not tried:
        return []
    for order in (best() - 1, best() + 1):
        if 1 <= order <= most and order not in tried:
            tried[order] = attempt(first, order)
    # what of the belt passes in slips that are all alike passes along the stroke, too
    others = [kind for kind in waves if kind != first and kind not in kinds_with(ALONG_BELT)]
    return [tried[best()], *(attempt(kind, best()) for kind in others)]


def _common_rate(pool: Pool) -> float | None:
    """Return the rate of the slips [Hz], where it is regular and the same in all runs."""
    rates = np.array([1.0 / s.cycle for s in pool.slips])
    irregular = max(deviation(np.diff(s.onset_time)) / s.cycle for s in pool.slips)
    if np.ptp(rates) > criteria.ENTRAINED * rates.mean() or irregular > criteria.ENTRAINED:
        return None
    return float(rates.mean())


def _tried(kind: str, wave: Wave, frequency: float, study: Study, model: Model, cases: Sequence[Case]) -> Trial:
    hypothesis = Hypothesis(kind, _columns(wave, frequency, study.pool), (wave.setting(frequency), 1.0), variant=ENTRAINED)
    score = 2.0 * float(study.baseline.gains([hypothesis.columns])[0]) - len(hypothesis.columns) * study.baseline.price
    candidate = Candidate(kind, "", score, hypothesis, study.baseline.solved(hypothesis.columns))
    trial = with_candidate(model, candidate, study.pool)
    confirmed = confirm(cases, trial, study.uncertainty, evaluations=EVALUATIONS, entrained=True)
    # the order is a number, too
    return candidate, dataclasses.replace(confirmed, n_parameters=confirmed.n_parameters + 1, freedom=confirmed.freedom - 1)


def _columns(wave: Wave, frequency: float, pool: Pool) -> list[Array]:
    """Return cosine and sine in each run as regressors; unlike those of other waves as a whole, since no slip differs."""
    angle: npt.NDArray[np.complex128] = np.exp(2.0j * np.pi * frequency * wave.place)
    columns: list[Array] = []
    for run in range(pool.n_runs):
        for part in (angle.real, angle.imag):
            force = wave.weight * part * (pool.run == run)[:, None]
            columns.append(pool.column(force[:, 0], force[:, 1:]))
    return columns
