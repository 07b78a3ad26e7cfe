"""The kinematic channel: in stick a rigid contact follows the belt, and whatever else the box does then is seen directly.

The binned stick phases, less each phase's mean and each run's belt velocity, are regressed on what a ripple of the
belt's speed, ringing after the re-stick, a step of the sensor, a clipped sensor and creep before the break-away would
leave. Gains are falls of chi^2 with the noise that the data show; scores subtract p ln n and twice ln(grid size).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.inference.frequency_search import worth_a_look
from stochfric_mb.discovery.inference.threads import CORES, in_threads
from stochfric_mb.discovery.stick_slip.records.record import Array, Noise
from stochfric_mb.discovery.stick_slip.records.slips import Slips, StickSamples
from stochfric_mb.discovery.stick_slip.records.stick_motion import TONES, shapes, tones
from stochfric_mb.discovery.stick_slip.records.stick_waves import centred, wave_gains
from stochfric_mb.effects.traits import BELT_RIPPLE, CREEPING_ZERO, JUMP, YIELDING

FINENESS = 4.0
"""Frequencies of a ripple are 1/(this times the length of the record) apart [-]."""
STRETCH = 128.0
"""Cycles of the slips in the stretch of a long record in which a ripple is looked for first [-]."""
HAT = 1.275
"""Distance of the corners of a creep before a break-away or after a re-stick, as an angle of the natural oscillation [rad]."""
ALIKE = 9
"""Corners of a course that all stick phases of a run share, from re-stick to break-away; with 14 it explains no more."""
WAVES_IN_A_SLIP = 2.0
"""Waves in the time of a slip up to which a ripple is looked for [-]."""


@dataclasses.dataclass(frozen=True)
class Sticking:
    """What the stick phases tell; scores are falls of chi^2 less what chance and choice give."""

    scores: dict[str, float]
    """Score of each finding: ripple, contact that yields, jump or drift of the reading, creep_before, creep_after, yielding."""
    settings: dict[str, dict[str, float]]
    """Parameters at the best score."""
    runs: tuple[tuple[str, float], ...]
    """Name of each run and its stated belt velocity [m/s], positive, in the order of the next two."""
    belt_velocity_error: Array
    """Measured over stated belt velocity, less 1, run by run [-]."""
    belt_velocity_deviation: Array
    """Standard deviation of it [-]."""
    excess: float
    """chi^2 of the belt's line less its degrees of freedom [-]."""
    excess_ratio: float
    """chi^2 over its degrees of freedom [-]."""
    jumps: int
    """Stick phases within which the box jumps."""
    departure: float
    """Root mean square of what the belt's line leaves beyond noise, over the noise of one reading [-]."""


@dataclasses.dataclass(frozen=True)
class _Phases:
    """The stick phases of one run, in units of their noise."""

    slips: Slips
    samples: StickSamples
    values: Array
    line: Array
    deviation: float

    def rest(self, columns: Sequence[Array]) -> Array:
        """Return the values less the belt's line and the columns."""
        design = np.stack([self.line, *(centred(c, self.samples.segment) for c in columns)], axis=1)
        design = design / np.maximum(np.linalg.norm(design, axis=0), 1.0e-300)
        return self.values - design @ np.linalg.lstsq(design, self.values, rcond=1.0e-9)[0]


def analyse(slips: Sequence[Slips]) -> Sticking | None:
    """Return what the stick phases of all runs tell; None where there are too few to tell anything."""
    runs = [_phases(s) for s in slips if len(s.stick.time) >= 50]
    if not runs:
        return None
    # a jump may stand in a single phase; all else that stick shows is there in most of them
    step, times, jumps = _step(runs, [run.rest([]) for run in runs])
    runs = [_without_accidents(run) for run in runs]
    rests = [run.rest([]) for run in runs]
    chi2 = sum(float(r @ r) for r in rests)
    freedom = sum(len(run.values) - len(np.unique(run.samples.segment)) - 1 for run in runs)
    log_n = float(np.log(max(freedom, 2)))
    scores: dict[str, float] = {}
    settings: dict[str, dict[str, float]] = {}
    scores[BELT_RIPPLE], settings[BELT_RIPPLE] = _ripple(runs, rests, log_n)
    scores[YIELDING], settings[YIELDING] = _yields(runs, rests, log_n)
    ring = settings[YIELDING]["angular_frequency"], settings[YIELDING]["damping_ratio"]
    scores |= _creep(runs, rests, log_n)
    settings |= {name: {"ringing": score} for name, score in _creep(runs, rests, log_n, ring).items()}
    scores[JUMP] = step - len(runs) * (log_n + 2.0 * np.log(max(freedom, 2)))
    settings[JUMP] = {f"time_{i}": t for i, t in enumerate(times)}
    errors = np.array([_belt_error(run) for run in runs]).T
    beyond = sum(
        (float(r @ r) - len(r)) * (run.deviation / run.slips.noise.deviation) ** 2 for run, r in zip(runs, rests, strict=True)
    )
    departure = float(np.sqrt(max(beyond, 0.0) / sum(map(len, rests))))
    stated = tuple((run.slips.record.name, run.slips.record.mechanism.belt_velocity) for run in runs)
    return Sticking(scores, settings, stated, errors[0], errors[1], chi2 - freedom, chi2 / max(freedom, 1), jumps, departure)


