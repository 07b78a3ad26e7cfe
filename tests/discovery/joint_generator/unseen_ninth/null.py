"""Nothing is missing: numbers are off within their uncertainty, sensors are what they are."""

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


def contaminated(rng: Generator, n: int) -> Array:
    """Noise of which one reading of twenty is three times as loud."""
    return rng.standard_normal(n) * np.where(rng.random(n) < 0.05, 3.0, 1.0)


@form("none")
def contaminated_noise_of_ramps(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tukey 1960 (both sensors' noise again, one reading of twenty three times as loud; trapezoids; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + size * contaminated(rng, record[name].size)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, motion="ramps"), measure=measure, deviation=2.0)


@form("none")
def rows_of_two_spacings(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bilinskis 2007 (a logger that misses every third of its rows, and stamps the others rightly; 1.5 kHz; 1.7 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        kept = np.arange(record["time [s]"].size) % 3 != 2
        return {name: x[kept] for name, x in record.items()}

    return Effect(rig=lambda bench: replace(bench, rate=1500.0), measure=measure, deviation=1.7)


@form("none")
def interpolation_of_a_scale(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Heydemann 1981 (an encoder whose interpolation errs by half of its noise, a hundred times a reach; a sweep; 1.5 off)."""
    pitch, size = 0.01 * bench.reach, 0.7 * bench.sensor.position

    def measure(record: Record, rng: Generator) -> Record:
        start = rng.uniform(0.0, 2.0 * np.pi)
        return record | {
            name: record[name] + size * np.sin(2.0 * np.pi * record[name] / pitch + start) for name in positions(record)
        }

    return Effect(rig=lambda bench: replace(bench, motion="sweep"), measure=measure, deviation=1.5)


@form("none")
def brushes_are_louder_when_fast(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Holm 1967 (noise of the drive that grows with the speed, to three times; a Fourier series at 650 Hz; 1.9 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        t, n, changed = record["time [s]"], 9, {}
        for name, place in zip(drives(record), positions(record), strict=True):
            smooth = np.convolve(np.pad(record[place], n, mode="edge"), np.ones(2 * n + 1) / (2 * n + 1), mode="valid")
            share = np.minimum(np.abs(np.gradient(smooth, t)) / bench.speed, 1.0)
            more = 2.8 * share * bench.sensor.drive / bench.gain
            changed[name] = record[name] + more * rng.standard_normal(t.size)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=650.0, motion="series"), measure=measure, deviation=1.9)


@form("none")
def middle_of_the_stroke_alone(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gautier and Khalil 1992 (an excitation that is too small: two fifths of the way, half of the speed; limits)."""
    return Effect(rig=lambda bench: replace(bench, reach=0.4 * bench.reach, speed=0.5 * bench.speed), deviation=2.0)


@form("none")
def sigma_delta_of_the_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Candy and Temes 1992 (noise of the drive that a modulator has shaped: second differences, as loud as its own)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for name in drives(record):
            shaped = np.diff(rng.standard_normal(record[name].size + 2), 2) / np.sqrt(6.0)
            changed[name] = record[name] + bench.sensor.drive / bench.gain * shaped
        return record | changed

    return Effect(rig=lambda bench: replace(bench, n_fit=3, n_test=2, duration=8.0), measure=measure, deviation=1.6)


@form("none", on=("slider",))
def level_below_and_contaminated(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tukey 1960 (constant friction a deviation below the stated one; one reading of twenty three times as noisy)."""

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            return 2e-4 * contaminated(rng, t.size)

        return RateAndState(0.5, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def waxed_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Coulomb 1785 (constant friction nine tenths of a deviation below the stated one; starts of 0.9 to 1.4 m/s)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.246, starts=(0.9, 1.4), noise=1.6e-4))
