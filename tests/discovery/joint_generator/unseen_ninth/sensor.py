"""Effects of the vocabulary in further shapes: what records say is late, repeated or off."""

import numpy as np
from scipy.ndimage import median_filter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import positions

from .enter import form


@form("sensor_delay", on=SINGLES)
def running_median(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tukey 1977 (a laser that shows the median of its last readings: late by half of them, and flat where it turns)."""
    delay = 0.022 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        half = max(round(delay / float(np.median(np.diff(record["time [s]"])))), 1)
        last = np.concatenate([np.full(2 * half, record[name][0]), record[name]])
        return record | {name: median_filter(last, size=2 * half + 1)[half : half + record[name].size]}

    return Effect({"delay": delay}, measure=measure)


@form("stale_samples")
def pauses_without_a_scale(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Pareto 1896; Crovella and Bestavros 1997 (a shared computer: many short pauses and a few long ones, by a power)."""
    shortest, longest, rate = 0.01 * strength, 0.16, 6.0

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        source = np.arange(t.size)
        for begin in np.sort(rng.uniform(0.0, t[-1], rng.poisson(rate * t[-1]))):
            lasts = min(shortest * (1.0 + float(rng.pareto(1.4))), longest)
            first, last = np.searchsorted(t, [begin, begin + lasts])
            source[first:last] = np.minimum(source[first:last], first)
        return record | {name: record[name][source] for name in positions(record)}

    return Effect({"shortest": shortest, "rate": rate}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def lines_beside(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merry, van de Molengraft and Steinbuch 2010 (one reading of 300 that is taken at a line beside: off by whole pitches)."""
    pitch, share = 0.05 * strength * bench.reach, 1.0 / 300.0

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        n = record[name].size
        lines = np.minimum(rng.geometric(0.6, n), 4) * rng.choice([-1.0, 1.0], n)
        return record | {name: record[name] + pitch * lines * (rng.random(n) < share)}

    return Effect({"pitch": pitch, "share": share}, measure=measure)
