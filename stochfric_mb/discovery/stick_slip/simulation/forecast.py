"""One-cycle-ahead forecasts: started in the middle of a stick phase, where the state is known, and compared sample by sample.

Stick-slip forgets nothing of a small error for long, so that a free-running simulation says little; a forecast over
one cycle says all that a cycle holds.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from stochfric_mb.discovery.stick_slip.records.long_records import FORECAST
from stochfric_mb.discovery.stick_slip.records.record import Array, Noise, Record
from stochfric_mb.discovery.stick_slip.records.slips import Slips
from stochfric_mb.discovery.stick_slip.simulation.auxiliary_state import auxiliary_state
from stochfric_mb.discovery.stick_slip.simulation.model import Model
from stochfric_mb.effects.traits import LATE, MOVES_ZERO
from stochfric_mb.errors import SimulationError
from stochfric_mb.statistics import crps

N_OUTPUTS = 105
"""Compared samples in a forecast."""
REACH = 1.05
"""Length of a forecast in typical cycles [-]."""
SHORTEST_DWELL, MEAN_OVER = 0.51, 1.275
"""Stick below which there is no forecast, and time to either side over which a start is averaged at most, as angles of the
natural oscillation [rad]."""
MEMBERS = 30
"""Members of the ensemble of a random model."""
STAND_INS = 10
"""Members that stand in for a measurement."""


@dataclasses.dataclass(frozen=True)
class Windows:
    """Forecasts of one run; arrays in the record's mirrored frame."""

    record: Record
    """The run."""
    starts: Array
    """Time [s], position as measured [m], dwell so far [s], shape (n, 3)."""
    targets: Array
    """Position as measured [m], shape (n, N_OUTPUTS)."""
    stride: int
    """Samples between two outputs."""
    uncertain: Array
    """Standard deviation of the position at the start [m], shape (n,)."""

    def __len__(self) -> int:
        return len(self.starts)

    def times(self) -> Array:
        """Return the times of the outputs [s], shape (n, N_OUTPUTS)."""
        return self.starts[:, :1] + self.stride / self.record.rate * np.arange(1, N_OUTPUTS + 1)

    def part(self, chosen: slice | np.ndarray) -> Windows:
        """Return some of the windows."""
        starts, targets, uncertain = self.starts[chosen], self.targets[chosen], self.uncertain[chosen]
        return dataclasses.replace(self, starts=starts, targets=targets, uncertain=uncertain)

    def started(self, deviations: float) -> Windows:
        """Return the windows with starts that are so many standard deviations further on."""
        return dataclasses.replace(self, starts=self.starts + deviations * self.uncertain[:, None] * np.r_[0.0, 1.0, 0.0])


def windows_of(slips: Slips) -> Windows:
    """Return the forecasts that a run's stick phases allow."""
    record = slips.record
    n = len(slips)
    starts: list[tuple[float, float, float]] = []
    targets: list[Array] = []
    uncertain: list[float] = []
    if n < 2:
        return Windows(record, np.zeros((0, 3)), np.zeros((0, N_OUTPUTS)), 1, np.zeros(0))
    stride = max(round(REACH * slips.cycle * record.rate / N_OUTPUTS), 1)
    dwells = slips.onset_time[1:] - slips.restick_time[:-1]
    typical = float(np.median(dwells))
    shortest, wide = (angle / record.angular_frequency for angle in (SHORTEST_DWELL, MEAN_OVER))
    # spread evenly over a long run
    for i in np.unique(np.linspace(0, n - 2, min(n - 1, FORECAST)).astype(np.int64)):
        if dwells[i] < max(0.3 * typical, shortest):
            continue
        dwell = 0.45 * typical if dwells[i] > 0.6 * typical else 0.5 * dwells[i]
        half = max(int(min(wide, 0.8 * dwell, 0.8 * (dwells[i] - dwell)) * record.rate), 1)
        middle = int(np.searchsorted(record.time, slips.restick_time[i] + dwell))
        last = middle + stride * N_OUTPUTS
        if last >= len(record.time) or middle - half < 0:
            continue
        starts.append(
            (record.time[middle], float(record.position[middle - half : middle + half + 1].mean()),
             record.time[middle] - slips.restick_time[i])
        )  # fmt: skip
        targets.append(record.raw[middle + stride : last + 1 : stride])
        uncertain.append(slips.noise.of_mean(2 * half + 1))
    return Windows(
        record, np.array(starts).reshape(-1, 3), np.array(targets).reshape(-1, N_OUTPUTS), stride, np.array(uncertain)
    )


