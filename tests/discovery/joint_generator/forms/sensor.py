"""What records say is late, stale or off."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.plant import Array

from .form import JOINTS, Effect, Generator, Record, form


def positions(record: Record) -> list[str]:
    """Columns that hold positions."""
    return [name for name in record if name.startswith("position") or "angle" in name]


def late(x: Array, time: Array, delay: float) -> Array:
    """A signal that comes `delay` late."""
    return np.interp(time - delay, time, x)


@form("sensor_delay", on=("slide", "hinge", "mjcf_slide", "mjcf_hinge"))
def pure_delay(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A telegram that takes its time."""
    delay = max(0.02 * strength * rng.uniform(0.7, 1.3), 4.0 / bench.rate)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t = record["time [s]"]
        return record | {name: late(record[name], t, delay) for name in positions(record)}

    return Effect({"delay": delay}, measure=measure)


@form("sensor_delay", on=("slide", "hinge", "mjcf_slide", "mjcf_hinge"))
def filtered(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A moving average in the encoder's electronics."""
    n = max(4, round(0.03 * strength * rng.uniform(0.7, 1.3) * bench.rate))

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        changed = {}
        for name in positions(record):
            padded = np.concatenate([np.full(n - 1, record[name][0]), record[name]])
            total = np.concatenate([[0.0], np.cumsum(padded)])
            changed[name] = (total[n:] - total[:-n]) / n
        return record | changed

    return Effect({"delay": 0.5 * (n - 1) / bench.rate}, measure=measure)


@form("sensor_delay", on=("arm",))
def one_late_encoder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Of two encoders one comes late."""
    delay = max(0.015 * strength * rng.uniform(0.7, 1.3), 4.0 / bench.rate)
    which = int(rng.integers(2))

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[which]
        return record | {name: late(record[name], record["time [s]"], delay)}

    return Effect({"delay": delay, "which": float(which)}, measure=measure)


@form("stale_samples", on=JOINTS)
def repeated(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A bus that drops telegrams: the last value is repeated for 5 to 30 ms, several times a second."""
    rate = 6.0 * strength

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        changed = {name: record[name].copy() for name in positions(record)}
        for begin in rng.integers(1, t.size - 2, rng.poisson(rate * t[-1])):
            end = begin + max(3, round(rng.uniform(0.005, 0.03) * bench.rate))
            for x in changed.values():
                x[begin:end] = x[begin]
        return record | changed

    return Effect({"rate": rate}, measure=measure)


@form("sensor_outliers", on=("slide", "hinge", "mjcf_hinge"))
def spikes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Single positions that are far off."""
    size, share = 0.05 * strength * bench.reach, rng.uniform(0.001, 0.003)

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        x = record[name]
        hit = rng.random(x.size) < share
        return record | {name: x + hit * size * rng.uniform(0.4, 1.6, x.size) * rng.choice([-1.0, 1.0], x.size)}

    return Effect({"size": size, "share": share}, measure=measure)
