"""Friction changes with time or temperature, or is random."""

from dataclasses import replace

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator, Record, either_sign
from tests.discovery.joint_generator.forms.time import in_time
from tests.discovery.joint_generator.plant import FACTOR_OF_TIME, Array, Plant

from .enter import form


@form("friction_drift", also=("distance_drift",))
def grease_flows(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lugt 2013 (churning, then bleeding: falls fast, and rises slowly)."""
    size, span = 0.55 * strength, bench.duration
    return in_time(
        {"size": size}, lambda t: 1.0 + size * (np.exp(-8.0 * np.maximum(t, 0.0) / span) + 0.5 * np.maximum(t, 0.0) / span)
    )


@form("friction_drift", also=("distance_drift",))
def starves(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Cann 1999 (starvation: the logarithm of time)."""
    size = 0.25 * strength
    return in_time({"size": size}, lambda t: 1.0 + size * np.log1p(np.maximum(t, 0.0) / (0.05 * bench.duration)))


def _thermometer(strength: float, bench: Bench, start: float, factor, *, late: float, noise: float) -> Effect:
    """A temperature that goes up and down, and friction as a factor of what it was `late` [s] before."""

    def celsius(t: Array) -> Array:
        return 24.0 + 10.0 * np.sin(np.pi * (1.4 * t / bench.duration + start)) ** 2

    def alter(plant: Plant, rng: Generator) -> Plant:
        del rng
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: factor(celsius(t - late)))

    def measure(record: Record, rng: Generator) -> Record:
        t = record["time [s]"]
        return record | {"temperature [degC]": celsius(t) + noise * rng.standard_normal(t.size)}

    return Effect({"strength": strength, "late": late}, alter=alter, measure=measure)


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def vogel(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Vogel 1921 (viscosity over the temperature, levelled by a dry part)."""
    size = 0.9 * strength
    return _thermometer(
        strength,
        bench,
        rng.uniform(0.0, 1.0),
        lambda c: 1.0 + size * (np.exp(300.0 / (c + 70.0) - 300.0 / 94.0) - 0.7),
        late=0.0,
        noise=0.05,
    )


@form("temperature_drift", also=("friction_drift", "distance_drift"))
def gauge_leads(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Simoni, Beschi, Legnani and Visioli 2015 (the gauge sits at the housing, the teeth warm later)."""
    size = 0.45 * strength
    return _thermometer(strength, bench, rng.uniform(0.0, 1.0), lambda c: 1.0 - size * (c - 29.0) / 10.0, late=0.5, noise=0.2)


@form("random_coefficients", also=("correlated_coefficients",))
def each_stroke_skewed(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Limpert, Stahel and Abbt 2001 (lognormal, a new one each stroke)."""
    sigma = 0.16 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        return replace(plant, by_stroke=np.exp(sigma * rng.standard_normal(400)))

    return Effect({"sigma": sigma}, alter=alter)


@form("random_coefficients")
def each_mounting(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Guide to the expression of uncertainty 4.3.7 (even between limits, a new one each run)."""
    half = 0.35 * strength

    def alter(plant: Plant, rng: Generator) -> Plant:
        factor = 1.0 + half * rng.uniform(-1.0, 1.0)
        return plant.times_in_time(FACTOR_OF_TIME, lambda t: factor + 0.0 * t)

    return Effect({"half": half}, rig=lambda bench: replace(bench, n_fit=9, n_test=4, duration=4.5), alter=alter)


@form("friction_drift", also=("distance_drift",))
def oil_arrives(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Wilson 1979 (a line that falls to a plateau, or rises to it)."""
    size, end = 0.45 * strength * either_sign(rng), bench.duration * rng.uniform(0.4, 0.7)
    return in_time({"size": size, "end": end}, lambda t: 1.0 + size * (np.clip(t / end, 0.0, 1.0) - 0.5))
