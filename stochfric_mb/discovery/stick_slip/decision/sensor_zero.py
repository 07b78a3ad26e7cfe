"""A sensor whose zero moves, beside other effects: seen first, and out of the way when slips are compared."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import cast

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.decision.kinematics import DRIFT_SEEN, STEP_SEEN
from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline
from stochfric_mb.discovery.stick_slip.screening.screen import Candidate
from stochfric_mb.effects import kind_with_signature
from stochfric_mb.effects.traits import CREEPING_ZERO, JUMP, MOVES_ZERO


def seen_in_stick(candidates: Sequence[Candidate], details: Mapping[str, object]) -> Candidate | None:
    """Return a zero that moves as was seen in stick, too, where no force of friction acts: it is there, whatever else is.

    Only another way in which the sensor's zero moves may stand for a step: a drift of it jumps a little at every look, but
    shows in stick as well. A drift has to contend with what explains the forces best.

    Args:
        candidates: the screening's outcome, best first.
        details: what the stick phases show.
    """
    step, drift = (next((c for c in candidates if c.name == kind_with_signature(sign)), None) for sign in (JUMP, CREEPING_ZERO))
    if DRIFT_SEEN in details and drift is not None:
        contends = drift.score >= max(criteria.NAMED, criteria.CONTENDS * candidates[0].score)
        return drift if contends else None
    if STEP_SEEN not in details or step is None or step.score < criteria.NAMED:
        return None
    if all(c.score <= step.score for c in candidates if c.has(MOVES_ZERO)):
        return step
    in_stick = cast("dict[str, float]", details["sticking"])
    return step if in_stick[CREEPING_ZERO] < criteria.OUTDONE * in_stick[JUMP] else None


def steady(baseline: Baseline, candidates: Sequence[Candidate], faults: Sequence[Array]) -> Pool:
    """Return the slips less what a sensor whose zero moves adds to their features: medians must be of slips alike.

    Args:
        baseline: what the model so far leaves of the slips.
        candidates: the screening's outcome; a fault of the sensor that may be named is taken out.
        faults: regressors of those that are named already, the last terms of the baseline.
    """
    pool = baseline.pool
    columns, strengths = list(faults), baseline.solution.coefficients[baseline.n_terms - len(faults) :]
    fault = next((c for c in candidates if c.has(MOVES_ZERO) and c.score >= criteria.NAMED), None)
    if fault is not None and (moved := _within_runs(baseline, fault)) is not None:
        columns += fault.hypothesis.columns
        strengths = np.r_[strengths, moved]
    if not columns:
        return pool
    return dataclasses.replace(pool, features=pool.features - np.stack(columns, axis=2) @ strengths)


def _within_runs(baseline: Baseline, fault: Candidate) -> Array | None:
    """Return the strengths of a fault that changes the slips of one run; None where it stands for what differs between runs.

    A step soon after a run's beginning is almost a level of the run's own, and so is what another load or speed does.
    """
    pool = baseline.pool
    levels = [
        column
        for run in range(1, pool.n_runs)
        for column in (pool.column(pool.static * (pool.run == run), None), pool.column(None, pool.kinetic * (pool.run == run)))
    ]
    if not levels:
        return fault.strengths
    apart = baseline.plus(levels)
    with_ = apart.fitted(fault.hypothesis.columns)
    penalty = 2.0 * (baseline.solution.cost - fault.solution.cost) - fault.score
    if 2.0 * (apart.solution.cost - with_.cost) - penalty < criteria.NAMED:
        return None
    return with_.coefficients[-len(fault.hypothesis.columns) :]
