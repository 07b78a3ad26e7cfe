"""Effects of the vocabulary: what records say is late, repeated or off."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions

from .enter import form


@form("sensor_delay", on=SINGLES)
def roams_between_access_points(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mishra, Shin and Arbaugh 2003 (a position by radio that roams between two access points: one delay, or twice that)."""
    delay = 0.015 * strength * rng.uniform(0.85, 1.15)

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        roams = np.cumsum(rng.uniform(1.2, 2.8, 40))
        late = delay * (1.0 + np.mod(np.searchsorted(roams, t) + rng.integers(2), 2))
        return record | {name: np.interp(t - late, t, record[name])} if strength else record

    return Effect({"delay": delay}, measure=measure)


LOST = 0.4


@form("stale_samples", on=SINGLES)
def telegrams_lost_by_chance(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sinopoli and others 2004 (a radio sensor that sends every 18 ms, of whose telegrams two of five are lost)."""
    cycle = 0.018 * strength

    def measure(record: Record, rng: Generator) -> Record:
        if not strength:
            return record
        t, name = record["time [s]"], positions(record)[0]
        sent = np.floor(t / cycle + rng.uniform(0.0, 1.0)).astype(int)
        got = rng.random(int(sent[-1]) + 1) >= LOST
        new = (np.diff(sent, prepend=-1) > 0) & got[sent]
        return record | {name: record[name][np.maximum.accumulate(np.where(new, np.arange(t.size), 0))]}

    return Effect({"cycle": cycle}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def multiplexer_at_the_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sheingold 1986 (a multiplexer that at one reading of 220 is still at the drive's channel: that share of its scale)."""
    share = strength / 220.0

    def measure(record: Record, rng: Generator) -> Record:
        name, drive = positions(record)[0], record[drives(record)[0]]
        other = 1.2 * bench.reach * drive / np.abs(drive).max()
        return record | {name: np.where(rng.random(drive.size) < share, other, record[name])}

    return Effect({"share": share}, measure=measure)
