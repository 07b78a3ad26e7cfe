"""An unnamed term where no name is known: a smooth change of friction along an axis, kept if held-out runs bear it out."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.polynomial import legendre

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.false_alarms import Evidence
from stochfric_mb.discovery.result import Where
from stochfric_mb.discovery.stick_slip.decision.held_out_check import Comparison, compared
from stochfric_mb.discovery.stick_slip.decision.rounds import Named
from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.screening.regression import Terms
from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import HeldOut
from stochfric_mb.discovery.stick_slip.simulation.model import CORRECTED, Model
from stochfric_mb.discovery.stick_slip.simulation.refit import Fit, refit, with_deviations
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.effects import kinds_with, make_effect
from stochfric_mb.effects.traits import ANONYMOUS
from stochfric_mb.errors import SimulationError

KNOTS = 7
"""Knots of the term's table."""
ORDERS, SIZE = 4, 0.3
"""Polynomials that the features can tell apart, half of a slip's seven moments, and the prior deviation of the first over mu_s;
the k-th one's is 1/k^2 of it, as the coefficients of a curve without corners fall [-]."""
ENDS = 0.01, 0.99
"""Quantiles of what the slips visit along an axis at which its table begins and ends [-]."""


@dataclasses.dataclass(frozen=True)
class Anonymous:
    """An unnamed term beside the recalibrated model."""

    named: Named
    """The term, as an effect is told."""
    fit: Fit
    """The model with it."""
    seen: Comparison | None
    """Forecasts of the held-out runs without it and with it; None where there are too few."""

    @property
    def carries_over(self) -> bool:
        """Whether held-out runs are forecast better with it, by more than chance and by enough to be worth a term."""
        seen = self.seen
        return seen is not None and seen.better and seen.without - seen.with_ > criteria.LEAST_REDUCIBLE * seen.without


@dataclasses.dataclass(frozen=True)
class _Axis:
    """An axis along which friction may change."""

    name: str
    at_onset: Array | None
    """Places at the break-aways, shape (n,); None: nothing changes there."""
    in_slip: Array
    """Places in the slips, shape (n, nodes)."""


def anonymous(study: Study, recalibrated: Fit, runs: HeldOut) -> Anonymous | None:
    """Return the unnamed term along the axis with most evidence; None where no axis has any.

    Args:
        study: what the fit runs told.
        recalibrated: the model without it.
        runs: held-out runs; no phase is to be found in them, since the term has none.
    """
    pool, regression = study.pool, study.regression
    tried: list[tuple[float, Model]] = []
    axes = _axes(pool)
    for axis in axes:
        low, high = (float(np.quantile(axis.in_slip, q)) for q in ENDS)
        columns = _columns(pool, axis, low, high)
        spread = SIZE * float(study.solution.coefficients[0]) / np.arange(1, ORDERS + 1) ** 2
        terms = Terms(np.concatenate([study.terms.columns, columns], axis=2), np.r_[study.terms.priors, spread])
        solution = regression.solve(terms, study.solution.scatter)
        score = (
            2.0 * (study.solution.cost - solution.cost) - ORDERS * float(np.log(regression.n)) - 2.0 * float(np.log(len(axes)))
        )
        if score <= criteria.UNNAMED_LEAST:
            continue
        numbers = solution.coefficients
        table = _polynomials(np.linspace(-1.0, 1.0, KNOTS)) @ numbers[-ORDERS:]
        values = {f"change_{i}": float(table[i] - table[0]) for i in range(1, KNOTS)}
        share = 0.0 if axis.at_onset is None else 1.0
        term = make_effect(kinds_with(ANONYMOUS)[0], axis=axis.name, low=low, high=high, static_share=share, **values)
        # coefficients and corrections belong to the table: a fit begins where the regression ended
        mu_s = max(float(numbers[0]), 1.0e-3)
        mu_k = max(float(numbers[1] + table[0]), 1.0e-3)
        corrections = dict(zip(CORRECTED, map(float, numbers[2:5]), strict=True))
        start = dataclasses.replace(recalibrated.model.with_law(mu_s, mu_k), corrections=corrections)
        tried.append((score, start.plus(term)))
    if not tried:
        return None
    score, start = max(tried, key=lambda t: t[0])
    fit = refit(start, study.windows, study.uncertainty)
    fit = with_deviations(fit, study.windows, study.uncertainty)
    term = fit.model.effects[-1]
    named = Named(term.kind, (), Evidence(score, None), Where(*term.appears()))
    try:
        seen = compared(recalibrated.model, fit.model, runs)
    except SimulationError:  # a model that cannot run by itself does not carry over
        seen = None
    return Anonymous(named, fit, seen)


def _axes(pool: Pool) -> list[_Axis]:
    """Return the axes on which every run starts anew: what lives elsewhere does not come back in another run."""
    turned = pool.direction[:, None]
    return [
        _Axis("speed", None, pool.relative_velocity),
        _Axis("slip", None, pool.slip_distance),
        _Axis("position", pool.direction * pool.typical_onset, turned * pool.typical_position),
        _Axis("time", pool.onset_time, pool.node_time),
    ]


def _polynomials(place: Array) -> Array:
    """Return Legendre polynomials of order 1 to `ORDERS` of places between -1 and 1, shape (..., ORDERS)."""
    return np.asarray(legendre.legvander(np.clip(place, -1.0, 1.0), ORDERS)[..., 1:], dtype=np.float64)


def _columns(pool: Pool, axis: _Axis, low: float, high: float) -> Array:
    """Return what each polynomial would change for a unit of the coefficient, shape (n, N_FEATURES, ORDERS)."""
    load = pool.normal_force
    inside = _polynomials(2.0 * (axis.in_slip - low) / (high - low) - 1.0)
    at_onset = None if axis.at_onset is None else _polynomials(2.0 * (axis.at_onset - low) / (high - low) - 1.0)
    return np.stack(
        [
            pool.column(None if at_onset is None else load * at_onset[:, k], load[:, None] * inside[..., k])
            for k in range(ORDERS)
        ],
        axis=2,
    )


def told(term: Anonymous | None) -> str:
    """Return what a reader is told of it."""
    if term is None:
        return "no smooth change of friction along speed, slip, position or time explains what is missing: it may be random"
    axis = term.named.where.axis
    if term.carries_over:
        return f"an unnamed term along the {axis} is in augmented.toml: it makes forecasts of the held-out runs better"
    return f"an unnamed term along the {axis} explains the fit runs, but does not carry over to the held-out ones"
