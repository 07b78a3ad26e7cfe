"""Nothing is missing: numbers are off within their uncertainty, sensors are what they are, controllers and motions differ."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.signal import butter, lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import coloured, drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array

from .enter import form


def _added(
    columns: Callable[[Record], list[str]],
    noise: Callable[[Array, Generator], Array],
    rig: Callable[[Bench], Bench] = lambda bench: bench,
    deviation: float | None = None,
) -> Effect:
    """Something is added to columns, in a rig of its own."""

    def measure(record: Record, rng: Generator) -> Record:
        return record | {name: record[name] + noise(record[name], rng) for name in columns(record)}

    return Effect(rig=rig, measure=measure, deviation=deviation)


def _rig(deviation: float | None = None, **changes: float | str | bool) -> Effect:
    return Effect(rig=lambda bench: replace(bench, **changes), deviation=deviation)


@form("none")
def at_125_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    return _rig(rate=125.0)


@form("none")
def limits_at_125_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Every number is two standard deviations off."""
    return _rig(2.0, rate=125.0)


@form("none")
def hum_at_5_khz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ott 2009 (mains in the drive's wires, as loud as its noise: 50 Hz, in no phase with anything)."""
    size = np.sqrt(2.0) * bench.sensor.drive / bench.gain

    def hum(x: Array, rng: Generator) -> Array:
        return size * np.sin(2.0 * np.pi * (50.0 * np.arange(x.size) / 5000.0 + rng.random()))

    return _added(drives, hum, rig=lambda bench: replace(bench, rate=5000.0))


@form("none")
def band_of_the_current_loop(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Krishnan 2001 (ripple of a current loop: three times the drive's noise, between 40 and 90 Hz)."""
    size = 3.0 * bench.sensor.drive / bench.gain
    numerator, denominator = butter(2, [40.0, 90.0], "bandpass", fs=bench.rate)

    def ripple(x: Array, rng: Generator) -> Array:
        band = lfilter(numerator, denominator, rng.standard_normal(x.size + 1000))[1000:]
        return size * band / band.std()

    return _added(drives, ripple)


@form("none")
def loud_and_slow_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box, Jenkins and Reinsel 1994 (autoregression of 80 ms, twice the drive's noise; numbers at their limits)."""
    size, kept = 2.0 * bench.sensor.drive / bench.gain, float(np.exp(-1.0 / (0.08 * bench.rate)))
    return _added(drives, lambda x, rng: size * coloured(rng.standard_normal(x.size), kept), deviation=2.0)


@form("none")
def heavy_tails(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lange, Little and Taylor 1989 (Student's t with four degrees of freedom, of both sensors' standard deviations)."""

    def rig(bench: Bench) -> Bench:
        return replace(bench, sensor=replace(bench.sensor, position=0.0, drive=0.0))

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                x = record[name]
                changed[name] = x + size / np.sqrt(2.0) * rng.standard_t(4.0, x.size)
        return record | changed

    return Effect(rig=rig, measure=measure)


@form("none")
def averaged_encoder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merry, van de Molengraft and Steinbuch 2010 (interpolated counts: noise that resembles that of five samples around)."""
    size = 2.0 * bench.sensor.position
    return _added(
        positions, lambda x, rng: size * np.convolve(rng.standard_normal(x.size + 4), np.ones(5) / np.sqrt(5.0), "valid")
    )


@form("none")
def counts_and_bits(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Widrow and Kollar 2008 (encoder in steps of 1e-4 of the reach, drive of 5 % of friction, neither with noise)."""
    step = 0.05 * bench.level / bench.gain

    def rig(bench: Bench) -> Bench:
        return replace(bench, sensor=replace(bench.sensor, position=0.0, drive=0.0, resolution=1e-4 * bench.reach))

    return _added(drives, lambda x, rng: np.round(x / step) * step - x, rig)


@form("none")
def noise_grows_with_the_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Carroll and Ruppert 1988 (noise of 2 % of what is read)."""
    return _added(drives, lambda x, rng: 0.02 * np.abs(x) * rng.standard_normal(x.size))


@form("none")
def stamps_cut_short(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Balakrishnan 1962 (samples at 640 Hz whose stamps are cut to a fifth of a millisecond)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {"time [s]": np.round(record["time [s]"] * 5e3) / 5e3}

    return Effect(rig=lambda bench: replace(bench, rate=640.0), measure=measure)


@form("none")
def sluggish_controller(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Franklin, Powell and Workman 1998 (half the usual bandwidth; numbers at their limits)."""
    return _rig(2.0, bandwidth=0.5)


@form("none")
def tight_controller(rng: Generator, strength: float, bench: Bench) -> Effect:
    return _rig(bandwidth=1.6)


@form("none")
def trapezoids(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Biagiotti and Melchiorri 2008 (accelerations that jump)."""
    return _rig(1.5, motion="ramps")


@form("none")
def swept_sine(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Pintelon and Schoukens 2012 (the frequency grows with time: speed, place and time go together)."""
    return _rig(motion="sweep")


@form("none")
def fourier_series(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Swevers, Ganseman, Tukel, De Schutter and Van Brussel 1997 (a periodic excitation of five harmonics)."""
    return _rig(motion="series")


@form("none")
def damped_at_its_limit(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A believed damping as large as friction, which like all numbers is two standard deviations off."""

    def rig(bench: Bench) -> Bench:
        if bench.design == "arm":
            return bench
        return replace(bench, numbers=bench.numbers | {"damping": bench.level / bench.speed})

    return Effect(rig=rig, deviation=2.0)


@form("none")
def light_carriage(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Friction alone: a tenth of the inertia, where nothing hangs on it."""

    def rig(bench: Bench) -> Bench:
        if "gravity" in bench.numbers:
            return bench
        return replace(bench, numbers=bench.numbers | {"inertia": 0.1 * bench.numbers["inertia"]})

    return Effect(rig=rig)


@form("none")
def twelve_runs_at_a_limit(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nine runs to fit and three to score, 3 s each; every number is two standard deviations off."""
    return _rig(2.0, n_fit=9, n_test=3, duration=3.0)
