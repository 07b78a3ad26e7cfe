"""Friction of a spring slider."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.slider import RateAndState, ageing, quadratic, slipping

from .form import Effect, Generator, either_sign, form


def _numbers(rng: Generator, strength: float) -> tuple[float, float, float]:
    """a, b and D: rock and gouge (Marone 1998)."""
    a = rng.uniform(0.006, 0.012) * strength
    return a, a * rng.uniform(1.1, 1.5), rng.uniform(6e-6, 20e-6)


@form("frictional_lag", on=("slider",))
def ageing_law(rng: Generator, strength: float, bench: Bench) -> Effect:
    a, b, distance = _numbers(rng, strength)
    return Effect({"a": a, "b": b, "distance": distance}, law=lambda _: RateAndState(0.6, a, (b,), (distance,), ageing))


@form("frictional_lag", on=("slider",))
def slip_law(rng: Generator, strength: float, bench: Bench) -> Effect:
    a, b, distance = _numbers(rng, strength)
    return Effect({"a": a, "b": b, "distance": distance}, law=lambda _: RateAndState(0.6, a, (b,), (distance,), slipping))


@form("frictional_lag", on=("slider",))
def quadratic_law(rng: Generator, strength: float, bench: Bench) -> Effect:
    a, b, distance = _numbers(rng, strength)
    return Effect({"a": a, "b": b, "distance": distance}, law=lambda _: RateAndState(0.6, a, (b,), (distance,), quadratic))


@form("frictional_lag", on=("slider",))
def two_states(rng: Generator, strength: float, bench: Bench) -> Effect:
    a, b, distance = _numbers(rng, strength)
    return Effect(
        {"a": a, "b": b, "distance": distance},
        law=lambda _: RateAndState(0.6, a, (0.6 * b, 0.5 * b), (distance, 4.0 * distance), ageing),
    )


@form("viscous_friction", also=("velocity_weakening", "speed_dependence"), on=("slider",))
def logarithmic(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Strengthening with the logarithm of the speed at once, without a memory."""
    a = 0.01 * strength
    return Effect({"a": a}, law=lambda _: RateAndState(0.6, a))


@form("friction_drift", also=("distance_drift", "position_dependent_friction"), on=("slider",))
def hardening(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gouge hardens with the distance slid."""
    rate = 150.0 * strength * either_sign(rng)
    return Effect({"rate": rate}, law=lambda _: RateAndState(0.6, 0.0, added=lambda t, x: rate * x))


@form("unknown", also=("harmonic_force",), on=("slider",))
def humid_air(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Friction follows the air conditioning, of which no column tells."""
    size, period = 0.012 * strength, rng.uniform(5.0, 11.0)

    def law(rng: Generator) -> RateAndState:
        phase = rng.uniform(0.0, 2.0 * np.pi)
        return RateAndState(0.6, 0.0, added=lambda t, x: size * np.sin(2.0 * np.pi * t / period + phase))

    return Effect({"size": size, "period": period}, law=law)
