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
def limits_at_200_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """JCGM 100:2008; Widrow and Kollar 2008 (every number two deviations off; an encoder of 2.5e-4 of the reach, alone)."""
    return Effect(
        rig=lambda bench: replace(
            bench, rate=200.0, sensor=replace(bench.sensor, position=0.0, resolution=2.5e-4 * bench.reach)
        ),
        deviation=2.0,
    )


@form("none")
def pink_at_5_khz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Keshner 1982 (1/f noise of both sensors, as loud as their own, at a high rate; one deviation off)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + size * pink(rng.standard_normal(record[name].size))
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=5000.0, duration=8.0), measure=measure, deviation=1.0)


@form("none")
def jitter_of_a_series(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Balakrishnan 1962 (rows taken up to 4 % of an interval early or late, evenly; a Fourier series at 640 Hz)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        taken = t + 0.04 / 640.0 * rng.uniform(-1.0, 1.0, t.size)
        return record | {name: np.interp(taken, t, x) for name, x in record.items() if name != "time [s]"} | {"time [s]": t}

    return Effect(rig=lambda bench: replace(bench, rate=640.0, motion="series"), measure=measure, deviation=1.5)


@form("none")
def rows_lost_at_1250_hz(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Little and Rubin 1987 (one row of fifty is lost, never two in a row; numbers at their limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        lost = rng.random(record["time [s]"].size) < 0.02
        lost[0] = False
        lost[1:] &= ~lost[:-1]
        return {name: x[~lost] for name, x in record.items()}

    return Effect(rig=lambda bench: replace(bench, rate=1250.0), measure=measure, deviation=2.0)


@form("none")
def hum_and_hyperbolic_secant(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ott 2009; Baten 1934 (60 Hz in the drive's wires, as loud as its noise, and heavy tails of the encoder; a sweep)."""

    def measure(record: Record, rng: Generator) -> Record:
        t, start = record["time [s]"], rng.uniform(0.0, 2.0 * np.pi)
        hum = np.sqrt(2.0) * bench.sensor.drive / bench.gain * np.sin(2.0 * np.pi * 60.0 * t + start)
        changed = {name: record[name] + hum for name in drives(record)}
        for name in positions(record):
            tails = 2.0 / np.pi * np.arcsinh(np.tan(np.pi * (rng.random(t.size) - 0.5)))
            changed[name] = record[name] + bench.sensor.position * tails
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=900.0, motion="sweep"), measure=measure, deviation=4.0 / 3.0)


@form("none")
def eight_runs_of_ramps(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Biagiotti and Melchiorri 2008 (trapezoids; five runs to fit, three to score, 4.5 s each; numbers at their limits)."""
    return Effect(rig=lambda bench: replace(bench, motion="ramps", n_fit=5, n_test=3, duration=4.5), deviation=2.0)


@form("none", on=("slider",))
def cell_of_pink_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Keshner 1982 (constant friction 1.1 standard deviations below the stated one; 1/f noise of the load cell)."""
    return Effect(law=lambda rng: RateAndState(0.55, 0.0, added=lambda t, x: 2e-4 * pink(rng.standard_normal(t.size))))


@form("none", on=("thrown",))
def lower_level(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Constant friction at half a standard deviation below the stated one; starts of 0.9 to 1.6 m/s, read thrice as badly."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.225, starts=(0.9, 1.6), noise=2.4e-4))
