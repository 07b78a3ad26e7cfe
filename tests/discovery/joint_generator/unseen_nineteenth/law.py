"""Effects of the vocabulary: by speed, direction, load, time, temperature, chance."""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, SINGLES, Effect, Generator, Record
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, Array, Plant
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

STROKES = 400


@form("viscous_friction")
def gearbox_grease_thins_with_its_rate(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Herschel and Bulkley 1926 (grease in a gearbox: beyond its yield stress, drag grows by a power of the speed below 1)."""
    size, power = 0.9 * strength * bench.level, rng.uniform(0.5, 0.75)
    return by_speed({"size": size, "power": power}, lambda v: size * (v / bench.speed) ** power)


@form("viscous_friction")
def shaft_in_an_oiled_sleeve(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Petroff 1883 (a shaft in the middle of an oiled sleeve: drag in proportion to the speed)."""
    size = 0.9 * strength * bench.level * rng.uniform(0.85, 1.15)
    return by_speed({"size": size}, lambda v: size * v / bench.speed)


@form("velocity_weakening")
def slideway_from_boundary_to_mixed_film(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Armstrong-Helouvry, Dupont and Canudas de Wit 1994 (an oiled slideway: Stribeck's fall as a Gaussian of the speed)."""
    size, falls = 0.9 * strength * bench.level, bench.speed * rng.uniform(0.12, 0.22)
    return by_speed({"size": size, "falls": falls}, lambda v: size * np.exp(-((v / falls) ** 2)))


@form("direction_asymmetry")
def joint_rubs_more_one_way(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kelly, Llamas and Campa 2000 (a joint whose Coulomb and viscous friction have other numbers each way)."""
    size, forward = strength * bench.level, rng.random() < 0.5

    def more(v: Array) -> Array:
        return size * (0.4 + 0.4 * v / bench.speed)

    def less(v: Array) -> Array:
        return size * (0.1 * v / bench.speed - 0.35)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(more, less) if forward else plant.add_by_speed(less, more)

    return Effect({"size": size, "forward": float(forward)}, alter=alter)


@form("quadratic_damping", on=SINGLES)
def paddle_stirs_water(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Morison, O'Brien, Johnson and Schaaf 1950 (a paddle dragged through water: the square of the speed)."""
    size = 1.4 * strength * bench.level * rng.uniform(0.85, 1.15)
    return by_speed({"size": size}, lambda v: size * (v / bench.speed) ** 2)


@form("load_dependence", also=("position_dependent_friction",), on=HINGES)
def gear_rubs_by_the_weight_it_holds(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hamon, Gautier and Garrec 2010 (a joint's gear: friction grows by a share of the moment of the weight that it holds)."""
    share = 0.9 * strength * rng.uniform(0.85, 1.15) * bench.level / bench.numbers["gravity"]
    return Effect({"share": share}, alter=lambda plant, _: plant.with_extra(hold_share=share))


@form("friction_drift", also=("distance_drift",))
def gear_runs_itself_warm(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Simoni, Beschi, Legnani and Visioli 2015 (a robot's gear from a cold start: friction falls exponentially in time)."""
    less, time = 0.5 * strength, bench.duration * rng.uniform(0.25, 0.5)
    return in_time({"less": less, "time": time}, lambda t: 1.0 - less * (1.0 - np.exp(-t / time)))


@form("distance_drift", also=("friction_drift",))
def debris_roughens_the_track(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Suh and Sin 1981 (clean metal on metal: debris ploughs more and more; friction rises with the way to a level)."""
    more, distance = 0.9 * strength, bench.reach * rng.uniform(4.0, 6.0)
    return Effect(
        {"more": more, "distance": distance}, alter=lambda plant, _: plant.with_extra(wear=more, wear_distance=distance)
    )


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def rail_grease_by_a_thermometer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Reynolds 1886 (a guide's grease: friction as an exponential of the temperature; a heater goes on and off, recorded)."""
    rate, time, on = 0.05 * strength, bench.duration * rng.uniform(0.15, 0.2), bench.duration * rng.uniform(0.5, 0.6)

    def celsius(t: Array) -> Array:
        top = 1.0 - np.exp(-on / time)
        return 19.0 + 19.0 * np.where(t < on, 1.0 - np.exp(-t / time), top * np.exp(-(t - on) / time))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: np.exp(-rate * (celsius(t) - 27.0)))

    return Effect({"rate": rate, "time": time, "on": on}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def lapped_plates_stroke_by_stroke(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Galton 1879 (lapped plates that meet anew each stroke: a lognormal factor on friction, a new draw each stroke)."""
    spread = 0.36 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        drawn = np.clip(rng.standard_normal(STROKES), -2.5, 2.5)
        return replace(plant, by_stroke=np.exp(spread * drawn - 0.5 * spread**2))

    return Effect({"spread": spread}, alter=alter)


@form("random_coefficients", on=("thrown",))
def wooden_block_slides_again_and_again(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gauss 1809 (a wooden block on a table: a normal coefficient, a new draw each slide)."""
    spread = 0.15 * strength

    def law(rng: Generator) -> Throw:
        mu = 0.28 * (1.0 + spread * float(np.clip(rng.standard_normal(), -2.5, 2.5)))
        return Throw(lambda v, x: mu)

    return Effect({"spread": spread}, law=law)


KEEPS = 0.8
"""Correlation of a stroke's friction with the last one's."""


def remembered(rng: Generator, strokes: int) -> Array:
    """A normal series of unit deviation, of which each term keeps a share of the one before."""
    drawn = rng.standard_normal(strokes)
    drawn[1:] *= np.sqrt(1.0 - KEEPS**2)
    return lfilter([1.0], [1.0, -KEEPS], drawn)


@form("correlated_coefficients", also=("random_coefficients",))
def third_body_carried_from_stroke_to_stroke(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Yule 1927; Godet 1984 (a third body that a stroke hands on to the next: an autoregression of first order)."""
    spread = 0.28 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + spread * np.clip(remembered(rng, STROKES), -2.5, 2.5))

    return Effect({"spread": spread}, alter=alter)


@form("frictional_lag")
def film_builds_again_after_each_turn(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hess and Soom 1990 (oil that has left the contact at a turn: friction is higher, and falls exponentially in time)."""
    more, time = 1.1 * strength, bench.reach / bench.speed * rng.uniform(0.5, 0.7)
    return Effect({"more": more, "time": time}, alter=lambda plant, _: plant.with_extra(memory=more, memory_time=time))
