"""Effects of the vocabulary: what records say is late, repeated or off."""

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import positions

from .enter import form


@form("sensor_delay", on=SINGLES)
def low_pass_before_the_converter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fraden 2016 (a gauge whose amplifier has a low pass of first order: late by its time constant)."""
    delay = 0.022 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], positions(record)[0]
        kept = np.exp(-float(np.median(np.diff(t))) / delay) if strength else 0.0
        shown, _ = lfilter([1.0 - kept], [1.0, -kept], record[name], zi=[kept * record[name][0]])
        return record | {name: shown}

    return Effect({"delay": delay}, measure=measure)


LOST = 0.02
"""Seconds that a spell of lost telegrams lasts in the mean."""


@form("stale_samples", on=SINGLES)
def telegrams_lost_in_spells(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gilbert 1960 (a line of two states, good and bad: in the bad one telegrams are lost, and the last value stays)."""
    rate = 6.0 * strength

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        step = float(np.median(np.diff(t)))
        good = np.ones(t.size, dtype=bool)
        for begin in 1 + np.flatnonzero(rng.random(t.size - 1) < rate * step):
            good[begin : begin + rng.geometric(min(step / LOST, 1.0))] = False
        return record | {name: record[name][np.maximum.accumulate(np.where(good, np.arange(t.size), 0))]}

    return Effect({"rate": rate}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def sparks_of_a_welder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tukey 1960 (a welder beside the cable: one reading of 300 has a normal error as large as a twentieth of the reach)."""
    share, size = 1.0 / 300.0, 0.05 * strength * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        hit = rng.random(record[name].size) < share
        return record | {name: record[name] + size * hit * rng.standard_normal(hit.size)}

    return Effect({"share": share, "size": size}, measure=measure)
