"""Nothing is missing: only numbers are wrong within their uncertainty, and sensors are what sensors are."""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench, Sensor
from tests.discovery.joint_generator.plant import Array

from .form import Effect, Generator, Record, form
from .sensor import positions


def drives(record: Record) -> list[str]:
    """Columns that hold drives."""
    words = ("force", "torque", "voltage")
    return [name for name in record if any(word in name for word in words)]


@form("none")
def wrong_numbers(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect()


@form("none")
def numbers_at_their_limits(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Everything is off by two of its standard deviations."""
    return Effect(deviation=2.0)


@form("none")
def right_numbers(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect(deviation=0.0)


def _sensor(position: float, drive: float) -> Effect:
    def rig(bench: Bench) -> Bench:
        return replace(bench, sensor=Sensor(bench.sensor.position * position, bench.sensor.drive * drive))

    return Effect(rig=rig)


@form("none")
def loud_encoder(rng: Generator, strength: float, bench: Bench) -> Effect:
    return _sensor(5.0, 1.0)


@form("none")
def loud_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    return _sensor(1.0, 8.0)


@form("none")
def quiet(rng: Generator, strength: float, bench: Bench) -> Effect:
    return _sensor(0.1, 0.1)


@form("none")
def coarse_encoder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Quantised, without other noise to hide it."""

    def rig(bench: Bench) -> Bench:
        return replace(bench, sensor=Sensor(0.0, bench.sensor.drive, resolution=4e-4 * bench.reach))

    return Effect(rig=rig)


def coloured(noise: Array, correlation: float) -> Array:
    """First-order autoregressive noise of the same standard deviation."""
    return lfilter([np.sqrt(1.0 - correlation**2)], [1.0, -correlation], noise)


@form("none")
def coloured_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Drive noise that is correlated over 5 to 30 ms."""
    time = rng.uniform(0.005, 0.03)

    def measure(record: Record, rng: Generator) -> Record:
        correlation = float(np.exp(-1.0 / (bench.rate * time)))
        noise = {name: 0.04 * np.std(record[name]) * rng.standard_normal(record[name].size) for name in drives(record)}
        return record | {name: record[name] + coloured(noise[name], correlation) for name in noise}

    return Effect({"time": time}, measure=measure)


@form("none")
def coloured_encoder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Position noise that is correlated over a few samples."""
    correlation = rng.uniform(0.6, 0.9)

    def measure(record: Record, rng: Generator) -> Record:
        noise = {name: bench.sensor.position * rng.standard_normal(record[name].size) for name in positions(record)}
        return record | {name: record[name] + coloured(noise[name], correlation) for name in noise}

    return Effect({"correlation": correlation}, measure=measure)


@form("none")
def jitter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A clock whose stamps are off by 5 % of an interval; the samples are taken at the true times."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"time [s]": t + 0.05 / bench.rate * np.clip(rng.standard_normal(t.size), -3.0, 3.0)}

    return Effect(measure=measure)


def _rate(rate: float) -> Effect:
    return Effect(rig=lambda bench: replace(bench, rate=rate))


@form("none")
def at_200_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    return _rate(200.0)


@form("none")
def at_5_khz(rng: Generator, strength: float, bench: Bench) -> Effect:
    return _rate(5000.0)


@form("none")
def short_record(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect(rig=lambda bench: replace(bench, duration=5.0))


@form("none", on=("slider",))
def constant_friction(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect(law=lambda rng: None)
