"""The gap on held-out runs: one-cycle-ahead forecasts before and after, and the noise floor.

A phase that each run has its own value of cannot be known before a run begins: it is estimated in the first half of a
held-out run, and every model is then scored on the second half alone.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from stochfric_mb.discovery.result import Gap
from stochfric_mb.discovery.stick_slip.records.calibration import calibrate
from stochfric_mb.discovery.stick_slip.records.pool import make_pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import Slips
from stochfric_mb.discovery.stick_slip.screening.competitors import step_times, steps
from stochfric_mb.discovery.stick_slip.screening.naming import with_steps
from stochfric_mb.discovery.stick_slip.screening.regression import START, Regression, stated_terms
from stochfric_mb.discovery.stick_slip.simulation.forecast import Windows, expected_scores, score, windows_of
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.phases import in_phase
from stochfric_mb.discovery.stick_slip.simulation.scatter import simulated_slips
from stochfric_mb.effects.traits import JUMP


@dataclasses.dataclass(frozen=True)
class HeldOut:
    """Held-out runs, split where phases must be estimated first."""

    slips: tuple[Slips, ...]
    """Slips of the held-out runs."""
    first: tuple[Windows, ...]
    """Forecasts from which phases are estimated."""
    second: tuple[Windows, ...]
    """Forecasts that are scored."""


def held_out(slips: Sequence[Slips], *, phased: bool) -> HeldOut:
    """Return the forecasts of held-out runs; ``phased``: some model has phases of its own in each run."""
    windows = [windows_of(s) for s in slips]
    halves = [len(w) // 2 if phased else 0 for w in windows]
    return HeldOut(
        tuple(slips),
        tuple(w.part(slice(0, h)) for w, h in zip(windows, halves, strict=True)),
        tuple(w.part(slice(h, None)) for w, h in zip(windows, halves, strict=True)),
    )


def as_split_for(model: Model, runs: HeldOut) -> HeldOut:
    """Return held-out runs as they are scored for a model: whole where it has no phases that a first half must tell."""
    split = any(map(len, runs.first))
    return held_out(runs.slips, phased=False) if split and not phased(model) else runs


def phased(model: Model) -> bool:
    """Return whether the model has phases that each run has its own value of."""
    return any(e.own_to_run for e in model.effects)


def settled(model: Model, runs: HeldOut) -> Model:
    """Return the model with its phases estimated in the first halves of the held-out runs."""
    model = _stepped(model, runs)
    if not phased(model):
        return model
    calm = model.mean
    kept = model.lasting
    for windows in runs.first:
        if len(windows):
            run = windows.record.name
            model = model.with_own(run, kept, in_phase(calm, windows).own[run])
    return model


def _stepped(model: Model, runs: HeldOut) -> Model:
    """Return the model with the sensor's step estimated in each held-out run: a fault of the record, like its phase."""
    places = [i for i, e in enumerate(model.effects) if JUMP in e.signatures]
    if not places:
        return model
    for slips in runs.slips:
        pool = make_pool([slips], [calibrate(slips)])
        regression = Regression(pool)
        terms = stated_terms(pool, dict.fromkeys(("stiffness", "mass", "damping"), 0.01))
        trials = steps(pool, 0, multiplied=False)
        when: list[float] = []
        for _ in places:
            best = int(np.argmax(regression.gains(terms, START, [[t] for t in trials])))
            terms = terms.plus([trials[best]])
            when.append(float(step_times(pool)[best]))
        # at the scatter that the step leaves: START is that of friction, and errs by a hundredth of the step
        sizes = regression.fit(terms).coefficients[-len(places) :]
        for place, size, time in zip(places, sizes, when, strict=True):
            model = with_steps(model, {slips.record.name: (float(size), time)}, place)
    return model


def scores(model: Model, runs: HeldOut) -> Array:
    """Return the CRPS of each of the scored forecasts [m], shape (n,)."""
    return np.concatenate([np.zeros(0), *(score(model, w) for w in runs.second)])


def mean_score(model: Model, runs: HeldOut) -> float:
    """Return the mean CRPS of the scored forecasts [m]; nan where there is none."""
    each = scores(model, runs)
    return float(each.mean()) if len(each) else float("nan")


def floor_scores(model: Model, runs: HeldOut, plain: Model | None = None) -> Array:
    """Return what the model scores in each forecast [m], shape (n,), on runs simulated from itself with the records' noise.

    Args:
        model: the model; a random one's scores are expected values.
        runs: the runs whose place the simulated ones take.
        plain: a model without what is random in it. If it is given, the floor of a random model is that of records as
            eventful as these: what the plain one misses of them, times how much less the model misses of its own records.
            A record with twice as many kicks as usual leaves twice as much to miss, whatever the model.
    """
    if not model.random:
        simulated = [windows_of(simulated_slips(model, s, sample=7 + i)) for i, s in enumerate(runs.slips)]
        return np.concatenate([np.zeros(0), *(score(model, w) for w in simulated)])
    noises = {s.record.name: s.noise for s in runs.slips}
    typical = next(iter(noises.values()))
    beside = model if plain is None else plain
    each = [expected_scores(model, beside, w, noises.get(w.record.name, typical)) for w in runs.second]
    own, others = np.concatenate([np.zeros((2, 0)), *each], axis=1)
    return own if plain is None or not len(own) else scores(beside, runs) * float(own.mean() / others.mean())


def floor_of(model: Model, runs: HeldOut, plain: Model | None = None) -> float:
    """Return the mean of `floor_scores` [m]; nan where there is none."""
    each = floor_scores(model, runs, plain)
    return float(each.mean()) if len(each) else float("nan")


def gap_of(stated: Model, recalibrated: Model, augmented: Model, runs: HeldOut) -> Gap:
    """Return the gap of three models, phases estimated already."""
    before = mean_score(recalibrated, runs)
    after = mean_score(augmented, runs) if augmented is not recalibrated else before
    # a score that was reached on real data is itself a bound of the floor
    floor = min(floor_of(augmented, runs, recalibrated), after)
    return Gap("crps_one_cycle", "m", True, mean_score(stated, runs), before, after, floor)
