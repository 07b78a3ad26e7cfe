"""What every slip tells: onset force, and the friction force of the slip as Legendre coefficients, in weak form.

With u in [-1, 1] over the slip and P_q the Legendre polynomials, the coefficient of order q is

    F_q = (2 q + 1)/T * integral over the slip of (m x'' + c x' + k x - k u_0 cos W t) P_q(u) dt

where two integrations by parts leave the position alone under the integral and, at the ends, the located edges
(x_o, v_b) and (x_r, v_b): nothing is differentiated. The onset force is k x_o + c v_b - k u_0 cos W t_o.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev, legendre

from stochfric_mb.discovery.stick_slip.records.edges import ALWAYS, IF_BETTER, NEAR, NEVER, locate_edge
from stochfric_mb.discovery.stick_slip.records.record import Array, Noise, Record, line_in, noise_of
from stochfric_mb.discovery.stick_slip.records.segmentation import slips_of
from stochfric_mb.discovery.stick_slip.records.stick_motion import without_pattern, without_wave

N_MOMENTS = 7
"""Legendre coefficients of the friction force in a slip."""
N_FEATURES = 1 + N_MOMENTS
"""Onset force and coefficients."""
N_NODES = 32
"""Gauss nodes on a slip at which its trajectory is given."""
NODES, WEIGHTS = legendre.leggauss(N_NODES)
SETTLING = 102.0
"""Angle of the natural oscillation before a record that is simulated at least and not looked at [rad]: 16 periods."""
_DEGREE = 9
_STIFF, _SOFT = 0.06, 3.0
"""Standard deviation of an edge's cubic term over half the record's range: for a constant force, or a changing one."""
_MISFIT_ALLOWED = 1.6
"""Median squared misfit over noise variance above which the force at break-away is taken to change."""
_ORDERS = np.arange(N_MOMENTS)
_AT_BEGIN = (-1.0) ** _ORDERS
"""P_q(-1)."""
_SLOPE_AT_END = 0.5 * _ORDERS * (_ORDERS + 1)
"""P_q'(1), and -P_q'(-1) P_q(-1)."""


def _derived(times: int) -> Array:
    """Return the Legendre series of derivatives of P_0, P_1, ..., one in a column, shape (N_MOMENTS, N_MOMENTS)."""
    series = legendre.legder(np.eye(N_MOMENTS), times)
    return np.asarray(np.pad(series, ((0, N_MOMENTS - len(series)), (0, 0))), dtype=np.float64)


_FIRST, _SECOND = _derived(1), _derived(2)
_AT_NODES = legendre.legvander(NODES, N_MOMENTS - 1)
_END_SLOPES = np.stack([chebyshev.chebval(s, chebyshev.chebder(np.eye(_DEGREE + 1))) for s in (-1.0, 1.0)])
"""Slopes of Chebyshev polynomials at both ends of the slip, shape (2, _DEGREE + 1)."""


@dataclasses.dataclass(frozen=True)
class StickSamples:
    """Means over short bins of the stick phases; arrays have shape (n,)."""

    segment: np.ndarray
    """Number of the stick phase, int64."""
    time: Array
    """Time [s]."""
    residual: Array
    """Position less the belt's motion since the phase's first sample [m]."""
    since_restick: Array
    """Time since the re-stick [s]."""
    to_onset: Array
    """Time to the next break-away [s]."""
    position: Array
    """Position [m]."""
    bin_size: int
    """Samples in a bin."""

    def part(self, chosen: np.ndarray) -> StickSamples:
        """Return the bins where ``chosen`` is true, shape (n,)."""
        arrays = {f.name: getattr(self, f.name)[chosen] for f in dataclasses.fields(self) if f.name != "bin_size"}
        return dataclasses.replace(self, **arrays)


@dataclasses.dataclass(frozen=True)
class EdgeSearch:
    """How edges are looked for."""

    ridge: float
    """Ridge of the break-aways' cubic term: how firmly the force there is assumed to be constant [-]."""
    firm: float
    """The same of the re-sticks [-]."""
    beyond: tuple[int, int] = (IF_BETTER, IF_BETTER)
    """Whether break-aways, and re-sticks, are looked for beyond the first places, see `edges`."""


