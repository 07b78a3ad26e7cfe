"""Confirmation by indirect inference: simulate a candidate, take the same features from it, compare with the data's.

Each operating point contributes the median features of its slips, or, where the slips differ by a known excitation,
those of a few typical slips. A candidate is simulated from the middle of a stick through one slip, and the features are
extracted as from data; the same extraction of the stated model is taken out again, so that its numerical bias
cancels. mu_s, mu_k, mass, stiffness and damping are refitted with every candidate, within their uncertainty.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.fitter import minimised
from stochfric_mb.discovery.inference.free_parameter import LAW, FreeParameter, steps_of
from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED, Array, Record
from stochfric_mb.discovery.stick_slip.records.slips import N_FEATURES, Slips, features_near
from stochfric_mb.discovery.stick_slip.screening.regression import Terms
from stochfric_mb.discovery.stick_slip.simulation.auxiliary_state import auxiliary_state
from stochfric_mb.discovery.stick_slip.simulation.model import TUNED, Model, adjusted, free_parameters
from stochfric_mb.discovery.stick_slip.simulation.natural_units import NaturalUnits
from stochfric_mb.discovery.stick_slip.simulation.strength import STRENGTHS
from stochfric_mb.errors import SimulationError
from stochfric_mb.reference.augmented import Start

FLOOR = 1.0e-3
"""Error of the features that is always allowed, over the normal force [-]: numerics are never discovered."""
PENALTY = float(np.log(60.0))
"""Evidence that each number of a candidate costs [-]: BIC's for 60 observations, whatever the record's length."""
LOOKED_AT = 120
"""Most slips looked at at an operating point with a known excitation."""
PART, MOST_PARTS = 0.3, 4
"""Phases at which slips begin that one of them stands for [rad], and most parts that they are divided into."""
ANY = np.eye(N_FEATURES)
"""Whitening of features that are not compared."""
LEVELLINGS = 2
"""Times that mu_s and mu_k are moved to their places before a fit begins."""
DIFFERENCE = 0.01
"""Step of the derivatives, over a natural step of each number [-]."""
REMEMBERED = 127.5
"""Length of the record that what effects with a motion of their own remember is computed from, as an angle of the natural
oscillation [rad]: 20 periods."""
LEVEL_STEP = 0.0154
"""Natural step of mu_s and mu_k [-]."""
MISSED = 50.0
"""Deviation that counts for every feature where the candidate does not slip as the data do."""


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
    ridges: tuple[float, float]
    """Ridges of the edges of the data, break-aways and re-sticks: those of a simulation are located as firmly [-]."""
    offset: Array
    """What the extraction adds to the truth in the stated model [N], shape (N_FEATURES,)."""


@dataclasses.dataclass(frozen=True)
class Confirmed:
    """A candidate, fitted to the features."""

    kinds: tuple[str, ...]
    """Effects in it."""
    model: Model
    """With its numbers fitted."""
    chi2: float
    """Misfit, priors included [-]."""
    n_parameters: int
    """Parameters of the effects, and those of the stated model that they leave open."""
    freedom: int
    """Features less parameters."""
    slips: bool
    """Whether it slips where the data do: otherwise the misfit says nothing."""

    @property
    def criterion(self) -> float:
        """chi^2 + p ln 60: lower is better, whatever the record's length."""
        return self.scaled(1.0)

    def scaled(self, spread: float) -> float:
        """Return the criterion with chi^2 in units of ``spread``, what the forms of all candidates miss [-]."""
        return self.chi2 / spread + self.n_parameters * PENALTY


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
        bare = Case(
            slips.record, onset, float(lengths[i]), pool.features[i], ANY, (slips.ridge, slips.firm), np.zeros(N_FEATURES)
        )
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
    case = Case(slips.record, onset, length, features, whitening, (slips.ridge, slips.firm), np.zeros(N_FEATURES))
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


