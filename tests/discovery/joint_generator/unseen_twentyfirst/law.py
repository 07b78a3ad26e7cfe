"""Friction of the vocabulary as laboratories meet it: by speed, direction, load, way, time, temperature and chance."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.null import coloured
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, TIME_SPACING, Array, Plant
from tests.discovery.joint_generator.thrown import Throw

from .enter import form


@form("viscous_friction")
def oil_between_shaft_and_bush(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Petroff 1883 (oil that fills the gap of a bush: a drag in proportion to the speed)."""
    size = strength * bench.level * rng.uniform(0.8, 1.1)
    return by_speed({"size": size}, lambda v: size * v / bench.speed)


@form("viscous_friction")
def grease_churned_by_a_reducer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Herschel and Bulkley 1926 (grease of a reducer, which thins as it is sheared: a power of the speed below one)."""
    size, power = strength * bench.level, rng.uniform(0.5, 0.7)
    return by_speed({"size": size, "power": power}, lambda v: size * (v / bench.speed) ** power)


@form("velocity_weakening")
def servo_table_creeps(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tustin 1947 (a servo's table: friction falls with the speed as an exponential, from that of creeping to the level)."""
    size, knee = 0.9 * strength * bench.level, bench.speed * rng.uniform(0.08, 0.16)
    return by_speed({"size": size, "knee": knee}, lambda v: size * np.exp(-v / knee))


@form("direction_asymmetry")
def motor_of_two_directions(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Canudas de Wit, Noel, Aubin and Brogliato 1991 (a joint whose level and line over the speed differ by direction)."""
    size, side = strength * bench.level, either_sign(rng)
    drag = rng.uniform(0.3, 0.5)

    def heavy(v: Array) -> Array:
        return size * (0.3 + drag * v / bench.speed)

    def light(v: Array) -> Array:
        return -0.3 * size + 0.0 * v

    ways = (heavy, light) if side > 0.0 else (light, heavy)
    return Effect({"size": size, "drag": drag, "side": side}, alter=lambda plant, _: plant.add_by_speed(*ways))


@form("quadratic_damping", on=SINGLES)
def vane_broadside_to_the_air(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Eiffel 1907 (a plate that is moved through the air across its own face: the square of the speed)."""
    size = 1.4 * strength * bench.level * rng.uniform(0.9, 1.1)
    return by_speed({"size": size}, lambda v: size * (v / bench.speed) ** 2)


@form("load_dependence", on=("hinge", "mjcf_hinge", "arm"))
def reducer_rubs_by_what_it_carries(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hamon, Gautier and Garrec 2010 (a robot's reducer: dry friction has a share of the torque that it passes on)."""
    share = 0.3 * strength * rng.uniform(0.85, 1.15)
    return Effect({"share": share}, alter=lambda plant, _: plant.with_extra(drive_share=share))


@form("friction_drift", also=("distance_drift",))
def gearbox_from_a_cold_start(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bittencourt, Wernholt, Sander-Tavallaey and Brogardh 2010 (a cold gearbox: friction falls as an exponential of time)."""
    fall, time = 0.5 * strength, bench.duration * rng.uniform(0.2, 0.4)
    return in_time({"fall": fall, "time": time}, lambda t: 1.0 - fall * (1.0 - np.exp(-t / time)))


@form("distance_drift", also=("friction_drift",))
def wear_particles_gather(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Suh and Sin 1981 (particles gather between fresh faces and plough: friction rises with the way to a level)."""
    more, way = 0.7 * strength, bench.reach * rng.uniform(4.0, 7.0)
    return Effect({"more": more, "way": way}, alter=lambda plant, _: plant.with_extra(wear=more, wear_distance=way))


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def joint_is_heated_and_aired(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Simoni, Beschi, Legnani and Visioli 2015 (a joint that is heated, then aired: a line of its recorded temperature)."""
    slope, turn, time = 0.03 * strength, bench.duration * rng.uniform(0.5, 0.65), 0.3 * bench.duration

    def celsius(t: Array) -> Array:
        heated = 20.0 + 26.0 * (1.0 - np.exp(-np.minimum(t, turn) / time))
        return 20.0 + (heated - 20.0) * np.exp(-np.maximum(t - turn, 0.0) / (0.7 * time))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    warmer = in_time({"slope": slope, "turn": turn}, lambda t: 1.0 - slope * (celsius(t) - 30.0))
    return replace(warmer, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def each_stroke_has_its_own(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ibrahim 1994 (friction that scatters from stroke to stroke, as a normal law does, and never beyond 2.5 deviations)."""
    sigma = 0.25 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + sigma * np.clip(rng.standard_normal(400), -2.5, 2.5))

    return Effect({"sigma": sigma}, alter=alter)


@form("random_coefficients", on=("thrown",))
def puck_is_wiped_each_time(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Blau 2009 (one pair, wiped before each test: its coefficient scatters by a fifth as a normal law does)."""
    sigma = 0.2 * strength

    def law(rng: Generator) -> Throw:
        mu = 0.28 * (1.0 + sigma * float(np.clip(rng.standard_normal(), -2.5, 2.5)))
        return Throw(lambda v, x: mu)

    return Effect({"sigma": sigma}, law=law)


@form("correlated_coefficients", also=("random_coefficients",))
def film_comes_and_goes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Uhlenbeck and Ornstein 1930 (a boundary film that wears off and heals: noise that forgets within part of a second)."""
    sigma, time = 0.3 * strength, rng.uniform(0.3, 0.8)

    def alter(plant: Plant, rng: Generator) -> Plant:
        wanders = coloured(rng.standard_normal(plant.times.size + 10_000), float(np.exp(-TIME_SPACING / time)))[10_000:]
        return plant.times_in_time(FACTOR_OF_TIME, lambda _: 1.0 + sigma * np.clip(wanders, -2.5, 2.5))

    return Effect({"sigma": sigma, "time": time}, alter=alter)


@form("frictional_lag")
def static_level_dies_with_the_way(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rabinowicz 1951 (friction starts from its static level at each turn, which dies out over the way slid since)."""
    more, way = 0.9 * strength, bench.reach * rng.uniform(0.12, 0.22)
    return Effect({"more": more, "way": way}, alter=lambda plant, _: plant.with_extra(memory=more, memory_distance=way))
