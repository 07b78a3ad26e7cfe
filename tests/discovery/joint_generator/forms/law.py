"""Friction depends on speed, direction, or what went before."""

from collections.abc import Callable

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.plant import Array, Plant

from .form import Effect, Generator, either_sign, form


def by_speed(parameters: dict[str, float], forward: Callable[[Array], Array], *, back: float = 1.0) -> Effect:
    """Further friction of this form; `back`: factor on it where the motion goes backward."""

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(forward, lambda speed: back * forward(speed))

    return Effect(parameters, alter=alter)


@form("viscous_friction")
def proportional(rng: Generator, strength: float, bench: Bench) -> Effect:
    c = 0.6 * strength * rng.uniform(0.8, 1.2) * bench.level / bench.speed
    return by_speed({"coefficient": c}, lambda v: c * v)


@form("viscous_friction")
def concave(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A power below 1, as of grease that thins with shear: Ostwald 1925; gear units: Pagani et al. 2020."""
    size, power = 0.7 * strength * bench.level, rng.uniform(0.45, 0.7)
    return by_speed({"size": size, "power": power}, lambda v: size * (v / bench.speed) ** power)


@form("viscous_friction")
def saturating(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hyperbolic tangent, levelling off within the range of speeds."""
    size, knee = 0.6 * strength * bench.level, bench.speed * rng.uniform(0.2, 0.4)
    return by_speed({"size": size, "knee": knee}, lambda v: size * np.tanh(v / knee))


@form("viscous_friction")
def sinh_law(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Eyring 1936: an inverse hyperbolic sine of the shear rate."""
    size, knee = 0.35 * strength * bench.level, bench.speed * rng.uniform(0.1, 0.3)
    return by_speed({"size": size, "knee": knee}, lambda v: size * np.arcsinh(v / knee))


@form("velocity_weakening")
def gaussian(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Armstrong-Helouvry 1991."""
    size, knee = 0.6 * strength * bench.level, bench.speed * rng.uniform(0.12, 0.3)
    return by_speed({"size": size, "knee": knee}, lambda v: size * np.exp(-((v / knee) ** 2)))


@form("velocity_weakening")
def rational(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hess and Soom 1990."""
    size, knee = 0.6 * strength * bench.level, bench.speed * rng.uniform(0.12, 0.3)
    return by_speed({"size": size, "knee": knee}, lambda v: size / (1.0 + (v / knee) ** 2))


@form("velocity_weakening")
def exponential(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bo and Pavelescu 1982 with an exponent of its own."""
    size, knee, power = 0.6 * strength * bench.level, bench.speed * rng.uniform(0.15, 0.4), rng.uniform(0.8, 1.3)
    return by_speed({"size": size, "knee": knee, "power": power}, lambda v: size * np.exp(-((v / knee) ** power)))


@form("quadratic_damping", on=("slide", "hinge", "mjcf_slide", "mjcf_hinge"))
def drag(rng: Generator, strength: float, bench: Bench) -> Effect:
    c = 0.8 * strength * rng.uniform(0.8, 1.2) * bench.level / bench.speed**2
    return Effect({"coefficient": c}, alter=lambda plant, _: plant.with_extra(quadratic=c))


@form("direction_asymmetry")
def coulomb_level(rng: Generator, strength: float, bench: Bench) -> Effect:
    size = 0.35 * strength * bench.level * either_sign(rng)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(lambda v: size + 0.0 * v, lambda v: -size + 0.0 * v)

    return Effect({"half_difference": size}, alter=alter)


@form("direction_asymmetry", also=("viscous_friction",))
def viscous_part(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Grease that drags more one way: EMPS-like drives differ in both parts (Janot et al. 2019)."""
    c = 0.9 * strength * bench.level / bench.speed
    share = rng.uniform(0.1, 0.3)
    return by_speed({"coefficient": c, "back": share}, lambda v: c * v, back=share)


@form("frictional_lag")
def after_reversal(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Friction starts high after a reversal and falls off with the distance slid (Rabinowicz 1951)."""
    size, distance = 0.7 * strength, bench.reach * rng.uniform(0.1, 0.25)
    return Effect(
        {"size": size, "distance": distance},
        alter=lambda plant, _: plant.with_extra(memory=size, memory_distance=distance),
    )


@form("frictional_lag")
def rational_in_time(rng: Generator, strength: float, bench: Bench) -> Effect:
    """The same in time, hyperbolic as thixotropic recovery is (Barnes 1997)."""
    size, time = 0.8 * strength, 0.2 * bench.reach / bench.speed * rng.uniform(0.7, 1.5)
    return Effect(
        {"size": size, "time": time}, alter=lambda plant, _: plant.with_extra(memory=size, memory_time=time, rational=1.0)
    )
