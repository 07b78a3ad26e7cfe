"""Periodic effects: what a wave in time or along the belt would leave in the slips, looked for over a grid of frequencies.

Amplitude and phase of every harmonic are each run's own, so that the columns of a wave are nonzero in one run only; the
gain of thousands of frequencies is computed from small Gram matrices, run by run.

Slow waves count by how they differ from slip to slip: phases of their own must not stand in for levels that differ from
run to run. Waves faster than the slips make these break away at their crests, all in the same phase, so that nothing
differs: such waves count as a whole.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference import alignment
from stochfric_mb.discovery.inference.frequency_search import worth_a_look
from stochfric_mb.discovery.stick_slip.records.pool import Pool
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import N_FEATURES, legendre_coefficients
from stochfric_mb.discovery.stick_slip.screening.regression import Baseline, Part
from stochfric_mb.effects.marks import RETURNING, WAVE, Hypothesis, Wave
from stochfric_mb.effects.shapes.splines import RETURNING_PIECES, returning

HARMONICS = 3
"""Harmonics of a wave that is no sine."""
SLOW = 1.6
"""Frequency over the rate of the slips up to which waves are slow [-]; harmonics are looked for in slow ones alone."""
COARSE, FINE = 3.0, 15.0
"""Frequencies of the grid, and about its best one, in 1/(length of the record) [-]."""
CHUNK, MOST_AT_ONCE = 64, 400_000
"""Frequencies that are looked at together, and numbers that one such array may hold."""
EVEN = 1.0e-9
"""Share by which steps of a grid may differ to be even [-]: 64 of them then turn a wave of a thousand cycles by 1e-6 of one."""
PEAKS = 3
"""Waves with harmonics that say where to look for a course that comes back."""
STRETCH = 128.0
"""Cycles of the slips in the stretch of a long record in which waves are looked for first [-]."""


def frequencies(pool: Pool, pace: float = 1.0) -> Array:
    """Return the frequencies at which waves are looked for [Hz]: three waves in a typical record to one wave in a slip."""
    fastest = 1.0 / float(np.median(pool.restick_time - pool.onset_time))
    return np.arange(3.0 / (pace * pool.duration), max(fastest, SLOW * _slip_rate(pool)), 1.0 / (COARSE * pool.duration))


def slow_frequencies(pool: Pool, pace: float = 1.0) -> Array:
    """Return those of the `frequencies` at which a wave differs from slip to slip [Hz]."""
    every = frequencies(pool, pace)
    return every[every <= SLOW * _slip_rate(pool)]


def _slip_rate(pool: Pool) -> float:
    return float(np.median(_slip_rates(pool)))


def _slip_rates(pool: Pool) -> Array:
    return np.array([1.0 / s.cycle for s in pool.slips])


def wave_columns(pool: Pool, wave: Wave, frequency: float, harmonics: int) -> list[Array]:
    """Return cosine and sine of every harmonic and run as regressors, each of shape (n, N_FEATURES)."""
    slow = frequency <= SLOW * _slip_rate(pool)
    features = _features(wave.place, wave.weight, np.array([frequency]), harmonics)[0]
    columns: list[Array] = []
    for run in range(pool.n_runs):
        mine = (pool.run == run)[:, None]
        for h in range(harmonics):
            for part in (features[h].real, features[h].imag):
                columns.append(mine * (part - part[mine[:, 0]].mean(axis=0) if slow else part))
    return columns


def _features(place: Array, weight: Array, grid: Array, harmonics: int) -> npt.NDArray[np.complex128]:
    """Return weight exp(2 pi i h f place) as features, shape (len(grid), harmonics, n, N_FEATURES), complex."""
    first = _turns(place, grid)
    values = np.empty((len(grid), harmonics, len(place), N_FEATURES), dtype=np.complex128)
    turned = np.ones_like(first)
    for h in range(harmonics):
        turned = turned * first
        values[:, h, :, 0] = weight[:, 0] * turned[..., 0]
        in_slip = weight[:, 1:] * turned[..., 1:]
        # the projection is real: two real products are half the work of a complex one
        values[:, h, :, 1:].real, values[:, h, :, 1:].imag = map(
            legendre_coefficients, (in_slip.real.copy(), in_slip.imag.copy())
        )
    return values


def _turns(place: Array, grid: Array) -> npt.NDArray[np.complex128]:
    """Return exp(2 pi i f place), shape (len(grid), *place.shape); frequencies one step apart are turned by the same angles."""
    steps = np.diff(grid)
    if len(steps) < 2 or np.ptp(steps) > EVEN * steps[0]:
        return np.exp(2.0j * np.pi * grid[:, None, None] * place)
    turns = np.empty((len(grid), *place.shape), dtype=np.complex128)
    turns[0], turn = np.exp(2.0j * np.pi * grid[0] * place), np.exp(2.0j * np.pi * steps[0] * place)
    for i in range(1, len(grid)):
        np.multiply(turns[i - 1], turn, out=turns[i])
    return turns


def shared_by_runs(pool: Pool) -> list[Array]:
    """Return a regressor for every feature and run: whatever all slips of a run share."""
    columns = [pool.column(None, None) for _ in range(pool.n_runs * N_FEATURES)]
    for i, column in enumerate(columns):
        column[pool.run == i // N_FEATURES, i % N_FEATURES] = 1.0
    return columns


@dataclasses.dataclass(frozen=True)
class _Scan:
    """Waves of a grid of frequencies, as far as they are worth a look."""

    harmonics: int
    """Harmonics of each."""
    frequencies: Array
    """Frequencies [Hz]."""
    gains: Array
    """By how much they lower the cost [-]."""
    looked_at: int
    """Size of the grid."""
    slow: bool
    """Whether they differ from slip to slip."""


def waves_of(kind: str, wave: Wave, baseline: Baseline, *, held: bool = False) -> list[tuple[Hypothesis, int]]:
    """Return the best wave of a kind and the best course that comes back, if there is one, and among how many they were chosen.

    Args:
        kind: a periodic effect.
        wave: its wave in the slips.
        baseline: what the model so far leaves of them.
        held: whether the model has such an effect: what that leaves has further tones, and no shape of its own.
    """
    scans = _scans(wave, baseline)
    course = None if held or wave.returning is None else _best_course(kind, wave, baseline, scans)
    return [_best_wave(kind, wave, baseline, scans), *([] if course is None else [course])]


def best_wave(kind: str, wave: Wave, baseline: Baseline) -> tuple[Hypothesis, int]:
    """Return the best wave of a kind, and how many were looked at; arguments as of `waves_of`."""
    return _best_wave(kind, wave, baseline, _scans(wave, baseline))


def _scans(wave: Wave, baseline: Baseline) -> list[_Scan]:
    pool = baseline.pool
    parts = baseline.regression.parts(baseline.terms, baseline.solution.scatter)
    whole, limit = frequencies(pool, wave.pace), SLOW * _slip_rate(pool)
    slow, fast = whole[whole <= limit], whole[whole > limit]
    scans: list[_Scan] = []
    for harmonics, grid in ((1, slow), (HARMONICS, slow), (1, fast)):
        if len(grid) == 0:
            continue
        near = worth_a_look(
            lambda some, stretch, harmonics=harmonics: _gains(pool, wave, parts, some, harmonics, stretch),
            grid,
            duration=pool.duration,
            stretch=STRETCH / _slip_rate(pool),
            fineness=COARSE,
        )
        gains = _gains(pool, wave, parts, near, harmonics)
        centre = float(near[np.argmax(gains)])
        close = centre + np.arange(-2, 3) / (FINE * pool.duration)
        close = close[(close <= limit) == (centre <= limit)]
        gains = np.concatenate([gains, _gains(pool, wave, parts, close, harmonics)])
        scans.append(_Scan(harmonics, np.concatenate([near, close]), gains, len(grid), grid is slow))
    return scans


def _best_wave(kind: str, wave: Wave, baseline: Baseline, scans: Sequence[_Scan]) -> tuple[Hypothesis, int]:
    pool = baseline.pool
    cost = 2.0 * pool.n_runs * baseline.price
    # a wave that all slips of a run keep to looks like a shape that they share: it must tell more with less
    alike = shared_by_runs(pool)
    shaped = 2.0 * float(baseline.gains([alike])[0]) - len(alike) * baseline.price
    rates = _slip_rates(pool)
    share = criteria.SHARE_OF_SHAPE if rates.max() > criteria.RATES_DIFFER * rates.min() else 1.0
    best = (-np.inf, float(frequencies(pool, wave.pace)[0]), 1)
    for scan in scans:
        score = 2.0 * float(scan.gains.max()) - cost * scan.harmonics
        if scan.slow or score > share * shaped:
            best = max(best, (score, float(scan.frequencies[np.argmax(scan.gains)]), scan.harmonics))
    _, frequency, harmonics = best
    columns = wave_columns(pool, wave, frequency, harmonics)
    looked_at = sum(scan.looked_at for scan in scans)
    return Hypothesis(kind, columns, (wave.setting(frequency), float(harmonics)), variant=WAVE), looked_at


def _best_course(kind: str, wave: Wave, baseline: Baseline, scans: Sequence[_Scan]) -> tuple[Hypothesis, int] | None:
    """Return the best course of any smooth shape that comes back, the same in all runs but for where it begins.

    What comes back is looked for where waves with harmonics explain most, and at twice and thrice their lengths; their
    harmonics say how the runs are shifted against each other.

    Reference: D. R. Lorimer, M. Kramer, Handbook of Pulsar Astronomy, Cambridge 2005, chapters 6 and 7 (harmonics, folding).
    """
    pool = baseline.pool
    scan = next((s for s in scans if s.harmonics == HARMONICS), None)
    if scan is None:
        return None
    lowest, best = float(frequencies(pool, wave.pace)[0]), None
    for frequency in _peaks(scan, 1.0 / pool.duration):
        for main in (frequency, frequency / 2.0, frequency / 3.0):
            if main < lowest:
                continue
            begins = _begins(pool, wave, baseline, main)
            for pieces in RETURNING_PIECES:
                columns = returning_columns(pool, wave, main, begins, pieces)
                score = 2.0 * float(baseline.gains([columns])[0]) - len(columns) * baseline.price
                if best is None or score > best[0]:
                    best = score, main, begins, pieces, columns
    if best is None:
        return None
    _, main, begins, pieces, columns = best
    setting, values = wave.setting(main), wave.returning
    assert values is not None

    def start(weights: Array) -> dict[str, Any]:
        return values(weights, pieces, setting)

    found = Hypothesis(kind, columns, (setting, *begins.tolist(), float(pieces)), start, variant=RETURNING)
    return found, scan.looked_at * alignment.BEGINS ** (pool.n_runs - 1)


def _peaks(scan: _Scan, apart: float) -> list[float]:
    """Return the best frequencies of a scan that are so far apart [Hz]."""
    chosen: list[float] = []
    for i in np.argsort(-scan.gains, kind="stable"):
        frequency = float(scan.frequencies[i])
        if all(abs(frequency - other) > apart for other in chosen):
            chosen.append(frequency)
        if len(chosen) == PEAKS:
            break
    return chosen


def _begins(pool: Pool, wave: Wave, baseline: Baseline, frequency: float) -> Array:
    """Return where in a course that comes back each run begins [turns], shape (n_runs,), the runs' own harmonics aligned."""
    columns = wave_columns(pool, wave, frequency, alignment.HARMONICS)
    solution = baseline.solved(columns)
    pairs = solution.coefficients[-len(columns) :].reshape(pool.n_runs, alignment.HARMONICS, 2)
    variance = (solution.deviations[-len(columns) :] ** 2).reshape(pairs.shape).sum(axis=2) + 1.0e-300
    # a cos + b sin is the real part of (a - i b) exp(i angle); a mirrored run passes the course backwards
    return alignment.aligned(pairs[..., 0] - 1j * pairs[..., 1] * _directions(pool, wave)[:, None], variance)


