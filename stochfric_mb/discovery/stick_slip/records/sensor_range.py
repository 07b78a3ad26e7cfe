"""The ends of the sensor's range: where records stay level although the box goes on."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence

import numpy as np

from stochfric_mb.discovery import criteria
from stochfric_mb.discovery.stick_slip.records.record import Array
from stochfric_mb.discovery.stick_slip.records.slips import Slips

QUIETEST = 3.0e-7
"""Noise that is always allowed, over the deflection of the spring under the normal force [-]."""


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
