"""Friction changes with time, distance or temperature, or is random; forces that depend on time alone."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, FORCE_OF_TIME, Array, Plant

from .enter import form

TURN = 2.0 * np.pi


@form("friction_drift", also=("distance_drift",))
def cold_start(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Incropera and DeWitt 2002 (two heat capacities: grease warms first, the housing after it)."""
    loss, fast, slow = 0.5 * strength, 0.06 * bench.duration, 0.6 * bench.duration
    return in_time(
        {"loss": loss},
        lambda t: 1.0 - loss * (1.0 - 0.5 * np.exp(-np.maximum(t, 0.0) / fast) - 0.5 * np.exp(-np.maximum(t, 0.0) / slow)),
    )


@form("friction_drift", also=("distance_drift",))
def there_and_back(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Blau 2005 (a film that builds up and breaks down again within the record)."""
    size, top = 0.45 * strength * either_sign(rng), bench.duration * rng.uniform(0.4, 0.6)
    return in_time({"size": size, "top": top}, lambda t: 1.0 + size * np.exp(-(((t - top) / (0.25 * bench.duration)) ** 2)))


@form("distance_drift", also=("friction_drift",))
def polishes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Archard 1953 (asperities go with the distance slid)."""
    loss, distance = 0.5 * strength, 0.15 * bench.speed * bench.duration * rng.uniform(0.8, 1.2)
    return Effect(
        {"loss": loss, "distance": distance}, alter=lambda plant, _: plant.with_extra(wear=-loss, wear_distance=distance)
    )


@form("distance_drift", also=("friction_drift",))
def debris_collects(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Godet 1984 (third bodies gather with the distance slid)."""
    gain, distance = 1.0 * strength, 0.5 * bench.speed * bench.duration
    return Effect(
        {"gain": gain, "distance": distance}, alter=lambda plant, _: plant.with_extra(wear=gain, wear_distance=distance)
    )


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def oil_in_kelvin(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Reynolds 1886 (viscosity falls exponentially); warms, and cools when the fan starts; recorded in kelvin."""
    rate, fan = 0.055 * strength, bench.duration * rng.uniform(0.45, 0.65)

    def kelvin(t: Array) -> Array:
        warm = 1.0 - np.exp(-np.clip(t, 0.0, fan) / 3.0)
        return 296.0 + 18.0 * warm * np.exp(-np.maximum(t - fan, 0.0) / 2.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: np.exp(-rate * (kelvin(t) - 305.0)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [K]": kelvin(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"rate": rate, "fan": fan}, alter=alter, measure=measure)


@form("random_coefficients")
def each_run_skewed(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Johnson, Kotz and Balakrishnan 1994 (a gamma distribution, a new draw each run)."""
    spread = 0.2 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        factor = rng.gamma(1.0 / spread**2, spread**2)
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: factor + 0.0 * t)

    return Effect({"spread": spread}, rig=lambda bench: replace(bench, n_fit=10, n_test=4, duration=4.0), alter=alter)


@form("random_coefficients", also=("correlated_coefficients",))
def each_stroke_even(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Kang, Choi and Yoo 2015, section 2.2, with an even density in place of the normal one; a new draw each stroke."""
    half = 0.3 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=1.0 + half * rng.uniform(-1.0, 1.0, 400))

    return Effect({"half": half}, alter=alter)


@form("harmonic_force")
def runners(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bachmann and Ammann 1987 (people who jog on the floor: 2.5 to 3.2 Hz with two overtones)."""
    size, frequency = 0.4 * strength * bench.level, rng.uniform(2.6, 3.2)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.uniform(0.0, TURN)

        def force(t: Array) -> Array:
            angle = TURN * frequency * t + start
            return size * (np.sin(angle) + 0.4 * np.sin(2.0 * angle - 1.6) + 0.15 * np.sin(3.0 * angle - 1.6))

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)


@form("harmonic_force")
def hose_pump(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Latham 1966 (a peristaltic pump: a triangle that rises slowly and falls fast)."""
    size, frequency = 0.45 * strength * bench.level, rng.uniform(4.0, 7.0)

    def alter(plant: Plant, rng: Generator) -> Plant:
        start = rng.random()

        def force(t: Array) -> Array:
            share = (frequency * t + start) % 1.0
            return size * (2.0 * np.where(share < 0.7, share / 0.7, (1.0 - share) / 0.3) - 1.0)

        return plant.add_in_time(FORCE_OF_TIME, force)

    return Effect({"size": size, "frequency": frequency}, alter=alter)
