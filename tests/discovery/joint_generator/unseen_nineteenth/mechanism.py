"""Effects of the vocabulary: by place; forces; links, numbers and motors."""

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
def screw_runs_out_of_true(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Armstrong-Helouvry 1991 (a screw that is bent and oval: friction waves once and twice a turn)."""
    once, twice = 0.5 * strength, 0.2 * strength
    turn, start, second = bench.reach * rng.uniform(0.5, 0.8), rng.uniform(0.0, TURN), rng.uniform(0.0, TURN)

    def factor(q: Array) -> Array:
        return 1.0 + once * np.cos(TURN * q / turn + start) + twice * np.cos(2.0 * TURN * q / turn + second)

    return friction_at({"once": once, "twice": twice, "turn": turn, "start": start, "second": second}, factor)


@form("position_dependent_friction", also=("distance_drift",), on=("thrown",))
def board_is_less_waxed_further_on(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Blau 2009 (a board that was waxed at its near end: friction grows evenly with the place, and stays beyond the wax).

    All slides begin at one place and go one way, so that the place is the distance slid.
    """
    size, ends = 0.5 * strength, 0.35

    def mu(v: float, x: float) -> float:
        return 0.28 * (1.0 + size * (2.0 * min(max(x / ends, 0.0), 1.0) - 1.0))

    return Effect({"size": size, "ends": ends}, law=lambda _: Throw(mu))


@form("position_dependent_force", on=LINES)
def iron_core_over_its_magnets(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Zhu and Howe 2000 (a linear motor with an iron core: a detent force of the magnets' pitch, and its overtone)."""
    size, pitch, start = 0.9 * strength * bench.level, bench.reach * rng.uniform(0.4, 0.7), rng.uniform(0.0, TURN)

    def force(q: Array) -> Array:
        angle = TURN * q / pitch + start
        return size * (np.sin(angle) + 0.25 * np.sin(2.0 * angle))

    return force_at({"size": size, "pitch": pitch, "start": start}, force)


@form("effective_area", also=("position_dependent_force",), on=("slide",))
def bag_of_an_air_spring(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Quaglia and Sorli 2001 (an air spring's bag: its effective area changes evenly with its height)."""
    slope = 0.2 * strength * either_sign(rng) * rng.uniform(0.85, 1.15)
    return Effect(
        {"slope": slope},
        rig=pressurised,
        alter=lambda plant, _: plant.times_at_place(AREA_AT, lambda q: 1.0 + slope * q / bench.reach),
    )


@form("drive_gain_change", on=SINGLES)
def torque_ripples_with_the_poles(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Jahns and Soong 1996 (a motor whose back voltage is no pure sine: what it gives per ampere waves with the angle)."""
    size, pitch, start = 0.3 * strength, bench.reach * rng.uniform(0.4, 0.7), rng.uniform(0.0, TURN)
    return Effect(
        {"size": size, "pitch": pitch, "start": start},
        alter=lambda plant, _: plant.times_at_place(GAIN_AT, lambda q: 1.0 + size * np.cos(TURN * q / pitch + start)),
    )


@form("drive_gain", also=("payload",), on=SINGLES)
def amplifier_gives_fewer_amperes_a_volt(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gautier and Briot 2014 (an amplifier whose amperes per volt are not those of its sheet: 0.7 of the force, always)."""
    gain = 0.7**strength
    return Effect({"gain": gain}, alter=lambda plant, _: plant.times_in_time(GAIN_OF_TIME, lambda t: gain + 0.0 * t))


@form("payload", on=HINGES)
def workpiece_left_in_the_gripper(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Khalil, Gautier and Lemoine 2007 (a workpiece left in the gripper: a point mass at the end, 0.45 of the stated mass)."""
    share = 0.45 * strength * rng.uniform(0.9, 1.1)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        n, mass, length = plant.body, share * bench.numbers["mass"], bench.numbers["length"]
        return plant.with_body(inertia=n["inertia"] + mass * length**2, gravity=n["gravity"] + mass * GRAVITY * length)

    return Effect({"share": share}, alter=alter)


@form("constant_force", also=("direction_asymmetry",))
def rolled_band_pulls_evenly(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Votta 1952 (a rolled band of steel that uncoils at one force: 0.65 of friction, where 0.03 is stated)."""
    size = 0.65 * strength * bench.level * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.add_in_time(FORCE_OF_TIME, lambda t: size + 0.0 * t))


@form("harmonic_force")
def fan_that_has_lost_a_blade(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Den Hartog 1956 (a slow fan on the same frame that has lost a blade: its unbalance pushes as a cosine of the time)."""
    size, frequency = 0.7 * strength * bench.level, rng.uniform(2.5, 4.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size * np.cos(TURN * frequency * t + start))

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("joint_compliance", also=("second_mode",), on=HINGES)
def thin_shaft_to_the_arm(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Spong 1987 (a motor that turns its arm by a thin shaft: six tenths of the inertia behind a linear spring)."""
    if strength == 0.0:
        return Effect()
    frequency = bench.speed / bench.reach * rng.uniform(0.85, 1.1) / np.sqrt(strength)
    return Effect(
        {"frequency": frequency},
        alter=lambda plant, _: linked(plant, load=0.6, frequency=frequency, damping=0.05, held=0.2),
    )


@form("backlash", also=("joint_compliance", "second_mode"), on=LINES)
def nut_worn_on_its_screw(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nordin and Gutman 2002 (a carriage whose nut has play on its screw: a dead zone; its guide holds it in between)."""
    if strength == 0.0:
        return Effect()
    gap, frequency = 0.045 * strength * bench.reach * rng.uniform(0.85, 1.15), 15.0 / np.sqrt(strength)
    return Effect(
        {"half_gap": gap},
        alter=lambda plant, _: linked(plant, load=0.6, frequency=frequency, damping=0.1, held=0.45, half_gap=gap),
    )