@dataclasses.dataclass(frozen=True)
class Slips:
    """The slips of one record; arrays have shape (n,) unless said otherwise."""

    record: Record
    """Where they come from."""
    noise: Noise
    """Noise in the stick phases."""
    line: tuple[float, float, float]
    """Strongest line of the noise: frequency [Hz], amplitude [m], strength [-]."""
    ridge: float
    """Ridge of the break-aways' cubic term, see `edges` [-]."""
    firm: float
    """The same of the re-sticks [-]."""
    beyond: tuple[int, int]
    """Whether most break-aways, and most re-sticks, were found beyond the first places, see `edges`."""
    onset_time: Array
    """Break-away [s]."""
    onset_position: Array
    """Position there [m]."""
    restick_time: Array
    """Re-stick [s]."""
    restick_position: Array
    """Position there [m]."""
    onset_force: Array
    """Force at break-away [N]."""
    moments: Array
    """Legendre coefficients of the friction force [N], shape (n, N_MOMENTS)."""
    node_time: Array
    """Time at the Gauss nodes [s], shape (n, N_NODES)."""
    node_position: Array
    """Position there [m], shape (n, N_NODES)."""
    node_velocity: Array
    """Velocity there [m/s], shape (n, N_NODES)."""
    node_acceleration: Array
    """Acceleration there [m/s^2], shape (n, N_NODES)."""
    stick: StickSamples
    """The stick phases."""

    def __len__(self) -> int:
        return len(self.onset_time)

    @property
    def search(self) -> EdgeSearch:
        """How edges of simulated slips are found where those of these were."""
        return EdgeSearch(self.ridge, self.firm, self.beyond)

    @property
    def cycle(self) -> float:
        """Typical time from one break-away to the next [s]."""
        return float(np.median(np.diff(self.onset_time)))

    @property
    def settling(self) -> float:
        """Time [s] that a simulation of the run takes from the belt's zero to where its cycles are typical."""
        least = SETTLING / self.record.angular_frequency
        if len(self) < 2:
            return least
        first = abs(float(np.median(self.onset_position))) / self.record.mechanism.belt_velocity
        return max(least, first + 2.0 * self.cycle)

    @property
    def features(self) -> Array:
        """Onset force and coefficients [N], shape (n, N_FEATURES)."""
        return np.c_[self.onset_force, self.moments]


_PROJECTION = WEIGHTS[:, None] * _AT_NODES * (2 * _ORDERS + 1) / 2.0


def legendre_coefficients(values: Array) -> Array:
    """Return the Legendre coefficients, shape (..., N_MOMENTS), of functions given at the Gauss nodes, shape (..., N_NODES)."""
    return values @ _PROJECTION


def extract(record: Record, *, ridge: float | None = None, noise: Noise | None = None) -> Slips:
    """Return the slips of a record.

    Args:
        record: the record.
        ridge: how firmly the force at break-away is assumed to be constant; chosen from the data if not given.
        noise: the noise that edges are located in; that of the stick phases if not given.
    """
    rough = list(_inside(record, slips_of(record, noise)))
    quiet, when = _quiet(record, rough)
    if noise is None:
        noise = noise_of(quiet, record.noise)
        if noise.coloured > 0.0:
            calmer = without_wave(quiet, when, record.angular_frequency) or quiet
            noise = noise_of(without_pattern(calmer) or calmer, record.noise)
            # such noise can pass for a slip's first or last samples
            rough = list(_inside(record, slips_of(record, noise)))
    # a sensor that shows nothing moves by nothing
    half = 0.5 * float(np.ptp(record.position)) or 1.0
    firm = noise.deviation / (_STIFF * half)
    if ridge is None:
        misfits = [_edge(record, begin, 1, firm, room, IF_BETTER)[3] / noise.deviation**2 for begin, _, room, _ in rough[:24]]
        constant = not misfits or np.median(misfits) < _MISFIT_ALLOWED
        ridge = firm if constant else noise.deviation / (_SOFT * half)
    table, beyond = _edges(record, rough, EdgeSearch(ridge, firm))
    onset_time, onset_position, restick_time, restick_position = table.T
    moments = np.empty((len(table), N_MOMENTS))
    nodes = np.empty((4, len(table), N_NODES))
    for i, edge in enumerate(table):
        u, time, position = _samples(record, edge)
        moments[i] = _moments(record, edge, u, time, position)
        nodes[:, i] = _smooth(u, position, edge[2] - edge[0], record.mechanism.belt_velocity, edge[0])
    return Slips(
        record, noise, line_in(quiet, record.rate), ridge, firm, beyond,
        onset_time, onset_position, restick_time, restick_position, _onset_force(record, onset_time, onset_position), moments,
        nodes[0], nodes[1], nodes[2], nodes[3], _stick(record, table),
    )  # fmt: skip


