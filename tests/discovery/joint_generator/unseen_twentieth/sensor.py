"""Effects of the vocabulary as laboratories meet them: what records say is late, repeated or off."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import late, positions
from tests.discovery.joint_generator.plant import Array

from .enter import form


@form("sensor_delay", on=SINGLES)
def camera_needs_its_time(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Corke 1993 (positions of a camera whose exposure and computing take the same time at each row: all late by it)."""
    delay = 0.02 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        return record | {name: late(record[name], record["time [s]"], delay)}

    return Effect({"delay": delay}, measure=measure)


def lost_in_bursts(rng: Generator, n: int, begins: float, ends: float) -> Array:
    """Which of the rows are lost: runs of lost and of kept ones, each of geometric length."""
    lost = np.zeros(n, dtype=bool)
    if begins <= 0.0:
        return lost
    row = int(rng.geometric(begins))
    while row < n:
        length = int(rng.geometric(ends))
        lost[row : row + length] = True
        row += length + int(rng.geometric(begins))
    return lost


@form("stale_samples", on=SINGLES)
def radio_link_fades(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gilbert 1960 (a radio link that is good or bad, and changes by chance: while it is bad the last position stays)."""
    fades, lasts = 4.0 * strength, 0.03

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        step = float(np.median(np.diff(t)))
        lost = lost_in_bursts(rng, t.size, fades * step, min(step / lasts, 1.0))
        lost[0] = False
        return record | {name: record[name][np.maximum.accumulate(np.where(lost, 0, np.arange(t.size)))]}

    return Effect({"fades": fades, "lasts": lasts}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def one_bit_of_a_word_flips(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hamming 1950 (a serial encoder without a check: in one word of 300 one of four bits is the other way round)."""
    share, least = strength / 300.0, 0.02 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        x = record[name]
        word, bit = np.floor(x / least).astype(np.int64), np.int64(1) << rng.integers(0, 4, x.size)
        return record | {name: np.where(rng.random(x.size) < share, x + least * ((word ^ bit) - word), x)}

    return Effect({"share": share, "least": least}, measure=measure)
