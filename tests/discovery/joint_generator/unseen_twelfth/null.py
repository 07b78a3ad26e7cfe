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
from .sensor import speed_of


@form("none")
def converter_misses_codes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kester 2005 (a drive in steps of 2 % of friction, of which each fifth is missing, under its noise; 1.9 off)."""
    step = 0.02 * bench.level / bench.gain

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        changed = {}
        for name in drives(record):
            code = np.round(record[name] / step)
            changed[name] = step * np.where(np.mod(code, 5.0) == 3.0, code - 1.0, code)
        return record | changed

    return Effect(measure=measure, deviation=1.9)


def buzz(rng: Generator, n: int, turns: float, quality: float) -> Array:
    """Noise about a tone of so many turns a row: an autoregression of second order, of unit deviation."""
    kept = float(np.exp(-np.pi * turns / quality))
    first, second = 2.0 * kept * np.cos(2.0 * np.pi * turns), kept**2
    spread = np.sqrt((1.0 + second) / ((1.0 - second) * ((1.0 + second) ** 2 - first**2)))
    return lfilter([1.0 / spread], [1.0, -first, second], rng.standard_normal(n + 2000))[2000:]


@form("none")
def read_head_buzzes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Yule 1927 (a read head that buzzes about 110 Hz, as loud as the encoder's noise; 1 kHz; numbers at their limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        size = bench.sensor.position
        return record | {name: record[name] + size * buzz(rng, record[name].size, 0.11, 4.0) for name in positions(record)}

    return Effect(rig=lambda bench: replace(bench, rate=1000.0), measure=measure, deviation=2.0)


@form("none")
def arc_sine_noise_of_a_series(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson, Kotz and Balakrishnan 1995 (noise that is mostly at either limit, twice both; a series at 750 Hz; 1.8 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + 2.0 * size * np.sqrt(2.0) * np.sin(
                    rng.uniform(0.0, 2.0 * np.pi, record[name].size)
                )
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=750.0, motion="series"), measure=measure, deviation=1.8)


@form("none")
def rows_in_bursts(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Emery and Thomson 2001 (a logger in bursts: all rows for 0.8 s, each fourth for 0.4 s, stamped rightly; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        kept = (np.mod(t + rng.uniform(0.0, 1.2), 1.2) < 0.8) | (np.arange(t.size) % 4 == 0)
        return {name: x[kept] for name, x in record.items()}

    return Effect(rig=lambda bench: replace(bench, rate=1600.0), measure=measure, deviation=2.0)


@form("none")
def single_precision(rng: Generator, strength: float, bench: Bench) -> Effect:
    """IEEE 754-1985, in Goldberg 1991 (every number of a file in 24 bits; trapezoids at 850 Hz; four runs of six; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return {name: x.astype(np.float32).astype(np.float64) for name, x in record.items()}

    return Effect(
        rig=lambda bench: replace(bench, rate=850.0, motion="ramps", n_fit=4, n_test=2, duration=6.5),
        measure=measure,
        deviation=2.0,
    )


@form("none")
def read_head_shakes_when_fast(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Slocum 1992 (noise of the position that grows with the speed, to three times; a sweep; numbers at 1.7 deviations)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for name in positions(record):
            fast = np.minimum(np.abs(speed_of(record[name], record["time [s]"])) / bench.speed, 1.2)
            changed[name] = record[name] + 2.8 * bench.sensor.position * fast * rng.standard_normal(fast.size)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, motion="sweep"), measure=measure, deviation=1.7)


@form("none", on=("slider",))
def level_above_and_noise_of_two_sides(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Pearson 1894 (constant friction a quarter of a deviation above the stated one; a cell that flickers to two sides)."""

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            return 3e-4 * rng.choice([-1.0, 1.0], t.size)

        return RateAndState(0.6355, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def chalked_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Coulomb 1785 (constant friction seven tenths of a deviation above the stated one; starts of 1.15 to 1.65 m/s)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.405, starts=(1.15, 1.65), noise=1.0e-4))
