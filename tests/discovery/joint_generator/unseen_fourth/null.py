"""Nothing is missing: numbers are off within their uncertainty, sensors are what they are."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen.null import pink

from .enter import form

TWO_THIRDS = 4.0 / 3.0
"""Two thirds of the two standard deviations that a number may be off."""


@form("none")
def pink_both(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Keshner 1982 (1/f noise of both sensors, as loud as their own; numbers at two thirds of their limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + size * pink(rng.standard_normal(record[name].size))
        return record | changed

    return Effect(measure=measure, deviation=TWO_THIRDS)


@form("none")
def steps_at_400_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Widrow and Kollar 2008 (an encoder of 1.5e-4 of the reach, no other noise; drive in steps of thrice its noise)."""

    def rig(bench: Bench) -> Bench:
        return replace(bench, rate=400.0, sensor=replace(bench.sensor, position=0.0, resolution=1.5e-4 * bench.reach))

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        step = 3.0 * bench.sensor.drive / bench.gain
        return record | {name: step * np.round(record[name] / step) for name in drives(record)}

    return Effect(rig=rig, measure=measure)


@form("none")
def stamps_jitter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Balakrishnan 1962 (rows are taken up to 3 % of an interval early or late, evenly; trapezoids)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        taken = t + 0.03 / bench.rate * rng.uniform(-1.0, 1.0, t.size)
        return record | {name: np.interp(taken, t, x) for name, x in record.items() if name != "time [s]"}

    return Effect(rig=lambda bench: replace(bench, motion="ramps"), measure=measure, deviation=TWO_THIRDS)


@form("none")
def double_exponential_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Laplace 1774 (noise whose density falls exponentially to both sides, twice that of both sensors)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + 2.0 * size * rng.laplace(0.0, np.sqrt(0.5), record[name].size)
        return record | changed

    return Effect(measure=measure)


@form("none", on=("thrown",))
def higher_level(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Constant friction at two thirds of its limits above the stated one; starts of 1.0 to 1.7 m/s, read twice as badly."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.3 * (1.0 + 0.2 * TWO_THIRDS), starts=(1.0, 1.7), noise=1.6e-4))