def evidence_needed(numbers: int) -> float:
    """Return by how much an effect of so many numbers must lower the misfit of simulated slips to be followed up [-]."""
    return criteria.FOLLOWED_UP + numbers * PENALTY


def _floor(load: float) -> Array:
    """Return the variance of the features that is always allowed [N^2], shape (N_FEATURES,)."""
    return np.asarray((FLOOR * 0.5 * load * np.r_[0.2, 0.5, np.ones(N_FEATURES - 2)]) ** 2, dtype=np.float64)


def predict(model: Model, case: Case) -> Array | None:
    """Return the features that the model predicts for a case [N], shape (N_FEATURES,); None where it does not slip so.

    A declared scatter is left out: medians are compared, and one draw of it is not the median.
    """
    model = dataclasses.replace(model, process=None)
    record = case.record
    box = record.mechanism
    margin = 3.3 / record.angular_frequency
    # from the middle of the stick, so that a break-away that comes early is not missed
    ahead = max(margin * 1.2, 0.55 * case.onset[2])
    time, position = case.onset[0] - ahead, record.direction * (case.onset[1] - box.belt_velocity * ahead)
    system = model.system(record)
    since = REMEMBERED / record.angular_frequency if all(e.forgets for e in system.effects) else 0.0
    memory = auxiliary_state(system, record, np.array([time]), np.array([position]), since=since)
    start = Start(
        time - model.late, position, record.stated.belt_velocity, True, max(case.onset[2] - ahead, 0.0),
        memory=None if memory is None else tuple(memory[0]),
    )  # fmt: skip
    # room for a break-away that comes late by a fifth of the static deflection
    late = 0.2 * abs(case.onset[1]) / box.belt_velocity
    count = round((ahead + late + 1.6 * case.length + margin) * record.rate)
    try:
        motion = system.march(start, 1.0 / record.rate, count)
    except SimulationError:
        return None
    position = record.direction * motion.position
    if not np.isfinite(position).all():
        return None
    time = start.time + model.late + np.arange(1, count + 1) / record.rate
    simulated = dataclasses.replace(record, time=time, position=position, raw=position, outlier=np.zeros(count, dtype=bool))
    return features_near(simulated, case.onset[0], ridge=case.ridges[0], firm=case.ridges[1])


@dataclasses.dataclass(frozen=True)
class SeenInSlips:
    """What a model misses of the slips that simulated ones are compared with, for a fit beside forecasts."""

    kinds: tuple[str, ...]
    """Effects that the slips were simulated with."""
    cases: tuple[Case, ...]
    """The slips."""

    def of(self, model: Model) -> Callable[[Model], Array] | None:
        """Return the function from models to errors, in their standard deviations; None for a model of other effects."""
        return self.errors if tuple(e.kind for e in model.effects) == self.kinds else None

    def errors(self, model: Model) -> Array:
        """Return the errors of a model, shape (N_FEATURES * len(cases),)."""
        return np.concatenate([_error(model, case) for case in self.cases])


