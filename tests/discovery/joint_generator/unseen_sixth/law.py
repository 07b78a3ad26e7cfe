"""Friction of the vocabulary in further shapes: by speed, direction, load, time, temperature and chance."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import GRAVITY, Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.law import by_speed
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, Array, Plant
from tests.discovery.joint_generator.slider import RateAndState
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

TURN = 2.0 * np.pi


@form("viscous_friction")
def carreau(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Carreau 1972 (straight while slow, then a power of the speed)."""
    size, knee, power = 0.7 * strength * bench.level, rng.uniform(4.0, 9.0), rng.uniform(0.3, 0.5)

    def drag(u: Array) -> Array:
        return u * (1.0 + (knee * u) ** 2) ** (0.5 * (power - 1.0))

    return by_speed({"size": size, "knee": knee, "power": power}, lambda v: size * drag(v / bench.speed) / drag(np.ones(1)))


@form("velocity_weakening")
def between_cut_offs(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Okubo 1989; Weeks 1993 (a logarithm of the speed between two cut-offs: level below and beyond)."""
    size, low, high = 0.65 * strength * bench.level, bench.speed * rng.uniform(0.03, 0.06), bench.speed * rng.uniform(0.4, 0.6)
    return by_speed(
        {"size": size, "low": low, "high": high}, lambda v: size * np.log((high + v) / (low + v)) / np.log(high / low)
    )


@form("direction_asymmetry", also=("viscous_friction", "velocity_weakening"))
def slanted_dimples(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Nanbu, Ren, Yasuda, Zhu and Wang 2008 (dimples that slant: one way a film drags more with speed, the other way it lifts).

    At half of the highest speed both ways are alike.
    """
    size, knee, forward = 0.8 * strength * bench.level, 0.5 * bench.speed / np.log(2.0), rng.random() < 0.5

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def lifts(v: Array) -> Array:
            return size * np.exp(-v / knee)

        def drags(v: Array) -> Array:
            return size * (1.0 - np.exp(-v / knee))

        return plant.add_by_speed(lifts, drags) if forward else plant.add_by_speed(drags, lifts)

    return Effect({"size": size, "knee": knee, "forward": float(forward)}, alter=alter)


@form("load_dependence", on=("slide",))
def adhering_sphere(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Derjaguin, Muller and Toporov 1975 (a sphere that adheres; its load is recorded, and goes by stairs)."""
    stair, pull = rng.uniform(0.9, 1.3), 0.15
    levels = (0.5, 1.6, 0.9, 1.9, 0.7, 1.3)

    def share(t: Array) -> Array:
        total = np.full_like(t, levels[0])
        for k in range(1, 40):
            rise = levels[k % len(levels)] - levels[(k - 1) % len(levels)]
            total += 0.5 * rise * (1.0 + np.tanh((t - k * stair) / 0.04))
        return total

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng

        def force(t: Array) -> Array:
            u = share(t)
            return u * (1.0 + strength * (((u + pull) / (1.0 + pull)) ** (2.0 / 3.0) / u - 1.0))

        return plant.times_in_time(FACTOR_OF_TIME, force)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        load = GRAVITY * bench.numbers["inertia"] * share(t)
        return record | {"normal_force [N]": load * (1.0 + 2e-3 * rng.standard_normal(t.size))}

    return Effect({"stair": stair}, alter=alter, measure=measure)


@form("friction_drift", also=("distance_drift",))
def scuffs(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lee and Ludema 1990 (scuffing that feeds itself: an exponential that grows)."""
    more, time = 0.7 * strength, bench.duration * rng.uniform(0.22, 0.35)
    return in_time({"more": more, "time": time}, lambda t: 1.0 + more * np.expm1(t / time) / np.expm1(bench.duration / time))


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def liquid_crystal(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Landau 1937; Carrion and others 2009 (a liquid crystal whose order ends at a temperature, as a root before it)."""
    clears, period, start = rng.uniform(27.0, 30.0), bench.duration * rng.uniform(0.6, 0.8), rng.uniform(0.0, TURN)

    def celsius(t: Array) -> Array:
        return 25.0 + 7.0 * np.sin(TURN * t / period + start) + 1.5 * np.sin(1.7 * TURN * t / period)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(
            FACTOR_OF_TIME, lambda t: 1.0 + 0.7 * strength * (np.sqrt(np.maximum(clears - celsius(t), 0.0) / 10.0) - 0.5)
        )

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"clears": clears, "period": period}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def each_stroke_gumbel(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gumbel 1958 (the strongest of many junctions: a new draw each stroke, skewed to above)."""
    spread = 0.25 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        z = (rng.gumbel(size=400) - np.euler_gamma) * np.sqrt(6.0) / np.pi
        return replace(plant, by_stroke=np.maximum(1.0 + spread * z, 0.2))

    return Effect({"spread": spread}, alter=alter)


@form("correlated_coefficients", also=("random_coefficients",))
def debris_from_stroke_to_stroke(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Box and Jenkins 1970; Godet 1984 (debris, of which two thirds stay for the next stroke)."""
    spread, kept = 0.3 * strength, 0.67

    def alter(plant: Plant, rng: Generator) -> Plant:
        left = np.empty(400)
        now = rng.standard_normal()
        for i in range(left.size):
            left[i] = now
            now = kept * now + np.sqrt(1.0 - kept**2) * rng.standard_normal()
        return replace(plant, by_stroke=np.maximum(1.0 + spread * left, 0.2))

    return Effect({"spread": spread, "kept": kept}, alter=alter)


@form("random_coefficients", on=("thrown",))
def throws_of_first_passages(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tweedie 1957 (an inverse Gaussian density: most throws alike, a long tail above; a new draw each slide)."""
    spread = 0.16 * strength

    def law(rng: Generator) -> Throw:
        mu = 0.26 * (min(rng.wald(1.0, 1.0 / spread**2), 1.8) if spread else 1.0)
        return Throw(lambda v, x: mu)

    return Effect({"spread": spread}, law=law)


@form("frictional_lag", on=("slider",))
def three_memories(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gu, Rice, Ruina and Tse 1984 (several states: three that weaken, each over four times the distance of the last one)."""
    a, distance = rng.uniform(0.007, 0.011) * strength, rng.uniform(4e-6, 7e-6)
    return Effect(
        {"a": a, "distance": distance},
        law=lambda _: RateAndState(0.6, a, (0.6 * a, 0.4 * a, 0.3 * a), (distance, 4.0 * distance, 16.0 * distance)),
    )


@form("distance_drift", also=("friction_drift", "position_dependent_friction"), on=("slider",))
def root_of_the_displacement(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Queener, Smith and Mitchell 1965 (wear-in that goes as the root of the way)."""
    size = 0.025 * strength * either_sign(rng)
    return Effect({"size": size}, law=lambda _: RateAndState(0.6, 0.0, added=lambda t, x: size * np.sqrt(x / 5e-4)))