def _gain(runs: Sequence[_Phases], rests: Sequence[Array], columns: Callable[[_Phases], Sequence[Array]]) -> float:
    """Return the fall of chi^2 by columns in all runs."""
    return sum(float(r @ r) - float(np.sum(run.rest(columns(run)) ** 2)) for run, r in zip(runs, rests, strict=True))


def _ripple(runs: Sequence[_Phases], rests: Sequence[Array], log_n: float) -> tuple[float, dict[str, float]]:
    """Return the score of a ripple of the belt's speed, its frequency [Hz], and its score and share of chi^2 as plain noise.

    Beside that share stands what one course explains that all phases of a run share: a wave with a rate of its own meets each
    phase elsewhere.
    """
    duration = max(run.slips.record.duration for run in runs)
    # a wave that is faster still is a sensor's, not a drive's
    lasting = np.concatenate([run.slips.restick_time - run.slips.onset_time for run in runs])
    fastest = WAVES_IN_A_SLIP / float(np.median(lasting))
    every = np.arange(2.0 / duration, fastest, 1.0 / (FINENESS * duration))
    cycle = float(np.median([run.slips.cycle for run in runs]))
    grid = worth_a_look(
        lambda some, stretch: _ripple_gains(runs, rests, some, stretch),
        every,
        duration=duration,
        stretch=STRETCH * cycle,
        fineness=FINENESS,
    )
    gains, plain = (_ripple_gains(runs, rests, grid, plain=p) for p in (False, True))
    chi2 = sum(float(r @ r) for r in rests)
    # a ripple that is nearly all of what counts as slow noise says itself how fast it is; that noise would favour its harmonics
    best = int(np.argmax(plain if plain.max() > criteria.STICK_EXPLAINED * chi2 else gains))
    cost = 2 * len(runs) * log_n + 2.0 * float(np.log(len(every)))
    settings = {"frequency": float(grid[best]), "plain": float(plain[best]) - cost, "share": float(plain[best]) / chi2}
    settings |= {"alike": _gain(runs, rests, _alike) / chi2, "tones": 1.0}
    score = float(gains[best]) - cost
    shaped = _any_shape(runs, rests, float(grid[best]), duration) if settings["plain"] > criteria.NAMED else None
    if shaped is None:
        return score, settings
    frequency, gain = shaped
    plain_score = gain - cost - 2 * (TONES - 1) * len(runs) * log_n
    shape = {"frequency": frequency, "plain": plain_score, "share": gain / chi2, "tones": float(TONES)}
    return max(score, plain_score), settings | shape


def _any_shape(
    runs: Sequence[_Phases], rests: Sequence[Array], frequency: float, duration: float
) -> tuple[float, float] | None:
    """Return the rate [Hz] of the best wave of any shape of which a tone is seen, and what it explains; None: one tone is all.

    Its other tones explain more than they leave: a form that nearly fits has further tones to no end. What has the rate of the
    slips may be what every phase repeats, which is of any shape, too.
    """
    slip_rate, apart = 1.0 / float(np.median([run.slips.cycle for run in runs])), 2.0 / duration

    def keeps_step(f: float) -> bool:
        fast, slow = max(f, slip_rate), min(f, slip_rate)
        return abs(f - slip_rate * max(round(f / slip_rate), 1)) < apart or abs(fast - slow * round(fast / slow)) < apart

    def explained(way: tuple[float, int]) -> float:
        return _gain(runs, rests, lambda run: tones(run.samples.time, *way))

    ways = shapes(frequency, duration)
    whole = [w for w in ways if w[1] == TONES and not keeps_step(w[0])]
    if not whole:
        return None
    chi2, one = sum(float(r @ r) for r in rests), max(explained(w) for w in ways if w[1] == 1)
    best = max(whole, key=explained)
    gain = explained(best)
    return (best[0], gain) if chi2 - gain < (1.0 - criteria.TONES_EXPLAIN) * (chi2 - one) else None


