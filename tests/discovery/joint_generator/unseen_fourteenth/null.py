"""Nothing is missing: numbers are off within their uncertainty, sensors are what they are."""

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline

from tests.discovery.joint_generator.bench import Bench, Sensor
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi


@form("none")
def rounds_by_chance(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Croci, Fasi, Higham, Mary and Mikaitis 2022 (a drive in steps of 3 % of friction, rounded by chance; 3 kHz; 1.8)."""
    step = 0.03 * bench.level / bench.gain

    def measure(record: Record, rng: Generator) -> Record:
        return record | {name: step * np.floor(record[name] / step + rng.random(record[name].size)) for name in drives(record)}

    return Effect(rig=lambda bench: replace(bench, rate=3000.0, motion="ramps"), measure=measure, deviation=1.8)


@form("none")
def counts_whole_lines(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Petrella, Tursini, Peretti and Zigliotto 2007 (an encoder that counts whole lines of 8e-5 of the reach; limits)."""
    step = 8e-5 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: step * np.floor(record[name] / step) for name in positions(record)}

    def rig(bench: Bench) -> Bench:
        return replace(bench, rate=1500.0, sensor=Sensor(0.0, bench.sensor.drive))

    return Effect(rig=rig, measure=measure, deviation=2.0)


@form("none")
def resampled_by_a_spline(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Unser 1999 (positions at 500 Hz that somebody has brought to the drive's 2 kHz by a cubic spline; a sweep; 1.7 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t = record["time [s]"]
        kept = np.unique(np.append(np.arange(0, t.size, 4), t.size - 1))
        return record | {name: CubicSpline(t[kept], record[name][kept])(t) for name in positions(record)}

    return Effect(rig=lambda bench: replace(bench, rate=2000.0, motion="sweep"), measure=measure, deviation=1.7)


@form("none")
def clock_swings_with_the_mains(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gardner 2005 (a clock on the mains that swings: rows up to 5 % of an interval early or late at 50 Hz; 800 Hz; 1.9)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        taken = t + 0.05 * float(np.median(np.diff(t))) * np.sin(TURN * (50.0 * t + rng.uniform(0.0, 1.0)))
        return record | {name: np.interp(taken, t, x) for name, x in record.items() if name != "time [s]"}

    return Effect(rig=lambda bench: replace(bench, rate=800.0), measure=measure, deviation=1.9)


def lognormal(rng: Generator, n: int, shape: float = 0.6) -> Array:
    """Noise of unit deviation about its mean, with a tail to above."""
    mean = np.exp(0.5 * shape**2)
    return (np.exp(shape * rng.standard_normal(n)) - mean) / (mean * np.sqrt(np.exp(shape**2) - 1.0))


@form("none")
def lognormal_noise_of_a_series(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Crow and Shimizu 1988 (lognormal noise of both sensors about its mean, as loud as their own; a series, 450 Hz; 1.6)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + size * lognormal(rng, record[name].size)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=450.0, motion="series"), measure=measure, deviation=1.6)


@form("none")
def thyristors_are_heard(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gardner, Napolitano and Paura 2006 (noise of the drive that swells a hundred times a second, to twice; 4 kHz; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        t, size, changed = record["time [s]"], bench.sensor.drive / bench.gain, {}
        for name in drives(record):
            swells = np.abs(np.sin(TURN * (50.0 * t + rng.uniform(0.0, 1.0))))
            changed[name] = record[name] + 2.0 * size * swells * rng.standard_normal(t.size)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=4000.0), measure=measure, deviation=2.0)


@form("none")
def detuned_controller_at_5_khz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rivera, Morari and Skogestad 1986 (a controller of three fifths of the usual bandwidth; a series at 5 kHz; limits)."""
    return Effect(rig=lambda bench: replace(bench, rate=5000.0, motion="series", bandwidth=0.6), deviation=2.0)


@form("none")
def short_strokes_at_200_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hollerbach, Khalil and Gautier 2008 (strokes of six tenths of the usual way at 200 Hz; six runs, four of them fitted)."""

    def rig(bench: Bench) -> Bench:
        return replace(
            bench,
            rate=200.0,
            motion="strokes",
            reach=0.6 * bench.reach,
            speed=0.8 * bench.speed,
            n_fit=4,
            n_test=2,
            duration=7.0,
        )

    return Effect(rig=rig, deviation=1.5)


@form("none", on=("slider",))
def level_above_and_logistic_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Balakrishnan 1992 (constant friction nine tenths of a deviation above the stated one; logistic noise of the cell)."""

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            return rng.logistic(0.0, 2e-4 * np.sqrt(3.0) / np.pi, t.size)

        return RateAndState(0.6758, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def polished_granite(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Morin 1833 (constant friction seven tenths of a deviation below the stated one; starts of 0.85 to 1.3 m/s)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.195, starts=(0.85, 1.3), noise=9e-5))
