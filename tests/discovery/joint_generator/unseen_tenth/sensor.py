"""Effects of the vocabulary in further shapes: what records say is late, repeated or off."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import positions

from .enter import form


@form("sensor_delay", on=SINGLES)
def polygon_of_the_last_cycle(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Franklin, Powell and Workman 1998 (a drive that draws lines between readings of its bus: late by a whole cycle)."""
    delay = 0.022 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        step = float(np.median(np.diff(t)))
        n = max(round(delay / step), 3)
        read = np.arange(int(rng.integers(n)), t.size, n)
        return record | {name: np.interp(t - n * step, t[read], record[name][read])}

    return Effect({"delay": delay}, measure=measure)


@form("stale_samples", on=SINGLES)
def dirt_on_the_scale(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fleming 2013 (a scale that is soiled at four places: its head shows the last good reading until it is past one)."""
    half, places = (
        0.025 * strength * bench.reach,
        bench.reach * (np.array([-0.55, -0.15, 0.2, 0.6]) + rng.uniform(-0.1, 0.1, 4)),
    )

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        x = record[name]
        seen = np.all(np.abs(x[:, None] - places) > half, axis=1)
        seen[0] = True
        return record | {name: x[np.maximum.accumulate(np.where(seen, np.arange(x.size), 0))]}

    return Effect({"half": half}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def sparks_of_a_contactor(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ott 2009 (fast transients on a line: a reading that is off to one side, the next one to the other; one of 400)."""
    size, share = 0.05 * strength * bench.reach, 1.0 / 400.0

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        n = record[name].size
        sparks = (rng.random(n) < share) * size * rng.uniform(0.5, 1.5, n) * rng.choice([-1.0, 1.0], n)
        return record | {name: record[name] + sparks - 0.8 * np.concatenate([[0.0], sparks[:-1]])}

    return Effect({"size": size, "share": share}, measure=measure)
