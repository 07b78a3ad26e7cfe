"""The numbers of a result: parameters of the effects, of mechanism and law, in SI units, with their intervals."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.intervals import confidence_interval
from stochfric_mb.discovery.result import EffectEstimate, Interval, Where
from stochfric_mb.discovery.stick_slip.decision.decision import Named
from stochfric_mb.discovery.stick_slip.records.record import CORRECTED
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.refit import Fit
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.measurement.dataset import Dataset

UNITS = {"mu_s": "-", "mu_k": "-", "mass": "kg", "stiffness": "N/m", "damping": "N s/m"}
"""Units of the parameters of mechanism and law."""


def effect_estimate(named: Named, fit: Fit | None, model: Model, study: Study) -> EffectEstimate:
    """Return a named effect of the augmented model as the result tells it.

    Args:
        named: the effect.
        fit: the fit of the model's effects that are not random; None where nothing was fitted.
        model: the augmented model.
        study: what the fit runs show.
    """
    parameters: dict[str, Interval] = {}
    place = next(i for i, e in enumerate(model.effects) if e.kind == named.kind)
    run = next(iter(model.own), "")
    effect = model.effects_in(run)[place]
    # a fit knows the effects that are not random alone
    fitted = len(dataclasses.replace(model, effects=model.effects[:place], own={}).mean.effects)
    time = sum(s.record.duration for s in study.pool.slips)
    drawn = effect.deviations(effect.draws(time, max(study.baseline.regression.n, 2)))
    for field in dataclasses.fields(effect):
        value = getattr(effect, field.name)
        if isinstance(value, str) or not np.isfinite(value) or effect.lacks(field.name):
            continue
        about = field.metadata
        if about.get("fit_prior") == 0.0:
            continue  # part of a shape, which stands in augmented.toml
        deviation = 0.0
        if fit is not None:
            deviations = [
                d
                for k, d in zip(fit.free, fit.deviations, strict=True)
                if (k.name, k.owner) == (field.name, fitted) and k.run in ("", run)
            ]
            deviation = float(deviations[0]) if deviations else model.measured.get(field.name, 0.0)
        deviation = drawn.get(field.name, deviation)
        unit = effect.unit_of(field.name)
        parameters[field.name] = confidence_interval(value, deviation, unit, about["low"], about["high"])
    evidence = named.evidence
    return EffectEstimate(named.kind, named.class_, Where(*effect.appears()), parameters, evidence.score, evidence.p_value)


def own_parameters(fit: Fit, model: Model, study: Study) -> dict[str, Interval]:
    """Return the parameters of mechanism and law beside the effects, of the model that the result tells.

    Intervals are of forecasts and priors together: forecasts of positions alone know friction over stiffness, and no more.

    Args:
        fit: the fit of that model.
        model: the model, as it stands in ``augmented.toml``.
        study: what the fit runs show.
    """
    rows: dict[str, Interval] = {}
    for one, posterior in zip(fit.free, fit.posterior, strict=True):
        if one.owner >= 0 or one.run:
            continue
        stated = getattr(study.dataset.scenario.mechanism, one.name, 0.0) if one.name in CORRECTED else 1.0
        value = 1.0 + model.corrections[one.name] if one.name in CORRECTED else getattr(model.law, one.name)
        rows[one.name] = confidence_interval(value * stated, float(posterior) * stated, UNITS.get(one.name, "-"), low=0.0)
    return rows


def not_measured(fit: Fit) -> list[str]:
    """Return the parameters of mechanism and law whose value is their prior more than a measurement."""
    return [
        k.name
        for k, data_share in zip(fit.free, fit.data_share, strict=True)
        if k.owner < 0 and not k.run and data_share < criteria.DECIDED_BY_DATA
    ]


def moved(parameters: Mapping[str, Interval], dataset: Dataset, unmeasured: Sequence[str]) -> dict[str, float]:
    """Return by how many stated standard deviations measured parameters are off from what is stated, where that is many."""
    scenario = dataset.scenario
    off: dict[str, float] = {}
    for name, interval in parameters.items():
        stated = getattr(scenario.mechanism, name, None) or getattr(scenario.law, name, None)
        doubt = scenario.uncertainty.get(name, 0.0)
        # what an effect leaves open is not off where its interval holds what is stated
        if stated and doubt and name not in unmeasured and not interval.low <= stated <= interval.high:
            off[name] = (interval.value - stated) / (stated * doubt)
    return {name: by for name, by in off.items() if abs(by) > criteria.SURPRISING}
