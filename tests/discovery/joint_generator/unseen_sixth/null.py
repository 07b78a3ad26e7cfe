"""Nothing is missing: numbers are off within their uncertainty, sensors are what they are."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen.null import pink

from .enter import form


@form("none")
def limits_and_coarse_bits(rng: Generator, strength: float, bench: Bench) -> Effect:
    """JCGM 100:2008; Widrow and Kollar 2008 (two deviations off; a drive in steps of 4 % of friction, at 2.5 kHz)."""
    step = 0.04 * bench.level / bench.gain

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: step * np.round(record[name] / step) for name in drives(record)}

    return Effect(rig=lambda bench: replace(bench, rate=2500.0, duration=9.0), measure=measure, deviation=2.0)


@form("none")
def rows_at_odd_times(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Marvasti 2001 (a quarter of the rows is dropped by chance, few in a row; the others are stamped rightly; 1.6 kHz)."""

    def measure(record: Record, rng: Generator) -> Record:
        kept = rng.random(record["time [s]"].size) > 0.25
        kept[0] = True
        kept[2:] |= ~kept[1:-1] & ~kept[:-2]
        return {name: x[kept] for name, x in record.items()}

    return Effect(rig=lambda bench: replace(bench, rate=1600.0), measure=measure, deviation=1.0)


@form("none")
def pink_drive_of_a_sweep(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Keshner 1982; Sripad and Snyder 1977 (1/f noise of the drive, an even density of the encoder's; a sweep at 450 Hz)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for name in drives(record):
            changed[name] = record[name] + bench.sensor.drive / bench.gain * pink(rng.standard_normal(record[name].size))
        for name in positions(record):
            changed[name] = record[name] + bench.sensor.position * rng.uniform(-np.sqrt(3.0), np.sqrt(3.0), record[name].size)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=450.0, motion="sweep"), measure=measure, deviation=1.5)


@form("none")
def heavy_tails_of_a_series(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lange, Little and Taylor 1989 (Student's t of three degrees of freedom in both sensors; a Fourier series; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + size * rng.standard_t(3.0, record[name].size) / np.sqrt(3.0)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=750.0, motion="series"), measure=measure, deviation=2.0)


@form("none")
def logger_pauses(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Little and Rubin 1987 (a logger that pauses twice a run for 0.15 s, and stamps rightly; trapezoids)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        kept = np.ones(t.size, bool)
        for begin in t[-1] * rng.uniform([0.2, 0.6], [0.4, 0.8]):
            kept &= (t < begin) | (t > begin + 0.15)
        return {name: x[kept] for name, x in record.items()}

    return Effect(rig=lambda bench: replace(bench, motion="ramps"), measure=measure, deviation=4.0 / 3.0)


@form("none")
def zeros_wander_at_the_limits(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Uhlenbeck and Ornstein 1930 (the drive's zero wanders by 0.7 of its noise, in 1.2 s; numbers at their limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        kept, size = float(np.exp(-(t[1] - t[0]) / 1.2)), 0.7 * bench.sensor.drive / bench.gain
        changed = {}
        for name in drives(record):
            zero = np.empty(t.size)
            now = rng.standard_normal()
            for i in range(t.size):
                zero[i] = now
                now = kept * now + np.sqrt(1.0 - kept**2) * rng.standard_normal()
            changed[name] = record[name] + size * zero
        return record | changed

    return Effect(measure=measure, deviation=2.0)


@form("none", on=("slider",))
def level_above_and_heavy_tails(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lange, Little and Taylor 1989 (constant friction 1.3 standard deviations above the stated one; Student's t noise)."""
    return Effect(law=lambda rng: RateAndState(0.7, 0.0, added=lambda t, x: 2e-4 * rng.standard_t(4.0, t.size)))


@form("none", on=("thrown",))
def rougher_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Constant friction two fifths of a standard deviation above the stated one; starts of 1 to 1.7 m/s, read badly."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.36, starts=(1.0, 1.7), noise=1.6e-4))
