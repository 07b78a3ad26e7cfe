"""The ends of the sensor's range: where records stay level although the box goes on, or bend over by and by.

Between a bottom and the top that follows, the belt carries the box along evenly, and reading + D(reading) = where the belt has
carried the box. D gets steeper towards an end of the range where the sensor shows less and less of the motion.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator, Sequence

import numpy as np
from scipy.optimize import nnls
from scipy.signal import find_peaks

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import Slips

QUIETEST = 3.0e-7
"""Noise that is always allowed, over the deflection of the spring under the normal force [-]."""

KNOTS = 16
"""Most places of the range at which the reading may bend; between quantiles of what stick phases show."""
ENDS = 0.05, 0.97
"""The first and the last of these quantiles [-]."""
MEANS = 30
"""Means of samples that stand for a stick phase."""
SWING = 0.4
"""Depth of a bottom, over the range of the record, from which on it is one [-]."""
MARGIN = 0.6
"""What is left out at both ends of a stick phase, as an angle of the natural oscillation [rad]."""
BELT = 0.003
"""Prior deviation of the belt's speed from what is stated, over that [-]: an error of all readings alike is no bend."""


@dataclasses.dataclass(frozen=True)
class SensorRange:
    """The sensor's range, as far as the records reach its ends."""

    share: float
    """Largest share of the visits to an end that are level [-]."""
    low: float
    """Lower end [m]; -inf where it is not reached."""
    high: float
    """Upper end [m]; inf where it is not reached."""

    @property
    def clipped(self) -> bool:
        """Whether an end is reached."""
        return self.low > -np.inf or self.high < np.inf


@dataclasses.dataclass(frozen=True)
class _End:
    """A run's visits to one of its ends."""

    share: float
    """Share of them that are level [-]."""
    level: float
    """Where the end is [m], not mirrored."""


def sensor_range(slips: Sequence[Slips]) -> SensorRange:
    """Return the range of the sensor."""
    share, result = 0.0, {-1: -np.inf, 1: np.inf}
    for side in (1, -1):
        # an upper end of a mirrored record is a lower end of the sensor
        ends = [_end(s, side * s.record.direction, side) for s in slips]
        share = max(share, *(end.share for end in ends))
        levels = [side * end.level for end in ends if end.share > criteria.LEVEL_VISITS]
        # a sensor has one range: where runs differ, it reaches as far as any of them
        if levels and not any(_goes_beyond(s, side, side * max(levels)) for s in slips):
            result[side] = side * max(levels)
    return SensorRange(share, result[-1], result[1])


def _end(slips: Slips, mirrored_side: int, side: int) -> _End:
    """Return how often a run stays level at its upper (1) or lower (-1) end.

    Counted are the visits in which the record is level, within its noise, for longer than the belt takes to cross the
    noise. A box that turns round smoothly is not level: if it seems to be in single visits, it is not in their mean.
    """
    record = slips.record
    noise = max(slips.noise.deviation, QUIETEST * record.deflection)
    raw = mirrored_side * record.raw
    top = float(np.quantile(raw, 0.9995)) - 2.0 * noise
    cross = 8.0 * noise / record.mechanism.belt_velocity * record.rate
    level, visits = 0, 0
    bows: list[float] = []
    for visit in _visits(raw, top - 4.0 * noise):
        visits += 1
        margin = int(cross / 2) + 2  # on the belt's way to the end, or from it, noise alone tells where it begins
        inner = visit[margin:-margin]
        if len(inner) < max(2.0 * cross, 15):
            continue
        error = noise / np.sqrt(len(inner) / 3.0)
        bow, tilt = _bow(inner)
        level += int(max(abs(bow), tilt) < criteria.LEVEL_SHARP * error and inner.std() < 1.5 * noise)
        # towards both ends a clipped record rounds off, where the noise or a force takes it over the end and back
        cut = int(0.5 * (1.0 - criteria.LEVEL_MIDDLE) * len(inner))
        middle = inner[cut : len(inner) - cut]
        bows.append(_bow(middle)[0] / (noise * np.sqrt(4.5 / len(middle))))
    smooth = abs(np.sum(bows)) > criteria.LEVEL_ROUND * np.sqrt(len(bows))
    share = level / visits if level >= criteria.FEWEST_VISITS and not smooth else 0.0
    return _End(share, side * float(np.median(raw[raw > top])))


def _bow(visit: Array) -> tuple[float, float]:
    """Return by how much the middle third lies above the outer ones [m], and how far those are apart [m]."""
    first, middle, last = (float(part.mean()) for part in np.array_split(visit, 3))
    return middle - 0.5 * (first + last), abs(last - first)


def _visits(raw: Array, above: float) -> Iterator[Array]:
    """Yield the pieces of a record above a level; gaps of a few samples are noise."""
    samples = np.flatnonzero(raw > above)
    for visit in filter(len, np.split(samples, np.flatnonzero(np.diff(samples) > 8) + 1)):
        yield raw[visit[0] : visit[-1] + 1]


