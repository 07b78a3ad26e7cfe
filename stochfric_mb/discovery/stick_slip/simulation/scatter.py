"""How strong random coefficients must be for the simulated slips to scatter as the measured ones do."""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery.stick_slip.records.long_records import middle
from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import Slips, extract
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.numerics.robust import deviation
from stochfric_mb.reference.augmented import Start

FARTHEST = 0.15
"""Most by which the matching moves the means, over mu_s [-]."""
SAMPLES, SAMPLES_OF_WANDER = 3, 8
"""Simulations of a run that are averaged: the scatter of 50 independent slips is known to 10 %, but a wander has only a
few independent values in a run, and its scatter in a single one may well be half or twice the process's."""


def matched(model: Model, pool: Pool, *, rounds: int = 3) -> Model:
    """Return the model with the strength of its random coefficients, and its means, matched to the scatter of the slips.

    What is matched: medians and robust deviations of the onset force and of the mean force in slip, run by run, by
    simulating each run with its noise. A break-away happens where a random limit first falls below the load, so that
    the limit's own mean and deviation are not those of the onset force.
    """
    place = next((i for i, e in enumerate(model.effects) if e.coefficient_process() is not None), None)
    if place is None:
        return model
    target = _statistics(pool.slips)
    first = model.law
    knots = getattr(model.effects[place], "process", "") == "knots"
    count = SAMPLES if knots else SAMPLES_OF_WANDER
    for round_ in range(rounds):
        samples = range(round_ * count, (round_ + 1) * count)
        simulated = _statistics([simulated_slips(model, s, sample=i) for s in pool.slips for i in samples])
        if not simulated.all():
            return model
        load = float(np.median(pool.normal_force))
        values = {}
        for name, column in (("sigma_s", 1), ("sigma_k", 3)):
            ratio = target[column] / simulated[column]
            values[name] = max(getattr(model.effects[place], name), 1.0e-5) * float(np.clip(ratio, 0.4, 2.5))
        most = _most(model)
        if knots:
            shift = np.clip((target[[0, 2]] - simulated[[0, 2]]) / load, -FARTHEST * first.mu_s, FARTHEST * first.mu_s)
            mu_s = float(np.clip(model.law.mu_s + shift[0], (1.0 - FARTHEST) * first.mu_s, (1.0 + FARTHEST) * first.mu_s))
            model = model.with_law(mu_s, float(np.clip(model.law.mu_k + shift[1], 1.0e-5, 0.98 * mu_s)))
            most = min(most, _most(model))  # the means may have come closer to each other
        effects = list(model.effects)
        effects[place] = dataclasses.replace(effects[place], **{name: min(value, most) for name, value in values.items()})
        model = dataclasses.replace(model, effects=tuple(effects))
    return model


def _most(model: Model) -> float:
    """Return the largest deviation of a coefficient: beyond a quarter of the means' distance pairs with mu_k > mu_s abound."""
    return 0.25 * max(model.law.mu_s - model.law.mu_k, 0.02 * model.law.mu_s)


def simulated_slips(model: Model, like: Slips, *, sample: int = 0, seed: int = 5) -> Slips:
    """Return the slips of a run simulated from the model, with the noise of ``like``: the middle stretch of a long one."""
    like = middle(like)
    generator = np.random.default_rng([seed, sample])
    return measured_slips(shown_by(model, like, generator, sample=sample, seed=seed), like, generator)


def shown_by(model: Model, like: Slips, generator: np.random.Generator, *, sample: int = 0, seed: int = 5) -> Array:
    """Return what a sensor without noise shows of a run simulated from the model [m], at the times of ``like``."""
    record = like.record
    step = 1.0 / record.rate
    system = model.system(record, seed=seed, sample=sample)
    first = Start(record.time[0] - like.settling, 0.0, record.stated.belt_velocity, stick=True)
    start = system.march(first, step, round(like.settling * record.rate)).end
    position = system.march(start, step, len(record.time)).position
    for effect in model.effects_in(record.name):
        if effect.group == "sensor":
            position = effect.measure(record.time, position, generator)
    return position


def measured_slips(shown: Array, like: Slips, generator: np.random.Generator) -> Slips:
    """Return the slips of a record of ``shown`` [m], shape (n,), with the noise of ``like``."""
    record = like.record
    measured = shown + like.noise.draw(len(shown), generator)
    return extract(record.showing(measured), ridge=like.ridge)


def _deviation(values: Array) -> float:
    """Return the standard deviation of what lies within five robust deviations."""
    centre, spread = np.median(values), deviation(values)
    inside = values[np.abs(values - centre) <= 5.0 * spread]
    return float(inside.std())


def _statistics(slips: list[Slips] | tuple[Slips, ...]) -> Array:
    """Return median and deviation of the onset force, and of the mean force in slip, averaged over the runs [N], shape (4,)."""
    rows = [
        (
            np.median(s.onset_force),
            _deviation(s.onset_force),
            np.median(s.moments[:, 0]),
            _deviation(s.moments[:, 0]),
        )
        for s in slips
        if len(s) >= 4
    ]
    return np.mean(rows, axis=0) if rows else np.array([0.0, 0.0, 0.0, 0.0])
