"""Nothing is missing: numbers are off within their uncertainty, sensors are what they are."""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form


def rounded(x: Array, digits: int) -> Array:
    """Numbers with so many digits."""
    step = 10.0 ** (np.floor(np.log10(np.maximum(np.abs(x), 1e-300))) + 1.0 - digits)
    return np.round(x / step) * step


@form("none")
def three_digits_in_the_file(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Higham 2002 (a logger that writes drives with three digits and positions with five; trapezoids at 2 kHz; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        coarse = {name: rounded(record[name], 3) for name in drives(record)}
        return record | coarse | {name: rounded(record[name], 5) for name in positions(record)}

    return Effect(rig=lambda bench: replace(bench, rate=2000.0, motion="ramps"), measure=measure, deviation=2.0)


@form("none")
def laser_is_louder_far_away(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rueger 1990 (noise of the position that grows with the distance from the laser, to three times; a sweep; 1.7 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for name in positions(record):
            far = np.clip(0.5 + 0.5 * record[name] / bench.reach, 0.0, 1.2)
            changed[name] = record[name] + 2.8 * bench.sensor.position * far * rng.standard_normal(far.size)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, motion="sweep"), measure=measure, deviation=1.7)


@form("none")
def fewer_rows_while_slow(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Miskowicz 2006 (a logger that keeps every row of a quick motion, every third of a slow one; stamped rightly; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, n = record["time [s]"], 10
        x = record[positions(record)[bench.place if bench.design == "arm" else 0]]
        smooth = np.convolve(np.pad(x, n, mode="edge"), np.ones(2 * n + 1) / (2 * n + 1), mode="valid")
        kept = (np.abs(np.gradient(smooth, t)) > 0.35 * bench.speed) | (np.arange(t.size) % 3 == 0)
        return {name: values[kept] for name, values in record.items()}

    return Effect(rig=lambda bench: replace(bench, rate=1200.0), measure=measure, deviation=2.0)


@form("none")
def coarser_when_fast(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kavanagh 2001 (an encoder of 5e-5 of the reach that gives up its last two bits beyond a speed; a series; 1.6 off)."""
    step = 5e-5 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, changed = record["time [s]"], {}
        for name in positions(record):
            fast = np.abs(np.gradient(record[name], t)) > 0.4 * bench.speed
            steps = np.where(fast, 4.0 * step, step)
            changed[name] = np.round(record[name] / steps) * steps
        return record | changed

    return Effect(
        rig=lambda bench: replace(bench, rate=900.0, motion="series", sensor=replace(bench.sensor, position=0.0)),
        measure=measure,
        deviation=1.6,
    )


@form("none")
def last_digit_flickers(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bernoulli 1713 (a last digit of either sensor that flickers up or down, as loud as its noise; four runs of six; 1.8)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + size * rng.choice([-1.0, 1.0], record[name].size)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, n_fit=4, n_test=2, duration=6.0), measure=measure, deviation=1.8)


@form("none")
def shot_noise_of_the_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Schottky 1918 (150 pulses of 3 ms a second, of either sign, as loud as the drive's noise; 800 Hz; limits)."""
    rate, time = 150.0, 0.003

    def measure(record: Record, rng: Generator) -> Record:
        changed, step = {}, 1.0 / bench.rate
        kept = float(np.exp(-step / time))
        size = bench.sensor.drive / bench.gain * np.sqrt((1.0 - kept**2) / (rate * step))
        for name in drives(record):
            n = record[name].size
            pulses = rng.poisson(0.5 * rate * step, n) - rng.poisson(0.5 * rate * step, n)
            changed[name] = record[name] + lfilter([size], [1.0, -kept], pulses)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=800.0), measure=measure, deviation=2.0)


@form("none", on=("slider",))
def level_below_and_triangular_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Simpson 1755 (constant friction seven tenths of a deviation below the stated one; a triangular density of noise)."""

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            return 2.5e-4 * rng.triangular(-2.4, 0.0, 2.4, t.size)

        return RateAndState(0.577, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def sanded_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Coulomb 1785 (constant friction a fifth of a deviation above the stated one; starts of 0.95 to 1.35 m/s)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.33, starts=(0.95, 1.35), noise=1.3e-4))
