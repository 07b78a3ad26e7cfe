"""Nothing is missing: numbers are off within their uncertainty, sensors and loggers are what they are."""

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


def correlated(record: Record, names: list[str], size: float, rows: float, rng: Generator) -> Record:
    """A record with first-order noise of this deviation on some columns, correlated over so many rows."""
    keeps = float(np.exp(-1.0 / rows))
    return record | {name: record[name] + coloured(size * rng.standard_normal(record[name].size), keeps) for name in names}


@form("none")
def every_number_at_its_limit(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mandel 1964 (a rig of which every stated number is two deviations off; a Fourier series at 1 kHz)."""
    return Effect(rig=lambda bench: replace(bench, rate=1000.0, motion="series"), deviation=2.0)


@form("none")
def shunt_noise_through_a_low_pass(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Uhlenbeck and Ornstein 1930 (drive noise behind a low pass of 8 to 25 ms, twice as loud as white noise; 800 Hz)."""
    time = rng.uniform(0.008, 0.025)

    def measure(record: Record, rng: Generator) -> Record:
        return correlated(record, drives(record), 2.0 * bench.sensor.drive / bench.gain, 800.0 * time, rng)

    return Effect({"time": time}, rig=lambda bench: replace(bench, rate=800.0), measure=measure, deviation=1.6)


@form("none")
def encoder_filter_colours_its_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box and Jenkins 1970 (an encoder whose noise is correlated over 4 rows, twice as loud as its white one; 1.5 kHz)."""

    def measure(record: Record, rng: Generator) -> Record:
        return correlated(record, positions(record), 2.0 * bench.sensor.position, 4.0, rng)

    return Effect(rig=lambda bench: replace(bench, rate=1500.0, motion="strokes"), measure=measure, deviation=1.8)


@form("none")
def encoder_counts_whole_steps(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Widrow 1956 (a position in whole steps of 3e-4 of the reach, without other noise; sines at 1 kHz; limits)."""

    def rig(bench: Bench) -> Bench:
        return replace(bench, rate=1000.0, motion="sines", sensor=Sensor(0.0, bench.sensor.drive, 3e-4 * bench.reach))

    return Effect(rig=rig, deviation=2.0)


@form("none")
def drive_read_in_twelve_bits(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bennett 1948 (a drive in whole steps of a converter, 4096 over 16 times the usual friction; ramps at 2.5 kHz)."""
    step = 16.0 * bench.level / bench.gain / 4096.0

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: step * np.round(record[name] / step) for name in drives(record)}

    return Effect({"step": step}, rig=lambda bench: replace(bench, rate=2500.0, motion="ramps"), measure=measure, deviation=1.7)


@form("none")
def computer_clock_jitters(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Liu and Layland 1973 (a logger's stamps are off by 4 % of an interval, at random; samples are on time; 2 kHz)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"time [s]": t + 0.04 / 2000.0 * np.clip(rng.standard_normal(t.size), -3.0, 3.0)}

    return Effect(rig=lambda bench: replace(bench, rate=2000.0), measure=measure, deviation=1.5)


@form("none")
def slow_logger_of_a_controller(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Shannon 1949 (a controller that logs at 200 Hz; strokes; numbers as they come)."""
    return Effect(rig=lambda bench: replace(bench, rate=200.0, motion="strokes"))


@form("none")
def quick_card_and_a_loud_amplifier(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson 1928 (a card of 5 kHz behind an amplifier three times as loud as usual; a sweep; limits)."""

    def rig(bench: Bench) -> Bench:
        return replace(bench, rate=5000.0, motion="sweep", sensor=Sensor(bench.sensor.position, 3.0 * bench.sensor.drive))

    return Effect(rig=rig, deviation=2.0)


@form("none", on=("slider",))
def level_below_and_a_cell_behind_a_filter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Dieterich 1972 (constant friction half a deviation below the stated one; a load cell's noise correlated over 5 rows)."""

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            return coloured(3e-4 * rng.standard_normal(t.size), float(np.exp(-1.0 / 5.0)))

        return RateAndState(0.59, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def steel_block_on_a_clean_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Coulomb 1785 (constant friction a fifth of a deviation above the stated one; a camera half again as noisy)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.33, noise=1.2e-4))
