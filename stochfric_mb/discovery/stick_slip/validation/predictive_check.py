"""Whether the named model is adequate: what it leaves of the slips, against what it leaves of records of its own.

A name that fits best need not be right. The evidence in the forces of the slips has four parts: how runs differ, the shape
that the slips of a run share, and how the slips of a run differ from one another, in level and in shape. A right name
leaves of each what chance and its form leave; a wrong one may explain the part that it was chosen for, and no more. Noise
hides edges, which biases the forces of slips that begin slowly: records simulated from the named model, taken through the same
extraction, tell by how much.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.innovations import left_over
from stochfric_mb.discovery.stick_slip.records.pool import Pool, make_pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import N_FEATURES
from stochfric_mb.discovery.stick_slip.screening.competitors import step_times
from stochfric_mb.discovery.stick_slip.screening.regression import LOWEST, Baseline, Regression, stated_terms
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.scatter import simulated_slips
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.effects.traits import CLIPPED, JUMP, LATE, MOVES_ZERO
from stochfric_mb.errors import SimulationError

PARTS = (
    Where("normal load, belt speed", "the forces of runs differ in a way that it does not explain"),
    Where("shape of the friction force within a slip", "the force within the slips has another shape"),
    Where("time within the run", "the forces of slips differ from one another in a way that it does not explain"),
    Where("shape of the friction force within a slip, time within the run", "the shape of the slips varies"),
)
"""Parts of the evidence: axis, and what is said if a name leaves it."""
VARYING = PARTS[2:]
"""Those in which the slips of a run differ from one another."""
LEVELS = 2
"""Features that are levels, force at break-away and mean force in slip; the others are shape."""
DRAWS = 2
"""Records of the named model for each measured one."""
FLOOR = 0.5e-3 * np.r_[0.2, 0.5, np.ones(N_FEATURES - 2)]
"""Errors of the features common to a run's slips that are always allowed, over the normal force [-], as in confirmation."""


@dataclasses.dataclass(frozen=True)
class _Misfit:
    """What a model leaves of the slips, run by run, in units of its noise."""

    means: list[Array]
    """Of the features of all slips, shape (N_FEATURES,) each."""
    weights: list[Array]
    """Inverse covariance of such a mean, shape (N_FEATURES, N_FEATURES) each."""
    varying: Array
    """chi^2 of what slips differ by, in level and in shape, less its freedom, shape (2,)."""
    freedom: Array
    """Degrees of freedom of the four parts, shape (4,)."""

    def excess(self, bias: list[Array], varying: Array) -> Array:
        """Return chi^2 less its freedom of the four parts beyond a bias of the means and chi^2 of the variation, shape (4,)."""
        common = np.zeros(2)
        for mean, weight, known in zip(self.means, self.weights, bias, strict=True):
            away = mean - known
            shape = weight[LEVELS:, LEVELS:] - weight[LEVELS:, :LEVELS] @ np.linalg.solve(
                weight[:LEVELS, :LEVELS], weight[:LEVELS, LEVELS:]
            )
            of_shape = float(away[LEVELS:] @ shape @ away[LEVELS:])
            common += np.r_[float(away @ weight @ away) - of_shape, of_shape]
        return np.r_[common - self.freedom[:2], self.varying - varying]


def inadequate(study: Study, model: Model) -> tuple[Where | None, dict[str, list[float]]]:
    """Return where a named model leaves the larger part of the evidence, None where it is adequate, and the numbers.

    Args:
        study: what the fit runs show.
        model: the model with the effects, fitted.
    """
    if any({LATE, CLIPPED} & set(e.signatures) for e in model.effects):
        return None, {}  # the forces of such a record are not those of its slips
    calm = model.mean
    try:
        left = _left(study.pool, calm, study.uncertainty, random=model.random)
        if left is None:
            return None, {}
        beyond = study.baseline.pool if study.model.says_more else study.pool  # less what is stated already
        before = _misfit(dataclasses.replace(beyond, kept=left[1]), study.uncertainty, random=model.random)
        nothing = [np.zeros(N_FEATURES)] * len(before.means), np.zeros(2)
        shown, rest = before.excess(*nothing), left[0].excess(*nothing)
        if not _lacks(shown, rest, left[0].freedom, 0.0).any():
            return None, {}
        bias, varying = _of_its_own(study, model, calm)
    except SimulationError:
        return None, {}
    rest = left[0].excess(bias, varying[0])
    lacks = _lacks(shown, rest, left[0].freedom * (1.0 + 1.0 / DRAWS), np.r_[0.0, 0.0, varying[1]])
    if model.random:
        lacks[LEVELS:] = False  # what differs from slip to slip is what such an effect explains
    numbers = {"shown": shown.tolist(), "left": rest.tolist()}
    worst = int(np.argmax(np.where(lacks, rest, -np.inf)))
    return (PARTS[worst] if lacks.any() else None), numbers


