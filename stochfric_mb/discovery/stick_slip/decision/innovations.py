"""What a model leaves of every slip: each one predicted by simulation from the stick before it.

For models with effects the regressors are only first-order; a simulated slip is exact. Features of the data, less what
the model's effects add to those of plain Coulomb friction, are again features of a Coulomb contact if the model is right.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.decision.cases import ANY, Case, predict
from stochfric_mb.discovery.stick_slip.records.calibration import LEAST_ERROR, Calibration
from stochfric_mb.discovery.stick_slip.records.pool import LEAST_DWELL, Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import N_FEATURES, Slips
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline, baseline_of
from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import phased
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.phases import in_phase
from stochfric_mb.discovery.stick_slip.simulation.refit import REFIT_WINDOWS, refit
from stochfric_mb.discovery.stick_slip.simulation.sensor_errors import errors_by_noise
from stochfric_mb.discovery.stick_slip.study import Study, retaken

BETWEEN = 64
"""Places between two samples at which the edges of predicted slips fall in turn: where samples fall moves the course of the
force in a single slip by a hundredth of the load, and a mean of measured slips knows nothing of it."""


def left_by(
    model: Model, study: Study, before: Baseline, *, anew: bool = False, faults: Sequence[Array] = ()
) -> Baseline | None:
    """Return the stated model, fitted to what the effects of a model leave; None where it misses too many slips.

    Args:
        model: the model.
        study: the slips as measured.
        before: what was left before.
        anew: as in `left_over`.
        faults: regressors that stay among the terms.
    """
    left = left_over(study.pool, model, anew=anew)
    if left.kept.sum() < criteria.LEAST_KEPT * before.pool.kept.sum():
        return None
    return baseline_of(left, study.uncertainty, before.solution.scatter, faults)


def beyond_stated(study: Study) -> Study:
    """Return a study whose baseline is what the stated model leaves of the slips, where that says more than two coefficients.

    A law that depends on speed, or effects that are stated, are taken out as effects are that are named, and forces are taken
    with the mechanism that they show.
    """
    if not study.model.says_more:
        return study
    mean = study.model.mean
    if phased(mean):
        for windows in study.windows:
            mean = in_phase(mean, windows) if len(windows) else mean
        study = dataclasses.replace(study, model=study.model.with_mean(mean))
    # one draw of what is random tells nothing of its mean
    mean = refit(mean, study.windows, study.uncertainty, most=REFIT_WINDOWS, evaluations=20).model
    study = retaken(study, mean.corrections)
    left = left_by(mean, study, study.baseline, anew=mean.shapes_slips)
    if left is None:
        return study
    # of the same slips, at the scatter that the stated model has not explained yet, as a candidate's evidence is taken
    measured = study.baseline.of(left.pool.kept)
    with_ = left.regression.solve(left.terms, measured.solution.scatter)
    return dataclasses.replace(study, baseline=left, explained=2.0 * max(measured.solution.cost - with_.cost, 0.0))


def left_over(pool: Pool, model: Model, *, anew: bool = False) -> Pool:
    """Return the pool with the effects of ``model`` taken out of its features; slips that it misses are set aside.

    Args:
        pool: the slips with their features as measured.
        model: a deterministic model with effects, its numbers fitted.
        anew: whether its effects change how a slip begins and ends, so that noise makes other errors in its features.
    """
    # what an effect freed of the mechanism goes with it
    corrections = {name: 0.0 if name in model.left_open else value for name, value in model.corrections.items()}
    plain = dataclasses.replace(model, law=model.plain_law, effects=(), own={}, corrections=corrections)
    features = pool.features.copy()
    kept = pool.kept.copy()
    calibrations = list(pool.calibrations)
    for r, slips in enumerate(pool.slips):
        rows = np.flatnonzero(pool.run == r)
        with_effects = predicted_features(slips, model, pool.dwell[rows], range(len(rows)))
        forced = slips.record.mechanism.excitation_amplitude != 0.0
        features[rows] -= with_effects - plain_features(slips, plain, pool.dwell[rows], range(len(rows)), forced=forced)
        if anew:
            features[rows], calibrations[r] = _calibrated_anew(features[rows], slips, model, plain, calibrations[r])
        missed = ~np.isfinite(features[rows]).all(axis=1)
        features[rows[missed]] = pool.features[rows[missed]]
        kept[rows[missed]] = False
    return dataclasses.replace(pool, features=features, kept=kept, calibrations=tuple(calibrations))


def _calibrated_anew(
    features: Array, slips: Slips, model: Model, plain: Model, before: Calibration
) -> tuple[Array, Calibration]:
    """Return features with the bias by noise that the effects' slips have instead of plain ones, and its covariance."""
    with_effects, without = errors_by_noise(model, slips), errors_by_noise(plain, slips)
    if with_effects is None or without is None:
        return features, before
    floor = (LEAST_ERROR * float(np.median(slips.onset_force))) ** 2 * np.eye(N_FEATURES)
    after = dataclasses.replace(before, covariance=with_effects.covariance + floor)
    return features - (with_effects.bias - without.bias), after


def plain_features(slips: Slips, plain: Model, dwell: Array, which: Sequence[int] | np.ndarray, *, forced: bool) -> Array:
    """Return the features of some slips as a model without effects predicts them [N]: alike where nothing shakes the box.

    Args:
        slips: the run's slips.
        plain: the model.
        dwell: time for which each slip's stick lasted [s].
        which: the slips.
        forced: whether the rig is excited, so that each slip is another one, predicted where it was measured; otherwise slips
            begin where the model lets go, which may be far from where a rig with the effects did.

    Returns:
        Shape (len(which), N_FEATURES), or (N_FEATURES,) of what is not forced; nan where none slips.
    """
    if forced:
        return predicted_features(slips, plain, dwell, which)
    box = plain.mechanism(slips.record.stated)
    away = (plain.law.mu_s * box.normal_force - box.damping * abs(box.belt_velocity)) / box.stiffness
    return predicted_features(slips, plain, dwell, range(min(len(slips), BETWEEN)), away=away).mean(axis=0)


def predicted_features(
    slips: Slips, model: Model, dwell: Array, which: Sequence[int] | np.ndarray, *, away: float | None = None
) -> Array:
    """Return the features of some slips as the model predicts them [N], shape (n, N_FEATURES); nan where none slips.

    Args:
        slips: the run's slips.
        model: the model.
        dwell: time for which each slip's stick lasted [s].
        which: the slips.
        away: position at which the box breaks away [m]; None: where it was measured to.
    """
    rows: list[Array] = []
    typical = float(np.median(slips.onset_position)) if away is None else away
    moved = typical - float(np.median(slips.onset_position))
    previous = np.r_[np.median(slips.restick_position), slips.restick_position[:-1]]
    belt = slips.record.mechanism.belt_velocity
    for i in which:
        # predicted from the last re-stick alone: the place of this break-away is what is to be predicted
        expected = slips.onset_time[i] + (typical - slips.onset_position[i]) / belt
        stuck = (typical - moved - previous[i]) / belt if i else float(dwell[i])
        case = Case(
            slips.record, (float(expected), typical, max(stuck, LEAST_DWELL / slips.record.angular_frequency)),
            float(np.median(slips.restick_time - slips.onset_time)), slips.features[i], ANY, slips.search,
            np.zeros(N_FEATURES), (i % BETWEEN) / BETWEEN,
        )  # fmt: skip
        result = predict(model, case)
        rows.append(np.full(N_FEATURES, np.nan) if result is None else result)
    return np.array(rows)
