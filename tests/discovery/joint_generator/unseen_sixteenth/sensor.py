"""Effects of the vocabulary: what records say is late, repeated or off."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import positions

from .enter import form

TURN = 2.0 * np.pi


@form("sensor_delay", on=SINGLES)
def buffer_of_a_wireless_link(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ramjee, Kurose, Towsley and Schulzrinne 1994 (a position by radio, behind a buffer that adapts: a delay that swings)."""
    delay, swing, waves = 0.022 * strength * rng.uniform(0.8, 1.2), 0.3, rng.uniform(2.0, 3.5)

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        late = delay * (1.0 + swing * np.sin(TURN * (waves * t / bench.duration + rng.uniform(0.0, 1.0))))
        return record | {name: np.interp(t - late, t, record[name])} if strength else record

    return Effect({"delay": delay, "swing": swing, "waves": waves}, measure=measure)


@form("stale_samples", on=SINGLES)
def film_shown_as_video(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Poynton 2003 (a position from a film shown as video: each frame stays for two, then three fields of a sixtieth)."""
    field = strength / 60.0

    def measure(record: Record, rng: Generator) -> Record:
        if not strength:
            return record
        t, name = record["time [s]"], positions(record)[0]
        fields = np.floor(t / field + rng.uniform(0.0, 5.0))
        frame = 2.0 * np.floor(fields / 5.0) + (np.mod(fields, 5.0) >= 2.0)
        new = np.diff(frame, prepend=-1.0) > 0.0
        return record | {name: record[name][np.maximum.accumulate(np.where(new, np.arange(t.size), 0))]}

    return Effect({"field": field}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def digits_change_places(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Damerau 1964 (a reading in thousandths of the reach, whose tens and hundreds change places one time in 220)."""
    share, unit = strength / 220.0, 1e-3 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        digits = np.floor(record[name] / unit + 5000.0)
        tens, hundreds = np.mod(np.floor(digits / 10.0), 10.0), np.mod(np.floor(digits / 100.0), 10.0)
        off = 90.0 * unit * (tens - hundreds)
        return record | {name: record[name] + np.where(rng.random(off.size) < share, off, 0.0)}

    return Effect({"share": share, "unit": unit}, measure=measure)
