"""The slips of all records of a data set side by side, with what screening regresses them on."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.records.calibration import Calibration
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import N_FEATURES, Slips, legendre_coefficients
from stochfric_mb.numerics.robust import deviation

LEAST_DWELL = 0.255
"""Shortest time in stick that is predicted, as an angle of the natural oscillation [rad]."""


@dataclasses.dataclass(frozen=True)
class Pool:
    """All slips; arrays have shape (n,), over the slips of all runs one after the other, unless said otherwise."""

    slips: tuple[Slips, ...]
    """The slips run by run."""
    calibrations: tuple[Calibration, ...]
    """Bias and covariance of the features, run by run."""
    run: np.ndarray
    """Number of the run, int64."""
    features: Array
    """Onset force and coefficients of the friction force [N], bias taken out, shape (n, N_FEATURES)."""
    kept: np.ndarray
    """False for slips set aside as gross outliers."""
    onset_time: Array
    """Break-away [s]."""
    restick_time: Array
    """Re-stick [s]."""
    typical_onset: Array
    """The run's median break-away position [m]."""
    node_time: Array
    """Time at the Gauss nodes [s], shape (n, N_NODES)."""
    node_position: Array
    """Position there [m]."""
    node_velocity: Array
    """Velocity there [m/s]."""
    node_acceleration: Array
    """Acceleration there [m/s^2]."""
    typical_position: Array
    """The run's median slip, scaled to this slip's onset [m]: an instrument, not driven by this slip's own friction."""
    normal_force: Array
    """Normal force [N]."""
    belt_velocity: Array
    """Belt velocity [m/s], positive."""
    direction: Array
    """-1 in runs with a reversed belt, otherwise 1."""
    static: Array
    """The run's median onset force [N]."""
    kinetic: Array
    """The run's median mean friction force in slip [N]."""
    dwell: Array
    """Time in stick before the break-away, predicted from where the last slip ended [s]: an instrument."""

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return len(self.slips)

    @property
    def rows(self) -> list[np.ndarray]:
        """Numbers of the slips that count, run by run."""
        return [np.flatnonzero(self.kept & (self.run == r)) for r in range(self.n_runs)]

    @property
    def angular_frequency(self) -> float:
        """Natural angular frequency of the rig [rad/s]."""
        return self.slips[0].record.angular_frequency

    @property
    def relative_velocity(self) -> Array:
        """Speed of the box relative to the belt at the nodes [m/s], shape (n, N_NODES)."""
        return np.abs(self.belt_velocity[:, None] - self.node_velocity)

    @property
    def slip_distance(self) -> Array:
        """Relative displacement since the break-away at the nodes [m], shape (n, N_NODES)."""
        onset = np.concatenate([s.onset_position for s in self.slips])
        moved = self.node_position - onset[:, None]
        return np.maximum(self.belt_velocity[:, None] * (self.node_time - self.onset_time[:, None]) - moved, 0.0)

    @property
    def slid_before(self) -> Array:
        """Distance slid at the break-away since the record began [m]: that of the slips seen."""
        return np.concatenate([np.r_[0.0, np.cumsum(_travel(s))[:-1]] for s in self.slips])

    @property
    def mean_time(self) -> Array:
        """Middle of the slip [s]."""
        return self.node_time.mean(axis=1)

    @property
    def duration(self) -> float:
        """Length of the longest record [s]."""
        return max(s.record.duration for s in self.slips)

    @property
    def cycle(self) -> float:
        """Typical time from one break-away to the next [s]."""
        return float(np.median([s.cycle for s in self.slips]))

    def temperature(self, time: Array) -> Array | None:
        """Return the measured temperature [degC] at times in the slips [s], shape (n,) or (n, m); None: a run has none."""
        tables = [s.record.temperatures for s in self.slips]
        values = np.zeros_like(time)
        for run, table in enumerate(tables):
            if table is None:
                return None
            mine = self.run == run
            values[mine] = np.interp(time[mine], *table)
        return values

    def per_run(self, value: Callable[[Slips], float]) -> Array:
        """Return a number of each run, repeated for its slips."""
        return np.array([value(s) for s in self.slips])[self.run]

    def column(self, at_onset: Array | None, in_slip: Array | None) -> Array:
        """Return a regressor, shape (n, N_FEATURES), from its force at onset [N] and its force in the slip [N].

        Args:
            at_onset: shape (n,); None: zero.
            in_slip: shape (n,) where it is constant in each slip, or (n, N_NODES); None: zero.
        """
        column = np.zeros((len(self.run), N_FEATURES))
        if at_onset is not None:
            column[:, 0] = at_onset
        if in_slip is not None:
            at, values = (1, in_slip) if in_slip.ndim == 1 else (slice(1, None), legendre_coefficients(in_slip))
            column[:, at] = values
        return column


