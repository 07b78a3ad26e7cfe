"""Slips that a simulation is to repeat, and what a model predicts of them.

Each operating point contributes the median features of its slips, or, where the slips differ by a known excitation,
those of a few typical slips. A model is simulated from the middle of a stick through one slip, and the features are
extracted as from data; the same extraction of the stated model is taken out again, so that its numerical bias cancels.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array, Record
from stochfric_mb.discovery.stick_slip.records.slips import N_FEATURES, EdgeSearch, Slips, features_near
from stochfric_mb.discovery.stick_slip.screening.regression import Terms
from stochfric_mb.discovery.stick_slip.simulation.auxiliary_state import auxiliary_state
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.errors import SimulationError

FLOOR = 1.0e-3
"""Error of the features that is always allowed, over the normal force [-]: numerics are never discovered."""
LOOKED_AT = 120
"""Most slips looked at at an operating point with a known excitation."""
PART, MOST_PARTS = 0.3, 4
"""Phases at which slips begin that one of them stands for [rad], and most parts that they are divided into."""
ANY = np.eye(N_FEATURES)
"""Whitening of features that are not compared."""
REMEMBERED = 127.5
"""Length of the record that what effects with a motion of their own remember is computed from, as an angle of the natural
oscillation [rad]: 20 periods."""


@dataclasses.dataclass(frozen=True)
class Case:
    """One slip to be predicted."""

    record: Record
    """A run at the operating point."""
    onset: tuple[float, float, float]
    """Break-away of the data: time [s], position [m], dwell before it [s]."""
    length: float
    """Duration of the slip [s]."""
    features: Array
    """Features of the data [N], shape (N_FEATURES,)."""
    whitening: Array
    """Inverse Cholesky factor of their covariance [1/N], shape (N_FEATURES, N_FEATURES)."""
    search: EdgeSearch
    """How the edges of the data were found: those of a simulation are looked for in the same way."""
    offset: Array
    """What the extraction adds to the truth in the stated model [N], shape (N_FEATURES,)."""
    between: float = 0.0
    """Part of a sample by which the simulation begins earlier [-]: its samples then fall elsewhere in the slip."""
    averaged: frozenset[str] = frozenset()
    """Kinds of waves over whose phases the features are a median: a slip that stands for all is simulated without them."""


def cases_of(pool: Pool, model: Model) -> list[Case]:
    """Return the slips to be predicted: one an operating point, a few where an excitation makes them differ."""
    cases: list[Case] = []
    for excitation, runs, rows in _points(pool):
        cases += _forced(pool, model, rows) if excitation else [_free(pool, model, rows, runs)]
    return cases


def _points(pool: Pool) -> list[tuple[float, list[int], np.ndarray]]:
    """Return the amplitude of the excitation, the runs and the slips of each operating point that has three slips."""
    points: dict[tuple[float, ...], list[int]] = {}
    for r, slips in enumerate(pool.slips):
        box = slips.record.mechanism
        point = (box.belt_velocity, box.normal_force, box.excitation_amplitude)
        key = (*(float(f"{x:.9g}") for x in point), float(slips.record.direction))
        points.setdefault(key, []).append(r)
    every = [(key[2], runs, np.flatnonzero(pool.kept & np.isin(pool.run, runs))) for key, runs in points.items()]
    return [one for one in every if len(one[2]) >= 3]


def _free(pool: Pool, model: Model, rows: np.ndarray, runs: Sequence[int]) -> Case:
    features = pool.features[rows]
    slips = pool.slips[runs[0]]
    centre = np.median(features, axis=0)
    covariance = _of_median(pool.calibrations[runs[0]].covariance, features)
    middle = float(slips.onset_time[len(slips) // 2])
    onset = (middle, float(np.median(slips.onset_position)), float(np.median(pool.dwell[rows])))
    length = float(np.median(pool.restick_time[rows] - pool.onset_time[rows]))
    return _case(model, slips, onset, length, centre, covariance)


def _forced(pool: Pool, model: Model, rows: np.ndarray) -> list[Case]:
    """Return one case for each part of the excitation's cycle in which slips begin.

    Slips that begin at nearly the same phase differ little: one of them stands for all, with the median of what the
    stated model misses in each.
    """
    chosen = rows[np.unique(np.linspace(0, len(rows) - 1, LOOKED_AT).round().astype(int))]
    plain = model.bare(pool.slips[0].record)
    onsets: list[tuple[float, float, float]] = []
    lengths = pool.restick_time - pool.onset_time
    predictions: list[Array] = []
    kept: list[int] = []
    for i in chosen:
        slips = pool.slips[pool.run[i]]
        k = i - int(np.flatnonzero(pool.run == pool.run[i])[0])
        onset = (float(slips.onset_time[k]), float(slips.onset_position[k]), float(pool.dwell[i]))
        bare = Case(slips.record, onset, float(lengths[i]), pool.features[i], ANY, slips.search, np.zeros(N_FEATURES))
        predicted = predict(plain, bare)
        if predicted is not None:
            onsets.append(onset)
            predictions.append(predicted)
            kept.append(int(i))
    if not kept:
        return []
    frequency = pool.slips[pool.run[kept[0]]].record.mechanism.excitation_angular_frequency
    cases: list[Case] = []
    for part in _parts(frequency * np.array([o[0] for o in onsets])):
        middle = part[len(part) // 2]
        mine = np.array(kept)[part]
        slips = pool.slips[pool.run[kept[middle]]]
        missed = pool.features[mine] - np.array(predictions)[part]
        covariance = _of_median(pool.calibrations[pool.run[kept[middle]]].covariance, missed)
        features = predictions[middle] + np.median(missed, axis=0)
        length = float(np.median(lengths[mine]))
        cases.append(_case(model, slips, onsets[middle], length, features, covariance))
    return cases


def _parts(phase: Array) -> list[np.ndarray]:
    """Return the numbers of the slips in each part of the cycle, by the phases at which they begin [rad], in their order."""
    turn = 2.0 * np.pi
    order = np.argsort(phase % turn, kind="stable")
    placed = (phase % turn)[order]
    gaps = np.diff(np.r_[placed, placed[0] + turn])
    first = (int(np.argmax(gaps)) + 1) % len(order)
    order = np.roll(order, -first)
    width = turn - float(gaps.max())
    count = int(np.clip(np.ceil(width / PART), 1, min(MOST_PARTS, max(len(order) // 3, 1))))
    return [p for p in np.array_split(order, count) if len(p)]


def _of_median(covariance: Array, values: Array) -> Array:
    """Return the covariance of a median of n ``values``, which err by ``covariance`` and may scatter more, shape as its."""
    # the variance of a median is pi/2 that of a mean
    share = 1.57 / len(values)
    scatter = share * np.var(values, axis=0)
    return share * covariance + np.diag(np.maximum(scatter - np.diag(share * covariance), 0.0))


def _case(
    model: Model,
    slips: Slips,
    onset: tuple[float, float, float],
    length: float,
    features: Array,
    covariance: Array,
) -> Case:
    load = slips.record.mechanism.normal_force
    whitening = np.asarray(np.linalg.inv(np.linalg.cholesky(covariance + np.diag(_floor(load)))), dtype=np.float64)
    case = Case(slips.record, onset, length, features, whitening, slips.search, np.zeros(N_FEATURES))
    plain = model.with_law(features[0] / load, min(features[1], 0.99 * features[0]) / load)
    predicted = predict(plain.bare(slips.record), case)
    if predicted is None:
        return case
    truth = np.zeros(N_FEATURES)
    truth[0], truth[1] = plain.law.mu_s * load, plain.law.mu_k * load
    return dataclasses.replace(case, offset=predicted - truth)


def evidence_in_medians(pool: Pool, terms: Terms, column: Array) -> float:
    """Return by how much a unit of a change lowers the misfit of simulated slips, beyond what the stated model imitates [-].

    What is simulated are medians, one slip an operating point, and their errors have a floor: many slips see a weak effect
    that their medians do not.

    Args:
        pool: the slips.
        terms: the stated model.
        column: the change for a unit [N], shape (n, N_FEATURES).
    """
    signal: list[Array] = []
    stated: list[Array] = []
    for _, runs, rows in _points(pool):
        load = pool.slips[runs[0]].record.mechanism.normal_force
        covariance = _of_median(pool.calibrations[runs[0]].covariance, pool.features[rows]) + np.diag(_floor(load))
        whitening = np.linalg.inv(np.linalg.cholesky(covariance))
        signal.append(whitening @ column[rows].mean(axis=0))
        stated.append(whitening @ terms.columns[rows].mean(axis=0))
    if not signal:
        return 0.0
    known = np.concatenate([*stated, np.diag(1.0 / terms.priors)])
    seen = np.concatenate([*signal, np.zeros(len(terms.priors))])
    size = np.linalg.norm(known, axis=0)
    left = seen - known @ (np.linalg.lstsq(known / size, seen, rcond=1.0e-10)[0] / size)
    return float(left @ left)


def _floor(load: float) -> Array:
    """Return the variance of the features that is always allowed [N^2], shape (N_FEATURES,)."""
    return np.asarray((FLOOR * 0.5 * load * np.r_[0.2, 0.5, np.ones(N_FEATURES - 2)]) ** 2, dtype=np.float64)


def predict(model: Model, case: Case) -> Array | None:
    """Return the features that the model predicts for a case [N], shape (N_FEATURES,); None where it does not slip so.

    What is random is left out: medians are compared, and one draw of it is not the median.
    """
    model = model.without_waves(case.averaged).mean
    record = case.record
    box = record.mechanism
    margin = 3.3 / record.angular_frequency
    # from the middle of the stick, so that a break-away that comes early is not missed
    ahead = max(margin * 1.2, 0.55 * case.onset[2]) + case.between / record.rate
    time, position = case.onset[0] - ahead, record.direction * (case.onset[1] - box.belt_velocity * ahead)
    system = model.system(record)
    since = REMEMBERED / record.angular_frequency if all(e.forgets for e in system.effects) else 0.0
    memory = auxiliary_state(system, record, np.array([time]), np.array([position]), since=since)
    start = [time - model.late, position, record.stated.belt_velocity, 1.0, max(case.onset[2] - ahead, 0.0), 0.0]
    # room for a break-away that comes late by a fifth of the static deflection
    late = 0.2 * abs(case.onset[1]) / box.belt_velocity
    count = round((ahead + late + 1.6 * case.length + margin) * record.rate)
    try:
        moved = system.forecasts([start], 1.0 / record.rate, count, memory)[0]
    except SimulationError:
        return None
    position = record.direction * moved
    if not np.isfinite(position).all():
        return None
    shown = time + np.arange(1, count + 1) / record.rate
    simulated = dataclasses.replace(record, time=shown, position=position, raw=position, outlier=np.zeros(count, dtype=bool))
    return features_near(simulated, case.onset[0], case.search)
