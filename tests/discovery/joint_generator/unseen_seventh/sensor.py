"""Effects of the vocabulary in further shapes: what records say is late, repeated or off."""

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import positions

from .enter import form


@form("sensor_delay", on=SINGLES)
def linear_phase(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Crochiere and Rabiner 1983 (positions from a converter behind a filter that delays all tones by half its length)."""
    delay = 0.022 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], positions(record)[0]
        n = max(round(delay / float(np.median(np.diff(t)))), 2)
        taps, start = np.hamming(2 * n + 1), record[name][0]
        return record | {name: start + lfilter(taps / taps.sum(), [1.0], record[name] - start)}

    return Effect({"delay": delay}, measure=measure)


@form("stale_samples", also=("sensor_delay",))
def radio_link(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nilsson, Bernhardsson and Wittenmark 1998 (a radio link: news comes by chance, every 25 ms in the mean)."""
    mean = 0.025 * strength

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        arrive = np.cumsum(np.minimum(rng.exponential(mean, int(3.0 * t[-1] / mean) + 20), 6.0 * mean))
        news = np.searchsorted(arrive, t, side="right") - 1
        source = np.where(news >= 0, np.searchsorted(t, arrive[np.maximum(news, 0)]), 0)
        source = np.minimum(source, np.arange(t.size))
        return record | {name: record[name][source] for name in positions(record)}

    return Effect({"mean": mean}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def second_reflection(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Dorsch, Hausler and Herrmann 1994 (a laser that sees a second reflection in one sample of 300, always as far off)."""
    size, share = 0.05 * strength * bench.reach, 1.0 / 300.0

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        return record | {name: record[name] + size * (rng.random(record[name].size) < share)}

    return Effect({"size": size, "share": share}, measure=measure)
