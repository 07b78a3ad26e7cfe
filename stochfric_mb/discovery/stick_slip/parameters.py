"""The numbers of a result: parameters of the effects and of the believed model, in SI units, with their intervals."""

from __future__ import annotations

import dataclasses

import numpy as np
from scipy.stats import chi2 as chi2_distribution

from stochfric_mb.discovery.inference.intervals import confidence_interval
from stochfric_mb.discovery.result import Found, Interval, Where
from stochfric_mb.discovery.stick_slip.decision.rounds import Named
from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import deterministic
from stochfric_mb.discovery.stick_slip.simulation.model import CORRECTED, Model
from stochfric_mb.discovery.stick_slip.simulation.refit import Fit
from stochfric_mb.discovery.stick_slip.study import Study

UNITS = {"mu_s": "-", "mu_k": "-", "mass": "kg", "stiffness": "N/m", "damping": "N s/m"}
"""Units of the believed model's fitted parameters."""


def found_effect(named: Named, fit: Fit | None, model: Model, found: Study) -> Found:
    """Return a named effect of the augmented model as the result tells it.

    Args:
        named: the effect.
        fit: the fit of the model's effects that are not random; None where nothing was fitted.
        model: the augmented model.
        found: what the fit runs told.
    """
    parameters: dict[str, Interval] = {}
    place = next(i for i, e in enumerate(model.effects) if e.kind == named.kind)
    run = next(iter(model.own), "")
    effect = model.effects_in(run)[place]
    # a fit knows the effects that are not random alone
    fitted = len(deterministic(dataclasses.replace(model, effects=model.effects[:place], own={})).effects)
    time = sum(float(s.record.time[-1] - s.record.time[0]) for s in found.pool.slips)
    drawn = effect.deviations(effect.draws(time, max(found.regression.n, 2)))
    for field in dataclasses.fields(effect):
        value = getattr(effect, field.name)
        if isinstance(value, str) or not np.isfinite(value):
            continue
        about = field.metadata
        deviation = 0.0
        if fit is not None:
            deviations = [
                d
                for k, d in zip(fit.free, fit.deviations, strict=True)
                if (k.name, k.owner) == (field.name, fitted) and k.run in ("", run)
            ]
            deviation = float(deviations[0]) if deviations else model.measured.get(field.name, 0.0)
        deviation = drawn.get(field.name, deviation)
        unit = found.size.of(about["unit"])
        parameters[field.name] = confidence_interval(value * unit, deviation * unit, about["unit"], about["low"], about["high"])
    p_value = float(chi2_distribution.sf(max(named.score, 0.0), max(len(parameters), 1)))
    return Found(named.kind, named.class_, Where(*effect.appears()), parameters, float(named.score), p_value)


def believed_intervals(fit: Fit, found: Study) -> dict[str, Interval]:
    """Return the parameters of the believed model, recalibrated."""
    box = found.dataset.scenario.mechanism
    rows: dict[str, Interval] = {}
    for one, value, deviation in zip(fit.free, fit.values, fit.deviations, strict=True):
        stated = getattr(box, one.name, 0.0) if one.name in CORRECTED else 0.0
        number, doubt = (stated * (1.0 + value), stated * deviation) if stated else (value, deviation)
        unit = UNITS.get(one.name, "-")
        rows[one.name] = confidence_interval(number * found.size.of(unit), doubt * found.size.of(unit), unit, low=0.0)
    return rows
