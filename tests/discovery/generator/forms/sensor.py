"""The position sensor is at fault, the rig is not."""

from collections.abc import Callable

import numpy as np

from tests.discovery.generator.curve import Array
from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, Record, either_sign, form

_POSITION, _TIME = "position [m]", "time [s]"


def _position(change: Callable[[Array, Array, Generator], Array]) -> Callable[[Record, Generator], Record]:
    """A change (time, position, rng) -> position as a change of the record."""
    return lambda record, rng: record | {_POSITION: change(record[_TIME], record[_POSITION], rng)}


@form("sensor_drift")
def linear(rng: Generator, strength: float, rig: Rig) -> Effect:
    rate = 0.12 * rig.slip_length / 60.0 * strength * either_sign(rng)
    return Effect({"rate": rate}, measure=_position(lambda time, x, _: x + rate * time))


@form("sensor_drift")
def square_root(rng: Generator, strength: float, rig: Rig) -> Effect:
    total = 0.12 * rig.slip_length * strength * either_sign(rng)
    return Effect({"at_60_s": total}, measure=_position(lambda time, x, _: x + total * np.sqrt(time / 60.0)))


@form("sensor_step")
def one_step(rng: Generator, strength: float, rig: Rig) -> Effect:
    height = 0.07 * rig.slip_length * strength * either_sign(rng)
    return Effect(
        {"height": height},
        measure=_position(lambda time, x, rng: x + height * (time > time[-1] * rng.uniform(0.25, 0.75))),
    )


@form("sensor_step")
def there_and_back(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A loose mount that jumps out and in again."""
    height = 0.07 * rig.slip_length * strength * either_sign(rng)

    def change(time: Array, x: Array, rng: Generator) -> Array:
        out, back = time[-1] * rng.uniform(0.2, 0.4), time[-1] * rng.uniform(0.6, 0.8)
        return x + height * ((time > out) & (time < back))

    return Effect({"height": height}, measure=_position(change))


def _clip(share: float, *, low: bool, high: bool) -> Callable[[Record, Generator], Record]:
    """Clip this share of the range that the run would show."""

    def change(time: Array, x: Array, rng: Generator) -> Array:
        del time, rng
        bottom, top = np.quantile(x, [0.002, 0.998])
        margin = share * (top - bottom)
        return np.clip(x, bottom + margin if low else -np.inf, top - margin if high else np.inf)

    return _position(change)


@form("sensor_clipping")
def top(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    share = strength * rng.uniform(0.1, 0.15)
    return Effect({"share": share}, measure=_clip(share, low=False, high=True))


@form("sensor_clipping")
def both_ends(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    share = strength * rng.uniform(0.08, 0.12)
    return Effect({"share": share}, measure=_clip(share, low=True, high=True))


@form("sensor_outliers")
def spikes(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Single samples that are far off."""
    size, rate = 0.25 * rig.slip_length * strength, rng.uniform(0.001, 0.004)

    def change(time: Array, x: Array, rng: Generator) -> Array:
        hit = rng.random(time.size) < rate
        return x + hit * size * rng.uniform(0.4, 1.6, time.size) * rng.choice([-1.0, 1.0], time.size)

    return Effect({"size": size, "rate": rate}, measure=_position(change))


@form("sensor_outliers")
def heavy_tails(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A few samples have Cauchy noise, limited by the sensor's range."""
    del rig
    scale, rate = 6e-5 * strength, rng.uniform(0.005, 0.015)

    def change(time: Array, x: Array, rng: Generator) -> Array:
        hit = rng.random(time.size) < rate
        return x + hit * np.clip(scale * rng.standard_cauchy(time.size), -2e-3, 2e-3)

    return Effect({"scale": scale, "rate": rate}, measure=_position(change))


@form("sensor_outliers")
def dropouts(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Two or three samples in a row read a wrong level."""
    level, rate = -0.3 * rig.slip_length * strength, rng.uniform(0.3, 0.8)

    def change(time: Array, x: Array, rng: Generator) -> Array:
        changed = x.copy()
        for begin in rng.integers(0, time.size - 4, rng.poisson(rate * time[-1])):
            changed[begin : begin + rng.integers(2, 4)] += level
        return changed

    return Effect({"level": level, "rate": rate}, measure=_position(change))


@form("sensor_delay")
def pure_delay(rng: Generator, strength: float, rig: Rig) -> Effect:
    """The position comes late; the velocity does not."""
    del rig
    delay = 0.02 * strength * rng.uniform(0.7, 1.3)
    return Effect(
        {"delay": delay}, measure=_position(lambda time, x, _: np.interp(time - delay, time, x)), channels=("velocity",)
    )


@form("sensor_delay")
def buffered(rng: Generator, strength: float, rig: Rig) -> Effect:
    """The position comes late by a whole number of samples that the converter buffers; the velocity does not."""
    del rig
    samples = int(max(3, round(24 * strength * rng.uniform(0.7, 1.3))))

    def change(time: Array, x: Array, rng: Generator) -> Array:
        del time, rng
        return np.concatenate([np.full(samples, x[0]), x[:-samples]])

    return Effect({"delay": 1e-3 * samples}, measure=_position(change), channels=("velocity",))
