"""Friction depends on speed, direction, load, or what went before."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, PRESSURE, Array, Plant

from .enter import form


@form("viscous_friction")
def logarithmic_grease(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Spikes 1999 (boundary films: the logarithm of the shear rate)."""
    size, knee = 0.3 * strength * bench.level, bench.speed * rng.uniform(0.05, 0.15)
    return by_speed({"size": size, "knee": knee}, lambda v: size * np.log1p(v / knee))


@form("viscous_friction")
def third_order(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Simoni, Beschi, Legnani and Visioli 2015 (a polynomial that bends down)."""
    size = 0.8 * strength * rng.uniform(0.8, 1.2) * bench.level
    return by_speed(
        {"size": size}, lambda v: size * np.minimum(v / bench.speed, 1.6) * (1.0 - 0.13 * np.minimum(v / bench.speed, 1.6) ** 2)
    )


@form("viscous_friction")
def hyperbolic_film(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Williamson 1929 (shear thinning to a plateau)."""
    size, knee = 0.9 * strength * bench.level, bench.speed * rng.uniform(0.4, 0.8)
    return by_speed({"size": size, "knee": knee}, lambda v: size * v / (v + knee))


@form("velocity_weakening")
def hyperbola(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Leine, van Campen, de Kraker and van den Steen 1998."""
    size, knee = 0.7 * strength * bench.level, bench.speed * rng.uniform(0.1, 0.25)
    return by_speed({"size": size, "knee": knee}, lambda v: size / (1.0 + v / knee))


@form("velocity_weakening")
def two_scales(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gafvert 1999; a boundary film, then a mixed one."""
    size, knee = 0.6 * strength * bench.level, bench.speed * rng.uniform(0.08, 0.12)
    return by_speed(
        {"size": size, "knee": knee}, lambda v: size * (0.5 * np.exp(-v / knee) + 0.5 * np.exp(-((v / (4.0 * knee)) ** 2)))
    )


@form("velocity_weakening")
def hyperbolic_secant(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Makkar, Dixon, Sawyer and Hu 2005 (differences of hyperbolic tangents)."""
    size, knee = 0.6 * strength * bench.level, bench.speed * rng.uniform(0.1, 0.2)
    return by_speed({"size": size, "knee": knee}, lambda v: size / np.cosh(np.minimum(v / knee, 50.0)))


@form("quadratic_damping", on=SINGLES)
def windage(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Vrancik 1968 (turbulent gap of a motor: a power of 1.85)."""
    size = 0.8 * strength * rng.uniform(0.8, 1.2) * bench.level
    return by_speed({"size": size}, lambda v: size * (v / bench.speed) ** 1.85)


@form("quadratic_damping", on=SINGLES)
def churning(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Changenet and Velex 2007 (an oil bath: mostly the square, with a laminar part)."""
    size = 0.9 * strength * bench.level
    return by_speed({"size": size}, lambda v: size * np.maximum(v / bench.speed, 0.2) * v / bench.speed)


@form("direction_asymmetry", also=("viscous_friction",))
def level_and_slope(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bona and Indri 2005 (each direction has a level and a slope of its own)."""
    level, slope = 0.25 * strength * bench.level * either_sign(rng), 0.3 * strength * bench.level / bench.speed

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(lambda v: level + slope * v, lambda v: -level + 0.3 * slope * v)

    return Effect({"level": level, "slope": slope}, alter=alter)


@form("direction_asymmetry")
def one_way_clutch(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Orthwein 2004 (a clutch that drags one way; what it drags with falls a little with speed)."""
    size = 0.6 * strength * bench.level

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(lambda v: size * (1.0 - 0.2 * np.minimum(v / bench.speed, 1.0)), lambda v: 0.0 * v)

    return Effect({"size": size}, alter=alter)


@form("frictional_lag")
def recovery_in_time(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ruderman 2014; after a reversal friction settles exponentially in time."""
    size, time = 0.9 * strength, 0.3 * bench.reach / bench.speed * rng.uniform(0.8, 1.4)
    return Effect({"size": size, "time": time}, alter=lambda plant, _: plant.with_extra(memory=size, memory_time=time))


@form("frictional_lag")
def hyperbolic_in_distance(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hsu, Rowe and others 2014 (seals that relax with distance, hyperbolically)."""
    size, distance = 0.9 * strength, bench.reach * rng.uniform(0.05, 0.12)
    return Effect(
        {"size": size, "distance": distance},
        alter=lambda plant, _: plant.with_extra(memory=size, memory_distance=distance, rational=1.0),
    )


@form("load_dependence", on=(*HINGES, "arm"))
def bearing_preload(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Palmgren 1959; Harris 2001 (rolling bearings: the load to a power above 1)."""
    power = rng.uniform(1.15, 1.35)
    typical = bench.numbers["gravity_2" if bench.place else "gravity"]
    factor = 0.3 * strength * typical ** (1.0 - power)
    return Effect(
        {"factor": factor, "power": power}, alter=lambda plant, _: plant.with_extra(drive_share=factor, drive_power=power)
    )


@form("load_dependence", on=("slide",))
def seal_under_a_swing(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nikas 2010 (a reciprocating seal while the pressure swings within each run)."""
    share, period = 1.8e-6 * strength * bench.level, rng.uniform(3.5, 5.5)

    def swing(t: Array) -> Array:
        return 1.2e5 * np.sin(2.0 * np.pi * t / period)

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {"pressure [Pa]": record["pressure [Pa]"] + swing(record["time [s]"])}

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.with_extra(pressure_share=share).add_in_time(PRESSURE, swing)

    return Effect({"share": share}, rig=pressurised, alter=alter, measure=measure)


@form("load_dependence", on=("slide",))
def seal_root(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Denny 1957 (friction as the root of the pressure: the lip is already pressed flat)."""
    size = 0.7 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        pressure = float(plant.by_time[PRESSURE, 0])
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + size * np.sqrt(pressure / 3.5e5) + 0.0 * t)

    return Effect({"size": size}, rig=pressurised, alter=alter)
