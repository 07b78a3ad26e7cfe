"""Nothing is missing: numbers are off within their uncertainty, sensors are what they are."""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench, Sensor
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen.null import pink

from .enter import form


@form("none")
def sweep_read_coarsely(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Widrow and Kollar 2008; JCGM 100:2008 (an encoder of 1.2e-4 of the reach alone; a sweep; two deviations off)."""
    sensor = Sensor(0.0, bench.sensor.drive, 1.2e-4 * bench.reach)
    return Effect(rig=lambda bench: replace(bench, sensor=sensor, motion="sweep"), deviation=2.0)


@form("none")
def one_row_in_ten_lost(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Little and Rubin 1987 (a tenth of the rows, any of them; the others are stamped rightly; 1.1 kHz)."""

    def measure(record: Record, rng: Generator) -> Record:
        kept = rng.random(record["time [s]"].size) > 0.1
        kept[0] = True
        return {name: x[kept] for name, x in record.items()}

    return Effect(rig=lambda bench: replace(bench, rate=1100.0), measure=measure, deviation=1.2)


@form("none")
def pink_encoder_of_ramps(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Keshner 1982 (1/f noise of the encoder, as loud as its own; trapezoids; numbers at 1.6 deviations)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {x: record[x] + bench.sensor.position * pink(rng.standard_normal(record[x].size)) for x in positions(record)}
        return record | changed

    return Effect(rig=lambda bench: replace(bench, motion="ramps"), measure=measure, deviation=1.6)


@form("none")
def logistic_noise_of_a_series(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Verhulst 1845; Swevers and others 1997 (a logistic density in both sensors; a Fourier series at 850 Hz; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + size * np.sqrt(3.0) / np.pi * rng.logistic(size=record[name].size)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=850.0, motion="series"), measure=measure, deviation=2.0)


@form("none")
def clock_with_a_little_jitter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Balakrishnan 1962 (rows taken early or late by 1.2 % of an interval, normally; four runs of six are fitted)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        taken = t + 0.012 * float(np.median(np.diff(t))) * np.clip(rng.standard_normal(t.size), -3.0, 3.0)
        return {name: x if name == "time [s]" else np.interp(taken, t, x) for name, x in record.items()}

    return Effect(rig=lambda bench: replace(bench, n_fit=4, n_test=2, duration=7.0), measure=measure, deviation=1.0)


@form("none")
def coloured_drive_at_the_limits(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box, Jenkins and Reinsel 1994 (an autoregression of 20 ms beside the drive's noise, as loud; two deviations off)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        kept, size = float(np.exp(-float(np.median(np.diff(t))) / 0.02)), bench.sensor.drive / bench.gain
        more = {x: lfilter([np.sqrt(1.0 - kept**2)], [1.0, -kept], rng.standard_normal(t.size)) for x in drives(record)}
        return record | {name: record[name] + size * more[name] for name in more}

    return Effect(measure=measure, deviation=2.0)


@form("none", on=("slider",))
def level_below_and_even_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sripad and Snyder 1977 (constant friction four tenths of a deviation below the stated one; an even density of noise)."""
    return Effect(law=lambda rng: RateAndState(0.57, 0.0, added=lambda t, x: 3e-4 * rng.uniform(-1.0, 1.0, t.size)))


@form("none", on=("thrown",))
def smoother_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Constant friction half a standard deviation below the stated one; starts of 1.0 to 1.5 m/s, read half as well again."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.27, starts=(1.0, 1.5), noise=1.2e-4))
