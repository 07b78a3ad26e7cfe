"""Nothing is missing: numbers are off within their uncertainty, sensors are what they are."""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench, Sensor
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import coloured, drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form


@form("none")
def sums_of_five_at_200_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Slutzky 1937 (noise of the drive that is a sum of the last five shocks, as loud as its own; 200 Hz; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        size, weights = bench.sensor.drive / bench.gain, np.full(5, 1.0 / np.sqrt(5.0))
        return record | {
            name: record[name] + size * np.convolve(rng.standard_normal(record[name].size + 4), weights, mode="valid")
            for name in drives(record)
        }

    return Effect(rig=lambda bench: replace(bench, rate=200.0), measure=measure, deviation=2.0)


def clustered(rng: Generator, n: int) -> Array:
    """White noise of unit deviation whose loudness follows that of the last rows."""
    loud, last, noise = 1.0, 0.0, np.empty(n)
    for i, drawn in enumerate(rng.standard_normal(n)):
        loud = 0.04 + 0.36 * last**2 + 0.6 * loud
        noise[i] = last = np.sqrt(loud) * drawn
    return noise


@form("none")
def loudness_in_clusters(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Engle 1982; Bollerslev 1986 (noise of both sensors, loud for a while and then not; ramps at 600 Hz; 1.7 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + 1.5 * size * clustered(rng, record[name].size)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=600.0, motion="ramps"), measure=measure, deviation=1.7)


@form("none")
def both_in_steps_at_5_khz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Widrow and Kollar 2008 (an encoder of 8e-5 of the reach, no other noise; a drive of 3 % of friction; 5 kHz; limits)."""
    step = 0.03 * bench.level / bench.gain

    def rig(bench: Bench) -> Bench:
        return replace(bench, rate=5000.0, sensor=Sensor(0.0, bench.sensor.drive, resolution=8e-5 * bench.reach))

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: step * np.round(record[name] / step) for name in drives(record)}

    return Effect(rig=rig, measure=measure, deviation=2.0)


@form("none")
def jitter_that_wanders(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lee and Hajimiri 2000 (rows taken up to 5 % of an interval early or late, alike over 30 rows; 1.2 kHz; 1.8 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        wanders = np.clip(coloured(rng.standard_normal(t.size), float(np.exp(-1.0 / 30.0))), -2.0, 2.0)
        taken = t + 0.025 * float(np.median(np.diff(t))) * wanders
        return record | {name: np.interp(taken, t, x) for name, x in record.items() if name != "time [s]"}

    return Effect(rig=lambda bench: replace(bench, rate=1200.0), measure=measure, deviation=1.8)


@form("none")
def warm_air_in_the_beam(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bobroff 1987 (warm air in an interferometer: noise of 25 ms, as loud as its own; a series, 300 Hz; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        kept = float(np.exp(-1.0 / (300.0 * 0.025)))
        size = bench.sensor.position
        return record | {
            name: record[name] + size * coloured(rng.standard_normal(record[name].size), kept) for name in positions(record)
        }

    return Effect(rig=lambda bench: replace(bench, rate=300.0, motion="series"), measure=measure, deviation=2.0)


@form("none")
def two_converters_in_turn(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Black and Hodges 1980 (a drive's two converters take turns: zeros that differ by its noise, one is louder; 1.9)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed, size = {}, bench.sensor.drive / bench.gain
        for name in drives(record):
            odd = np.arange(record[name].size) % 2
            changed[name] = record[name] + size * (odd - 0.5 + 1.5 * odd * rng.standard_normal(odd.size))
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=2500.0), measure=measure, deviation=1.9)


@form("none")
def good_sensors_and_wrong_numbers(rng: Generator, strength: float, bench: Bench) -> Effect:
    """JCGM 100:2008 (sensors three times as good as usual, and every number two deviations off; a sweep)."""

    def rig(bench: Bench) -> Bench:
        return replace(bench, motion="sweep", sensor=Sensor(bench.sensor.position / 3.0, bench.sensor.drive / 3.0))

    return Effect(rig=rig, deviation=2.0)


@form("none")
def ripple_of_a_rectifier(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mohan, Undeland and Robbins 2003 (300 Hz and 600 Hz in a drive's wires, as loud as its noise; 2 kHz; 5 runs; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        t, changed = record["time [s]"], {}
        for name in drives(record):
            angle = 2.0 * np.pi * 300.0 * t + rng.uniform(0.0, 2.0 * np.pi)
            changed[name] = record[name] + 1.37 * bench.sensor.drive / bench.gain * (np.cos(angle) + 0.25 * np.cos(2.0 * angle))
        return record | changed

    return Effect(
        rig=lambda bench: replace(bench, rate=2000.0, n_fit=3, n_test=2, duration=7.0), measure=measure, deviation=2.0
    )


@form("none", on=("slider",))
def level_below_and_differenced_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box, Jenkins and Reinsel 1994 (constant friction 0.8 of a deviation below the stated one; noise in differences)."""

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            return lfilter([2e-4, -2e-4], [1.0], rng.standard_normal(t.size))

        return RateAndState(0.5705, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def lacquered_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Coulomb 1785 (constant friction three tenths of a deviation below the stated one; starts of 1.0 to 1.6 m/s)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.255, starts=(1.0, 1.6), noise=1.1e-4))
