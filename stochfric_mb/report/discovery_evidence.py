"""What the pictures of a discovery show: forecasts of held-out cycles, forces that a model leaves, statistics of events."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt
from numpy.polynomial import legendre

from stochfric_mb.discovery.outcome import Outcome
from stochfric_mb.discovery.stick_slip.decision.innovations import left_over
from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.slips import Slips
from stochfric_mb.discovery.stick_slip.screening.regression import baseline_of
from stochfric_mb.discovery.stick_slip.simulation.forecast import MEMBERS, N_OUTPUTS, Windows, forecasts
from stochfric_mb.discovery.stick_slip.simulation.forecast_skill import HeldOut
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.discovery.stick_slip.simulation.scatter import simulated_slips
from stochfric_mb.discovery.stick_slip.study import Study
from stochfric_mb.reference.augmented import Start

Array = npt.NDArray[np.float64]

SMOOTH = 5
"""Legendre coefficients of a slip that are drawn along it: the higher ones are mostly noise in a single slip."""
BAND = 0.9
"""Share of the values that a band or a bar holds [-]."""
PLACES = np.linspace(-0.94, 0.94, 48)
"""Where along a slip, from -1 to 1, the force that a model leaves is drawn: its polynomial is loose at the very ends."""
ALONG = 200
"""Parts of a simulated slip of which each shows its friction."""
EVENTS = {"period": "s", "break_away_force": "N", "slip_travel": "m"}
"""Statistics of events and their units."""


@dataclasses.dataclass(frozen=True)
class Cycles:
    """Forecasts of the held-out cycles by one model; arrays have shape (n, N_OUTPUTS)."""

    error: Array
    """Measured position less the mean forecast [m]."""
    spread: Array
    """Members of the ensemble less their mean [m]; zeros for a model that is not random."""
    runs: tuple[Array, ...]
    """Mean forecasts run by run [m]."""


@dataclasses.dataclass(frozen=True)
class LeftOver:
    """The friction force of each slip less what a model says [N]; n slips."""

    time: Array
    """Break-away [s], shape (n,)."""
    belt_position: Array
    """Place on the belt under the box at break-away [m], shape (n,)."""
    run: npt.NDArray[np.int64]
    """Number of the run, shape (n,)."""
    onset: Array
    """At break-away, shape (n,)."""
    mean: Array
    """Mean over the slip, shape (n,)."""
    along: Array
    """Along the slip, shape (n, len(PLACES))."""
    in_full: Array
    """The same with all its coefficients, shape (n, len(PLACES))."""
    noise: float
    """Largest standard deviation that the sensor's noise brings into ``along`` [N]."""

    @property
    def rms(self) -> dict[str, float]:
        """Root mean square of what is left at break-away, and of the mean over the slip [N]."""
        return {"break_away": float(np.sqrt(np.mean(self.onset**2))), "slip": float(np.sqrt(np.mean(self.mean**2)))}


@dataclasses.dataclass(frozen=True)
class SlipFriction:
    """Friction of a model in one slip that it simulates: its law and effects, without sensor and smoothing."""

    relative_velocity: Array
    """Relative velocity of belt and box [m/s], shape (n,), at even steps of time."""
    force: Array
    """Friction force, along the belt's motion [N], shape (n,)."""

    def at(self, places: Array) -> tuple[Array, Array]:
        """Return relative velocity and force at places along the slip, from -1 to 1, each of the places' shape."""
        along = 2.0 * np.arange(1, len(self.force) + 1) / (len(self.force) + 1) - 1.0
        return np.interp(places, along, self.relative_velocity), np.interp(places, along, self.force)


@dataclasses.dataclass(frozen=True)
class Evidence:
    """All that is drawn of a belt-box."""

    windows: tuple[Windows, ...]
    """Held-out cycles, run by run."""
    cycles: Mapping[str, Cycles]
    """Name of a model -> its forecasts; empty without held-out cycles."""
    before: LeftOver
    """What the recalibrated model leaves in the runs that were fitted."""
    after: LeftOver | None
    """What the augmented model leaves; None where it differs by its scatter alone, or not at all."""
    events: Mapping[str, Mapping[str, Array]]
    """"data" or name of a model -> statistic -> values in the held-out runs."""
    friction: Mapping[str, SlipFriction]
    """"recalibrated" or "augmented" -> its friction in a slip of the first run; none for a model that does not slip there."""


