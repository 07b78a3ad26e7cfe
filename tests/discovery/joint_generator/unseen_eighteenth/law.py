"""Effects of the vocabulary: by speed, direction, load, time, temperature, chance."""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi
STROKES = 400
"""Strokes for which a run has a level drawn."""


@form("viscous_friction")
def oil_film_of_a_plain_bearing(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Petroff 1883 (oil that fills an even gap: friction in proportion to the speed)."""
    size = 0.75 * strength * bench.level * rng.uniform(0.85, 1.15)
    return by_speed({"size": size}, lambda v: size * v / bench.speed)


@form("viscous_friction")
def rolling_bearings_in_oil(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Palmgren 1959 (rolling bearings that run in oil: the power two thirds of the speed)."""
    size = 0.85 * strength * bench.level * rng.uniform(0.85, 1.15)
    return by_speed({"size": size}, lambda v: size * (v / bench.speed) ** (2.0 / 3.0))


@form("velocity_weakening")
def ways_float_up_on_oil(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tustin 1947 (oiled ways of a machine tool: what is above the sliding level falls exponentially with the speed)."""
    size, fades = 0.8 * strength * bench.level, bench.speed * rng.uniform(0.1, 0.2)
    return by_speed({"size": size, "fades": fades}, lambda v: size * np.exp(-v / fades))


@form("direction_asymmetry")
def wrist_rubs_more_one_way(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Armstrong-Helouvry 1991 (a robot's joint whose gears were cut for one way: two levels of Coulomb friction)."""
    size = 0.35 * strength * bench.level * rng.uniform(0.9, 1.1) * either_sign(rng)
    return by_speed({"half_difference": size}, lambda v: size + 0.0 * v, back=-1.0)


@form("quadratic_damping", on=SINGLES)
def plate_across_the_air(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Eiffel 1907 (a plate that is moved through air: the square of the speed)."""
    size = 1.1 * strength * bench.level * rng.uniform(0.85, 1.15)
    return by_speed({"size": size}, lambda v: size * (v / bench.speed) ** 2)


@form("load_dependence", on=(*HINGES, "arm"))
def teeth_rub_by_their_torque(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hamon, Gautier and Garrec 2011 (a robot's gear: besides the level, a share of the torque that it passes on)."""
    share = 0.28 * strength * rng.uniform(0.85, 1.15)
    return Effect({"share": share}, alter=lambda plant, _: plant.with_extra(drive_share=share))


@form("friction_drift", also=("distance_drift",))
def stiff_grease_of_the_morning(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lugt 2013 (grease that is stiff at the start and churned soft: an excess that decays exponentially in time)."""
    more, time = 0.75 * strength, bench.duration * rng.uniform(0.25, 0.4)
    return in_time({"more": more, "time": time}, lambda t: 1.0 + more * np.exp(-t / time))


@form("distance_drift", also=("friction_drift",))
def new_ways_run_in(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Blau 2005 (new ways whose tips wear off: friction falls to a lower level, exponentially with the distance slid)."""
    less, distance = 0.5 * strength, bench.reach * rng.uniform(3.0, 5.0)
    return Effect(
        {"less": less, "distance": distance}, alter=lambda plant, _: plant.with_extra(wear=-less, wear_distance=distance)
    )


USUAL = 24.0
"""Temperature at which a level is the believed one [degC]."""


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def gear_oil_follows_the_coolant(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Reynolds 1886 (oil whose viscosity falls exponentially with the temperature; that of the coolant swings, recorded)."""
    rate, start, waves = 0.055 * strength, rng.uniform(0.0, TURN), rng.uniform(1.3, 1.8)

    def celsius(t: Array) -> Array:
        s = TURN * waves * t / bench.duration + start
        return USUAL + 6.0 * np.sin(s) + 3.0 * np.sin(2.3 * s)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: np.exp(-rate * (celsius(t) - USUAL)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"rate": rate, "waves": waves}, alter=alter, measure=measure)


def within(z: Array | float, most: float) -> Array:
    """Normal draws, of which none is further out."""
    return np.clip(z, -most, most)


@form("random_coefficients", also=("correlated_coefficients",))
def other_asperities_each_pass(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rabinowicz, Rightmire, Tedholm and Williams 1955 (scatter of a dry contact: normal, a new draw each stroke)."""
    sigma = 0.22 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + sigma * within(rng.standard_normal(STROKES), 3.0))

    return Effect({"sigma": sigma}, alter=alter)


@form("random_coefficients", on=("thrown",))
def block_is_laid_down_anew(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Morin 1835 (a block that is laid down anew before each slide: a normal coefficient, a new draw each slide)."""
    sigma = 0.15 * strength

    def law(rng: Generator) -> Throw:
        mu = 0.28 * (1.0 + sigma * float(within(rng.standard_normal(), 2.5)))
        return Throw(lambda v, x: mu, starts=(1.25, 1.65))

    return Effect({"sigma": sigma}, law=law)


def gauss_markov(rng: Generator, kept: float, n: int) -> Array:
    """A stationary normal sequence of unit variance, of which each step keeps a share."""
    steps = np.sqrt(1.0 - kept**2) * rng.standard_normal(n)
    steps[0] = rng.standard_normal()
    return lfilter([1.0], [1.0, -kept], steps)


@form("correlated_coefficients", also=("random_coefficients",))
def debris_lingers_for_some_strokes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Uhlenbeck and Ornstein 1930 (debris that comes and lingers: a normal level whose correlation decays with the strokes)."""
    sigma, kept = 0.3 * strength, rng.uniform(0.75, 0.85)

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + sigma * within(gauss_markov(rng, kept, STROKES), 3.0))

    return Effect({"sigma": sigma, "kept": kept}, alter=alter)


@form("frictional_lag")
def junctions_let_go_over_a_way(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rabinowicz 1951 (friction that is high as the motion begins anew and falls exponentially with the distance slid)."""
    more, way = 0.85 * strength, bench.reach * rng.uniform(0.15, 0.25)
    return Effect({"more": more, "way": way}, alter=lambda plant, _: plant.with_extra(memory=more, memory_distance=way))
