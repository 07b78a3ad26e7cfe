"""Friction of a spring slider."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator, either_sign
from tests.discovery.joint_generator.slider import RateAndState, ageing, slipping

from .enter import form

SLIDER = ("slider",)


@form("frictional_lag", on=SLIDER)
def two_that_weaken(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Tullis and Weeks 1986 (two states, both weaken; the second takes five times the distance)."""
    a, distance = rng.uniform(0.008, 0.012) * strength, rng.uniform(6e-6, 1e-5)
    return Effect(
        {"a": a, "distance": distance},
        law=lambda _: RateAndState(0.6, a, (0.8 * a, 0.5 * a), (distance, 5.0 * distance), ageing),
    )


@form("frictional_lag", on=SLIDER)
def weakens_by_slip(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bhattacharya, Rubin, Bayart, Savage and Marone 2015 (the slip law, memory larger than the direct effect)."""
    a, distance = rng.uniform(0.006, 0.01) * strength, rng.uniform(1.5e-5, 3e-5)
    return Effect({"a": a, "distance": distance}, law=lambda _: RateAndState(0.6, a, (1.25 * a,), (distance,), slipping))


@form("viscous_friction", on=SLIDER)
def talc(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Moore and Lockner 2008 (stronger with the logarithm of speed, without a memory)."""
    a = rng.uniform(0.004, 0.006) * strength
    return Effect({"a": a}, law=lambda _: RateAndState(0.6, a))


@form("friction_drift", also=("distance_drift", "position_dependent_friction"), on=SLIDER)
def fault_warms(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Blau 2005 (a line in time)."""
    size = 0.02 * strength * either_sign(rng)
    return Effect({"size": size}, law=lambda _: RateAndState(0.6, 0.0, added=lambda t, x: size * t / 60.0))


@form("unknown", also=("friction_drift",), on=SLIDER)
def piston_sticks(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rice 1944 (shot noise: a seal of the loading piston catches at random times, and lets go exponentially)."""
    size, rate = 0.02 * strength, rng.uniform(0.1, 0.2)

    def law(rng: Generator) -> RateAndState:
        at = np.cumsum(rng.exponential(1.0 / rate, 40))

        def added(t: np.ndarray, x: np.ndarray) -> np.ndarray:
            since = t[:, None] - at[None, :]
            return size * np.sum(np.where(since > 0.0, np.exp(-np.maximum(since, 0.0) / 1.5), 0.0), axis=1)

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size, "rate": rate}, law=law)


@form("none", on=SLIDER)
def noise_of_a_load_cell(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Constant friction, 1.9 standard deviations off, in steps of 1e-4 (Widrow and Kollar 2008)."""

    def law(rng: Generator) -> RateAndState:
        return RateAndState(0.73, 0.0, added=lambda t, x: 1e-4 * np.round(2.0 * rng.standard_normal(t.size)))

    return Effect(law=law)
