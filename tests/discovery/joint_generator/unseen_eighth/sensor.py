"""Effects of the vocabulary in further shapes: what records say is late, repeated or off."""

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import positions

from .enter import form


@form("sensor_delay", on=SINGLES)
def all_pass(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Regalia, Mitra and Vaidyanathan 1988 (positions behind three all-pass sections: late, and not smoothed)."""
    delay = 0.024 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], positions(record)[0]
        k = delay / 3.0 / float(np.median(np.diff(t)))
        kept, start = (1.0 - k) / (1.0 + k), record[name][0]
        shown = record[name] - start
        for _ in range(3):
            shown = lfilter([kept, 1.0], [1.0, kept], shown)
        return record | {name: start + shown}

    return Effect({"delay": delay}, measure=measure)


@form("stale_samples")
def backs_off_after_collisions(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Metcalfe and Boggs 1976 (a shared cable: after a collision the pauses between telegrams double, four times over)."""
    slot, rate = 0.005 * strength, 2.5

    def measure(record: Record, rng: Generator) -> Record:
        t, n = record["time [s]"], record["time [s]"].size
        source = np.arange(n)
        for begin in rng.uniform(0.0, t[-1], rng.poisson(rate * t[-1])):
            for pause in 2.0 ** np.arange(5):
                first = int(np.searchsorted(t, begin + slot * (pause - 1.0)))
                last = int(np.searchsorted(t, begin + slot * (2.0 * pause - 1.0)))
                source[first:last] = np.minimum(source[first:last], min(first, n - 1))
        return record | {name: record[name][source] for name in positions(record)}

    return Effect({"slot": slot, "rate": rate}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def bit_flips(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hamming 1950 (one reading of 350 in which one of its upper bits is flipped: off by a power of two, to either side)."""
    size, share = 0.12 * strength * bench.reach, 1.0 / 350.0

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        x = record[name]
        flipped = 0.5 ** rng.integers(0, 5, x.size) * rng.choice([-1.0, 1.0], x.size)
        return record | {name: x + size * flipped * (rng.random(x.size) < share)}

    return Effect({"size": size, "share": share}, measure=measure)
