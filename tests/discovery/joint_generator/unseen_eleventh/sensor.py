"""Effects of the vocabulary in further shapes: what records say is late, repeated or off."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import late, positions

from .enter import form


@form("sensor_delay", on=SINGLES)
def averages_and_then_sends(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Corke 1996 (a tracker that exposes for a while, and needs as long again to find the mark: a mean, and a dead time)."""
    exposure = 0.016 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], positions(record)[0]
        n = max(round(exposure / float(np.median(np.diff(t)))), 2)
        total = np.cumsum(np.concatenate([np.zeros(1), np.full(n - 1, record[name][0]), record[name]]))
        return record | {name: late((total[n:] - total[:-n]) / n, t, exposure)}

    return Effect({"delay": 1.5 * exposure}, measure=measure)


@form("stale_samples", on=SINGLES)
def telegrams_fail_under_current(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ott 2009 (an encoder's cable beside the motor's: telegrams of 8 ms fail by the square of the current; the last stays)."""
    most, length = 0.75 * strength, 0.008

    def measure(record: Record, rng: Generator) -> Record:
        t, name, drive = record["time [s]"], positions(record)[0], np.abs(record[drives(record)[0]])
        telegram = ((t - t[0]) / length).astype(int)
        chance = most * np.minimum(drive / np.quantile(drive, 0.95), 1.0) ** 2
        first = np.flatnonzero(np.diff(telegram, prepend=-1))
        fails = rng.random(first.size) < chance[first]
        fails[0] = False
        seen = ~fails[telegram]
        return record | {name: record[name][np.maximum.accumulate(np.where(seen, np.arange(t.size), 0))]}

    return Effect({"most": most}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def minus_is_lost(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rahm and Do 2000 (a serial line that loses a character: at one reading of 130 below zero its minus)."""
    share = strength / 130.0

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        x = record[name]
        return record | {name: np.where(rng.random(x.size) < share, np.abs(x), x)}

    return Effect({"share": share}, measure=measure)
