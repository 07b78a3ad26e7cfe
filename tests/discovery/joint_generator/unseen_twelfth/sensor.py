"""Effects of the vocabulary in further shapes: what records say is late, repeated or off."""

import numpy as np
from scipy.signal import lfilter, savgol_filter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array

from .enter import form


def speed_of(x: Array, t: Array, time: float = 0.02) -> Array:
    """Speed along a record, by a running polynomial over twice that time."""
    step = float(np.median(np.diff(t)))
    return savgol_filter(x, 2 * max(3, round(time / step)) + 1, 3, deriv=1, delta=step)


@form("sensor_delay", on=SINGLES)
def four_equal_lags(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Strejc 1959 (a position that passes four lags alike: gauge, amplifier, converter and logger, a quarter each)."""
    delay = 0.022 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], positions(record)[0]
        rows = 0.25 * delay / float(np.median(np.diff(t)))
        x, kept = record[name] - record[name][0], rows / (1.0 + rows)
        for _ in range(4):
            x = lfilter([1.0 - kept], [1.0, -kept], x)
        return record | {name: record[name][0] + x}

    return Effect({"delay": delay}, measure=measure)


@form("stale_samples", on=SINGLES)
def dozes_while_slow(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ng 2003 (an optical mouse beside the joint, which saves its battery: while slow, it looks every 70 ms, or 35)."""
    apart = 0.07 * strength

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        n = max(3, round(apart / float(np.median(np.diff(t)))))
        awake = np.abs(speed_of(record[name], t)) > 0.4 * bench.speed
        seen = awake | (np.arange(t.size) % n == int(rng.integers(n)))
        seen[0] = True
        return record | {name: record[name][np.maximum.accumulate(np.where(seen, np.arange(t.size), 0))]}

    return Effect({"apart": apart}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def decimal_point_slips(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Barnett and Lewis 1994 (a display that is read by a camera: one reading of 250 is a tenth of what it should be)."""
    share = strength / 250.0

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        x = record[name]
        return record | {name: np.where(rng.random(x.size) < share, 0.1 * x, x)}

    return Effect({"share": share}, measure=measure)
