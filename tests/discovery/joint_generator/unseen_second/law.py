"""Friction depends on speed, direction, load, or what went before."""

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.coupling import pressurised
from tests.discovery.joint_generator.forms.form import HINGES, SINGLES, Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, PRESSURE, Array, Plant

from .enter import form


@form("viscous_friction")
def cross_fluid(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Cross 1965 (a viscosity that falls between two plateaus)."""
    size, knee, power = 0.35 * strength * bench.level, bench.speed * rng.uniform(0.08, 0.15), rng.uniform(0.5, 0.65)
    return by_speed({"size": size, "knee": knee, "power": power}, lambda v: size * (v / knee) / (1.0 + (v / knee) ** power))


@form("viscous_friction")
def limiting_shear(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bair and Winer 1979 (an exponential approach to the shear stress that a film bears)."""
    size, knee = 0.8 * strength * bench.level, bench.speed * rng.uniform(0.3, 0.5)
    return by_speed({"size": size, "knee": knee}, lambda v: size * (1.0 - np.exp(-v / knee)))


@form("velocity_weakening")
def falling_logarithm(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rice and Ruina 1983 (steady friction falls with the logarithm of speed)."""
    size, knee = 0.9 * strength * bench.level, 0.03 * bench.speed
    return by_speed(
        {"size": size, "knee": knee},
        lambda v: size * (1.0 - np.minimum(np.log1p(v / knee) / np.log1p(bench.speed / knee), 1.0)),
    )


@form("velocity_weakening")
def flash_heating(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rice 2006 (asperities that melt: constant to a speed, then as its inverse)."""
    size, knee = 0.8 * strength * bench.level, bench.speed * rng.uniform(0.15, 0.25)
    return by_speed({"size": size, "knee": knee}, lambda v: size * knee / np.maximum(v, knee))


@form("quadratic_damping", on=SINGLES)
def turbulent_line(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Blasius 1913 (a smooth pipe: speed to 1.75)."""
    size = 0.9 * strength * rng.uniform(0.8, 1.2) * bench.level
    return by_speed({"size": size}, lambda v: size * (v / bench.speed) ** 1.75)


@form("direction_asymmetry", also=("viscous_friction",))
def rebound_and_bump(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Dixon 2007 (a damper that blows off one way and is a quarter as hard the other way)."""
    size, knee = 1.0 * strength * bench.level, bench.speed * rng.uniform(0.4, 0.6)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.add_by_speed(
            lambda v: size * (np.minimum(v, knee) + 0.3 * np.maximum(v - knee, 0.0)) / knee, lambda v: 0.25 * size * v / knee
        )

    return Effect({"size": size, "knee": knee}, alter=alter)


@form("direction_asymmetry", also=("velocity_weakening", "constant_force"))
def pile_of_a_brush(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hancock, Sekeroglu and Demirel 2012 (leaning hairs grip one way; that grip falls by a third at speed)."""
    size, side, knee = 0.45 * strength * bench.level, either_sign(rng), 0.2 * bench.speed

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def grip(v: Array) -> Array:
            return side * size * (0.67 + 0.33 * np.exp(-v / knee))

        return plant.add_by_speed(grip, lambda v: -grip(v))

    return Effect({"size": side * size}, alter=alter)


@form("frictional_lag")
def distance_and_time(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Persson 1998 (after a reversal junctions are renewed by the distance, and the film closes in time)."""
    size = 1.0 * strength
    distance, time = bench.reach * rng.uniform(0.2, 0.35), 0.25 * bench.reach / bench.speed * rng.uniform(0.8, 1.2)
    return Effect(
        {"size": size, "distance": distance, "time": time},
        alter=lambda plant, _: plant.with_extra(memory=size, memory_distance=distance, memory_time=time),
    )


@form("load_dependence", on=(*HINGES, "arm"))
def preloaded_nut(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Altintas, Verl, Brecher, Uriarte and Pritschow 2011 (a preload: only what exceeds it rubs more)."""
    share = 0.45 * strength * rng.uniform(0.9, 1.1)
    above = 0.25 * bench.numbers["gravity_2" if bench.place else "gravity"]
    return Effect(
        {"share": share, "above": above}, alter=lambda plant, _: plant.with_extra(drive_share=share, drive_from=above)
    )


@form("load_dependence", on=("slide",))
def clamped_rail(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bowden and Tabor 1950 (a clamp whose load cell is recorded: friction as a power of the load well below 1)."""
    power, period, start = 1.0 - 0.7 * strength, rng.uniform(2.5, 4.0), rng.uniform(0.0, 2.0 * np.pi)

    def share(t: Array) -> Array:
        return 1.0 + 0.5 * np.sin(2.0 * np.pi * t / period + start)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: share(t) ** power)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"power": power, "period": period}, alter=alter, measure=measure)


@form("load_dependence", on=("slide",))
def lip_levels_off(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Archard 1957 (the real area of contact approaches the apparent one: pressure falls exponentially within each run)."""
    size = 0.9 * strength

    def fall(t: Array) -> Array:
        return 2.5e5 * (np.exp(-np.maximum(t, 0.0) / 4.0) - 0.4)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        plant = plant.add_in_time(PRESSURE, fall)
        pressure = plant.by_time[PRESSURE]
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + size * (1.0 - np.exp(-pressure / 3e5)))

    def measure(record: Record, rng: Generator) -> Record:
        del rng
        return record | {"pressure [Pa]": record["pressure [Pa]"] + fall(record["time [s]"])}

    return Effect({"size": size}, rig=pressurised, alter=alter, measure=measure)
