"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import Array
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_third.nameless import drive_of_the_place
from tests.discovery.joint_generator.unseen_thirteenth.nameless import accelerations, step_of
from tests.discovery.joint_generator.unseen_twelfth.nameless import place_of, undeclared
from tests.discovery.joint_generator.unseen_twelfth.sensor import speed_of

from .enter import form

TURN = 2.0 * np.pi


def felt(bench: Bench) -> float:
    """Inertia that is felt beside the joint's own and beside its friction [kg or kg m^2]."""
    return max(bench.inertia, bench.level * bench.reach / bench.speed**2)


def engaged(v: Array, step: float, coasts: float) -> Array:
    """Whether a flywheel behind a freewheel is driven: the joint is as quick as it, which else coasts down in a time."""
    kept, wheel, driven = float(np.exp(-step / coasts)), 0.0, np.empty(v.size, dtype=bool)
    for i, speed in enumerate(v):
        wheel *= kept
        driven[i] = speed >= wheel
        wheel = max(speed, wheel)
    return driven


@form("unknown", also=("payload",), on=SINGLES)
def flywheel_behind_a_freewheel(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Orthwein 2004 (a flywheel behind a freewheel: the joint speeds it up one way, and never slows it down).

    Inertia while the joint speeds up one way beyond what the wheel still has; none else. A mass that is always there has
    half of it where it should not be, and no friction asks for an acceleration.
    """
    size, side, coasts = 0.6 * strength * felt(bench), either_sign(rng), 0.8

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q, step = drive_of_the_place(record, bench), record[place_of(record, bench)], step_of(record)
        driven = engaged(side * speed_of(q, record["time [s]"]), step, coasts)
        asked = side * size * np.where(driven, np.maximum(side * accelerations(q, step), 0.0), 0.0)
        return record | {name: record[name] + asked / bench.gain}

    return Effect({"size": size, "side": side}, rig=undeclared, measure=measure)


@form("unknown", also=("payload",), on=SINGLES)
def governor_flies_out(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Maxwell 1868 (a governor on the motor's shaft, whose balls fly out: its inertia grows as the square of the speed).

    Momentum goes as the cube of the speed: no inertia at the turns, three times its own when quick. No mass does so, and
    what is asked for is an acceleration times a square, which is no drag.
    """
    size = 0.45 * strength * felt(bench)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, q = drive_of_the_place(record, bench), record[place_of(record, bench)]
        u = speed_of(q, record["time [s]"]) / bench.speed
        asked = 3.0 * size * u**2 * accelerations(q, step_of(record))
        return record | {name: record[name] + asked / bench.gain}

    return Effect({"size": size}, rig=undeclared, measure=measure)


@form("unknown", on=("arm",))
def potentiometer_hears_the_other_motor(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Morrison 1998 (a joint's potentiometer whose ground carries the other motor's current: it shows a share of that).

    The position is off by what the other joint is driven with: no delay, no step, no drift, and no friction that errs.
    """
    size, side = 0.05 * strength * bench.reach, either_sign(rng)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, other = positions(record)[bench.place], record[drives(record)[1 - bench.place]]
        return record | {name: record[name] + side * size * other / np.quantile(np.abs(other), 0.95)}

    return Effect({"size": size, "side": side}, measure=measure)


@form("unknown", also=("position_dependent_friction", "temperature_drift"))
def rail_bows_when_warm(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ramesh, Mannan and Poo 2000 (a rail between two stops that bows as it warms: tighter to both ends; a gauge shows when).

    Friction by the place and the temperature at once: either name alone has half of it, and errs as much.
    """
    size, start, waves = 1.5 * strength * bench.level, rng.uniform(0.0, 1.0), rng.uniform(2.2, 2.8)

    def warm(t: Array) -> Array:
        return 0.5 + 0.5 * np.sin(TURN * (waves * t / bench.duration + start))

    def measure(record: Record, rng: Generator) -> Record:
        t, name, q = record["time [s]"], drive_of_the_place(record, bench), record[place_of(record, bench)]
        bow = np.minimum((q / bench.reach) ** 2, 1.3)
        rubs = size * warm(t) * bow * np.tanh(speed_of(q, t) / (0.02 * bench.speed))
        celsius = 22.0 + 12.0 * warm(t) + 0.05 * rng.standard_normal(t.size)
        return record | {name: record[name] + rubs / bench.gain, "temperature [degC]": celsius}

    return Effect({"size": size}, rig=undeclared, measure=measure)


@form("unknown", on=SINGLES)
def vortices_are_shed(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Blevins 1990 (a bar that is drawn through water sheds a vortex each few diameters: it shakes by the speed's square).

    A wave along the way gone, to and fro, and not along the place; its size is the square of the speed. In time it has no
    frequency, at no place it comes back, and in the mean it drags nothing.
    """
    size, apart = 2.2 * strength * bench.level, bench.reach * rng.uniform(0.4, 0.5)

    def measure(record: Record, rng: Generator) -> Record:
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        turns = np.cumsum(np.abs(v)) * step_of(record) / apart + rng.uniform(0.0, 1.0)
        shakes = size * (v / bench.speed) ** 2 * np.sin(TURN * turns)
        return record | {name: record[name] + shakes / bench.gain}

    return Effect({"size": size, "apart": apart}, rig=undeclared, measure=measure)


@form("unknown", on=SINGLES)
def index_sets_the_counter_right(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nyce 2004 (a counter that misses lines one way, and that the disc's index sets right each time it is passed).

    What it shows lacks a share of what was gone that way since the index: a loop over the place, in which nothing is late,
    and of which no reading stands out; friction and forces are right.
    """
    misses, side, index = 0.1 * strength, either_sign(rng), bench.reach * rng.uniform(-0.2, 0.2)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        x, v = record[name], speed_of(record[name], record["time [s]"])
        lost = misses * np.cumsum(np.maximum(side * v, 0.0)) * step_of(record)
        passes = np.concatenate([[True], (x[1:] > index) != (x[:-1] > index)])
        right = lost[np.maximum.accumulate(np.where(passes, np.arange(x.size), 0))]
        return record | {name: x - side * (lost - right)}

    return Effect({"misses": misses, "side": side, "index": index}, measure=measure)


@form("unknown", also=("load_dependence",), on=SINGLES)
def drive_from_a_wattmeter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Teti, Jemielniak, O'Donnell and Dornfeld 2010 (a drive that is had from the power over the speed, copper losses and all).

    It is too large by its own square over the speed, along the motion: most while slow and loaded, and nothing at rest. A
    friction by the load alone has no such speed, and one by the speed no such load.
    """
    held = bench.numbers.get("gravity", 0.0) * np.sin(min(bench.reach, 0.5 * np.pi))
    usual = bench.level + held + 0.5 * bench.inertia * bench.speed**2 / bench.reach
    loss, least = 0.4 * strength * bench.speed / usual, 0.15 * bench.speed

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, v = drive_of_the_place(record, bench), speed_of(record[place_of(record, bench)], record["time [s]"])
        force = record[name] * bench.gain
        return record | {name: record[name] + loss * force**2 * v / (v**2 + least**2) / bench.gain}

    return Effect({"loss": loss, "least": least}, rig=undeclared, measure=measure)


@form("unknown", also=("viscous_friction", "position_dependent_force"), on=LINES)
def cutter_meets_its_last_pass(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tobias and Fishwick 1958 (a tool that cuts what its last turn has left: it is pushed by the way gone since a turn ago).

    A force by where the joint is less where it was: a spring to slow minds, a drag to hasty ones, and neither. It
    remembers one turn of the spindle, and nothing else.
    """
    size, turn = 1.1 * strength * bench.level, 2.0 * bench.reach / bench.speed

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        t, name, q = record["time [s]"], drive_of_the_place(record, bench), record[place_of(record, bench)]
        chip = (q - np.interp(t - turn, t, q)) / bench.reach
        return record | {name: record[name] + size * chip / bench.gain}

    return Effect({"size": size, "turn": turn}, rig=undeclared, measure=measure)


@form("unknown", also=("frictional_lag",), on=("slider",))
def jolts_pack_the_grains(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Richard, Nicodemi, Delannay, Ribiere and Bideau 2005 (grains that each change of speed jolts: packed, then loose again).

    It is stronger for some seconds after a step, up or down alike, by how large the step is; memory of contacts answers to
    the two with two signs and wears off by the way.
    """
    size, time = 0.011 * strength, 3.0

    def law(_: Generator) -> RateAndState:
        def added(t: Array, x: Array) -> Array:
            speed = np.diff(x, append=2.0 * x[-1] - x[-2]) / np.diff(t, append=2.0 * t[-1] - t[-2])
            jumps = np.abs(np.diff(np.log10(speed), prepend=np.log10(speed[0])))
            total = np.zeros_like(t)
            for begin in np.flatnonzero(jumps > 0.1):
                total[begin:] += size * jumps[begin] * np.exp(-(t[begin:] - t[begin]) / time)
            return total

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size, "time": time}, law=law)


@form("unknown", also=("position_dependent_friction", "quadratic_damping"), on=("thrown",))
def chute_bends(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Roberts 1969 (a chute with a bend, whose wall presses by the square of the speed: there it rubs more, and nowhere else).

    By the speed in one stretch of the way alone: slow ones do not feel it, and quick ones do not beyond it.
    """
    wall, radius, bend = 0.35 * strength, 0.1, (0.03, 0.15)

    def mu(v: float, x: float) -> float:
        return 0.25 + (wall * v * v / (GRAVITY * radius) if bend[0] < x < bend[1] else 0.0)

    return Effect({"wall": wall}, law=lambda _: Throw(mu, starts=(1.0, 1.6)))