def gather(outcome: Outcome) -> Evidence | None:
    """Return what can be drawn of a discovery on a belt-box; None where its slips were too few, and on other mechanisms."""
    if outcome.study is None or outcome.models is None or outcome.runs is None:
        return None
    nominal, recalibrated, augmented = outcome.models
    models = {"believed": nominal, "recalibrated": recalibrated}
    if outcome.result.verdict == "effect":
        models["augmented"] = augmented
    windows = tuple(w for w in outcome.runs.second if len(w))
    calm = augmented.mean
    study = outcome.study
    added = len(calm.effects) > len(study.model.effects) and outcome.result.verdict == "effect"
    compared = {"recalibrated": recalibrated.mean} | ({"augmented": calm} if added else {})
    friction = {name: slip for name, m in compared.items() if (slip := _slip_friction(m, study.pool.slips[0])) is not None}
    return Evidence(
        windows=windows,
        cycles={name: _cycles(model, windows) for name, model in models.items()} if windows else {},
        before=_left_over(study.pool, study),
        after=_left_over(left_over(study.pool, calm), study) if added else None,
        events=_events(models, outcome.runs),
        friction=friction,
    )


def _slip_friction(model: Model, like: Slips) -> SlipFriction | None:
    """Return the friction in the first slip that a model makes once a run has settled; None where it makes none."""
    record, belt = like.record, like.record.stated.belt_velocity
    system = model.system(record)
    settled = system.march(Start(record.time[0] - like.settling, 0.0, belt, stick=True), like.settling, 1).end
    time, begins = system.march(settled, 3.0 * like.cycle, 1).events.T
    pairs = np.flatnonzero((begins[:-1] == 1.0) & (begins[1:] == 0.0))
    if not len(pairs):
        return None
    begin, end = time[pairs[0] : pairs[0] + 2]
    away = system.march(settled, float(begin) - settled.time, 1).end
    slip = system.march(away, float(end - begin) / ALONG, ALONG - 1)
    return SlipFriction(np.abs(belt - slip.velocity), math.copysign(1.0, belt) * slip.friction_force)


def _cycles(model: Model, windows: Sequence[Windows]) -> Cycles:
    errors: list[Array] = []
    spreads: list[Array] = []
    means: list[Array] = []
    for window in windows:
        samples = range(1, MEMBERS + 1) if model.random else range(1)
        members = np.stack([forecasts(model, window, sample=s) for s in samples])
        mean = members.mean(axis=0)
        means.append(mean)
        errors.append(window.targets - mean)
        spreads.append((members - mean).reshape(-1, N_OUTPUTS))
    return Cycles(np.concatenate(errors), np.concatenate(spreads), tuple(means))


def _left_over(pool: Pool, study: Study) -> LeftOver:
    """Return what remains of the features in ``pool`` once the stated model's parameters are fitted to them."""
    rest = baseline_of(pool, study.uncertainty, study.baseline.solution.scatter).residuals()[pool.kept]
    series = rest[:, 1:].T
    return LeftOver(
        time=pool.onset_time[pool.kept],
        belt_position=(pool.belt_velocity * pool.onset_time - pool.typical_onset)[pool.kept],
        run=pool.run[pool.kept],
        onset=rest[:, 0],
        mean=rest[:, 1],
        along=np.asarray(legendre.legval(PLACES, series[:SMOOTH]), dtype=np.float64),
        in_full=np.asarray(legendre.legval(PLACES, series), dtype=np.float64),
        noise=_noise(pool),
    )


def _noise(pool: Pool) -> float:
    """Return the largest deviation of the force along a slip from noise alone [N]: from the covariance of its coefficients."""
    values = np.asarray(legendre.legvander(PLACES, SMOOTH - 1), dtype=np.float64)
    largest: list[float] = []
    for calibration in pool.calibrations:
        covariance = calibration.covariance[1 : SMOOTH + 1, 1 : SMOOTH + 1]
        largest.append(float(np.sqrt(((values @ covariance) * values).sum(axis=1).max())))
    return float(np.mean(largest))


def _events(models: Mapping[str, Model], runs: HeldOut) -> dict[str, dict[str, Array]]:
    """Return the events of the held-out runs and of the same runs simulated with each model."""
    seen = {"data": _statistics(runs.slips)}
    for name, model in models.items():
        seen[name] = _statistics([simulated_slips(model, s, sample=i) for i, s in enumerate(runs.slips)])
    return seen


def _statistics(slips: Sequence[Slips]) -> dict[str, Array]:
    return {
        "period": np.concatenate([np.diff(s.onset_time) for s in slips] or [np.zeros(0)]),
        "break_away_force": np.concatenate([s.onset_force for s in slips] or [np.zeros(0)]),
        "slip_travel": np.concatenate([s.onset_position - s.restick_position for s in slips] or [np.zeros(0)]),
    }


def band(values: Array, axis: int | None = None) -> tuple[Array, Array, Array]:
    """Return median, lower and upper end of the middle `BAND` of ``values`` along ``axis``."""
    low, middle, high = np.quantile(values, (0.5 - BAND / 2.0, 0.5, 0.5 + BAND / 2.0), axis=axis)
    return middle, low, high
