"""Nothing is missing: numbers are off within their uncertainty, sensors and loggers are what they are."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench, Sensor
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RATE, RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi


@form("none")
def recorder_with_a_pre_trigger(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kularatna 2003 (a recorder that keeps what came before its trigger: stamps from -2 s; ramps at 1600 Hz; limits)."""
    return Effect(
        rig=lambda bench: replace(bench, rate=1600.0, motion="ramps"),
        measure=lambda record, _: record | {"time [s]": record["time [s]"] - 2.0},
        deviation=2.0,
    )


@form("none")
def fan_of_the_cabinet_runs_up(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Boashash 1992 (a cabinet's fan that runs up: a tone in the drive's wires from 60 to 240 Hz, as loud as noise; 2.2 kHz).

    Numbers are 1.8 deviations off.
    """

    def measure(record: Record, rng: Generator) -> Record:
        t, size = record["time [s]"], np.sqrt(2.0) * bench.sensor.drive / bench.gain
        last = float(t[-1])
        turns = 60.0 * t + 90.0 * t**2 / last + rng.uniform(0.0, 1.0)
        return record | {name: record[name] + size * np.cos(TURN * turns) for name in drives(record)}

    return Effect(rig=lambda bench: replace(bench, rate=2200.0), measure=measure, deviation=1.8)


@form("none")
def largest_of_many_shocks(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gumbel 1958 (noise of both sensors with the density of extremes about its mean, as loud as theirs; a series; 550 Hz)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                extreme = (rng.gumbel(size=record[name].size) - np.euler_gamma) * np.sqrt(6.0) / np.pi
                changed[name] = record[name] + size * extreme
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=550.0, motion="series"), measure=measure, deviation=1.7)


@form("none")
def thermometer_on_the_wall(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Wiener 1923 (a hall whose temperature wanders by a degree or two and is recorded; friction does not mind; a sweep)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        walk = np.cumsum(rng.standard_normal(t.size)) * np.sqrt(float(np.median(np.diff(t))) / bench.duration)
        return record | {"temperature [degC]": 21.0 + 1.5 * walk + 0.05 * rng.standard_normal(t.size)}

    return Effect(rig=lambda bench: replace(bench, rate=950.0, motion="sweep"), measure=measure, deviation=2.0)


@form("none")
def task_wakes_late(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Proctor and Shackleford 2001 (a logger's task that wakes late, never early: by 2 % of an interval in the mean; 1.9 kHz).

    Stamps are even; what is later than a tenth of an interval is dropped to that; numbers are 1.9 deviations off.
    """

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        late = np.minimum(rng.exponential(0.02, t.size), 0.1) * float(np.median(np.diff(t)))
        return record | {name: np.interp(t + late, t, x) for name, x in record.items() if name != "time [s]"}

    return Effect(rig=lambda bench: replace(bench, rate=1900.0, motion="strokes"), measure=measure, deviation=1.9)


def by_sine_and_cosine(x: Array, line: float, levels: float = 127.0) -> Array:
    """A place that is read from the sine and the cosine within a line, each in whole levels."""
    turns = x / line
    sine, cosine = np.round(levels * np.sin(TURN * turns)), np.round(levels * np.cos(TURN * turns))
    read = np.arctan2(sine, cosine) / TURN
    return line * (read + np.round(turns - read))


@form("none")
def sine_and_cosine_in_eight_bits(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hagiwara, Suzuki and Murase 1992 (an encoder read by eight-bit sine and cosine of lines of 3 % of the reach; 1.3 kHz).

    There is no other noise of the position; every number is two deviations off.
    """
    line = 0.03 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: by_sine_and_cosine(record[name], line) for name in positions(record)}

    def rig(bench: Bench) -> Bench:
        return replace(bench, rate=1300.0, sensor=Sensor(0.0, bench.sensor.drive))

    return Effect({"line": line}, rig=rig, measure=measure, deviation=2.0)


@form("none")
def one_run_to_fit_and_five_to_score(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Stone 1974 (one run of 14 s to fit, and five like it to score; a Fourier series at 340 Hz; numbers at 1.5 deviations)."""
    return Effect(
        rig=lambda bench: replace(bench, rate=340.0, motion="series", n_fit=1, n_test=5, duration=14.0), deviation=1.5
    )


@form("none")
def new_and_tight_seals(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Neale 1995 (a rig with new seals: twice the usual friction, stated as such; trapezoids at 3.6 kHz; limits)."""

    def rig(bench: Bench) -> Bench:
        first, second = bench.coulomb
        return replace(bench, coulomb=(2.0 * first, 2.0 * second), rate=3600.0, motion="ramps")

    return Effect(rig=rig, deviation=2.0)


@form("none", on=("slider",))
def level_above_and_a_cell_that_settles(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Breusch and Pagan 1979 (constant friction half a deviation above the stated one; noise that falls to a third)."""

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            settles = 1.0 / 3.0 + 2.0 / 3.0 * np.exp(-t / (600.0 / RATE))
            return 3e-4 * settles * rng.standard_normal(t.size)

        return RateAndState(0.651, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def planed_ash(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Vince 1785 (constant friction a quarter of a deviation below the stated one; starts of 1.2 to 1.55 m/s)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.2625, starts=(1.2, 1.55), noise=1.2e-4))