def _alike(run: _Phases) -> list[Array]:
    """Return the corners of a course that all stick phases share."""
    since, left = run.samples.since_restick, run.samples.to_onset
    place = since / (since + left) * (ALIKE - 1)
    return [np.clip(1.0 - np.abs(place - corner), 0.0, 1.0) for corner in range(ALIKE)]


def _yields(runs: Sequence[_Phases], rests: Sequence[Array], log_n: float) -> tuple[float, dict[str, float]]:
    """Return score, angular frequency [rad/s] and damping ratio of a contact that rings, and may yield besides."""
    n = len(runs)
    ringing = [(f, z) for f in np.geomspace(1.5, 15.0, 40) * runs[0].slips.record.angular_frequency for z in (0.03, 0.08, 0.2)]
    gains = np.array([_gain(runs, rests, lambda run, w=w, z=z: _ringing(run, w, z)) for w, z in ringing])
    best = int(np.argmax(gains))
    choice = 2.0 * np.log(len(ringing))
    score = float(gains[best]) - 2 * n * log_n - choice
    # a contact whose stiffness changes with its load follows the belt at one speed no longer
    both = _gain(runs, rests, lambda run: [*_ringing(run, *ringing[best]), *_yielding(run)]) - 5 * n * log_n - choice
    settings = {"angular_frequency": float(ringing[best][0]), "damping_ratio": ringing[best][1]}
    return max(score, both) if score > criteria.RINGS * both else score, settings


def _creep(
    runs: Sequence[_Phases], rests: Sequence[Array], log_n: float, ring: tuple[float, float] | None = None
) -> dict[str, float]:
    """Return the scores of other ways in which a stuck box, or its reading, may creep.

    Args:
        runs: the stick phases.
        rests: what the belt's line leaves of them.
        log_n: logarithm of the number of independent samples.
        ring: angular frequency [rad/s] and damping ratio of a contact that rings beside them, if one does.
    """
    rings = [] if ring is None else [ring]

    def hats(run: _Phases, column: Array, count: int) -> list[Array]:
        turned = column * run.slips.record.angular_frequency / HAT
        return [np.clip(1.0 - np.abs(turned - p), 0.0, 1.0) for p in range(count)]

    ways: dict[str, tuple[int, Callable[[_Phases], Sequence[Array]]]] = {
        "creep_before": (4, lambda run: hats(run, run.samples.to_onset, 4)),
        CREEPING_ZERO: (2, lambda run: [np.sqrt(run.samples.time - run.samples.time[0]), run.samples.time**2]),
        "yielding": (3, _yielding),
        "creep_after": (3, lambda run: hats(run, run.samples.since_restick, 3)),
    }

    def beside(columns: Callable[[_Phases], Sequence[Array]]) -> Callable[[_Phases], Sequence[Array]]:
        return lambda run: [*columns(run), *(c for w, z in rings for c in _ringing(run, w, z))]

    more = 2 * len(rings)
    return {name: _gain(runs, rests, beside(ways_)) - (p + more) * len(runs) * log_n for name, (p, ways_) in ways.items()}


def _phases(slips: Slips) -> _Phases:
    samples = slips.stick
    deviation = slips.noise.of_mean(samples.bin_size)
    values, line = (centred(column, samples.segment) for column in (samples.residual / deviation, samples.time))
    return _Phases(slips, samples, values, line, deviation)


def _without_accidents(run: _Phases) -> _Phases:
    """Return the stick phases without those few that are far more off the belt's line than the others: a kick was in them."""
    segment, values = run.samples.segment, run.rest([])
    count = np.maximum(np.bincount(segment), 1)
    misfit = np.bincount(segment, values**2) / count
    present = np.bincount(segment) > 0
    off = present & (misfit > criteria.PHASE_ACCIDENT * float(np.median(misfit[present])))
    if not off.any() or off.sum() > criteria.PHASE_MOST_ACCIDENTS * present.sum():
        return run
    kept = ~off[segment]
    return dataclasses.replace(run, samples=run.samples.part(kept), values=run.values[kept], line=run.line[kept])