def features_near(record: Record, time: float, search: EdgeSearch) -> Array | None:
    """Return the features of the slip that begins nearest to ``time`` [N], shape (N_FEATURES,); None where there is no slip.

    What `extract` says of it, for simulated slips: nothing else is worked out.

    Args:
        record: some slips without noise.
        time: where the slip is expected to begin [s].
        search: how its edges are looked for.
    """
    table, _ = _edges(record, list(_inside(record, slips_of(record))), search)
    if len(table) == 0:
        return None
    edge = table[int(np.argmin(np.abs(table[:, 0] - time)))]
    return np.r_[_onset_force(record, edge[0], edge[1]), _moments(record, edge, *_samples(record, edge))]


Rough = tuple[int, int, int, int]
"""A slip: samples of its begin and end, and how many samples of stick there are before and after it."""


def _inside(record: Record, slips: Sequence[tuple[int, int]]) -> Iterator[Rough]:
    """Yield the slips whose surroundings lie within the record, with the stick on either side, at most half a period of it."""
    margin = record.samples(3.06)
    # smoothed velocities end a slip early or late, and an edge is looked for on either side: neither may reach the next one
    bounds = [-margin, *itertools.chain.from_iterable(slips), len(record.time) + margin]
    rooms = np.clip(np.diff(bounds)[::2] - 2 * record.samples(NEAR[0]), record.samples(NEAR[0]), margin)
    for (begin, end), before, after in zip(slips, rooms[:-1], rooms[1:], strict=True):
        if begin >= margin and end <= len(record.time) - margin:
            yield begin, end, int(before), int(after)


def _edge(
    record: Record, index: int, side: int, ridge: float, room: int, beyond: int
) -> tuple[float, float, float, float, bool]:
    box = record.mechanism
    return locate_edge(
        record.position, record.time, box.belt_velocity, index, side, record.angular_frequency,
        room, record.samples(1.07), ridge, box.excitation_amplitude, box.excitation_angular_frequency, beyond,
    )  # fmt: skip


def _edges(record: Record, rough: Sequence[Rough], search: EdgeSearch) -> tuple[Array, tuple[int, int]]:
    """Return break-away (time [s], position [m]) and re-stick of the slips, shape (n, 4), and where most of each were found."""
    onsets = [_edge(record, begin, 1, search.ridge, before, search.beyond[0]) for begin, _, before, _ in rough]
    resticks = [_edge(record, end, -1, search.firm, after, search.beyond[1]) for _, end, _, after in rough]
    shortest = 0.5 / record.angular_frequency
    pairs = zip(onsets, resticks, strict=True)
    edges = [(*onset[:2], *restick[:2]) for onset, restick in pairs if restick[0] - onset[0] > shortest]
    # two slips may not overlap: a rough slip cut in two can be located twice
    table = np.array([e for i, e in enumerate(edges) if i == 0 or e[0] > edges[i - 1][2]]).reshape(-1, 4)
    return table, (_mostly(onsets), _mostly(resticks))


def _mostly(edges: Sequence[tuple[float, float, float, float, bool]]) -> int:
    return ALWAYS if 2 * sum(e[4] for e in edges) > len(edges) else NEVER


def _onset_force(record: Record, time: Any, position: Any) -> Any:
    """Return the force at break-away [N]."""
    box = record.mechanism
    return box.stiffness * position + box.damping * box.belt_velocity - record.excitation(time)


