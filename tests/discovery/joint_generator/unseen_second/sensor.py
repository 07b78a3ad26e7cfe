"""Positions or drives that are late, stale or off."""

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array

from .enter import form


def first_order(x: Array, interval: float, time: float) -> Array:
    """A signal behind a filter of first order that was at rest before."""
    kept = float(np.exp(-interval / time))
    return lfilter([1.0 - kept], [1.0, -kept], x, zi=[kept * x[0]])[0]


@form("sensor_delay", on=SINGLES)
def resistor_and_capacitor(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Horowitz and Hill 1989 (an analogue position behind a low-pass of first order)."""
    time = 0.02 * strength * rng.uniform(0.8, 1.2) + 2.0 / bench.rate

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: first_order(record[name], 1.0 / bench.rate, time) for name in positions(record)}

    return Effect({"delay": time}, measure=measure)


@form("sensor_delay", on=SINGLES)
def smoothed_current(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Franklin, Powell and Workman 1998 (an amplifier that shows its current through a low-pass)."""
    time = 0.022 * strength * rng.uniform(0.8, 1.2) + 2.0 / bench.rate

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: first_order(record[name], 1.0 / bench.rate, time) for name in drives(record)}

    return Effect({"delay": time}, measure=measure)


@form("stale_samples", also=("sensor_delay",))
def busy_computer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nilsson, Bernhardsson and Wittenmark 1998 (few, long pauses: 40 to 90 ms, two or three a second)."""
    rate = 3.0 * strength

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        changed = {name: record[name].copy() for name in positions(record)}
        for begin in rng.integers(1, t.size - 2, rng.poisson(rate * t[-1])):
            end = begin + round(rng.uniform(0.04, 0.09) * bench.rate)
            for x in changed.values():
                x[begin:end] = x[begin]
        return record | changed

    return Effect({"rate": rate}, measure=measure)


@form("stale_samples", also=("sensor_delay",), on=SINGLES)
def camera(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Corke 1996 (a position from a camera of 25 to 36 frames a second, repeated until the next one)."""
    n = round((0.015 + 0.025 * strength) * bench.rate)

    def measure(record: Record, rng: Generator) -> Record:
        first = int(rng.integers(n))
        held = np.maximum((np.arange(record["time [s]"].size) - first) // n * n + first, 0)
        return record | {name: record[name][held] for name in positions(record)}

    return Effect({"samples": float(n)}, measure=measure)


@form("sensor_outliers", on=SINGLES)
def bursts(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gilbert 1960 (interference comes in bursts: two to four samples in a row are off, each by another amount)."""
    size, rate = 0.06 * strength * bench.reach, 1.5

    def measure(record: Record, rng: Generator) -> Record:
        t, name = record["time [s]"], positions(record)[0]
        x = record[name].copy()
        for begin in rng.integers(1, t.size - 5, 6 + rng.poisson(rate * t[-1])):
            n = int(rng.integers(2, 5))
            x[begin : begin + n] += size * rng.uniform(0.5, 1.5, n) * rng.choice([-1.0, 1.0], n)
        return record | {name: x}

    return Effect({"size": size, "rate": rate}, measure=measure)


@form("sensor_outliers", on=(*LINES, *HINGES))
def reads_zero(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Little and Rubin 1987 (a logger that writes zero where it got nothing)."""
    share = 0.003 * strength

    def measure(record: Record, rng: Generator) -> Record:
        name = positions(record)[0]
        return record | {name: np.where(rng.random(record[name].size) < share, 0.0, record[name])}

    return Effect({"share": share}, measure=measure)
