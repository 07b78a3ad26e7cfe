"""Effects of the vocabulary in further shapes: by place, forces, links, numbers and motors."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_OF_TIME, GAIN_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fifth.link import linked

from .enter import form

TURN = 2.0 * np.pi


@form("position_dependent_friction")
def sheath_round_a_bend(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kaneko, Yamashita and Tanie 1991 (a tendon in a sheath that is straight at a place: the exponential of its bend)."""
    bend, straight = 0.95 * strength, bench.reach * rng.uniform(-0.3, 0.3)
    middle = float(np.exp(0.5 * bend))

    def factor(q: Array) -> Array:
        return np.exp(bend * np.minimum(np.abs(q - straight) / bench.reach, 1.4)) / middle

    return friction_at({"bend": bend, "straight": straight}, factor)


@form("position_dependent_friction", also=("distance_drift",), on=("thrown",))
def oil_of_a_bowling_lane(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Frohlich 2004 (a bowling lane: oiled as far as a line, from where on the oil is less and less, and dry at last).

    All slides begin at one place and go one way, so that the place is the distance slid.
    """
    ends, less, more = (0.06, 0.2), 0.27 * (1.0 - 0.4 * strength), 0.27 * (1.0 + 0.35 * strength)
    return Effect(
        {"oiled": ends[0], "dry": ends[1]},
        law=lambda _: Throw(lambda v, x: float(less + (more - less) * min(max((x - ends[0]) / (ends[1] - ends[0]), 0.0), 1.0))),
    )


@form("position_dependent_force")
def air_shut_in_on_both_sides(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Beater 2007 (a cylinder whose ports are shut in the middle: air on both sides of its piston, each by Boyle's law)."""
    size, length = 0.9 * strength * bench.level, rng.uniform(1.35, 1.5)

    def force(q: Array) -> Array:
        x = np.clip(q / bench.reach, -1.2, 1.2)
        return size * x * (length**2 - 1.0) / (length**2 - x**2)  # 1 / (length - x) less 1 / (length + x), `size` at the reach

    return force_at({"size": size, "length": length}, force)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def pouch_motor(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Niiyama and others 2015 (a flat pouch: pressure pulls by its angle's cosine over the angle, which contraction opens)."""
    size, side = 0.22 * strength, either_sign(rng)
    angles = np.linspace(0.5, 1.3, 400)
    contracted = 1.0 - np.sin(angles) / angles  # 0.04 to 0.26
    entered = float(np.interp(0.14, contracted, np.cos(angles) / angles))

    def factor(q: Array) -> Array:
        shorter = 0.14 + 0.08 * side * np.clip(q / bench.reach, -1.2, 1.2)
        return 1.0 + size * (np.interp(shorter, contracted, np.cos(angles) / angles) / entered - 1.0)

    return Effect({"size": size, "side": side}, rig=pressurised, alter=lambda plant, _: plant.times_at_place(AREA_AT, factor))


@form("drive_gain_change")
def generator_takes_up_a_load(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kundur 1994 (a shop's own generator: another machine starts, its voltage dips, swings and settles at what is left)."""
    loss, moment = 0.3 * strength, bench.duration * rng.uniform(0.15, 0.25)
    time, period = 0.16 * bench.duration, 0.24 * bench.duration

    def gain(t: Array) -> Array:
        since = np.maximum(t - moment, 0.0)
        return 1.0 - loss * (1.0 - np.exp(-since / time) * np.cos(TURN * since / period))

    return Effect({"loss": loss, "moment": moment}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, gain))


@form("drive_gain", also=("payload",), on=SINGLES)
def windings_in_parallel(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hughes 2006 (a motor whose two windings are in parallel, and were entered as in series: half of the force per unit)."""
    gain = 0.5**strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=("arm",))
def battery_on_the_upper_arm(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Siciliano, Sciavicco, Villani and Oriolo 2009 (a battery on the upper arm: the shoulder bears it, the elbow does not).

    It is the shoulder's load, so that the effect always sits there.
    """
    share, where = 1.2 * strength * rng.uniform(0.9, 1.1), 0.7

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass, out = plant.body, share * bench.numbers["m1"], where * bench.numbers["l1"]
        return plant.with_body(inertia=n["inertia"] + mass * out**2, gravity=n["gravity"] + mass * GRAVITY * out)

    return Effect({"share": share}, rig=lambda bench: replace(bench, place=0), alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def jet_of_coolant(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Munson, Young and Okiishi 2002 (a jet of coolant strikes the joint: 0.6 of friction, against 0.03 that is stated)."""
    size = 0.6 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


@form("harmonic_force")
def indexer_on_the_frame(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Norton 2009 (an indexing table on the frame, cycloidal: a whole sine while it moves on, nothing while it dwells)."""
    size, frequency, moves = 1.0 * strength * bench.level, rng.uniform(1.6, 2.6), 0.4

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, 1.0)

        def force(t: Array) -> Array:
            s = np.mod(frequency * t + start, 1.0)
            return size * np.where(s < moves, np.sin(TURN * s / moves), 0.0)

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=HINGES)
def dish_behind_its_gear(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gawronski 2008 (an antenna: nearly three quarters of the inertia are its dish, hardly damped, in bearings of its own)."""
    frequency = bench.speed / bench.reach * rng.uniform(0.9, 1.1) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.72, frequency=frequency, damping=0.05, held=0.25),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=LINES)
def drawbar_of_a_trolley(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Garg and Dukkipati 1984 (a trolley on a drawbar with slack: three fifths of the mass, and of the friction)."""
    gap = 0.05 * strength * bench.reach * rng.uniform(0.85, 1.15)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.6, frequency=20.0, damping=0.15, held=0.6, half_gap=gap),
    )
