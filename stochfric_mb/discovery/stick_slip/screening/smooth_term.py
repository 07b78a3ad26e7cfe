"""A smooth change of friction along an axis, found in the features of the slips: where a term without a name begins."""

from __future__ import annotations

import dataclasses
import itertools

import numpy as np
from numpy.polynomial import legendre

from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.screening.naming import beside
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline, Solution
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.effects import kinds_with, make_effect
from stochfric_mb.effects.traits import ANONYMOUS

KNOTS = 7
"""Knots of the term's table."""
ORDERS, SIZE = 4, 0.3
"""Polynomials that the features can tell apart, half of a slip's seven moments, and the prior deviation of the first over mu_s;
the k-th one's is 1/k^2 of it, as the coefficients of a curve without corners fall [-]."""
ENDS = 0.01, 0.99
"""Quantiles of what the slips visit along an axis at which its table begins and ends [-]."""

SPANS = (1.0, 0.3)
"""Shares of what they visit that the table covers [-]."""
LOADS_DIFFER = 0.05
"""Range of the loads over the median from which on they tell a force from a coefficient [-]."""


@dataclasses.dataclass(frozen=True)
class Axis:
    """An axis along which friction may change."""

    name: str
    at_onset: Array | None
    """Places at the break-aways, shape (n,); None: nothing changes there."""
    in_slip: Array
    """Places in the slips, shape (n, nodes)."""


@dataclasses.dataclass(frozen=True)
class SmoothTerm:
    """A term along an axis, as the features of the slips tell it."""

    score: float
    """Score [-]."""
    model: Model
    """The model with it, where a fit may start."""
    solution: Solution
    """The fit of the features with it."""


def smooth_term(baseline: Baseline, model: Model, axis: Axis, among: int = 1) -> SmoothTerm:
    """Return the term along an axis.

    Args:
        baseline: what the model's effects leave of the slips.
        model: the model.
        axis: the axis.
        among: number of axes among which it is chosen.
    """
    first, last = (float(np.quantile(axis.in_slip, q)) for q in ENDS)
    spread = SIZE * float(baseline.solution.coefficients[0]) / np.arange(1, ORDERS + 1) ** 2
    load = baseline.pool.normal_force
    reference = float(np.median(load))

    def fitted(share: float, reference: float) -> tuple[Solution, float, float, float]:
        high = first + share * (last - first)
        weight = np.full(len(load), reference) if reference else load
        return baseline.fitted(_columns(baseline.pool, axis, first, high, weight), spread), first, high, reference

    # what begins with every slip may be over soon; what loads differ by tells a coefficient from a force
    spans = SPANS if axis.at_onset is None else SPANS[:1]
    references = (0.0, reference) if np.ptp(load) > LOADS_DIFFER * reference and axis.name != "load" else (0.0,)
    ways = list(itertools.product(spans, references))
    best, low, high, held = min((fitted(*way) for way in ways), key=lambda f: f[0].cost)
    choice = 2.0 * float(np.log(among * len(ways)))
    score = 2.0 * (baseline.solution.cost - best.cost) - ORDERS * baseline.price - choice
    numbers = best.coefficients
    table = _polynomials(np.linspace(-1.0, 1.0, KNOTS)) @ numbers[-ORDERS:]
    values = {f"change_{i}": float(table[i] - table[0]) for i in range(1, KNOTS)}
    share = 0.0 if axis.at_onset is None else 1.0
    term = make_effect(
        kinds_with(ANONYMOUS)[0], axis=axis.name, low=low, high=high, static_share=share, reference_load=held, **values
    )
    start = beside(model, np.r_[numbers[0], numbers[1] + table[0], numbers[2:]])
    return SmoothTerm(score, start.plus(term), best)


def axes_of(pool: Pool) -> list[Axis]:
    """Return the axes on which every run starts anew: what lives elsewhere does not come back in another run.

    The last one is that of a named effect alone: any difference between runs may lie along their loads.
    """
    turned = pool.direction[:, None]
    warm, warmer = pool.temperature(pool.onset_time), pool.temperature(pool.node_time)
    measured = [] if warm is None or warmer is None or not np.ptp(warm) else [Axis("temperature", warm, warmer)]
    return [
        Axis("speed", None, pool.relative_velocity),
        Axis("slip", None, pool.slip_distance),
        Axis("position", pool.direction * pool.typical_onset, turned * pool.typical_position),
        Axis("time", pool.onset_time, pool.node_time),
        *measured,
        Axis("load", pool.normal_force, np.repeat(pool.normal_force[:, None], pool.node_time.shape[1], axis=1)),
    ]


def _polynomials(place: Array) -> Array:
    """Return Legendre polynomials of order 1 to `ORDERS` of places between -1 and 1, shape (..., ORDERS)."""
    return np.asarray(legendre.legvander(np.clip(place, -1.0, 1.0), ORDERS)[..., 1:], dtype=np.float64)


def _columns(pool: Pool, axis: Axis, low: float, high: float, load: Array) -> list[Array]:
    """Return what each polynomial would change for a unit of the coefficient under ``load`` [N], shape (n, N_FEATURES)."""
    inside = _polynomials(2.0 * (axis.in_slip - low) / (high - low) - 1.0)
    at_onset = None if axis.at_onset is None else _polynomials(2.0 * (axis.at_onset - low) / (high - low) - 1.0)
    return [
        pool.column(None if at_onset is None else load * at_onset[:, k], load[:, None] * inside[..., k]) for k in range(ORDERS)
    ]