def confirm(
    cases: Sequence[Case],
    candidate: Model,
    uncertainty: Mapping[str, float],
    *,
    evaluations: int = 20,
    entrained: bool = False,
) -> Confirmed:
    """Return the candidate with its numbers fitted to the features of ``cases``.

    Args:
        cases: slips to be predicted.
        candidate: the model.
        uncertainty: relative standard deviations of the stated numbers.
        evaluations: most Gauss-Newton steps.
        entrained: whether the last effect is a wave to which the slips keep: what they leave open is its phase, not its
            frequency.
    """
    free = _free_in(candidate, cases, uncertainty, entrained=entrained)
    steps = steps_of(free, np.array([_step(k) for k in free]))

    def errors(step: Array) -> Array:
        values = steps.values(step)
        trial = adjusted(candidate, free, values)
        return np.concatenate([*map(functools.partial(_error, trial), cases), steps.surprise(values)])

    def levelled(step: Array) -> Array:
        """Return the step with mu_s and mu_k moved to where the break-away and the mean force in slip are right."""
        for _ in range(LEVELLINGS):
            away = _levels_away(adjusted(candidate, free, steps.values(step)), cases)
            step = np.clip(step + np.array([away.get(k.name, 0.0) for k in free]) / steps.scale, steps.low, steps.high)
        return step

    starts = [levelled(np.clip(s, steps.low, steps.high)) for s in _starts(candidate, free, steps.scale)]
    first = min(starts, key=lambda s: float(np.sum(errors(s) ** 2)))
    minimum = minimised(
        errors,
        first,
        steps.low,
        steps.high,
        difference=DIFFERENCE,
        evaluations=evaluations,
        tolerance=1.0e-3,
    )
    n_parameters = _own(candidate, free)
    model = adjusted(candidate, free, steps.values(minimum.x))
    return Confirmed(
        tuple(e.kind for e in candidate.effects),
        model,
        float(2.0 * minimum.cost),
        n_parameters,
        N_FEATURES * len(cases) - 2 - n_parameters,
        all(predict(model, case) is not None for case in cases),
    )


def _free_in(
    candidate: Model, cases: Sequence[Case], uncertainty: Mapping[str, float], *, entrained: bool
) -> list[FreeParameter]:
    """Return what is fitted; of a wave to which the slips keep the phase, but not the frequency."""
    last, units = len(candidate.effects) - 1, NaturalUnits.of_run(cases[0].record)
    if not entrained:
        return [k for k in free_parameters(candidate, uncertainty, units) if not k.run]
    runs = list(dict.fromkeys(case.record.name for case in cases))
    free = [k for k in free_parameters(candidate, uncertainty, units, runs) if not k.run or k.owner == last]
    return [k for k in free if k.owner != last or k.name not in TUNED]


def _own(candidate: Model, free: Sequence[FreeParameter]) -> int:
    """Return the number of the effects' parameters, and of those of the stated model that they leave open."""
    freed = {name for e in candidate.effects for name in e.frees if name in CORRECTED}
    return sum(k.owner >= 0 or k.name in freed for k in free)


def _levels_away(model: Model, cases: Sequence[Case]) -> dict[str, float]:
    """Return by how much mu_s and mu_k are too low for the break-away and the mean force in slip, over all cases."""
    away: list[Array] = []
    for case in cases:
        predicted = predict(model, case)
        if predicted is not None:
            away.append((case.features - (predicted - case.offset))[:2] / case.record.mechanism.normal_force)
    return dict(zip(("mu_s", "mu_k"), np.mean(away, axis=0).tolist(), strict=True)) if away else {}


def _starts(candidate: Model, free: Sequence[FreeParameter], scale: Array) -> list[Array]:
    """Return where a fit may start: as screened, and with the last effect, and what it leaves open, several times weaker."""
    starts = [np.zeros(len(free))]
    if not candidate.effects:
        return starts
    last = len(candidate.effects) - 1
    freed = candidate.effects[last].frees
    strong = [k.owner == last and k.name in STRENGTHS and k.value != 0.0 for k in free]
    if not any(strong):
        return starts
    # a stiffness that was freed for a curved spring would, without its curve, be of another rig
    along = np.array([s or (k.owner < 0 and k.name in freed) for s, k in zip(strong, free, strict=True)])
    values = np.array([k.value for k in free])
    return starts + [np.where(along, (share - 1.0) * values / scale, 0.0) for share in (0.5, 0.2, 0.05)]


def _step(one: FreeParameter) -> float:
    return LEVEL_STEP if one.owner == LAW else one.scale


def _error(model: Model, case: Case) -> Array:
    predicted = predict(model, case)
    if predicted is None:
        return np.full(N_FEATURES, MISSED)
    return np.clip(case.whitening @ (case.features - (predicted - case.offset)), -1.0e3, 1.0e3)
