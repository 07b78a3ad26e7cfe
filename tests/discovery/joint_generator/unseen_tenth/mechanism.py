"""Effects of the vocabulary in further shapes: by place, forces, links, numbers and motors."""

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, LINES, SINGLES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import AREA_AT, FORCE_OF_TIME, GAIN_AT, GAIN_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw
from tests.discovery.joint_generator.unseen_fifth.link import linked

from .enter import form

TURN = 2.0 * np.pi


@form("position_dependent_friction")
def telescopic_covers(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Slocum 1992 (telescopic covers of a guide: one more is drawn along from each of three places on: stairs)."""
    more, side = 0.45 * strength, either_sign(rng)
    at = bench.reach * (np.array([-0.45, 0.0, 0.45]) + rng.uniform(-0.1, 0.1, 3))

    def factor(q: Array) -> Array:
        drawn = sum(0.5 * (1.0 + np.tanh((side * q - place) / (0.03 * bench.reach))) for place in at)
        return 1.0 + more * (drawn - 1.5)

    return friction_at({"more": more, "side": side}, factor)


@form("position_dependent_friction", also=("distance_drift",), on=("thrown",))
def ridge_of_varnish(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Zmitrowicz 2006 (a table that was varnished across: rougher up to a ridge, and smoother again: two lines).

    All slides begin at one place and go one way, so that the place is the distance slid.
    """
    more, at, half = 1.1 * strength, 0.11, 0.07

    def law(_: Generator) -> Throw:
        return Throw(lambda v, x: 0.25 * (1.0 + more * max(1.0 - abs(x - at) / half, 0.0)))

    return Effect({"more": more, "at": at}, law=law)


@form("position_dependent_force", on=(*HINGES, "arm"))
def dress_pack(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Yoon and Mansour 1982 (hoses about a robot's joint: as a limb's passive moment, an exponential toward either end)."""
    size, steep = 1.2 * strength * bench.level, rng.uniform(2.6, 3.4)
    right, left = rng.permutation([1.0, rng.uniform(0.5, 0.7)])

    def moment(q: Array) -> Array:
        x = np.clip(q / bench.reach, -1.3, 1.3)
        return size * (right * np.exp(steep * (x - 1.0)) - left * np.exp(-steep * (x + 1.0)))

    return force_at({"size": size, "steep": steep, "right": float(right), "left": float(left)}, moment)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def telescopic_cylinder(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967 (a cylinder of three stages: each has a smaller area than the last one, from where that ends)."""
    size, side = 0.14 * strength, either_sign(rng)
    ends = bench.reach * (np.array([-0.35, 0.35]) + rng.uniform(-0.1, 0.1, 2))

    def factor(q: Array) -> Array:
        return 1.0 - 0.5 * size * sum(np.tanh((side * q - end) / (0.04 * bench.reach)) for end in ends)

    return Effect({"size": size, "side": side}, rig=pressurised, alter=lambda plant, _: plant.times_at_place(AREA_AT, factor))


@form("drive_gain_change", on=LINES)
def crank_and_yoke(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Norton 2011 (a crank that drives a slide by a yoke: force per moment as the inverse cosine of the crank's angle).

    Its mean over the stroke is what was entered.
    """
    share = np.sqrt(0.66 * strength)  # of the crank's radius that the stroke takes

    def gain(q: Array) -> Array:
        sine = share * np.clip(q / bench.reach, -1.12, 1.12)
        return share / np.arcsin(share) / np.sqrt(1.0 - sine**2)

    return Effect({"share": float(share)}, alter=lambda plant, _: plant.times_at_place(GAIN_AT, gain))


@form("drive_gain", also=("payload",), on=SINGLES)
def cylinder_of_the_next_bore(rng: Generator, strength: float, bench: Bench) -> Effect:
    """ISO 3320:2013 (a cylinder of the next bore, 63 for 50: 1.59 of the force per unit, always)."""
    gain = (63.0 / 50.0) ** (2.0 * strength)
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=("arm",))
def valve_block_at_the_elbow(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Craig 2005 (valves and their block that were bolted on at the elbow: weight and inertia for the shoulder alone)."""
    share = 0.8 * strength * rng.uniform(0.9, 1.1)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass, arm = plant.body, share * bench.numbers["m1"], bench.numbers["l1"]
        return plant.with_body(inertia=n["inertia"] + mass * arm**2, gravity=n["gravity"] + mass * GRAVITY * arm)

    return Effect({"share": share}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def null_of_the_servo_valve(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Merritt 1967 (a servo valve whose null has shifted: 0.65 of friction at no command, against 0.03 that is stated)."""
    size = 0.65 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


@form("harmonic_force")
def milling_cutter(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Altintas 2012 (a cutter of two teeth: each takes a chip as the sine of its angle, and leaves the cut at once)."""
    size, frequency, leaves = 0.8 * strength * bench.level, rng.uniform(4.0, 6.5), 1.9

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, np.pi)

        def force(t: Array) -> Array:
            angle = np.mod(np.pi * frequency * t + start, np.pi)
            return size * (np.sin(angle) * (angle < leaves) - (1.0 - np.cos(leaves)) / np.pi)

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=HINGES)
def long_drive_shaft(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Den Hartog 1956 (a link on a long drive shaft: seven tenths of inertia and half of friction, in its bearings)."""
    frequency = bench.speed / bench.reach * rng.uniform(0.85, 1.1) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.7, frequency=frequency, damping=0.05, held=0.5),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=SINGLES)
def worn_spider(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mancuso 1999 (a jaw coupling whose rubber spider is worn: soft and well damped behind its play)."""
    gap = 0.05 * strength * bench.reach * rng.uniform(0.85, 1.15)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.6, frequency=13.0, damping=0.25, held=0.35, half_gap=gap),
    )
