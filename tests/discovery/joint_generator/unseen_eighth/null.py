"""Nothing is missing: numbers are off within their uncertainty, sensors are what they are."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench, Sensor
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import coloured, drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form


@form("none")
def ten_bits_at_700_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Widrow and Kollar 2008 (a drive in steps of 2.5 % of friction under its noise; 700 Hz; numbers at 1.8 deviations)."""
    step = 0.025 * bench.level / bench.gain

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: np.round(record[name] / step) * step for name in drives(record)}

    return Effect(rig=lambda bench: replace(bench, rate=700.0), measure=measure, deviation=1.8)


@form("none")
def blue_encoder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lau and Arce 2008 (noise of the encoder that is louder the higher the tone, as loud as its own; trapezoids; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for name in positions(record):
            blue = np.diff(rng.standard_normal(record[name].size + 1)) / np.sqrt(2.0)
            changed[name] = record[name] + bench.sensor.position * blue
        return record | changed

    return Effect(rig=lambda bench: replace(bench, motion="ramps"), measure=measure, deviation=2.0)


@form("none")
def stamps_of_the_day(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mills 1991 (a clock of the day: rows begin at 43200 s; a Fourier series at 900 Hz; numbers at 1.4 deviations)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {"time [s]": record["time [s]"] + 43200.0}

    return Effect(rig=lambda bench: replace(bench, rate=900.0, motion="series"), measure=measure, deviation=1.4)


@form("none")
def dithered_converter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gray and Stockham 1993 (steps of the encoder of 6e-5 of the reach under a triangular dither; a sweep; 1.5 off)."""
    step = 6e-5 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for name in positions(record):
            dither = rng.random(record[name].size) - rng.random(record[name].size)
            changed[name] = np.round(record[name] / step + dither) * step
        return record | changed

    return Effect(rig=lambda bench: replace(bench, motion="sweep"), measure=measure, deviation=1.5)


@form("none")
def crystal_of_200_ppm(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Allan 1966 (a clock that is fast by two rows of ten thousand; an encoder of 1e-4 of the reach alone; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {"time [s]": 1.0002 * record["time [s]"]}

    sensor = Sensor(0.0, bench.sensor.drive, 1e-4 * bench.reach)
    return Effect(rig=lambda bench: replace(bench, sensor=sensor), measure=measure, deviation=2.0)


@form("none")
def amplifier_gets_louder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nyquist 1928 (noise of the drive that grows along each run, to three times; four runs of six are fitted; 1.7 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        more = 2.8 * t / t[-1] * bench.sensor.drive / bench.gain
        return record | {name: record[name] + more * rng.standard_normal(t.size) for name in drives(record)}

    return Effect(rig=lambda bench: replace(bench, n_fit=4, n_test=2, duration=7.0), measure=measure, deviation=1.7)


@form("none", on=("slider",))
def level_above_and_slow_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box, Jenkins and Reinsel 1994 (constant friction half a deviation above the stated one; an autoregression of 0.2 s)."""
    kept = float(np.exp(-1.0 / (50.0 * 0.2)))

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            return coloured(2e-4 * rng.standard_normal(t.size), kept)

        return RateAndState(0.68, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def dustier_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Coulomb 1785 (constant friction six tenths of a deviation above the stated one; starts of 1.05 to 1.7 m/s)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.336, starts=(1.05, 1.7), noise=1.8e-4))