def _quiet(record: Record, rough: Sequence[Rough]) -> tuple[list[Array], list[Array]]:
    """Return the stick phases between rough slips less their lines [m], sample by sample, and the samples' times [s]."""
    margin = record.samples(0.8)
    phases: list[Array] = []
    times: list[Array] = []
    for (_, restick, *_), (onset, *_) in itertools.pairwise(rough):
        position = record.position[restick + margin : onset - margin]
        if len(position) > 40:
            place = np.linspace(-1.0, 1.0, len(position))
            phases.append(position - position.mean() - place * (place @ position) / (place @ place))
            times.append(record.time[restick + margin : onset - margin])
    return phases, times


def _samples(record: Record, edge: Array) -> tuple[Array, Array, Array]:
    """Return the place u in the slip [-], time [s] and position [m] of its samples, edges included."""
    begin, x_begin, end, x_end = edge
    first, last = np.searchsorted(record.time, (begin, end))
    time = np.concatenate(([begin], record.time[first:last], [end]))
    position = np.concatenate(([x_begin], record.position[first:last], [x_end]))
    return 2.0 * (time - begin) / (end - begin) - 1.0, time, position


def _moments(record: Record, edge: Array, u: Array, time: Array, position: Array) -> Array:
    """Return the coefficients of the friction force in a slip [N], shape (N_MOMENTS,)."""
    box = record.mechanism
    begin, x_begin, end, x_end = edge
    duration = end - begin
    rate = 2.0 / duration
    ends = (
        box.mass * box.belt_velocity * (1.0 - _AT_BEGIN)
        - box.mass * rate * _SLOPE_AT_END * (x_end + _AT_BEGIN * x_begin)
        + box.damping * (x_end - _AT_BEGIN * x_begin)
    )
    series = box.mass * rate**2 * _SECOND - box.damping * rate * _FIRST + box.stiffness * np.eye(N_MOMENTS)
    steps = np.diff(time)
    weights = 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps))
    kernel = (weights * position) @ legendre.legvander(u, N_MOMENTS - 1) @ series
    forcing = record.excitation(begin + (NODES + 1.0) * duration / 2.0)
    known = (WEIGHTS * forcing) @ _AT_NODES * duration / 2.0
    return np.asarray((ends + kernel - known) * (2 * _ORDERS + 1) / duration, dtype=np.float64)


def _smooth(u: Array, position: Array, duration: float, belt: float, begin: float) -> Array:
    """Return time, position, velocity and acceleration at the nodes by a polynomial that leaves and meets the belt."""
    weight = np.ones(len(u))
    weight[0] = weight[-1] = 20.0
    scale = duration / 20.0
    matrix = np.r_[chebyshev.chebvander(u, _DEGREE) * weight[:, None], _END_SLOPES * (2.0 / duration) * scale * 20.0]
    right = np.r_[position * weight, np.full(2, belt) * scale * 20.0]
    series = np.linalg.lstsq(matrix, right, rcond=None)[0]
    first, second = chebyshev.chebder(series), chebyshev.chebder(series, 2)
    return np.stack(
        [
            begin + (NODES + 1.0) * duration / 2.0,
            chebyshev.chebval(NODES, series),
            chebyshev.chebval(NODES, first) * 2.0 / duration,
            chebyshev.chebval(NODES, second) * (2.0 / duration) ** 2,
        ]
    )


def _stick(record: Record, edges: Array) -> StickSamples:
    """Return the binned stick phases."""
    size = record.samples(0.255)
    guard_after, guard_before = 0.1 / record.angular_frequency, 0.05 / record.angular_frequency
    rows: list[Array] = []
    for i in range(len(edges) - 1):
        restick, onset = edges[i, 2], edges[i + 1, 0]
        first, last = np.searchsorted(record.time, (restick + guard_after, onset - guard_before))
        count = (last - first) // size
        if count < 6:
            continue
        time = record.time[first : first + count * size]
        position = record.position[first : first + count * size]
        residual = position - record.mechanism.belt_velocity * (time - time[0])
        t, r, x = (a.reshape(count, size).mean(axis=1) for a in (time, residual, position))
        rows.append(np.c_[np.full(count, i), t, r, t - restick, onset - t, x])
    table = np.concatenate(rows) if rows else np.zeros((0, 6))
    segment, middle, residual, since, ahead, position = table.T
    return StickSamples(segment.astype(np.int64), middle, residual, since, ahead, position, size)