def less_medians(values: Array, run: np.ndarray) -> Array:
    """Return numbers of slips, shape (n,) or (n, m), less their median in the slip's run."""
    return values - np.array([np.median(values[run == r], axis=0) for r in range(run[-1] + 1)])[run]


def make_pool(slips: Sequence[Slips], calibrations: Sequence[Calibration]) -> Pool:
    """Return the slips of all runs side by side, with the bias of their features taken out."""
    run = np.repeat(np.arange(len(slips)), [len(s) for s in slips])
    features = np.concatenate([c.unbiased(s.features) for s, c in zip(slips, calibrations, strict=True)])

    def joined(value: Callable[[Slips], Array]) -> Array:
        return np.concatenate([value(s) for s in slips])

    def repeated(value: Callable[[Slips], float]) -> Array:
        return np.array([value(s) for s in slips])[run]

    static = repeated(lambda s: float(np.median(s.onset_force)))
    typical_onset = repeated(lambda s: float(np.median(s.onset_position)))
    belt = repeated(lambda s: s.record.mechanism.belt_velocity)
    last_restick = joined(lambda s: np.r_[np.median(s.restick_position), s.restick_position[:-1]])
    return Pool(
        slips=tuple(slips),
        calibrations=tuple(calibrations),
        run=run,
        features=features,
        kept=_kept(features, run, static),
        onset_time=joined(lambda s: s.onset_time),
        restick_time=joined(lambda s: s.restick_time),
        typical_onset=typical_onset,
        node_time=joined(lambda s: s.node_time),
        node_position=joined(lambda s: s.node_position),
        node_velocity=joined(lambda s: s.node_velocity),
        node_acceleration=joined(lambda s: s.node_acceleration),
        typical_position=joined(_typical),
        normal_force=repeated(lambda s: s.record.mechanism.normal_force),
        belt_velocity=belt,
        direction=repeated(lambda s: s.record.direction),
        static=static,
        kinetic=repeated(lambda s: float(np.median(s.moments[:, 0]))),
        dwell=np.maximum((typical_onset - last_restick) / belt, repeated(lambda s: LEAST_DWELL / s.record.angular_frequency)),
    )


def _kept(features: Array, run: np.ndarray, static: Array) -> np.ndarray:
    away = np.abs(less_medians(features, run))
    spread = np.array([deviation(features[run == r], axis=0) for r in range(run[-1] + 1)])[run]
    off = np.asarray((away > criteria.STRAY_SLIP * spread).any(axis=1))
    # a scatter of 15 % of the static force is friction that varies, not an outlier
    gross = np.asarray((away > np.maximum(criteria.GROSS_SLIP * spread, 0.15 * static[:, None])).any(axis=1))
    for r in np.unique(run):
        mine = run == r
        if off[mine].sum() <= max(criteria.FEW_STRAY, criteria.STRAY_SHARE * mine.sum()):
            gross |= off & mine
    return np.logical_not(gross)


def _travel(slips: Slips) -> Array:
    """Return the relative displacement of each slip [m], shape (n,)."""
    lasting = slips.restick_time - slips.onset_time
    return slips.record.mechanism.belt_velocity * lasting - (slips.restick_position - slips.onset_position)


def _typical(slips: Slips) -> Array:
    """Return the median slip of the run, scaled about its centre to each slip's onset, shape (n, N_NODES)."""
    centre = np.median((slips.onset_position + slips.restick_position) / 2.0)
    shape = np.median((slips.node_position - centre) / (slips.onset_position - centre)[:, None], axis=0)
    return centre + (slips.onset_position - centre)[:, None] * shape[None]
