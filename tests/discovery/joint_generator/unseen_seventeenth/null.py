"""Nothing is missing: numbers are off within their uncertainty, sensors and loggers are what they are."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi


@form("none")
def telephone_beside_the_cable(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Redl, Weber and Oliver 1995 (a telephone beside the wires: bursts of pulses at 217 Hz, as loud as noise; 3 kHz; 1.8)."""

    def measure(record: Record, rng: Generator) -> Record:
        t, start = record["time [s]"], rng.uniform(0.0, 1.0)
        on = (np.mod(t + start, 1.0) < 0.5) & (np.mod(217.0 * t, 1.0) < 0.125)
        size = bench.sensor.drive / bench.gain / np.sqrt(0.0625 * (1.0 - 0.0625))
        return record | {name: record[name] + size * (on - 0.0625) for name in drives(record)}

    return Effect(rig=lambda bench: replace(bench, rate=3000.0), measure=measure, deviation=1.8)


def by_threes(x: Array) -> Array:
    """Means of three in a row; what is left over at the end is dropped."""
    return x[: x.size // 3 * 3].reshape(-1, 3).mean(axis=1)


@form("none")
def three_readings_to_a_row(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Crochiere and Rabiner 1983 (a logger whose rows are means of three readings, stamps too: 800 of 2400 Hz; limits)."""
    return Effect(
        rig=lambda bench: replace(bench, rate=2400.0),
        measure=lambda record, _: {name: by_threes(x) for name, x in record.items()},
        deviation=2.0,
    )


def secant(rng: Generator, n: int) -> Array:
    """Noise of unit deviation whose density is a hyperbolic secant."""
    return 2.0 / np.pi * np.log(np.tan(0.5 * np.pi * rng.uniform(1e-9, 1.0 - 1e-9, n)))


@form("none")
def secant_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Perks 1932 (noise of both sensors with the density of a hyperbolic secant, as loud as theirs; a series; 620 Hz; 1.7)."""

    def measure(record: Record, rng: Generator) -> Record:
        sizes = dict.fromkeys(positions(record), bench.sensor.position)
        sizes |= dict.fromkeys(drives(record), bench.sensor.drive / bench.gain)
        return record | {name: record[name] + size * secant(rng, record[name].size) for name, size in sizes.items()}

    return Effect(rig=lambda bench: replace(bench, rate=620.0, motion="series"), measure=measure, deviation=1.7)


@form("none")
def hygrometer_in_the_hall(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Wexler 1965 (a dehumidifier that goes on and off: a saw of humidity, recorded; friction does not mind; ramps; 1.6)."""
    period, start = rng.uniform(2.5, 4.0), rng.uniform(0.0, 1.0)

    def measure(record: Record, rng: Generator) -> Record:
        s = np.mod(record["time [s]"] / period + start, 1.0)
        saw = np.minimum(s / 0.7, (1.0 - s) / 0.3)
        return record | {"humidity [%]": np.round(46.0 + 8.0 * saw + 0.1 * rng.standard_normal(s.size), 1)}

    return Effect(rig=lambda bench: replace(bench, rate=1150.0, motion="ramps"), measure=measure, deviation=1.6)


@form("none")
def stiffly_tuned_controller(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Astrom and Hagglund 2006 (a controller of 1.3 of the usual bandwidth; a sweep at 1.4 kHz; numbers at their limits)."""
    return Effect(rig=lambda bench: replace(bench, bandwidth=1.3, rate=1400.0, motion="sweep"), deviation=2.0)


@form("none")
def two_long_runs(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ljung 1999 (one run of 25 s to fit, and one to score; a Fourier series at 260 Hz; numbers 1.9 deviations off)."""
    return Effect(
        rig=lambda bench: replace(bench, rate=260.0, motion="series", n_fit=1, n_test=1, duration=25.0), deviation=1.9
    )


@form("none")
def one_ground_for_both_sensors(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bendat and Piersol 1986 (noise that both sensors share by their ground, as loud as their own; 1.7 kHz; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        shared = rng.standard_normal(record["time [s]"].size)
        changed = {name: record[name] + bench.sensor.position * shared for name in positions(record)}
        return record | changed | {name: record[name] + bench.sensor.drive / bench.gain * shared for name in drives(record)}

    return Effect(rig=lambda bench: replace(bench, rate=1700.0), measure=measure, deviation=2.0)


@form("none")
def dim_stretch_of_a_scale(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fleming 2013 (a scale that is dim over a quarter of the way: its noise is three times as loud there; 1.1 kHz; 1.5)."""
    at, half = bench.reach * rng.uniform(-0.4, 0.4), 0.25 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        size = np.sqrt(8.0) * bench.sensor.position
        changed = {}
        for name in positions(record):
            dim = np.abs(record[name] - at) < half
            changed[name] = record[name] + size * dim * rng.standard_normal(dim.size)
        return record | changed

    return Effect(
        {"at": at, "half": half},
        rig=lambda bench: replace(bench, rate=1100.0, motion="strokes"),
        measure=measure,
        deviation=1.5,
    )


@form("none", on=("slider",))
def level_below_and_mains_folded_down(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Shannon 1949 (constant friction six tenths of a deviation below the stated one; mains of 53.7 Hz, folded to 3.7 Hz)."""

    def law(rng: Generator) -> RateAndState:
        start = rng.uniform(0.0, 1.0)

        def added(t: Array, x: Array) -> Array:
            del x
            return 2e-4 * np.sin(TURN * (53.7 * t + start))

        return RateAndState(0.62 - 0.6 * 0.062, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def dry_slate(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Musschenbroek 1762 (constant friction 0.35 of a deviation above the stated one; starts of 1.3 to 1.75 m/s)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.3525, starts=(1.3, 1.75), noise=1e-4))
