"""The gap where the disagreement lives: forces of held-out slips against their prediction, in units of their noise.

A one-cycle forecast of the position averages over what an effect does to single slips, and the sensor's noise hides the rest;
the force at break-away and the coefficients of the friction force within a slip are where the evidence comes from.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Gap, Leading
from stochfric_mb.discovery.stick_slip.decision.innovations import plain_features, predicted_features
from stochfric_mb.discovery.stick_slip.records.calibration import Calibration, calibrate
from stochfric_mb.discovery.stick_slip.records.pool import make_pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import N_FEATURES, Slips
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.statistics import crps_normal

LOOKED_AT = 24
"""Most slips of a run that are predicted."""


def slip_force_gap(stated: Model, recalibrated: Model, augmented: Model, slips: Sequence[Slips]) -> Gap | None:
    """Return the CRPS of predicted slip forces over their noise [-]; None where the model holds what they cannot show.

    Args:
        stated: the model as stated.
        recalibrated: with its parameters fitted.
        augmented: with the effects, their phases in the held-out runs estimated already.
        slips: slips of the held-out runs; where phases were estimated in their first halves, the second halves are scored.
    """
    if any(e.group == "sensor" or (e.random and e.coefficient_process() is None) for e in augmented.effects):
        return None
    phased = any(e.own_to_run for e in augmented.effects)
    scores: list[Array] = []
    for run in slips:
        first = len(run) // 2 if phased else 1
        rows = np.unique(np.linspace(first, len(run) - 1, LOOKED_AT).round().astype(int)) if len(run) > first else np.arange(0)
        if len(rows):
            scores.append(_scores((stated, recalibrated, augmented), run, calibrate(run), rows))
    joined = np.concatenate(scores) if scores else np.zeros((0, 4))
    joined = joined[np.isfinite(joined).all(axis=1)]
    if len(joined) < criteria.FORCES_FEWEST:
        return None
    before, middle, after, floor = (float(x) for x in joined.mean(axis=0))
    source = "what the final model would score if it were true"
    return Gap("crps_slip_forces", "-", True, before, middle, after, min(floor, after), source)


@dataclasses.dataclass(frozen=True)
class Gaps:
    """How far stated, recalibrated and augmented model are off on held-out runs."""

    forecasts: Gap | None
    """In forecasts of a cycle."""
    forces: Gap | None = None
    """In the forces of slips."""
    readings: Gap | None = None
    """In single readings."""

    @property
    def leading(self) -> Leading:
        """The score in which effects show.

        That of readings where these alone show the first effect; that of the forces where far more of it can be made better
        than of forecasts.
        """
        if self.readings is not None and self.readings.closed is not None:
            return "readings"
        if self.forces is None or self.forces.closed is None or self.forecasts is None:
            return "gap"
        seen, felt = (g.reducible / g.recalibrated for g in (self.forecasts, self.forces))
        return "slip_forces" if seen < criteria.SHOWS_IN_FORECASTS * felt else "gap"

    @property
    def leads(self) -> Gap | None:
        """The gap of that score."""
        return {"gap": self.forecasts, "slip_forces": self.forces, "readings": self.readings}[self.leading]


def _scores(models: Sequence[Model], slips: Slips, calibration: Calibration, rows: np.ndarray) -> Array:
    """Return the scores of three models and the floor of the last, slip by slip, shape (n_rows, 4)."""
    pool = make_pool([slips], [calibration])
    noise = np.sqrt(np.diag(calibration.covariance))
    columns: list[Array] = []
    spread = noise
    for model in models:
        spread = np.hypot(noise, _scatter(model, slips))
        error = pool.features[rows] - _expected(model, slips, pool.dwell, rows)
        columns.append((crps_normal(error, spread) / noise).mean(axis=1))
    # of a normal number scored by its own distribution the expectation is 1/sqrt(pi) of its deviation
    floor = np.full(len(rows), float(np.mean(spread / noise)) / np.sqrt(np.pi))
    return np.stack([*columns, floor], axis=1)


def _expected(model: Model, slips: Slips, dwell: Array, rows: np.ndarray) -> Array:
    """Return the features that a model expects of some slips [N], without what the extraction adds, shape (n, N_FEATURES)."""
    calm = model.mean
    bare = model.bare(slips.record)
    forced = slips.record.mechanism.excitation_amplitude != 0.0
    added = plain_features(slips, bare, dwell, rows, forced=forced)
    truth = slips.record.mechanism.normal_force * np.r_[model.law.mu_s, model.law.mu_k, np.zeros(N_FEATURES - 2)]
    return predicted_features(slips, calm, dwell, rows) - (added - truth)


def _scatter(model: Model, slips: Slips) -> Array:
    """Return the standard deviation by which a model's coefficients scatter the features [N], shape (N_FEATURES,)."""
    processes = [model.process, *(e.coefficient_process() for e in model.effects)]
    drawn = [p for p in processes if p is not None]
    sigma_s, sigma_k = (float(np.sqrt(sum(_sigma(p, i) ** 2 for p in drawn))) for i in (0, 1))
    return slips.record.mechanism.normal_force * np.r_[sigma_s, sigma_k, np.zeros(N_FEATURES - 2)]


def _sigma(process: object, which: int) -> float:
    return float(getattr(process, ("sigma_s", "sigma_k")[which], 0.0))