def _goes_beyond(slips: Slips, side: int, level: float) -> bool:
    """Return whether a run shows positions beyond an end."""
    beyond = side * (slips.record.direction * slips.record.raw - level) > criteria.RANGE_BEYOND * slips.noise.deviation
    return bool(beyond.mean() > criteria.RANGE_BEYOND_SHARE)


@dataclasses.dataclass(frozen=True)
class ReadingCurve:
    """A reading that bends over."""

    score: float
    """Fall of chi^2 of the stick phases less what its numbers cost [-]."""
    share: float
    """Share of what they show beyond noise that it explains [-]; 0 where that is nothing."""
    position: Array
    """Where the box is [m], rising, not mirrored, shape (n,)."""
    reading: Array
    """What the sensor shows there [m], shape (n,)."""

    @property
    def slopes(self) -> tuple[float, float]:
        """Slope of the reading over the position at the lower and at the upper end [-]."""
        slope = np.diff(self.reading) / np.diff(self.position)
        return float(slope[0]), float(slope[-1])

    @property
    def bends(self) -> bool:
        """Whether it is sure, explains stick as a name must, and hides the larger half of the motion at an end."""
        sure = self.score > criteria.NAMED and self.share > criteria.STICK_EXPLAINED
        return sure and min(self.slopes) < criteria.HIDES


@dataclasses.dataclass(frozen=True)
class _Flank:
    """Means of samples of a stick phase, not mirrored."""

    reading: Array
    """[m]."""
    carried: Array
    """How far the belt has gone [m]."""
    deviation: float
    """Standard deviation of a mean [m]."""


def reading_curve(slips: Sequence[Slips]) -> ReadingCurve | None:
    """Return how the reading bends over; None where there is hardly any stick."""
    flanks = [flank for s in slips for flank in _flanks(s)]
    if len(flanks) < criteria.FEWEST_PHASES:
        return None
    shown = np.concatenate([f.reading for f in flanks])
    knots = np.unique(np.quantile(shown, np.linspace(*ENDS, KNOTS)))  # of coarse readings some are the same
    bends, free = (np.concatenate(parts) for parts in zip(*(_rows(f, knots) for f in flanks), strict=True))
    design = np.r_[bends, np.c_[np.zeros((2, 2 * len(knots))), np.eye(2) / BELT]]
    target = np.r_[free, 0.0, 0.0]
    size = np.maximum(np.linalg.norm(design, axis=0), 1.0e-300)
    best, left = nnls(design / size, target)
    before = nnls((design / size)[:, -2:], target)[1] ** 2
    steeper = best[:-2] / size[:-2]
    freedom = len(free) - len(flanks) - 1
    gain = before - left**2
    score = gain - np.count_nonzero(steeper) * np.log(freedom)
    reading = np.unique(np.r_[shown.min(), knots, shown.max()])
    position = reading + _hinges(reading, knots) @ steeper
    share = gain / (before - freedom) if before > freedom else 0.0
    return ReadingCurve(float(score), float(share), position, reading)


def _rows(flank: _Flank, knots: Array) -> tuple[Array, Array]:
    """Return regressors, shape (n, 2 len(knots) + 2), and what they are to explain, shape (n,), in standard deviations."""
    columns = np.c_[_hinges(flank.reading, knots), -flank.carried, flank.carried]
    missed = flank.carried - flank.reading
    return (columns - columns.mean(axis=0)) / flank.deviation, (missed - missed.mean()) / flank.deviation


def _hinges(reading: Array, knots: Array) -> Array:
    """Return what is added to a reading that gets steeper above each knot, and below each, shape (n, 2 len(knots))."""
    away = reading[:, None] - knots
    return np.c_[np.maximum(away, 0.0), np.minimum(away, 0.0)]


def _flanks(slips: Slips) -> Iterator[_Flank]:
    """Yield what stick phases show, from bottoms to tops: where a reading bends over, slips are not told so well."""
    record = slips.record
    smooth, margin = record.direction * record.motion[0], record.samples(MARGIN)
    bottoms = find_peaks(-smooth, prominence=SWING * float(np.ptp(smooth)))[0]
    for bottom, following in itertools.pairwise(bottoms):
        first = bottom + margin
        last = bottom + int(np.argmax(smooth[bottom:following])) - margin
        width = max((last - first) // MEANS, 1)
        count = (last - first) // width
        if count < MEANS // 2:
            continue
        part = slice(first, first + count * width)
        reading, time = (x[part].reshape(count, width).mean(axis=1) for x in (record.position, record.time))
        belt = record.direction * record.mechanism.belt_velocity
        yield _Flank(record.direction * reading, belt * time, slips.noise.of_mean(width))
