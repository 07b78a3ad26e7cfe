"""Effects of the vocabulary as laboratories meet them: what records say is late, repeated or off."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import late, positions

from .enter import form


@form("sensor_delay", on=SINGLES)
def cycles_of_a_field_bus(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nilsson, Bernhardsson and Wittenmark 1998 (positions that come over a field bus: a few of its cycles late, always)."""
    delay = 0.02 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        return record | {name: late(record[name], record["time [s]"], delay) if delay > 0.0 else record[name]}

    return Effect({"delay": delay}, measure=measure)


@form("stale_samples", on=SINGLES)
def link_sends_again(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hespanha, Naghshtabrizi and Xu 2007 (a link that loses packets and sends again: the last value holds meanwhile)."""
    rate, mean = 5.0 * strength, 0.03

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        begins = rng.uniform(0.0, t[-1], rng.poisson(rate * t[-1]))
        waits = np.zeros(t.size, dtype=bool)
        for begin, lasts in zip(begins, rng.exponential(mean, begins.size), strict=True):
            waits |= (t > begin) & (t < begin + lasts)
        return record | {name: record[name][np.maximum.accumulate(np.where(waits, 0, np.arange(t.size)))]}

    return Effect({"rate": rate, "mean": mean}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def wiper_lifts_off_its_track(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tukey 1960 (a potentiometer whose wiper lifts off at one reading of 250: off to either side, as a normal law is)."""
    size, share = 0.07 * strength * bench.reach, 1.0 / 250.0

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        x = record[name]
        return record | {name: x + size * rng.standard_normal(x.size) * (rng.random(x.size) < share)}

    return Effect({"size": size, "share": share}, measure=measure)
