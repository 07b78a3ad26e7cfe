"""Effects of the vocabulary in further shapes: what records say is late, repeated or off."""

import numpy as np
from scipy.signal import ellip, sosfilt, sosfilt_zi

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.sensor import positions

from .enter import form

ORDER, RIPPLE, STOPS = 3, 0.5, 40.0
"""Of the elliptic filter: its order, its ripple and what it holds back [dB]."""


def lag_of_one_radian() -> float:
    """Delay of slow tones behind the filter, if it ends at 1 rad/s [s]."""
    above, below = ellip(ORDER, RIPPLE, STOPS, 1.0, analog=True)
    return float(below[-2] / below[-1] - above[-2] / above[-1])


@form("sensor_delay", on=SINGLES)
def behind_a_cauer_filter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Cauer 1958 (positions behind an elliptic anti-alias filter of third order: it ripples, and is steep)."""
    delay = 0.022 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, rate = positions(record)[0], 1.0 / float(np.median(np.diff(record["time [s]"])))
        sections = ellip(ORDER, RIPPLE, STOPS, lag_of_one_radian() / delay, fs=2.0 * np.pi * rate, output="sos")
        return record | {name: sosfilt(sections, record[name], zi=sosfilt_zi(sections) * record[name][0])[0]}

    return Effect({"delay": delay}, measure=measure)


@form("stale_samples", on=SINGLES)
def file_grows(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rosenblum and Ousterhout 1992 (a logger whose file grows: each fifth of a second it writes for longer, and repeats)."""
    every, longest = 0.2, 0.1 * strength

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        since = np.mod(t + rng.uniform(0.0, every), every)
        writes = since < longest * (0.25 + 0.75 * t / t[-1])
        writes[0] = False
        return record | {name: record[name][np.maximum.accumulate(np.where(writes, 0, np.arange(t.size)))]}

    return Effect({"longest": longest}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def wiper_lifts(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fraden 2016 (a potentiometer whose wiper lifts at one reading of 280, which goes to one end of the scale)."""
    share, end = strength / 280.0, 1.25 * bench.reach * either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        x = record[name]
        return record | {name: np.where(rng.random(x.size) < share, end, x)}

    return Effect({"share": share, "end": end}, measure=measure)
