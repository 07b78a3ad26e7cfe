"""Where in a run periodic effects are: their phases are each run's own, since a record starts anywhere.

The pattern that the fit runs showed is shifted along: harmonics keep to their fundamental, whatever their sizes. From the
best shifts a fit of every phase by itself begins.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery.stick_slip.simulation.forecast import Windows
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.refit import Fit, cost_of, refit
from stochfric_mb.effects import Effect
from stochfric_mb.effects.contract import PHASES

SHIFTS = 24
"""Shifts of a pattern that are tried, over its period."""
FOLLOWED = 2
"""Best shifts that are followed up by a fit."""
HARMONIC = 0.02
"""How far the ratio of two frequencies may be from a whole number for one to be a harmonic of the other [-]."""
MOST = 10
"""Forecasts that are used."""


def in_phase(model: Model, windows: Windows) -> Model:
    """Return the model with its phases in one run estimated from that run's forecasts.

    Args:
        model: a deterministic model with phases.
        windows: forecasts of the run, one or more.
    """
    run = windows.record.name
    known = next(iter(model.own.values()), tuple({} for _ in model.effects))
    own = tuple(dict(values) for values in model.own.get(run, known))
    trials = [dataclasses.replace(model, own=dict(model.own) | {run: own})]
    for pattern in _patterns(model):
        shifted = [_shifted(t, run, pattern, 2.0 * np.pi * s / SHIFTS) for t in trials for s in range(SHIFTS)]
        costs = np.array([cost_of(t, [windows], most=MOST) for t in shifted])
        trials = [shifted[i] for i in np.argsort(costs, kind="stable")[:FOLLOWED]]
    fits: list[Fit] = [refit(t, [windows], {}, only=PHASES, evaluations=12, most=MOST) for t in trials]
    return min(fits, key=lambda f: f.cost).model


def _patterns(model: Model) -> list[dict[int, int]]:
    """Return the patterns among the effects: each maps the numbers of its effects to their orders."""
    patterns: list[dict[int, int]] = []
    for i, effect in enumerate(model.effects):
        if not effect.own_to_run:
            continue
        for pattern in patterns:
            first = model.effects[next(iter(pattern))]
            order = _pace(effect) / _pace(first)
            if hasattr(first, "wavelength") == hasattr(effect, "wavelength") and abs(order - round(order)) < HARMONIC <= order:
                pattern[i] = round(order)
                break
        else:
            patterns.append({i: 1})
    return patterns


def _pace(effect: Effect) -> float:
    """Return the waves of an effect in a second, or in a metre."""
    return float(effect.frequency if hasattr(effect, "frequency") else 1.0 / effect.wavelength)  # pyright: ignore[reportAttributeAccessIssue]


def _shifted(model: Model, run: str, pattern: dict[int, int], angle: float) -> Model:
    """Return the model with a pattern shifted in a run by an angle of its fundamental [rad]."""
    own = [dict(values) for values in model.own[run]]
    for i, order in pattern.items():
        for harmonic, name in enumerate(PHASES, start=1):
            if hasattr(model.effects[i], name):
                start = own[i][name] if name in own[i] else getattr(model.effects[i], name)
                own[i][name] = start + harmonic * order * angle
    return dataclasses.replace(model, own=dict(model.own) | {run: tuple(own)})