def returning_columns(pool: Pool, wave: Wave, frequency: float, begins: Array, pieces: int) -> list[Array]:
    """Return the regressors of a course that comes back, one a weight, each of shape (n, N_FEATURES).

    Args:
        pool: the slips.
        wave: where it runs.
        frequency: how often it comes back [Hz].
        begins: where in it each run begins [turns], shape (n_runs,).
        pieces: its pieces.
    """
    turns = (_directions(pool, wave) * frequency)[pool.run][:, None] * wave.place + begins[pool.run][:, None]
    weighted = wave.weight[..., None] * returning(turns, pieces)
    columns = [pool.column(weighted[:, 0, k], weighted[:, 1:, k]) for k in range(pieces - 1)]
    for column in columns:
        for run in range(pool.n_runs):
            mine = pool.run == run
            column[mine] -= column[mine].mean(axis=0)
    return columns


def _directions(pool: Pool, wave: Wave) -> Array:
    """Return which way each run passes a wave, 1 or -1, shape (n_runs,)."""
    return np.array([float(s.record.direction) if wave.turned else 1.0 for s in pool.slips])


def with_harmonics(pool: Pool, kind: str, wave: Wave, frequency: float) -> Hypothesis:
    """Return the wave of a kind with its harmonics at a frequency [Hz]."""
    columns = wave_columns(pool, wave, frequency, HARMONICS)
    return Hypothesis(kind, columns, (wave.setting(frequency), float(HARMONICS)), variant=WAVE)


