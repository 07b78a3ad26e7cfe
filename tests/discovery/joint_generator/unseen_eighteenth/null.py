"""Nothing is missing: numbers are off within their uncertainty, sensors and loggers are what they are."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench, Sensor
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RATE, RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form
from .law import gauss_markov

TURN = 2.0 * np.pi


@form("none")
def plc_logs_at_two_hundred_hertz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bolton 2015 (a programmable controller that logs each cycle of 5 ms; strokes; numbers are 1.8 deviations off)."""
    return Effect(rig=lambda bench: replace(bench, rate=200.0, motion="strokes"), deviation=1.8)


BITS = 12


@form("none")
def fast_card_of_twelve_bits(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bennett 1948 (a card of twelve bits for the drive over forty frictions; ramps at 5 kHz for 8 s)."""
    level = 40.0 * bench.level / bench.gain / 2**BITS

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: level * np.round(record[name] / level) for name in drives(record)}

    return Effect(
        {"level": level}, rig=lambda bench: replace(bench, rate=5000.0, motion="ramps", duration=8.0), measure=measure
    )


@form("none")
def encoder_of_few_lines(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Widrow 1956 (an encoder without noise, in steps of a 4000th of the reach; sines at 1 kHz; 1.6 deviations)."""

    def rig(bench: Bench) -> Bench:
        sensor = Sensor(0.0, bench.sensor.drive, resolution=bench.reach / 4000.0)
        return replace(bench, rate=1000.0, motion="sines", sensor=sensor)

    return Effect(rig=rig, deviation=1.6)


@form("none")
def amplifier_noise_has_a_memory(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson 1928 (noise of the drive behind a low pass of 8 ms, as loud as the white one; strokes at 1.5 kHz; limits)."""
    time = 0.008

    def measure(record: Record, rng: Generator) -> Record:
        t, size = record["time [s]"], bench.sensor.drive / bench.gain
        kept = np.exp(-float(np.median(np.diff(t))) / time)
        return record | {name: record[name] + size * gauss_markov(rng, kept, t.size) for name in drives(record)}

    return Effect(
        {"time": time}, rig=lambda bench: replace(bench, rate=1500.0, motion="strokes"), measure=measure, deviation=2.0
    )


@form("none")
def logger_reads_early_or_late(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kobayashi, Morimura, Kobayashi and Onaya 1999 (a logger that reads a hundredth of an interval early or late; 750 Hz).

    Errors are normal, stamps are even; numbers are 1.7 deviations off.
    """

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        read = t + 0.01 * float(np.median(np.diff(t))) * np.clip(rng.standard_normal(t.size), -4.0, 4.0)
        return record | {name: np.interp(read, t, x) for name, x in record.items() if name != "time [s]"}

    return Effect(rig=lambda bench: replace(bench, rate=750.0), measure=measure, deviation=1.7)


@form("none")
def mains_in_the_current_probe(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ott 1988 (hum of 50 Hz and a third of it at 150 Hz on the drive's reading, as loud as its noise; 2.5 kHz)."""

    def measure(record: Record, rng: Generator) -> Record:
        angle = TURN * (50.0 * record["time [s]"] + rng.uniform(0.0, 1.0))
        hum = (np.sin(angle) + np.sin(3.0 * angle) / 3.0) * np.sqrt(1.8) * bench.sensor.drive / bench.gain
        return record | {name: record[name] + hum for name in drives(record)}

    return Effect(rig=lambda bench: replace(bench, rate=2500.0), measure=measure, deviation=1.8)


@form("none")
def all_numbers_at_two_deviations(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Taylor and Kuyatt 1994 (every number is two of its stated deviations off; a sweep at 1 kHz)."""
    return Effect(rig=lambda bench: replace(bench, rate=1000.0, motion="sweep"), deviation=2.0)


@form("none")
def air_of_the_room_is_logged(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Doiron 2007 (temperature and humidity of a room whose air conditioner swings; nothing follows; a series; 400 Hz)."""

    def measure(record: Record, rng: Generator) -> Record:
        t, start = record["time [s]"], rng.uniform(0.0, TURN)
        air = np.sin(TURN * 1.7 * t / bench.duration + start) + 0.02 * rng.standard_normal((2, t.size))
        return record | {"temperature [degC]": 21.0 + 0.8 * air[0], "humidity": 45.0 - 3.0 * air[1]}

    return Effect(rig=lambda bench: replace(bench, rate=400.0, motion="series"), measure=measure, deviation=1.5)


@form("none", on=("slider",))
def level_below_and_a_cell_with_a_memory(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box and Jenkins 1970 (constant friction half a deviation below the stated one; a cell whose noise lingers for 0.2 s)."""

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            return 2e-4 * gauss_markov(rng, np.exp(-1.0 / (0.2 * RATE)), t.size)

        return RateAndState(0.589, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def sanded_plywood(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Morin 1835 (constant friction a fifth of a deviation above the stated one; starts of 1.15 to 1.6 m/s)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.33, starts=(1.15, 1.6), noise=1e-4))