def _ripple_gains(
    runs: Sequence[_Phases], rests: Sequence[Array], grid: Array, stretch: float = np.inf, *, plain: bool = False
) -> Array:
    """Return the fall of chi^2 by a cosine and a sine of each frequency, with each run's own phase.

    Args:
        runs: the stick phases.
        rests: what the belt's line leaves of them.
        grid: frequencies [Hz].
        stretch: time from the first sample of each run after which there is no wave [s].
        plain: whether the noise counts with its long-run strength at all frequencies.
    """
    gains = np.zeros(len(grid))
    for run, rest in zip(runs, rests, strict=True):
        n = int(np.searchsorted(run.samples.time, run.samples.time[0] + stretch, "right"))
        seen = run.samples.time[:n], run.samples.segment[:n], run.line[:n], rest[:n]
        parts = np.array_split(grid, CORES)
        gain = np.concatenate(in_threads(lambda some, seen=seen: wave_gains(some, *seen), parts))
        gains += gain if plain else gain * noise_ratio(run.slips.noise, grid / run.slips.record.rate)
    return gains


def noise_ratio(noise: Noise, frequency: Array) -> Array:
    """Return the noise's long-run strength over that at frequencies [1/sample]: a ripple that it holds is slow noise to it."""
    turn = np.cos(2.0 * np.pi * frequency)
    slow, at = ((1.0 - noise.memory**2) / (1.0 - 2.0 * noise.memory * c + noise.memory**2) for c in (1.0, turn))
    return np.asarray((noise.white**2 + noise.coloured**2 * slow) / (noise.white**2 + noise.coloured**2 * at))


def _ringing(run: _Phases, frequency: float, ratio: float) -> list[Array]:
    since = run.samples.since_restick
    envelope = np.exp(-ratio * frequency * since)
    return [envelope * np.cos(frequency * since), envelope * np.sin(frequency * since)]


def _yielding(run: _Phases) -> list[Array]:
    """Return powers of how far the spring has been loaded in the stick phase: a contact that yields lags more and more."""
    dwell = run.samples.since_restick + run.samples.to_onset
    loaded = run.samples.since_restick / dwell
    return [loaded * dwell, loaded**2 * dwell, loaded**4 * dwell]


def _step(runs: Sequence[_Phases], rests: Sequence[Array]) -> tuple[float, list[float], int]:
    """Return the fall of chi^2 by one step within a stick phase of each run, its times [s], and how many phases jump.

    What counts is the fall beyond that by the phase's own slope: a reading that drifts, faster at times, does not jump.
    """
    total, times, jumps = 0.0, list[float](), 0
    for run, rest in zip(runs, rests, strict=True):
        best, when = 0.0, 0.0
        for segment in np.unique(run.samples.segment):
            rows = np.flatnonzero(run.samples.segment == segment)
            n = len(rows)
            if n < 10:
                continue
            time = run.samples.time[rows] - run.samples.time[rows].mean()
            mine = rest[rows] - rest[rows].mean()
            mine = mine - time * (time @ mine) / (time @ time)
            k = np.arange(1, n)
            # of a step from sample k on, less the mean and the slope that it has itself
            own = k * (n - k) / n - np.cumsum(time)[:-1] ** 2 / (time @ time)
            gains = np.cumsum(mine)[:-1] ** 2 / np.maximum(own, 1.0 / n)
            jumps += int(gains.max() > criteria.PHASE_JUMPED)
            if gains.max() > best:
                best, when = float(gains.max()), float(run.samples.time[rows[int(np.argmax(gains))]])
        total += best
        times.append(when)
    return total, times, jumps


def _belt_error(run: _Phases) -> tuple[float, float]:
    """Return the relative error of the stated belt velocity, and its standard deviation."""
    norm = run.line @ run.line
    slope, deviation = (run.line @ run.values) / norm, 1.0 / np.sqrt(norm)
    belt = run.slips.record.mechanism.belt_velocity
    return float(slope * run.deviation / belt), float(deviation * run.deviation / belt)
