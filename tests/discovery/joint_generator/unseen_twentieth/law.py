"""Friction of the vocabulary as laboratories meet it: by speed, direction, load, time, temperature and chance."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.null import coloured
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, TIME_SPACING, Array, Plant
from tests.discovery.joint_generator.thrown import Throw

from .enter import form


@form("viscous_friction")
def full_film_of_a_bush(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Petroff 1883 (a bush that runs in oil: a drag that is a line of the speed, on top of what its seals rub)."""
    size = 0.9 * strength * bench.level * rng.uniform(0.85, 1.15)
    return by_speed({"size": size}, lambda v: size * v / bench.speed)


@form("viscous_friction")
def grease_that_yields(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Herschel and Bulkley 1926 (grease whose yield is the stated friction, and beyond it a power of the shear rate)."""
    size, power = 0.9 * strength * bench.level, rng.uniform(0.55, 0.75)
    return by_speed({"size": size, "power": power}, lambda v: size * (v / bench.speed) ** power)


@form("velocity_weakening")
def mixed_film_at_low_speed(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tustin 1947 (asperities that touch while slow: friction that falls off as an exponential of the speed)."""
    size, knee = 0.9 * strength * bench.level, bench.speed * rng.uniform(0.14, 0.25)
    return by_speed({"size": size, "knee": knee}, lambda v: size * np.exp(-v / knee))


@form("direction_asymmetry")
def wiper_leans_one_way(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kelly, Llamas and Campa 2000 (a wiper whose lip digs in one way and trails the other way: two levels of Coulomb's)."""
    size = 0.35 * strength * bench.level * either_sign(rng)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(lambda v: size + 0.0 * v, lambda v: -size + 0.0 * v)

    return Effect({"size": size}, alter=alter)


@form("quadratic_damping", on=SINGLES)
def paddle_in_a_tank(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rushton, Costich and Everett 1950 (a paddle in a baffled tank: a drag that is the square of the speed)."""
    size = 1.2 * strength * bench.level * rng.uniform(0.85, 1.15)
    return by_speed({"size": size}, lambda v: size * (v / bench.speed) ** 2)


@form("load_dependence", on=(*HINGES, "arm"))
def teeth_bear_the_torque(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hamon, Gautier, Garrec and Janot 2010 (a gear unit: beside the stated level a share of the torque that it carries)."""
    share = 0.28 * strength * rng.uniform(0.85, 1.15)
    return Effect({"share": share}, alter=lambda plant, _: plant.with_extra(drive_share=share))


@form("friction_drift", also=("distance_drift",))
def gearbox_from_cold(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Simoni, Beschi, Legnani and Visioli 2015 (a robot's gearbox that warms up: friction falls to a lower level)."""
    fall, time = 0.5 * strength, bench.duration * rng.uniform(0.25, 0.5)
    return in_time({"fall": fall, "time": time}, lambda t: 1.0 - fall * (1.0 - np.exp(-t / time)))


@form("distance_drift", also=("friction_drift",))
def asperities_run_in(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Queener, Smith and Mitchell 1965 (a new liner that runs in: friction falls by the way slid, to a level that stays)."""
    fall, way = 0.5 * strength, bench.reach * rng.uniform(4.0, 7.0)
    return Effect({"fall": fall, "way": way}, alter=lambda plant, _: plant.with_extra(wear=-fall, wear_distance=way))


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def oil_thins_as_reynolds_said(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Reynolds 1886 (oil that thins by an exponential of its temperature; a heater goes on, then off, and is recorded)."""
    thins, off = 0.04 * strength, bench.duration * rng.uniform(0.4, 0.6)
    warms, cools = bench.duration * rng.uniform(0.2, 0.3), bench.duration * rng.uniform(0.2, 0.3)

    def celsius(t: Array) -> Array:
        return 24.0 + 24.0 * (1.0 - np.exp(-np.minimum(t, off) / warms)) * np.exp(-np.maximum(t - off, 0.0) / cools)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: np.exp(-thins * (celsius(t) - 34.0)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"thins": thins, "off": off}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def no_stroke_like_the_last(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hinrichs, Oestreich and Popp 1997 (dry friction that differs from stroke to stroke: normal, a new draw each time)."""
    spread = 0.25 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + spread * np.clip(rng.standard_normal(400), -2.5, 2.5))

    return Effect({"spread": spread}, alter=alter)


@form("random_coefficients", on=("thrown",))
def wiped_by_hand_each_time(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rabinowicz, Rightmire, Tedholm and Williams 1955 (a plate wiped by hand before each slide: a normal draw each)."""
    spread = 0.06 * strength

    def law(rng: Generator) -> Throw:
        mu = 0.28 + spread * float(np.clip(rng.standard_normal(), -2.0, 2.0))
        return Throw(lambda v, x: mu)

    return Effect({"spread": spread}, law=law)


@form("correlated_coefficients", also=("random_coefficients",))
def third_body_comes_and_goes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Uhlenbeck and Ornstein 1930; Godet 1984 (debris between the faces that comes and goes: forgotten exponentially)."""
    spread, time = 0.25 * strength, rng.uniform(0.25, 0.5)

    def alter(plant: Plant, rng: Generator) -> Plant:
        before = round(10.0 * time / TIME_SPACING)
        course = coloured(rng.standard_normal(before + plant.times.size), np.exp(-TIME_SPACING / time))[before:]
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + spread * np.clip(course, -2.5, 2.5))

    return Effect({"spread": spread, "time": time}, alter=alter)


@form("frictional_lag")
def junctions_renew_at_a_turn(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rabinowicz 1951; Dieterich 1979 (junctions that are new at each turn: high friction, forgotten with the way slid)."""
    more, way = 0.9 * strength, bench.reach * rng.uniform(0.15, 0.25)
    return Effect({"more": more, "way": way}, alter=lambda plant, _: plant.with_extra(memory=more, memory_distance=way))
