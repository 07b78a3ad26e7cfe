"""Nothing is missing: numbers are off within their uncertainty, sensors are what they are."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench, Sensor
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import coloured, drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form


def beside(record: Record, columns: list[str], size: float, correlation: float, rng: Generator) -> Record:
    """The record with coloured noise of this deviation in some columns."""
    return record | {x: record[x] + size * coloured(rng.standard_normal(record[x].size), correlation) for x in columns}


@form("none")
def current_loop_is_heard(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box and Jenkins 1970 (noise of the drive, twice its sensor's, that forgets within 4 to 15 ms; 1 kHz; 1.5 off)."""
    time, size = rng.uniform(0.004, 0.015), 2.0 * bench.sensor.drive / bench.gain

    def measure(record: Record, rng: Generator) -> Record:
        return beside(record, drives(record), size, float(np.exp(-1e-3 / time)), rng)

    return Effect({"time": time}, rig=lambda bench: replace(bench, rate=1000.0), measure=measure, deviation=1.5)


@form("none")
def encoder_of_fourteen_bits(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Widrow and Kollar 2008 (an encoder of fourteen bits over 1.2 times the way, without other noise; 2 kHz; 1.8 off)."""

    def rig(bench: Bench) -> Bench:
        return replace(bench, rate=2000.0, sensor=Sensor(0.0, bench.sensor.drive, resolution=2.4 * bench.reach / 2**14))

    return Effect(rig=rig, deviation=1.8)


@form("none")
def stamps_by_a_busy_computer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mills 1991 (stamps that a busy computer gives 4 % of an interval early or late, taken in time; 500 Hz; 1.6 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"time [s]": t + 0.04 / 500.0 * np.clip(rng.standard_normal(t.size), -3.0, 3.0)}

    return Effect(rig=lambda bench: replace(bench, rate=500.0), measure=measure, deviation=1.6)


@form("none")
def slow_logger_of_a_plc(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Swevers, Ganseman, Tukel, De Schutter and Van Brussel 1997 (a series of sines, logged at 200 Hz; numbers at limits)."""
    return Effect(rig=lambda bench: replace(bench, rate=200.0, motion="series"), deviation=2.0)


@form("none")
def scope_at_5_khz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Biagiotti and Melchiorri 2008 (trapezoids at 5 kHz, and sensors twice as loud as usual; 1.4 off)."""

    def rig(bench: Bench) -> Bench:
        loud = Sensor(2.0 * bench.sensor.position, 2.0 * bench.sensor.drive)
        return replace(bench, rate=5000.0, motion="ramps", duration=8.0, sensor=loud)

    return Effect(rig=rig, deviation=1.4)


@form("none")
def drive_in_steps_of_a_converter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bennett 1948 (a drive that is recorded in steps of 2 % of friction; 2.5 kHz; numbers at their limits)."""
    step = 0.02 * bench.level / bench.gain

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: step * np.round(record[name] / step) for name in drives(record)}

    return Effect(rig=lambda bench: replace(bench, rate=2500.0), measure=measure, deviation=2.0)


@form("none")
def interpolator_wanders(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Heydemann 1981 (an interpolated encoder, whose noise is twice the usual and lasts for some samples; 800 Hz; 1.7 off)."""
    correlation = rng.uniform(0.5, 0.8)

    def measure(record: Record, rng: Generator) -> Record:
        return beside(record, positions(record), 2.0 * bench.sensor.position, correlation, rng)

    return Effect({"correlation": correlation}, rig=lambda bench: replace(bench, rate=800.0), measure=measure, deviation=1.7)


@form("none")
def thermometer_beside_a_dry_guide(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fraden 2016 (a thermometer is recorded as the room warms by 6 degrees, and dry friction does not ask; 1 kHz; 1.8 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        warm = 21.0 + 6.0 * (1.0 - np.exp(-t / (0.5 * bench.duration)))
        return record | {"temperature [degC]": warm + 0.05 * rng.standard_normal(t.size)}

    return Effect(rig=lambda bench: replace(bench, rate=1000.0), measure=measure, deviation=1.8)


@form("none", on=("slider",))
def level_below_and_a_wandering_cell(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Byerlee 1978 (constant friction six tenths of a deviation below the stated one; a cell whose noise lasts for samples)."""

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            return 2e-4 * coloured(rng.standard_normal(t.size), 0.7)

        return RateAndState(0.583, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def block_of_dry_beech(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Coulomb 1785 (constant friction four tenths of a deviation above the stated one; a camera a little louder than usual)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.36, starts=(1.2, 1.6), noise=1e-4))
