"""Effects of the vocabulary in further shapes: what records say is late, repeated or off."""

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.sensor import late, positions

from .enter import form


@form("sensor_delay", on=SINGLES)
def dead_time_and_lag(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ziegler and Nichols 1942 (positions after a dead time and a lag, half of the delay each)."""
    each = 0.012 * strength * rng.uniform(0.8, 1.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name = record["time [s]"], positions(record)[0]
        shown = late(record[name], t, each)
        kept = float(np.exp(-float(np.median(np.diff(t))) / each))
        return record | {name: lfilter([1.0 - kept], [1.0, -kept], shown, zi=[kept * shown[0]])[0]}

    return Effect({"delay": 2.0 * each}, measure=measure)


@form("stale_samples", also=("sensor_delay",))
def token_goes_round(rng: Generator, strength: float, bench: Bench) -> Effect:
    """IEEE 802.4-1990 (a bus whose token comes back after 16, 48, 26 and 34 ms in turn; between, no news)."""
    slots = np.array([0.016, 0.048, 0.026, 0.034]) * strength

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        starts = np.cumsum(np.tile(slots, int(t[-1] / slots.sum()) + 2)) - rng.uniform(0.0, slots.sum())
        news = np.maximum(np.searchsorted(starts, t, side="right") - 1, 0)
        source = np.minimum(np.searchsorted(t, starts[news]), np.arange(t.size))
        return record | {name: record[name][source] for name in positions(record)}

    return Effect({"longest": float(slots.max())}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def clicks_that_ring(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Godsill and Rayner 1998 (one click in four hundred samples, each of which rings over four)."""
    size, share = 0.05 * strength * bench.reach, 0.0025

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        n = record[name].size
        hit = (rng.random(n) < share) * size * rng.standard_normal(n)
        return record | {name: record[name] + lfilter([1.0, -0.7, 0.45, -0.25], [1.0], hit)}

    return Effect({"size": size, "share": share}, measure=measure)
