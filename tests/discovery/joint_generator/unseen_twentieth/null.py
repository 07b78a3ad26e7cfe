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
def both_sensors_remember(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box and Jenkins 1970 (noise of first order on both sensors, as loud as their own, over 4 ms; 1 kHz; 1.5 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed, memory = {}, float(np.exp(-1.0 / (0.004 * bench.rate)))
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + size * coloured(rng.standard_normal(record[name].size), memory)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=1000.0, motion="sines"), measure=measure, deviation=1.5)


def flicker(rng: Generator, n: int) -> Array:
    """Noise of unit deviation and no mean, whose power falls as one over the frequency."""
    spectrum = np.fft.rfft(rng.standard_normal(n))
    spectrum[0] = 0.0
    spectrum[1:] /= np.sqrt(np.arange(1.0, spectrum.size))
    noise = np.fft.irfft(spectrum, n)
    return noise / noise.std()


@form("none")
def strain_gauge_flickers(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hooge 1969; Kasdin 1995 (flicker noise of the drive's amplifier, as loud as its white one; a series at 2.5 kHz; 1.7)."""

    def measure(record: Record, rng: Generator) -> Record:
        size = bench.sensor.drive / bench.gain
        return record | {name: record[name] + size * flicker(rng, record[name].size) for name in drives(record)}

    return Effect(rig=lambda bench: replace(bench, rate=2500.0, motion="series"), measure=measure, deviation=1.7)


@form("none")
def steps_of_an_optical_scale(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bennett 1948 (a scale in steps of 1e-4 of the reach, rounded, without another noise that hides them; 2 kHz; limits)."""

    def rig(bench: Bench) -> Bench:
        return replace(bench, rate=2000.0, sensor=Sensor(0.0, bench.sensor.drive, resolution=1e-4 * bench.reach))

    return Effect(rig=rig, deviation=2.0)


@form("none")
def drive_of_eight_bits(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Widrow and Kollar 2008 (a drive that is logged in steps of 4 % of friction, rounded; ramps at 500 Hz; 1.8)."""
    step = 0.04 * bench.level / bench.gain

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: step * np.round(record[name] / step) for name in drives(record)}

    return Effect(rig=lambda bench: replace(bench, rate=500.0, motion="ramps"), measure=measure, deviation=1.8)


@form("none")
def stamps_of_a_busy_computer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Eidson 2006 (stamps that a busy computer sets up to a tenth of an interval late, samples at even times; 400 Hz; 1.6)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"time [s]": t + np.minimum(0.03 * rng.exponential(size=t.size), 0.1) / bench.rate}

    return Effect(rig=lambda bench: replace(bench, rate=400.0), measure=measure, deviation=1.6)


@form("none")
def sweep_logged_at_200_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Pintelon and Schoukens 2012 (a sweep whose log has 200 rows a second; all numbers at their limits)."""
    return Effect(rig=lambda bench: replace(bench, rate=200.0, motion="sweep"), deviation=2.0)


@form("none")
def fast_log_of_a_loud_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson 1928; Nyquist 1928 (white noise of the drive three times as loud as usual, at 5 kHz; strokes; limits)."""

    def rig(bench: Bench) -> Bench:
        sensor = replace(bench.sensor, drive=3.0 * bench.sensor.drive)
        return replace(bench, rate=5000.0, motion="strokes", sensor=sensor)

    return Effect(rig=rig, deviation=2.0)


@form("none")
def drive_shown_as_a_mean_of_three(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Smith 1997 (a drive whose log is the mean of each row and both neighbours; 3 kHz; 1.5)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        padded = {name: np.pad(record[name], 1, mode="edge") for name in drives(record)}
        return record | {name: lfilter(np.full(3, 1.0 / 3.0), 1.0, x)[2:] for name, x in padded.items()}

    return Effect(rig=lambda bench: replace(bench, rate=3000.0), measure=measure, deviation=1.5)


@form("none", on=("slider",))
def even_level_and_slow_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Byerlee 1978 (constant friction half a deviation below the stated one; noise of the cell over a few rows)."""

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            return 2e-4 * coloured(rng.standard_normal(t.size), 0.7)

        return RateAndState(0.589, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def same_board_all_day(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Coulomb 1785 (constant friction four tenths of a deviation above the stated one; starts of 1.2 to 1.7 m/s)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.36, starts=(1.2, 1.7), noise=1.2e-4))