def _gains(pool: Pool, wave: Wave, parts: list[Part], grid: Array, harmonics: int, stretch: float = np.inf) -> Array:
    """Return by how much waves of the grid's frequencies lower the cost at fixed variance components, shape (len(grid),).

    Args:
        pool: the slips.
        wave: where the wave runs.
        parts: what it meets, run by run.
        grid: frequencies [Hz].
        harmonics: how many of them a wave has.
        stretch: time from the first slip of each run after which there is no wave [s].
    """
    first = np.array([s.onset_time[0] for s in pool.slips])[pool.run]
    inside = np.asarray(pool.onset_time - first <= stretch)
    chunk = max(1, min(CHUNK, MOST_AT_ONCE // (harmonics * wave.place.shape[1] * max(int(inside.sum()), 1))))
    some = [_some(pool, wave, parts, grid[i : i + chunk], harmonics, inside) for i in range(0, len(grid), chunk)]
    return np.concatenate(some)


def _some(pool: Pool, wave: Wave, parts: list[Part], grid: Array, harmonics: int, inside: npt.NDArray[np.bool_]) -> Array:
    width = 2 * harmonics
    size = width * len(parts)
    gram = np.zeros((len(grid), size, size))
    along = np.zeros((len(grid), size))
    shared = np.zeros((len(grid), parts[0].basis.shape[1], size))
    for i, part in enumerate(parts):
        mine = (pool.run == part.run) & inside
        features = _features(wave.place[mine], wave.weight[mine], grid, harmonics)
        if grid[0] <= SLOW * _slip_rate(pool):
            features -= features.mean(axis=2, keepdims=True)
        white = (features[:, :, pool.kept[mine]] @ part.inverse.T).reshape(len(grid), harmonics, -1)
        columns = np.stack([white.real, white.imag], axis=2).reshape(len(grid), width, -1)
        at = slice(i * width, (i + 1) * width)
        rows = np.repeat(inside[(pool.run == part.run) & pool.kept], N_FEATURES)
        gram[:, at, at] = columns @ columns.transpose(0, 2, 1)
        along[:, at] = columns @ part.rest[rows]
        shared[:, :, at] = part.basis[rows].T @ columns.transpose(0, 2, 1)
    scale = np.sqrt(np.maximum(np.einsum("fii->fi", gram), 1.0e-300))
    # what of the waves the stated model cannot imitate
    gram = (gram - shared.transpose(0, 2, 1) @ shared) / (scale[:, :, None] * scale[:, None, :]) + 1.0e-6 * np.eye(size)
    along /= scale
    return 0.5 * np.einsum("fi,fi->f", along, np.linalg.solve(gram, along[..., None])[..., 0])
