"""Something is missing that no effect of the vocabulary describes."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.plant import (
    FACTOR_OF_TIME,
    FORCE_OF_TIME,
    GAIN_AT,
    GAIN_OF_TIME,
    TIME_SPACING,
    Array,
    Plant,
)

from .form import LINES, SINGLES, Effect, Generator, either_sign, form


@form("unknown")
def telegraph(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Friction jumps between two levels at random times."""
    size, rate = 0.6 * strength, rng.uniform(1.0, 2.5)

    def alter(plant: Plant, rng: Generator) -> Plant:
        switched = np.cumsum(rng.random(plant.times.size) < rate * TIME_SPACING) % 2
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + size * switched)

    return Effect({"size": size, "rate": rate}, alter=alter)


@form("unknown")
def rub(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Something rubs for half a second now and then."""
    size = 1.0 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        begins = rng.uniform(0.0, bench.duration, 4)
        return plant.times_in_time(
            FACTOR_OF_TIME, lambda t: 1.0 + size * np.max([(t > b) & (t < b + 0.5) for b in begins], axis=0)
        )

    return Effect({"size": size}, alter=alter)


@form("unknown", also=("friction_drift",))
def seized(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A bearing that seizes at one moment of each run."""
    size = 0.7 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        at = bench.duration * rng.uniform(0.3, 0.7)
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + size * (t > at))

    return Effect({"size": size}, alter=alter)


@form("unknown")
def breathing(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Friction waves in time, not in place: another machine leans on the rail."""
    size, frequency = 0.45 * strength, rng.uniform(0.8, 2.2)

    def alter(plant: Plant, rng: Generator) -> Plant:
        phase = rng.uniform(0.0, 2.0 * np.pi)
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 + size * np.sin(2.0 * np.pi * frequency * t + phase))

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("unknown", on=("arm",))
def other_joint(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Friction of a joint depends on how fast the other one turns."""
    size = 0.6 * strength / bench.speed
    return Effect({"size": size}, alter=lambda plant, _: plant.with_extra(other_speed=size))


@form("unknown", on=SINGLES)
def viscous_along_the_stroke(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Grease that lies at one end: speed times place."""
    size = 0.9 * strength * bench.level / (bench.speed * bench.reach) * either_sign(rng)
    return Effect({"size": size}, alter=lambda plant, _: plant.with_extra(speed_times_place=size))


@form("unknown", also=("position_dependent_force", "frictional_lag", "presliding_compliance"))
def hysteretic_cable(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A cable that yields: force of a soft bristle (Dahl 1968)."""
    force, length = 0.6 * strength * bench.level, bench.reach * rng.uniform(0.3, 0.6)
    return Effect({"force": force}, alter=lambda plant, _: plant.with_extra(soft_force=force, soft_length=length))


@form("unknown")
def motor_constant_waves(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Force per command depends on the place (phases of unequal strength)."""
    size, pitch = 0.25 * strength, bench.reach * rng.uniform(0.3, 0.7)
    return Effect(
        {"size": size},
        alter=lambda plant, _: plant.times_at_place(GAIN_AT, lambda q: 1.0 + size * np.sin(2.0 * np.pi * q / pitch)),
    )


@form("unknown")
def amplifier_drops_out(rng: Generator, strength: float, bench: Bench) -> Effect:
    """The amplifier gives half for 50 ms, twice a second."""
    loss = 0.6 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        begins = rng.uniform(0.0, bench.duration, round(2.0 * bench.duration))

        def factor(t: Array) -> Array:
            gain = np.ones_like(t)
            for begin in begins:
                gain[(t > begin) & (t < begin + 0.05)] = 1.0 - loss
            return gain

        return plant.times_in_time(GAIN_OF_TIME, factor)

    return Effect({"loss": loss}, alter=alter)


@form("unknown", also=("harmonic_force",))
def wandering_force(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A hose that somebody moves: a force that wanders over a second."""
    size = 0.4 * strength * bench.level

    def alter(plant: Plant, rng: Generator) -> Plant:
        n, memory = plant.times.size, np.exp(-TIME_SPACING / 1.0)
        path = np.zeros(n)
        shocks = np.sqrt(1.0 - memory**2) * rng.standard_normal(n)
        for i in range(1, n):
            path[i] = memory * path[i - 1] + shocks[i]
        return plant.add_in_time(FORCE_OF_TIME, lambda t: size * path)

    return Effect({"size": size}, alter=alter)


@form("unknown", also=("impacts",))
def blows(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Something hits the carriage once a second, for 10 ms."""
    size = 6.0 * strength * bench.level

    def alter(plant: Plant, rng: Generator) -> Plant:
        begins = rng.uniform(0.0, bench.duration, round(bench.duration))
        signs = rng.choice([-1.0, 1.0], begins.size)

        def force(t: Array) -> Array:
            total = np.zeros_like(t)
            for begin, sign in zip(begins, signs, strict=True):
                inside = (t > begin) & (t < begin + 0.01)
                total[inside] += sign * size * np.sin(np.pi * (t[inside] - begin) / 0.01)
            return total

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size}, alter=alter)


@form("unknown", on=LINES)
def late_friction(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Weakening that follows the speed late (Hess and Soom 1990)."""
    size, lag = 0.8 * strength * bench.level, 0.12 * bench.reach / bench.speed

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        knee = 0.3 * bench.speed
        return plant.add_by_speed(lambda v: size * np.exp(-((v / knee) ** 2))).with_extra(speed_lag=lag)

    return Effect({"size": size, "lag": lag}, alter=alter)


@form("unknown", also=("random_coefficients", "correlated_coefficients"))
def grabs_at_random(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Every third stroke or so grabs."""
    size = 0.8 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + size * (rng.random(400) < 0.3))

    return Effect({"size": size}, alter=alter)
