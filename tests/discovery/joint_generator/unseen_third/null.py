"""Nothing is missing: numbers are off within their uncertainty, sensors are what they are."""

from dataclasses import replace

import numpy as np
from scipy.signal import savgol_filter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array

from .enter import form


@form("none")
def limits_at_160_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """JCGM 100:2008 (every number is two standard deviations off), at a low rate."""
    return Effect(rig=lambda bench: replace(bench, rate=160.0), deviation=2.0)


@form("none")
def spells_of_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ott 2009 (a welder next door: twice the noise of both sensors, in spells)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        flips = np.cumsum(rng.exponential(1.0, 200))
        loud = np.sqrt(3.0) * np.mod(np.searchsorted(flips, t), 2)
        changed = {
            name: record[name] + bench.sensor.position * loud * rng.standard_normal(t.size) for name in positions(record)
        }
        size = bench.sensor.drive / bench.gain
        return record | changed | {name: record[name] + size * loud * rng.standard_normal(t.size) for name in drives(record)}

    return Effect(measure=measure)


@form("none")
def uniform_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sripad and Snyder 1977 (an even density between two bounds, three times both sensors' noise; 1.5 deviations off)."""
    root = np.sqrt(3.0)

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + 3.0 * size * rng.uniform(-root, root, record[name].size)
        return record | changed

    return Effect(measure=measure, deviation=1.5)


@form("none")
def rows_lost_in_pairs(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gilbert 1960 (two rows are lost in a row, one time in a hundred)."""

    def measure(record: Record, rng: Generator) -> Record:
        n = record["time [s]"].size
        first = rng.random(n) < 0.01
        kept = ~(first | np.concatenate([[False], first[:-1]]))
        kept[:3] = True
        return {name: x[_at_most_two(kept)] for name, x in record.items()}

    return Effect(measure=measure)


def _at_most_two(kept: Array) -> Array:
    """Keep the third of three rows that would be lost one after the other: four intervals without a sample are a gap."""
    out = kept.copy()
    for i in range(2, out.size):
        out[i] = out[i] or not (out[i - 1] or out[i - 2])
    return out


@form("none")
def encoder_smooths(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Savitzky and Golay 1964 (an encoder that smooths over seven samples, without delay, three times as noisy before)."""

    def measure(record: Record, rng: Generator) -> Record:
        size = 3.0 * bench.sensor.position
        return record | {
            name: savgol_filter(record[name] + size * rng.standard_normal(record[name].size), 7, 3)
            for name in positions(record)
        }

    return Effect(measure=measure)


@form("none")
def pink_at_the_limits(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Keshner 1982 (1/f noise of the drive, as loud as its own; every number is two standard deviations off)."""

    def pink(n: int, rng: Generator) -> Array:
        f = np.maximum(np.fft.rfftfreq(n), 1e-3)
        x = np.fft.irfft(np.fft.rfft(rng.standard_normal(n)) / np.sqrt(f), n)
        return x / x.std()

    def measure(record: Record, rng: Generator) -> Record:
        size = bench.sensor.drive / bench.gain
        return record | {name: record[name] + size * pink(record[name].size, rng) for name in drives(record)}

    return Effect(measure=measure, deviation=2.0)


@form("none")
def coarse_at_the_limits(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Widrow and Kollar 2008 (an encoder of 3e-4 of the reach, nothing else to hide it; numbers two deviations off)."""

    def rig(bench: Bench) -> Bench:
        return replace(bench, sensor=replace(bench.sensor, position=0.0, resolution=3e-4 * bench.reach))

    return Effect(rig=rig, deviation=2.0)


@form("none")
def at_801_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """An odd clock, and a sweep."""
    return Effect(rig=lambda bench: replace(bench, rate=801.0, motion="sweep"))


@form("none")
def six_runs_of_ramps(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Biagiotti and Melchiorri 2008 (trapezoids; four runs to fit, two to score; 1.5 deviations off)."""
    return Effect(rig=lambda bench: replace(bench, motion="ramps", n_fit=4, n_test=2, duration=6.0), deviation=1.5)
