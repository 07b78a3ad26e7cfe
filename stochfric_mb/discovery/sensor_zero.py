"""A sensor whose zero moves, beside other effects: seen first, and out of the way when slips are compared."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from stochfric_mb.discovery.kinematics import NAME, STEP_SEEN
from stochfric_mb.discovery.pool import Pool
from stochfric_mb.discovery.record import Array
from stochfric_mb.discovery.regression import Solution
from stochfric_mb.discovery.screening import Candidate

ZERO_MOVES = ("sensor_drift", "sensor_step")
"""Effects that change how the slips of one run compare."""


def seen_step(candidates: Sequence[Candidate], details: Mapping[str, object]) -> Candidate | None:
    """Return a step of the sensor that was seen in stick, too: it is there, whatever else the forces hold.

    Args:
        candidates: the screening's outcome.
        details: what the stick phases told.
    """
    step = next((c for c in candidates if c.name == "sensor_step"), None)
    return step if STEP_SEEN in details and step is not None and step.score >= NAME else None


def steady(pool: Pool, candidates: Sequence[Candidate], kept: Sequence[Array], solution: Solution) -> Pool:
    """Return the slips less what a sensor whose zero moves adds to their features: medians must be of slips alike.

    Args:
        pool: the slips.
        candidates: the screening's outcome; a fault of the sensor that may be named is taken out.
        kept: regressors of faults that are named already, the last terms of ``solution``.
        solution: the fit with them.
    """
    columns, strengths = list(kept), solution.coefficients[len(solution.coefficients) - len(kept) :]
    fault = next((c for c in candidates if c.name in ZERO_MOVES and c.score >= NAME), None)
    if fault is not None:
        columns += fault.hypothesis.columns
        strengths = fault.solution.coefficients[-len(columns) :]
    if not columns:
        return pool
    return dataclasses.replace(pool, features=pool.features - np.stack(columns, axis=2) @ strengths)
