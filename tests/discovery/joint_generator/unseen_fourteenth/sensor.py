"""Effects of the vocabulary in further shapes: what records say is late, repeated or off."""

import numpy as np
from scipy.signal import bilinear, lfilter, lfilter_zi

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.sensor import positions

from .enter import form

BELOW = np.array([1.0, 1.310, 1.359, 0.577])
"""Denominator of the filter of third order that falls as steeply as one can without a ripple, for 1 rad/s."""


@form("sensor_delay", on=SINGLES)
def behind_a_papoulis_filter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Papoulis 1958 (positions behind an anti-alias filter of third order that is as steep as one can be without a ripple)."""
    delay = 0.022 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        if delay == 0.0:
            return record
        name, rate = positions(record)[0], 1.0 / float(np.median(np.diff(record["time [s]"])))
        ends = BELOW[2] / BELOW[3] / delay
        above, below = bilinear([BELOW[3]], BELOW / ends ** np.array([3.0, 2.0, 1.0, 0.0]), rate)
        return record | {name: lfilter(above, below, record[name], zi=lfilter_zi(above, below) * record[name][0])[0]}

    return Effect({"delay": delay}, measure=measure)


SENDERS = ((0.047, 0.012), (0.061, 0.02), (0.09, 0.035))
"""Period of each of the three, and for how long it keeps the bus [s]."""


@form("stale_samples", on=SINGLES)
def loses_arbitration(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tindell, Burns and Wellings 1995 (a bus on which three others go first, each in its own time: the last value stays)."""

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        waits = np.zeros(t.size, dtype=bool)
        for period, keeps in SENDERS:
            waits |= np.mod(t + rng.uniform(0.0, period), period) < keeps * strength
        waits[0] = False
        return record | {name: record[name][np.maximum.accumulate(np.where(waits, 0, np.arange(t.size)))]}

    return Effect({"strength": strength}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def dust_before_the_laser(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Thrun, Burgard and Fox 2005 (a laser that meets dust at one reading of 300: too near, by any share of the way)."""
    share, side = strength / 300.0, either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        far = 1.6 * bench.reach + side * record[name]
        near = -np.log(1.0 - rng.random(far.size) * (1.0 - np.exp(-far / bench.reach))) * bench.reach
        hit = rng.random(far.size) < share
        return record | {name: np.where(hit, side * (near - 1.6 * bench.reach), record[name])}

    return Effect({"share": share, "side": side}, measure=measure)