def forecasts(model: Model, windows: Windows, *, sample: int = 0) -> Array:
    """Return the positions that the model says the sensor will show [m], shape (n, N_OUTPUTS), in the mirrored frame.

    Not numbers where the model cannot be simulated at all.
    """
    record = windows.record
    system = model.system(record, sample=sample)
    effects = model.effects_in(record.name)
    sign = record.direction
    belt = record.stated.belt_velocity
    times, position, dwell = windows.starts.T
    generator = np.random.default_rng(sample)
    # a sensor's error at the start is taken out: what it shows there is true position plus that error
    shown = sign * position
    true = shown.copy()
    for effect in effects:
        true -= effect.measure(times, shown, generator) - shown if MOVES_ZERO in effect.traits else 0.0
    starts = np.stack([times - model.late, true, np.full(len(times), belt), np.ones(len(times)), dwell], axis=1)
    try:
        paths = system.forecasts(
            starts, windows.stride / record.rate, N_OUTPUTS, auxiliary_state(system, record, starts[:, 0], true)
        )
    except SimulationError:
        return np.full(windows.targets.shape, np.nan)
    for effect in effects:
        if effect.group == "sensor" and not effect.random and LATE not in effect.signatures:
            paths = np.stack([effect.measure(t, p, generator) for t, p in zip(windows.times(), paths, strict=True)])
    return sign * paths


def score(model: Model, windows: Windows) -> Array:
    """Return the CRPS of each forecast [m], shape (n,): of an ensemble where the model is random, else the absolute error."""
    if len(windows) == 0:
        return np.zeros(0)
    if not model.random:
        return np.abs(forecasts(model, windows) - windows.targets).mean(axis=1)
    return crps(windows.targets, _members(model, windows)).mean(axis=1)


def expected_scores(model: Model, plain: Model, windows: Windows, noise: Noise) -> Array:
    """Return the scores that each forecast of two models would have on average if the first one were true [m], shape (2, n).

    Members of its ensemble take the place of what was measured, each with the sensor's noise, and are scored by the
    others: a single record of the model would miss as much as its chances happen to make it miss.

    Args:
        model: a random model.
        plain: one without its random effects.
        windows: the forecasts.
        noise: of the sensor.
    """
    if len(windows) == 0:
        return np.zeros((2, 0))
    members = _members(model, windows)
    others = _members(plain, windows) if plain.random else None
    single = forecasts(plain, windows)
    generator = np.random.default_rng(0)
    outliers = [e for e in model.effects_in(windows.record.name) if e.group == "sensor" and e.random]
    scores: list[Array] = []
    for chosen in range(0, MEMBERS, MEMBERS // STAND_INS):
        shown = members[chosen]
        for effect in outliers:
            shown = np.stack([effect.measure(t, p, generator) for t, p in zip(windows.times(), shown, strict=True)])
        shown = shown + np.stack([noise.draw(N_OUTPUTS, generator) for _ in shown])
        own = crps(shown, np.delete(members, chosen, axis=0)).mean(axis=1)
        beside = np.abs(shown - single) if others is None else crps(shown, others)
        scores.append(np.stack([own, beside.mean(axis=1)]))
    return np.mean(scores, axis=0)


def _members(model: Model, windows: Windows) -> Array:
    """Return the forecasts of a random model's ensemble [m], shape (MEMBERS, n, N_OUTPUTS)."""
    return np.stack([forecasts(model, windows, sample=s + 1) for s in range(MEMBERS)])
