"""Nothing is missing: numbers are wrong within their uncertainty, and sensors are what sensors are."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import LINES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import coloured, drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array

from .enter import form


def pink(noise: Array) -> Array:
    """1/f noise of unit variance."""
    f = np.maximum(np.fft.rfftfreq(noise.size), 1e-3)
    shaped = np.fft.irfft(np.fft.rfft(noise) / np.sqrt(f), noise.size)
    return shaped / shaped.std()


def _added(columns: Callable[[Record], list[str]], noise: Callable[[Array, Generator], Array]) -> Effect:
    def measure(record: Record, rng: Generator) -> Record:
        return record | {name: record[name] + noise(record[name], rng) for name in columns(record)}

    return Effect(measure=measure)


@form("none")
def pink_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Keshner 1982, as loud as the drive's own noise."""
    size = bench.sensor.drive / bench.gain
    return _added(drives, lambda x, rng: size * pink(rng.standard_normal(x.size)))


@form("none")
def pink_encoder(rng: Generator, strength: float, bench: Bench) -> Effect:
    size = bench.sensor.position
    return _added(positions, lambda x, rng: size * pink(rng.standard_normal(x.size)))


@form("none")
def zero_of_the_drive_wanders(rng: Generator, strength: float, bench: Bench) -> Effect:
    """By the drive's own noise, in 2 s."""
    size, kept = bench.sensor.drive / bench.gain, float(np.exp(-1.0 / (2.0 * bench.rate)))
    return _added(drives, lambda x, rng: size * coloured(rng.standard_normal(x.size), kept))


@form("none")
def zero_of_the_encoder_wanders(rng: Generator, strength: float, bench: Bench) -> Effect:
    size, kept = bench.sensor.position, float(np.exp(-1.0 / (1.0 * bench.rate)))
    return _added(positions, lambda x, rng: size * coloured(rng.standard_normal(x.size), kept))


@form("none")
def coarse_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A converter with steps of 3 % of friction (Widrow and Kollar 2008)."""
    step = 0.03 * bench.level / bench.gain
    return _added(drives, lambda x, rng: np.round(x / step) * step - x)


@form("none")
def coarse_and_slow(rng: Generator, strength: float, bench: Bench) -> Effect:
    """250 samples a second, and an encoder of 2e-4 of the reach, without other noise."""
    sensor = replace(bench.sensor, position=0.0, resolution=2e-4 * bench.reach)
    return Effect(rig=lambda bench: replace(bench, rate=250.0, sensor=sensor))


@form("none")
def samples_taken_unevenly(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Stamps are even, samples are up to 6 % of an interval off (Balakrishnan 1962)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        taken = t + 0.02 / bench.rate * np.clip(rng.standard_normal(t.size), -3.0, 3.0)
        return record | {name: np.interp(taken, t, x) for name, x in record.items() if name != "time [s]"}

    return Effect(measure=measure)


@form("none")
def samples_lost(rng: Generator, strength: float, bench: Bench) -> Effect:
    """One row of a hundred is missing in the file (Little and Rubin 1987)."""

    def measure(record: Record, rng: Generator) -> Record:
        kept = rng.random(record["time [s]"].size) > 0.01
        return {name: x[kept] for name, x in record.items()}

    return Effect(measure=measure)


@form("none")
def at_333_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect(rig=lambda bench: replace(bench, rate=1000.0 / 3.0))


@form("none")
def at_4_khz(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect(rig=lambda bench: replace(bench, rate=4000.0))


@form("none")
def limits_and_a_loud_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Every number is two standard deviations off, under four times the noise."""
    sensor = replace(bench.sensor, drive=4.0 * bench.sensor.drive)
    return Effect(rig=lambda bench: replace(bench, sensor=sensor), deviation=2.0)


@form("none")
def limits_of_a_slow_motion(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect(rig=lambda bench: replace(bench, speed=0.5 * bench.speed), deviation=1.9)


def _scaled(bench: Bench, factor: float) -> Bench:
    """All masses and forces times a factor."""
    numbers = {key: value * (1.0 if key in ("length", "l1", "l2") else factor) for key, value in bench.numbers.items()}
    coulomb = (bench.coulomb[0] * factor, bench.coulomb[1] * factor)
    sensor = replace(bench.sensor, drive=bench.sensor.drive * factor)
    return replace(bench, numbers=numbers, coulomb=coulomb, sensor=sensor, offset_sd=bench.offset_sd * factor)


@form("none")
def excavator(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A machine a thousand times as heavy."""
    return Effect(rig=lambda bench: _scaled(bench, 1000.0))


@form("none")
def watch(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A machine ten thousand times as light."""
    return Effect(rig=lambda bench: _scaled(bench, 1e-4))


@form("none", on=LINES)
def air_bearing(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A fifth of the friction, read with the same noise."""
    coulomb = (0.2 * bench.coulomb[0], 0.2 * bench.coulomb[1])
    return Effect(rig=lambda bench: replace(bench, coulomb=coulomb, offset_sd=0.2 * bench.offset_sd))


@form("none")
def quick_motion(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect(rig=lambda bench: replace(bench, speed=1.6 * bench.speed))


@form("none")
def ten_short_runs(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect(rig=lambda bench: replace(bench, n_fit=7, n_test=3, duration=4.0))


@form("none")
def one_long_run(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect(rig=lambda bench: replace(bench, n_fit=1, n_test=1, duration=24.0))


@form("none", on=("slide",))
def cylinder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Three pressures, and a seal that does not mind."""
    return Effect(rig=pressurised)


@form("none")
def eight_wrong_offsets(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Every number is one standard deviation off, and the encoder is three times as loud."""
    sensor = replace(bench.sensor, position=3.0 * bench.sensor.position)
    return Effect(rig=lambda bench: replace(bench, sensor=sensor), deviation=1.0)
