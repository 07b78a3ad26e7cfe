"""Effects of the vocabulary: what records say is late, repeated or off."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import late, positions

from .enter import form


@form("sensor_delay", on=SINGLES)
def encoder_by_way_of_a_field_bus(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nilsson, Bernhardsson and Wittenmark 1998 (a position by a field bus and its buffers: the same delay always)."""
    delay = 0.022 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        return record | {name: late(record[name], record["time [s]"], delay)} if strength else record

    return Effect({"delay": delay}, measure=measure)


@form("stale_samples", on=SINGLES)
def reader_tries_again(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sinopoli and others 2004 (a reader that fails at times by chance and tries again: the last value for 30 to 90 ms)."""
    rate = 2.5 * strength

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        rows = np.arange(t.size)
        for begin in np.sort(rng.uniform(0.0, t[-1], rng.poisson(rate * t[-1]))):
            kept = (t > begin) & (t < begin + rng.uniform(0.03, 0.09))
            rows[kept] = rows[kept][:1]
        return record | {name: record[name][rows]}

    return Effect({"rate": rate}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def laser_sees_a_glint(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tukey 1960 (a laser that now and then sees a glint: a normal error of a tenth of the reach, one row in 200)."""
    share, size = strength / 200.0, 0.1 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        off = size * rng.standard_normal(record[name].size)
        return record | {name: record[name] + np.where(rng.random(off.size) < share, off, 0.0)}

    return Effect({"share": share, "size": size}, measure=measure)
