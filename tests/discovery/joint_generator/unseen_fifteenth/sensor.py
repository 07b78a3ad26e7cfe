"""Effects of the vocabulary: what records say is late, repeated or off."""

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.sensor import positions

from .enter import form

LAGS = 2.0 / ((np.arange(1, 5) - 0.5) * np.pi) ** 2
"""First lags of a long thin tube, as shares of its delay; all of them add up to 1."""


@form("sensor_delay", on=SINGLES)
def pneumatic_transmitter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rohmann and Grogan 1957 (a position sent as air pressure through a long thin tube: it diffuses, a row of lags)."""
    delay = 0.022 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], positions(record)[0]
        rows = delay / float(np.median(np.diff(t)))
        x = record[name] - record[name][0]
        for lag in rows * np.append(LAGS, 1.0 - LAGS.sum()):
            kept = lag / (1.0 + lag)
            x = lfilter([1.0 - kept], [1.0, -kept], x)
        return record | {name: record[name][0] + x} if delay else record

    return Effect({"delay": delay}, measure=measure)


@form("stale_samples", on=SINGLES)
def camera_in_changing_light(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nourani-Vatani and Roberts 2007 (a camera that sets its time by the light: a frame each 12 to 60 ms, as clouds pass)."""
    shortest, longest = 0.012 * strength, 0.06 * strength

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        dark = np.sin(np.pi * (1.3 * t / bench.duration + rng.uniform(0.0, 1.0))) ** 2
        step = np.diff(t, prepend=t[0])
        frame = np.floor(np.cumsum(step / np.maximum(shortest + (longest - shortest) * dark, step.max())) + rng.random())
        new = np.diff(frame, prepend=-1.0) > 0.0
        return record | {name: record[name][np.maximum.accumulate(np.where(new, np.arange(t.size), 0))]} if strength else record

    return Effect({"shortest": shortest, "longest": longest}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def echo_there_and_back_twice(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kuc and Siegel 1987 (an ultrasonic gauge that takes the echo of an echo at one reading of 320: twice as far away)."""
    share, side = strength / 320.0, either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        far = 1.3 * bench.reach + side * record[name]
        return record | {name: np.where(rng.random(far.size) < share, record[name] + side * far, record[name])}

    return Effect({"share": share, "side": side}, measure=measure)
