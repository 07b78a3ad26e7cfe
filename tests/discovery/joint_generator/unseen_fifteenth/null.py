"""Nothing is missing: numbers are off within their uncertainty, sensors and loggers are what they are."""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter
from scipy.special import gamma

from tests.discovery.joint_generator.bench import Bench, Sensor
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import coloured, drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RATE, RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi


@form("none")
def runs_ended_by_hand(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rubin 1976 (runs that somebody ends by hand after 55 to 100 % of their time; trapezoids at 1400 Hz; five runs; 1.8)."""

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        kept = t <= rng.uniform(0.55, 1.0) * t[-1]
        return {name: x[kept] for name, x in record.items()}

    return Effect(
        rig=lambda bench: replace(bench, rate=1400.0, motion="ramps", n_fit=3, n_test=2), measure=measure, deviation=1.8
    )


def triggered(x: Array, step: float) -> Array:
    """Counts of an encoder whose trigger switches six tenths of a step behind a line, either way."""
    held, last = np.empty_like(x), x[0]
    for i, value in enumerate(x):
        last = min(max(last, value - 0.1 * step), value + 0.1 * step)
        held[i] = last
    return np.round(held / step)


@form("none")
def trigger_with_hysteresis(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Schmitt 1938 (an encoder of 8e-5 of the reach, whose trigger switches late either way; a sweep at 1.1 kHz; limits)."""
    step = 8e-5 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {name: step * triggered(record[name], step) for name in positions(record)}

    def rig(bench: Bench) -> Bench:
        return replace(bench, rate=1100.0, motion="sweep", sensor=Sensor(0.0, bench.sensor.drive))

    return Effect(rig=rig, measure=measure, deviation=2.0)


@form("none")
def channels_one_after_another(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Austerlitz 2003 (a multiplexer: positions are taken a seventh of an interval after drives; a series at 5 kHz; 1.6)."""

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t = record["time [s]"]
        taken = t + float(np.median(np.diff(t))) / 7.0
        return record | {name: np.interp(taken, t, record[name]) for name in positions(record)}

    return Effect(rig=lambda bench: replace(bench, rate=5000.0, motion="series"), measure=measure, deviation=1.6)


@form("none")
def clock_is_set_each_second(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Eidson 2006 (a clock that gains or loses a tenth of a row each second, and is set right then; 730 Hz; limits)."""
    gains = 0.1 * either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        off = gains * (np.mod(t + rng.uniform(0.0, 1.0), 1.0) - 0.5) * float(np.median(np.diff(t)))
        return record | {name: np.interp(t + off, t, x) for name, x in record.items() if name != "time [s]"}

    return Effect(rig=lambda bench: replace(bench, rate=730.0), measure=measure, deviation=2.0)


def flat_topped(rng: Generator, n: int) -> Array:
    """Noise of unit deviation whose density falls by the exponential of the fourth power: a flat top and short tails."""
    size = rng.gamma(0.25, size=n) ** 0.25 * rng.choice([-1.0, 1.0], n)
    return size * np.sqrt(gamma(0.25) / gamma(0.75))


@form("none")
def flat_topped_noise(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Subbotin 1923 (noise of both sensors with a flat top and short tails, as loud again as theirs; 900 Hz; 1.7 off)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed = {}
        for columns, size in ((positions(record), bench.sensor.position), (drives(record), bench.sensor.drive / bench.gain)):
            for name in columns:
                changed[name] = record[name] + 1.5 * size * flat_topped(rng, record[name].size)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=900.0), measure=measure, deviation=1.7)


@form("none")
def companded_drive(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Smith 1957 (a drive in ten bits of a logarithmic scale: fine steps about zero, 1 % when large; 2.4 kHz; limits)."""
    full, bend, steps = 20.0 * bench.level / bench.gain, 255.0, 512.0

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        changed = {}
        for name in drives(record):
            code = np.round(steps * np.log1p(bend * np.abs(record[name]) / full) / np.log1p(bend))
            changed[name] = np.sign(record[name]) * full * np.expm1(code / steps * np.log1p(bend)) / bend
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=2400.0), measure=measure, deviation=2.0)


@form("none")
def switching_tone_folds_back(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Holmes and Lipo 2003 (an amplifier that switches at 8.04 kHz, read at 1 kHz: a tone of 40 Hz as loud as noise; 1.9)."""

    def measure(record: Record, rng: Generator) -> Record:
        t, size = record["time [s]"], np.sqrt(2.0) * bench.sensor.drive / bench.gain
        tone = size * np.cos(TURN * (8040.0 * t + rng.uniform(0.0, 1.0)))
        return record | {name: record[name] + tone for name in drives(record)}

    return Effect(rig=lambda bench: replace(bench, rate=1000.0, motion="strokes"), measure=measure, deviation=1.9)


@form("none")
def noise_of_two_times(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gardiner 1985 (noise of the drive that is the sum of one of 3 and one of 40 ms, as loud as its own; ramps; limits)."""

    def measure(record: Record, rng: Generator) -> Record:
        changed, size = {}, np.sqrt(0.5) * bench.sensor.drive / bench.gain
        for name in drives(record):
            kept = (float(np.exp(-1.0 / (1700.0 * time))) for time in (0.003, 0.04))
            changed[name] = record[name] + size * sum(coloured(rng.standard_normal(record[name].size), k) for k in kept)
        return record | changed

    return Effect(rig=lambda bench: replace(bench, rate=1700.0, motion="ramps"), measure=measure, deviation=2.0)


def ringing_noise(rng: Generator, n: int, frequency: float, kept: float) -> Array:
    """Noise of unit deviation about a frequency [cycles a row], of whose waves a share is kept at each row."""
    turn = TURN * frequency
    spread = (1.0 + kept**2) / ((1.0 - kept**2) * (1.0 + kept**4 - 2.0 * kept**2 * np.cos(2.0 * turn)))
    noise = lfilter([1.0], [1.0, -2.0 * kept * np.cos(turn), kept**2], rng.standard_normal(n + 200))
    return noise[200:] / np.sqrt(spread)


@form("none", on=("slider",))
def level_below_and_a_cell_that_rings(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Priestley 1981 (constant friction a third of a deviation below the stated one; noise of the cell about 8 Hz)."""

    def law(rng: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            del x
            return 2e-4 * ringing_noise(rng, t.size, 8.0 / RATE, 0.9)

        return RateAndState(0.5993, 0.0, added=added)

    return Effect(law=law)


@form("none", on=("thrown",))
def planed_beech(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rennie 1829 (constant friction three tenths of a deviation above the stated one; starts of 1.1 to 1.6 m/s)."""
    return Effect(law=lambda _: Throw(lambda v, x: 0.345, starts=(1.1, 1.6), noise=1e-4))
