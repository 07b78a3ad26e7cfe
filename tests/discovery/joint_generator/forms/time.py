"""Friction changes with time, distance or temperature, or is random; forces that depend on time alone."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, FORCE_OF_TIME, Array, Plant

from .form import Effect, Generator, Record, either_sign, form


def in_time(parameters: dict[str, float], factor: Callable[[Array], Array]) -> Effect:
    return Effect(parameters, alter=lambda plant, _: plant.times_in_time(FACTOR_OF_TIME, factor))


@form("friction_drift", also=("distance_drift",))
def warming(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Grease warms up: an exponential approach."""
    loss, time = 0.45 * strength, bench.duration * rng.uniform(0.25, 0.6)
    return in_time({"loss": loss, "time": time}, lambda t: 1.0 - loss * (1.0 - np.exp(-t / time)))


@form("friction_drift", also=("distance_drift",))
def wear(rng: Generator, strength: float, bench: Bench) -> Effect:
    total = 0.4 * strength
    return in_time({"total": total}, lambda t: 1.0 + total * t / bench.duration)


@form("friction_drift", also=("distance_drift",))
def run_in(rng: Generator, strength: float, bench: Bench) -> Effect:
    """As the square root of time (Blau 2005)."""
    total = 0.4 * strength
    return in_time({"total": total}, lambda t: 1.0 - total * np.sqrt(np.maximum(t, 0.0) / bench.duration))


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def thermometer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Friction falls with a temperature that goes up and down and is recorded (Bittencourt and Gunnarsson 2012)."""
    size, start = 0.4 * strength, rng.uniform(0.0, 1.0)

    def celsius(t: Array) -> Array:
        return 25.0 + 12.0 * np.sin(np.pi * (t / bench.duration * 1.3 + start)) ** 2

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: 1.0 - size * (celsius(t) - 31.0) / 12.0)

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + 0.05 * rng.standard_normal(t.size)}

    return Effect({"size": size}, alter=alter, measure=measure)


@form("random_coefficients", also=("correlated_coefficients",))
def per_stroke(rng: Generator, strength: float, bench: Bench) -> Effect:
    sigma = 0.15 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=np.maximum(1.0 + sigma * rng.standard_normal(400), 0.2))

    return Effect({"sigma": sigma}, alter=alter)


@form("random_coefficients")
def per_run(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Each run, mounted anew, has a friction of its own."""
    sigma = 0.2 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        factor = max(1.0 + sigma * rng.standard_normal(), 0.2)
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: factor + 0.0 * t)

    return Effect({"sigma": sigma}, rig=lambda bench: replace(bench, n_fit=8, n_test=4, duration=5.0), alter=alter)


def _force(parameters: dict[str, float], force: Callable[[Array, float], Array]) -> Effect:
    """A force over time and a phase that is drawn for each run."""

    def alter(plant: Plant, rng: Generator) -> Plant:
        phase = rng.uniform(0.0, 2.0 * np.pi)
        return plant.add_in_time(FORCE_OF_TIME, lambda t: force(t, phase))

    return Effect(parameters, alter=alter)


@form("harmonic_force")
def floor_vibration(rng: Generator, strength: float, bench: Bench) -> Effect:
    size, frequency = 0.35 * strength * bench.level, rng.uniform(4.0, 9.0)
    return _force({"size": size, "frequency": frequency}, lambda t, phase: size * np.sin(2.0 * np.pi * frequency * t + phase))


@form("harmonic_force")
def rotating_unbalance(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A fan on the carriage, with its second harmonic."""
    size, frequency = 0.3 * strength * bench.level, rng.uniform(10.0, 16.0)

    def force(t: Array, phase: float) -> Array:
        angle = 2.0 * np.pi * frequency * t + phase
        return size * (np.sin(angle) + 0.3 * np.sin(2.0 * angle))

    return _force({"size": size, "frequency": frequency}, force)


@form("harmonic_force")
def slow_square(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A valve that opens and shuts."""
    size, frequency = 0.3 * strength * bench.level * either_sign(rng), rng.uniform(1.5, 3.0)
    return _force(
        {"size": size, "frequency": frequency},
        lambda t, phase: size * np.sign(np.sin(2.0 * np.pi * frequency * t + phase)),
    )
