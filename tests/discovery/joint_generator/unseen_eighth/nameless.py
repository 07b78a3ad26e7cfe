"""What no effect of the vocabulary describes; a further name beside `unknown` would be defensible where it stands there.

Each says why no name can be defended, or what speaks for the further ones.
"""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.null import drives
from tests.discovery.joint_generator.forms.place import friction_at
from tests.discovery.joint_generator.forms.sensor import positions
from tests.discovery.joint_generator.plant import FORCE_OF_TIME, Array, Plant
from tests.discovery.joint_generator.slider import RateAndState

from .enter import form

TURN = 2.0 * np.pi


@form("unknown", on=HINGES)
def counter_too_slow(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Horowitz and Hill 1989 (a counter that misses a share of the lines as soon as they come too fast, either way).

    What is quick seems slower, and the zero is elsewhere after each stroke: neither late, nor repeated, nor off at times.
    """
    loss, top = 0.3 * strength, 0.5 * bench.speed

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name, step = positions(record)[0], float(np.median(np.diff(record["time [s]"])))
        n = max(1, round(0.01 / step))
        smooth = np.convolve(np.pad(record[name], n, mode="edge"), np.ones(2 * n + 1) / (2 * n + 1), mode="valid")
        speed = np.gradient(smooth, step)
        return record | {name: record[name] - np.cumsum(loss * speed * (np.abs(speed) > top)) * step}

    return Effect({"loss": loss, "top": top}, measure=measure)


@form("unknown", on=HINGES)
def angle_from_a_gyroscope(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mahony, Hamel and Pflimlin 2008 (an angle that is summed up from a gyroscope and leaks back to zero in seconds).

    What lasts fades from the angle, so that the weight pulls by another one; no reading is late.
    """
    time = 3.0 / strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = positions(record)[0]
        kept, start = float(np.exp(-float(np.median(np.diff(record["time [s]"]))) / time)), record[name][0]
        return record | {name: lfilter([kept, -kept], [1.0, -kept], record[name], zi=[(1.0 - kept) * start])[0]}

    return Effect({"time": time}, rig=lambda bench: replace(bench, motion="strokes"), measure=measure)


@form("unknown", on=LINES)
def meter_cuts_off(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Miller 1996 (a meter with a low cut-off: what is below it is shown as nothing).

    It hides what is small, whatever the speed, the place or the time; a gain that changes would not jump to zero.
    """
    least = 0.9 * strength * bench.level / bench.gain

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        name = drives(record)[0]
        return record | {name: record[name] * (np.abs(record[name]) > least)}

    return Effect({"least": least}, measure=measure)


@form("unknown", also=("sensor_outliers",), on=SINGLES)
def packets_out_of_order(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bennett, Partridge and Shectman 1999 (packets of 8 ms, of which some overtake each other; rows are stamped as they come).

    Nothing is lost, repeated or off, it stands at another row, drives as well; to spells of readings that are off it is next.
    """
    share, length = 0.12 * strength, 0.008

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        n = max(3, round(length / float(np.median(np.diff(t)))))
        order = np.arange(t.size)
        for begin in range(0, t.size - 2 * n, 2 * n):
            if rng.random() < share:
                order[begin : begin + 2 * n] = np.roll(order[begin : begin + 2 * n], n)
        return {name: x if name == "time [s]" else x[order] for name, x in record.items()}

    return Effect({"share": share}, measure=measure)


@form("unknown", also=("constant_force",), on=LINES)
def shut_in_air_leaks(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Andersen 1967 (air that is shut in at the start of each run leaks through an orifice: a force that dies away).

    A force that depends on time alone and comes back never; at the beginning of each run it resembles a constant one.
    """
    size, time = 1.2 * strength * bench.level * either_sign(rng), bench.duration * rng.uniform(0.2, 0.3)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size * np.exp(-t / time))

    return Effect({"size": size, "time": time}, alter=alter)


@form("unknown", also=("payload",), on=("arm",))
def currents_share_a_return(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ott 2009 (two motors whose currents share a return wire: one joint's meter shows a share of the other's current).

    A torque that is nobody's; what the other joint carries resembles a load, which would have to be at both joints.
    """
    share = (0.4, 0.12)[bench.place] * strength

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        names = drives(record)
        shown, other = names[bench.place], names[1 - bench.place]
        return record | {shown: record[shown] + share * record[other]}

    return Effect({"share": share}, measure=measure)


@form("unknown", also=("position_dependent_friction",))
def cage_settles_elsewhere(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Harris 2001 (a cage whose rollers stand elsewhere after each mounting: a wave along the stroke, another phase each run).

    In each run friction depends on the place, and over the runs on none: what one run teaches is wrong in the next.
    """
    size, length = 0.5 * strength, bench.reach * rng.uniform(0.5, 0.8)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)
        effect = friction_at({}, lambda q: 1.0 + size * np.sin(TURN * q / length + start))
        return effect.alter(plant, rng)

    return Effect({"size": size, "length": length}, rig=lambda bench: replace(bench, n_fit=3), alter=alter)


@form("unknown", also=("viscous_friction", "velocity_weakening"), on=("slider",))
def strengthens_then_weakens(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Beeler, Tullis, Blanpied and Weeks 1996 (a fault that strengthens with speed while new, and weakens once it has slid).

    Speed and displacement by a product; each name of the speed says what one half of the test shows.
    """
    size, whole = 0.014 * strength, rng.uniform(3.5e-4, 4.5e-4)

    def added(t: Array, x: Array) -> Array:
        speed = np.maximum(np.gradient(x, t), 1e-8)
        return size * np.log(speed / 1e-6) * (1.0 - 2.0 * np.minimum(x / whole, 1.0))

    return Effect({"size": size, "whole": whole}, law=lambda _: RateAndState(0.6, 0.0, added=added))
