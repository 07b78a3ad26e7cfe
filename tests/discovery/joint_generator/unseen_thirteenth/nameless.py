"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

from dataclasses import replace

import numpy as np
from scipy.signal import fftconvolve, savgol_filter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import LINES, SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import FACTOR_ON_SPEED, Array, Plant
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place
from tests.discovery.joint_generator.unseen_twelfth.nameless import place_of, undeclared
from tests.discovery.joint_generator.unseen_twelfth.sensor import speed_of

from .enter import form

TURN = 2.0 * np.pi


def step_of(record: Record) -> float:
    """Time between two rows [s]."""
    return float(np.median(np.diff(record["time [s]"])))


def accelerations(x: Array, step: float) -> Array:
    """Along a record, by a running polynomial over 60 ms."""
    return savgol_filter(x, 2 * max(3, round(0.03 / step)) + 1, 3, deriv=2, delta=step)


@form("unknown", on=SINGLES)
def linkage_behind_the_joint(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Eksergian 1930 (a linkage behind the joint: the inertia that it adds waves along the stroke, by half of it either way).

    What it asks for is the acceleration by the place, and the square of the speed by its slope; in the mean nothing is
    heavier, and a force by the place alone would be the same at any speed.
    """
    size, wave, start = 0.5 * strength * bench.inertia, TURN / (1.6 * bench.reach), rng.uniform(0.0, TURN)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q, step = drive_of_the_place(record, bench), record[place_of(record, bench)], step_of(record)
        v, angle = speed_of(q, record["time [s]"]), wave * q + start
        asked = size * (np.sin(angle) * accelerations(q, step) + 0.5 * wave * np.cos(angle) * v**2)
        return record | {name: record[name] + asked / bench.gain}

    return Effect({"size": size, "wave": wave, "start": start}, rig=undeclared, measure=measure)


@form("unknown", on=LINES)
def rotor_out_of_balance(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rao 2011 (a motor on the carriage, geared to its rail, whose rotor is out of balance: it shakes by the speed's square).

    A wave along the way whose size is the square of the speed: no force of the place, no wave in time and no drag.
    """
    size, pitch, start = 2.0 * strength * bench.level, bench.reach * rng.uniform(0.3, 0.4), rng.uniform(0.0, TURN)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        u = speed_of(q, record["time [s]"]) / bench.speed
        return record | {name: record[name] + size * u**2 * np.sin(TURN * q / pitch + start) / bench.gain}

    return Effect({"size": size, "pitch": pitch, "start": start}, rig=undeclared, measure=measure)


def half_derivative(x: Array, step: float) -> Array:
    """Derivative of order 1/2 from the record's begin on, by the sum of Gruenwald and Letnikov."""
    k = np.arange(1.0, x.size)
    weights = np.concatenate([[1.0], np.cumprod((k - 1.5) / k)])
    return fftconvolve(x - x[0], weights)[: x.size] / np.sqrt(step)


@form("unknown", also=("position_dependent_force", "viscous_friction"))
def rubber_of_half_order(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bagley and Torvik 1983 (rubber that joins the joint to its frame: it pulls by the derivative of order 1/2 of the way).

    Half of it a spring would explain, and the other half a drag; together they err by the frequency, and it remembers.
    """
    size = 0.8 * strength * bench.level

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), record[place_of(record, bench)]
        pulls = half_derivative(x / bench.reach, step_of(record)) / np.sqrt(bench.speed / bench.reach)
        return record | {name: record[name] + size * pulls / bench.gain}

    return Effect({"size": size}, rig=undeclared, measure=measure)


def structure(speed: Array, step: float, rest: float, way: float) -> Array:
    """Share of a grease's structure that is left: it is worked down by the way and builds up at rest in a time."""
    left, shares = 1.0, np.empty_like(speed)
    for i, v in enumerate(speed):
        rate = 1.0 / rest + v / way
        left = 1.0 / (rest * rate) + (left - 1.0 / (rest * rate)) * np.exp(-rate * step)
        shares[i] = left
    return shares


@form("unknown", also=("viscous_friction", "frictional_lag"))
def grease_is_worked_soft(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Moore 1959 (a thixotropic grease: a drag by the speed and by a structure that work breaks down and rest restores).

    At one speed after another it is a curve of the speed; what it drags in a stroke depends on what went before.
    """
    size, rest, way = 3.0 * strength * bench.level, 0.8, 0.5 * bench.reach

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        drags = size * structure(np.abs(v), step_of(record), rest, way) * v / bench.speed
        return record | {name: record[name] + drags / bench.gain}

    return Effect({"size": size, "rest": rest, "way": way}, rig=undeclared, measure=measure)


def last_stroke(x: Array, v: Array, slow: float) -> Array:
    """Length of the stroke before the one that a row belongs to, of which none is shorter than what noise makes."""
    way = np.where(np.abs(v) > slow, np.sign(v), 0.0)
    at = np.maximum.accumulate(np.where(way != 0.0, np.arange(x.size), 0))
    turns = np.flatnonzero(np.diff(way[at])) + 1
    length, begin, lengths = np.nan, 0, np.full(x.size, np.nan)
    for turn in turns:
        length, begin = abs(x[turn] - x[begin]), turn
        lengths[turn:] = length
    return lengths


@form("unknown", also=("random_coefficients", "correlated_coefficients"), on=SINGLES)
def long_strokes_carry_oil(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lugt 2013 (a guide that only long strokes oil: after a short one it rubs more, after a long one less).

    The length of the last stroke decides about the next one; who does not look at that sees friction that scatters.
    """
    more = 0.6 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drive_of_the_place(record, bench), record[place_of(record, bench)]
        v = speed_of(x, record["time [s]"])
        length = np.nan_to_num(last_stroke(x, v, 0.05 * bench.speed), nan=1.35 * bench.reach)
        dry = np.clip((1.35 - length / bench.reach) / 0.5, -1.0, 1.0)
        return record | {name: record[name] + more * bench.level * dry * np.tanh(v / (0.02 * bench.speed)) / bench.gain}

    return Effect({"more": more}, rig=lambda bench: replace(undeclared(bench), motion="strokes"), measure=measure)


@form("unknown", on=("arm",))
def rod_turns_in_the_base(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tsai 1999 (an arm whose forearm a parallel rod holds in the base: its bearing rubs by the sum of both joints' speeds).

    Both drives have the same torque, whose sign is that of neither joint's speed; each alone would call it noise.
    """
    more = 0.9 * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        speeds = [speed_of(record[name], record["time [s]"]) for name in positions(record)]
        rubs = more * bench.level * np.tanh((speeds[0] + speeds[1]) / (0.03 * bench.speed))
        return record | {name: record[name] + rubs for name in drives(record)}

    return Effect({"more": more}, rig=undeclared, measure=measure)


@form("unknown", also=("direction_asymmetry", "temperature_drift"))
def lip_bites_when_cold(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mueller and Nau 1998 (a lip that bites forward alone, and only while it is cold; a gauge shows when).

    Friction by the direction and the temperature at once: either name alone has half of it, and errs as much.
    """
    size, start, waves = 1.3 * strength * bench.level, rng.uniform(0.0, 1.0), rng.uniform(2.2, 2.8)

    def cold(t: Array) -> Array:
        return 0.5 + 0.5 * np.sin(TURN * (waves * t / bench.duration + start))

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        plant = plant.add_by_speed(lambda v: size + 0.0 * v, lambda v: 0.0 * v)
        return plant.times_in_time(FACTOR_ON_SPEED, cold)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": 32.0 - 12.0 * cold(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"size": size}, alter=alter, measure=measure)


@form("unknown", on=SINGLES)
def indicator_tracks_its_zero(rng: Generator, strength: float, bench: Bench) -> Effect:
    """OIML R 76-1:2006 (an indicator that tracks its zero: while the joint stands, it takes what is held for nothing).

    From each rest on the drive is off by another constant; no force acts, and no gain, time or place decides.
    """
    time, stands = 0.08, 0.05 * bench.speed

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, x = drives(record)[0], record[drives(record)[0]]
        still = np.abs(speed_of(record[positions(record)[0]], record["time [s]"])) < stands
        kept, zero, zeros = float(np.exp(-step_of(record) / time)), 0.0, np.empty_like(x)
        for i, value in enumerate(x):
            zero = value + (zero - value) * kept if still[i] else zero
            zeros[i] = zero
        return record | {name: x - strength * zeros}

    return Effect({"time": time}, measure=measure)


@form("unknown", on=("slider",))
def load_is_stepped_unnoted(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Linker and Dieterich 1992 (a load that is stepped at times nobody noted: contacts answer at once, and slip wears it off).

    The coefficient jumps up or down at six times by chance in each run and comes back with the way slid; no speed makes
    it jump, and it drifts nowhere.
    """
    size, distance = 0.013 * strength, 8e-6

    def law(rng: Generator) -> RateAndState:
        times, sides = np.sort(rng.uniform(0.05, 0.98, 6)), rng.choice([-1.0, 1.0], 6)

        def added(t: Array, x: Array) -> Array:
            total = np.zeros_like(t)
            for share, side in zip(times, sides, strict=True):
                begin = min(int(share * t.size), t.size - 1)
                total[begin:] += side * size * np.exp(-(x[begin:] - x[begin]) / distance)
            return total

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size, "distance": distance}, law=law)


@form("unknown", also=("viscous_friction",), on=("thrown",))
def ball_begins_to_roll(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Frohlich 2004 (a ball that is let go without spin: it slides down to 5/7 of the speed it began with, and rolls then).

    Its own start decides, neither a speed nor a place: the slow ones still slide at the speed at which quick ones roll.
    """
    slides, rolls = 0.28, 0.28 * (1.0 - 0.75 * strength)

    def law(_: Generator) -> Throw:
        first = [0.0]

        def mu(v: float, x: float) -> float:
            if x == 0.0:
                first[0] = v
            return slides if v > first[0] * 5.0 / 7.0 else rolls

        return Throw(mu, starts=(0.8, 1.7))

    return Effect({"slides": slides, "rolls": rolls}, law=law)
