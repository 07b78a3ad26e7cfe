"""Effects of the vocabulary in further shapes: by place, forces, links, numbers and motors."""

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
def telescope_drawn_out(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Slocum 1992 (a telescope whose tube overhangs: both its bearings are pressed by the overhang over what overlaps)."""
    side = either_sign(rng)

    def pressed(u: Array) -> Array:
        """Sum of both reactions, in weights, over the place in reaches."""
        return 1.0 + 2.0 * (1.2 + u) / (2.6 - u)

    def factor(q: Array) -> Array:
        grows = pressed(np.clip(side * q / bench.reach, -1.2, 1.3)) / float(pressed(np.array(0.0)))
        return 1.0 + 0.9 * strength * (grows - 1.0)

    return friction_at({"side": side}, factor)


@form("position_dependent_friction", also=("distance_drift",), on=("thrown",))
def waves_of_a_milled_table(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Whitehouse 1994 (a milled table: a wave of 14 cm that the cutter has left across the way, alike in each slide).

    All slides begin at one place and go one way, so that the place is the distance slid.
    """
    size, length, start = 0.45 * strength, 0.14, rng.uniform(0.0, TURN)
    return Effect(
        {"size": size, "length": length},
        law=lambda _: Throw(lambda v, x: float(0.28 * (1.0 + size * np.sin(TURN * x / length + start)))),
    )


def dipped(depth: Array) -> Array:
    """Share of a lying cylinder that is under water, over the share of its diameter that is."""
    angle = np.arccos(1.0 - 2.0 * np.clip(depth, 0.0, 1.0))
    return (angle - np.sin(angle) * np.cos(angle)) / np.pi


@form("position_dependent_force")
def float_dips_in(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Munson, Young and Okiishi 2002 (a lying cylinder that dips into a tank: a segment's area, half of it balanced)."""
    size, side = 1.3 * strength * bench.level, either_sign(rng)
    middle, width = rng.uniform(-0.15, 0.15), rng.uniform(1.0, 1.2)

    def force(q: Array) -> Array:
        return side * size * (dipped((side * q / bench.reach - middle) / width + 0.5) - 0.5)

    return force_at({"size": size, "side": side, "middle": middle, "width": width}, force)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def fluidic_muscle_as_fitted(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Sarosi, Biro, Nemeth and Cveticanin 2015 (a muscle: an exponential of its contraction, soon gone, and a line)."""
    size, side = 0.42 * strength, either_sign(rng)

    def pulls(percent: Array) -> Array:
        return 1.0 - 0.035 * percent + 0.35 * np.exp(-0.33 * percent)

    def factor(q: Array) -> Array:
        shorter = 8.0 + 7.0 * side * np.clip(q / bench.reach, -1.1, 1.1)
        return 1.0 + size * (pulls(shorter) / float(pulls(np.array(8.0))) - 1.0)

    return Effect({"size": size, "side": side}, rig=pressurised, alter=lambda plant, _: plant.times_at_place(AREA_AT, factor))


@form("drive_gain_change")
def tank_between_two_switch_points(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Beater 2007 (a drive on a small air tank: its pressure falls as a line, and rises once the compressor has cut in)."""
    loss, falls, rises = 0.4 * strength, bench.duration * rng.uniform(0.24, 0.3), bench.duration * rng.uniform(0.1, 0.14)

    def gain(t: Array) -> Array:
        s = np.mod(np.maximum(t, 0.0), falls + rises)
        return 1.0 - loss * np.minimum(s / falls, (falls + rises - s) / rises)

    return Effect(
        {"loss": loss, "falls": falls, "rises": rises}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, gain)
    )


@form("drive_gain", also=("payload",), on=SINGLES)
def motor_left_in_its_small_displacement(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Manring 2005 (a hydraulic motor of two displacements, left in the small one: 0.6 of the force per unit, always)."""
    gain = 0.6**strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=("arm",))
def counterweight_behind_the_elbow(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lowen, Tepper and Berkof 1983 (a weight on the forearm's tail, behind the elbow: the shoulder bears it, the elbow less).

    The elbow's moment of weight falls, all moments of inertia grow.
    """
    share, behind = 0.9 * strength * rng.uniform(0.9, 1.1), 0.55

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass = plant.body, share * bench.numbers["m2"]
        upper, tail = bench.numbers["l1"], behind * bench.numbers["l2"]
        return plant.with_body(
            inertia=n["inertia"] + mass * upper**2, gravity=n["gravity"] + mass * GRAVITY * upper,
            inertia_2=n["inertia_2"] + mass * tail**2, gravity_2=n["gravity_2"] - mass * GRAVITY * tail,
            coupling=n["coupling"] - mass * upper * tail,
        )  # fmt: skip

    return Effect({"share": share}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def wind_from_one_side(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Simiu and Scanlan 1996 (a steady wind on what moves, out of doors: 0.65 of friction, against 0.03 that is stated)."""
    size = 0.65 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


def ringing(turns: Array) -> Array:
    """Four waves that die away within a turn, and begin again; without a mean, and 1 at most."""
    s, decay, wave = np.mod(turns, 1.0), 3.0, TURN * 4.0
    mean = wave * (1.0 - np.exp(-decay)) / (decay**2 + wave**2)
    first = np.arctan2(wave, decay) / wave
    return (np.exp(-decay * s) * np.sin(wave * s) - mean) / (np.exp(-decay * first) * np.sin(wave * first) - mean)


@form("harmonic_force")
def punch_press_rings(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Harris and Crede 1961 (a punch press on the same floor: at each of its strokes the floor rings, and dies away)."""
    size, frequency = 0.9 * strength * bench.level, rng.uniform(1.5, 2.2)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, 1.0)
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size * ringing(frequency * t + start))

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=LINES)
def mast_of_a_stacker_crane(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hajdu and Gaspar 2014 (a stacker crane: half of its mass is high up on a mast, hardly damped, on a guide that rubs)."""
    frequency = bench.speed / bench.reach * rng.uniform(0.85, 1.05) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.5, frequency=frequency, damping=0.03, held=0.2),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=HINGES)
def open_teeth_of_a_slewing_ring(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Niemann and Winter 1989 (open teeth of a slewing ring: nearly all inertia behind them, and half of the friction)."""
    gap = 0.045 * strength * bench.reach * rng.uniform(0.85, 1.15)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.8, frequency=15.0, damping=0.12, held=0.45, half_gap=gap),
    )
