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


@form("none")
def mean_of_two_readings(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Horowitz and Hill 1989 (a converter that shows the mean of a drive's last two readings, at 2 kHz; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {
            name: 0.5 * (record[name] + np.concatenate([record[name][:1], record[name][:-1]])) for name in drives(record)
        }

    return Effect(rig=lambda bench: replace(bench, rate=2000.0), measure=measure, deviation=2.0)


@form("none")
def lines_of_unequal_width(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merry, van de Molengraft and Steinbuch 2010 (an encoder whose lines are wide and narrow in turn; a sweep; 1.8 off)."""
    pair = 1.6e-4 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        changed = {}
        for name in positions(record):
            whole = np.floor(record[name] / pair)
            changed[name] = pair * (whole + np.where(record[name] / pair - whole < 0.6, 0.3, 0.8))
        return record | changed

    return Effect(
        rig=lambda bench: replace(bench, motion="sweep", sensor=replace(bench.sensor, position=0.0)),
        measure=measure,
        deviation=1.8,
    )


@form("none")
def skewed_noise_of_a_series(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson, Kotz and Balakrishnan 1994 (exponential noise about its mean in both sensors; a Fourier series at 550 Hz)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + size * (rng.exponential(1.0, record[name].size) - 1.0)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=550.0, motion="series"), measure=measure, deviation=2.0)


@form("none")
def slack_controller_of_ramps(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Franklin, Powell and Workman 1998 (0.7 of the usual bandwidth; trapezoids at 1250 Hz; numbers at 1.9 deviations)."""
    return Effect(rig=lambda bench: replace(bench, rate=1250.0, motion="ramps", bandwidth=0.7), deviation=1.9)


@form("none")
def half_the_rows_from_half_time(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bilinskis 2007 (a logger that keeps every other row from the middle of a run on, stamped rightly; 1 kHz; 1.5 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        n = record["time [s]"].size
        kept = (np.arange(n) < n // 2) | (np.arange(n) % 2 == 0)
        return {name: x[kept] for name, x in record.items()}

    return Effect(rig=lambda bench: replace(bench, rate=1000.0), measure=measure, deviation=1.5)


@form("none")
def popcorn_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Horowitz and Hill 1989 (a zero of the drive that jumps between two levels, 0.6 of its noise to either side; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        t, size = record["time [s]"], 0.6 * bench.sensor.drive / bench.gain
        changed = {}
        for name in drives(record):
            jumps = np.cumsum(rng.exponential(1.0 / 15.0, int(40.0 * t[-1]) + 40))
            changed[name] = record[name] + size * (1.0 - 2.0 * (np.searchsorted(jumps, t) % 2))
        return record | changed

    return Effect(rig=lambda bench: replace(bench, n_fit=4, n_test=2, duration=7.0), measure=measure, deviation=2.0)


@form("none", on=("slider",))
def level_above_and_skewed_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson, Kotz and Balakrishnan 1994 (friction 0.4 of a deviation above the stated one; exponential noise of the cell)."""

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            return 2e-4 * (rng.exponential(1.0, t.size) - 1.0)

        return RateAndState(0.66, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def scrubbed_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Coulomb 1785 (constant friction an eighth of a deviation above the stated one; starts of 0.85 to 1.55 m/s)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.318, starts=(0.85, 1.55), noise=1.1e-4))