def _lacks(shown: Array, left: Array, freedom: Array, error: Array | float) -> np.ndarray:
    """Return which parts that show something keep more evidence than a name may leave, both beyond doubt, shape (4,).

    A form that errs by a share e of its effect leaves e^2 of the evidence where it acts, and the order of e^4 of it
    elsewhere. The variance of a chi^2 with d degrees of freedom that exceeds them by x is 2 d + 4 x.
    """
    doubt = np.sqrt(2.0 * freedom + 4.0 * np.maximum(left, 0.0) + np.asarray(error) ** 2)
    shown = np.maximum(shown, 0.0)
    allowed = np.maximum(criteria.EVIDENCE_LEFT * shown, criteria.FORM_MISSES**2 * shown.sum())
    seen = shown > criteria.LEFT_BEYOND * np.sqrt(2.0 * freedom)
    return np.asarray(seen & (left - allowed > criteria.LEFT_BEYOND * doubt))


def _left(pool: Pool, calm: Model, uncertainty: Mapping[str, float], *, random: bool) -> tuple[_Misfit, np.ndarray] | None:
    """Return what a model without chances leaves of slips, and which of them count; None where it misses too many."""
    left = left_over(_zeroed(pool, calm), calm, anew=calm.shapes_slips)
    kept = pool.kept & left.kept & ~_jumped(pool, calm)
    if kept.sum() < criteria.LEAST_KEPT * pool.kept.sum():
        return None
    return _misfit(dataclasses.replace(left, kept=kept), uncertainty, random=random), kept


def _of_its_own(study: Study, model: Model, calm: Model) -> tuple[list[Array], tuple[Array, Array]]:
    """Return the means that a model leaves of records of its own, and how slips vary in them, with its standard deviation."""
    misfits: list[_Misfit] = []
    for draw in range(DRAWS):
        slips = [simulated_slips(model, s, sample=1 + draw * len(study.pool.slips) + i) for i, s in enumerate(study.pool.slips)]
        if not all(map(len, slips)):
            raise SimulationError("the model does not slip")
        left = _left(make_pool(slips, study.pool.calibrations), calm, study.uncertainty, random=model.random)
        if left is None:
            raise SimulationError("the model does not slip as it did in the fit")
        misfits.append(left[0])
    means = [np.asarray(np.mean([m.means[r] for m in misfits], axis=0), dtype=np.float64) for r in range(study.pool.n_runs)]
    varying = np.array([m.varying for m in misfits])
    return means, (varying.mean(axis=0), varying.std(axis=0, ddof=1))


def _misfit(pool: Pool, uncertainty: Mapping[str, float], *, random: bool) -> _Misfit:
    """Return what the stated model, its numbers fitted, leaves of slips; scatter beside noise counts as such if random."""
    regression, terms = Regression(pool), stated_terms(pool, uncertainty)
    solution = regression.fit(terms) if random else regression.solve(terms, np.full(3, LOWEST))
    rest = Baseline(regression, terms, solution).residuals()
    means: list[Array] = []
    weights: list[Array] = []
    varying, freedom = np.zeros(2), np.zeros(4)
    for run in range(pool.n_runs):
        mine = rest[pool.kept & (pool.run == run)]
        covariance = regression.covariance(run, solution.scatter)
        floor = np.diag((FLOOR * pool.slips[run].record.mechanism.normal_force) ** 2)
        count = max(len(mine), 1)
        means.append(mine.mean(axis=0) if len(mine) else np.zeros(N_FEATURES))
        weights.append(np.asarray(np.linalg.inv(covariance / count * (1.0 + 1.0 / DRAWS) + floor), dtype=np.float64))
        away = mine - means[-1]
        levels = _chi2(away[:, :LEVELS], covariance[:LEVELS, :LEVELS])
        every = np.array([LEVELS, N_FEATURES - LEVELS], dtype=np.float64)
        freedom += np.r_[every, (count - 1) * every]
        varying += np.r_[levels, _chi2(away, covariance) - levels] - (count - 1) * every
    return _Misfit(means, weights, varying, freedom)


def _chi2(rows: Array, covariance: Array) -> float:
    return float(np.einsum("ij,ji->", rows, np.linalg.solve(covariance, rows.T)))


def _jumped(pool: Pool, model: Model) -> np.ndarray:
    """Return the slips whose cycle holds a jump of the reading, as well as its time is known: their forces are not theirs."""
    doubt = float(np.ptp(step_times(pool)[:2]))
    jumped = np.zeros(len(pool.run), dtype=bool)
    for run, slips in enumerate(pool.slips):
        onset = pool.onset_time[pool.run == run]
        for effect in model.effects_in(slips.record.name):
            if JUMP in effect.signatures:
                jumped[pool.run == run] |= np.abs(onset - effect.time) < slips.cycle + doubt  # pyright: ignore[reportAttributeAccessIssue]
    return jumped


def _zeroed(pool: Pool, model: Model) -> Pool:
    """Return the slips less what a sensor whose zero moves adds to their forces."""
    features = pool.features.copy()
    for run, slips in enumerate(pool.slips):
        mine = pool.run == run
        force = slips.record.direction * slips.record.mechanism.stiffness
        for effect in model.effects_in(slips.record.name):
            if MOVES_ZERO in effect.traits:
                for column, time in ((0, pool.onset_time[mine]), (1, pool.mean_time[mine])):
                    moved = effect.measure(time, np.zeros(len(time)), np.random.default_rng(0))
                    features[mine, column] -= force * moved
    return dataclasses.replace(pool, features=features)
