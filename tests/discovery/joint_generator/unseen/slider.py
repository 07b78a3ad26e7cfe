"""Friction of a spring slider."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator, either_sign
from tests.discovery.joint_generator.slider import RateAndState, ageing, slipping

from .enter import form

SLIDER = ("slider",)


def composite(theta: float, v: float, distance: float) -> float:
    """Kato and Tullis 2001, with a cut-off speed within the range."""
    x = v * theta / distance
    return float(np.exp(-v / 2e-6)) - x * float(np.log(max(x, 1e-12)))


def between(theta: float, v: float, distance: float) -> float:
    """Between the ageing law and that of Perrin, Rice and Zheng 1995."""
    return 1.0 - (v * theta / distance) ** 1.5


def _memory(rng: Generator, strength: float, share: float, law) -> Effect:
    a, distance = rng.uniform(0.006, 0.012) * strength, rng.uniform(8e-6, 25e-6)
    return Effect(
        {"a": a, "b": share * a, "distance": distance}, law=lambda _: RateAndState(0.6, a, (share * a,), (distance,), law)
    )


@form("frictional_lag", on=SLIDER)
def composite_law(rng: Generator, strength: float, bench: Bench) -> Effect:
    return _memory(rng, strength, rng.uniform(1.2, 1.6), composite)


@form("frictional_lag", on=SLIDER)
def steeper_law(rng: Generator, strength: float, bench: Bench) -> Effect:
    return _memory(rng, strength, rng.uniform(1.2, 1.6), between)


@form("frictional_lag", on=SLIDER)
def strengthening_gouge(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Marone, Raleigh and Scholz 1990 (memory, yet stronger at speed)."""
    return _memory(rng, strength, rng.uniform(0.45, 0.65), slipping)


@form("frictional_lag", on=SLIDER)
def two_memories(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ikari, Saffer and Marone 2009 (clay: one state weakens, a slower one strengthens)."""
    a, distance = rng.uniform(0.008, 0.012) * strength, rng.uniform(6e-6, 10e-6)
    return Effect(
        {"a": a, "distance": distance},
        law=lambda _: RateAndState(0.6, a, (1.3 * a, -0.7 * a), (distance, 4.0 * distance), ageing),
    )


@form("friction_drift", also=("distance_drift", "position_dependent_friction"), on=SLIDER)
def gouge_forms(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mair and Marone 1999 (gouge layer that settles with the distance)."""
    size, length = 0.02 * strength * either_sign(rng), rng.uniform(8e-5, 2e-4)
    return Effect({"size": size}, law=lambda _: RateAndState(0.6, 0.0, added=lambda t, x: size * (1.0 - np.exp(-x / length))))


@form("unknown", also=("position_dependent_friction",), on=SLIDER)
def screw(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A loading screw whose pitch shows in the friction that is measured."""
    size, pitch = 0.01 * strength, rng.uniform(2e-5, 5e-5)

    def law(rng: Generator) -> RateAndState:
        phase = rng.uniform(0.0, 2.0 * np.pi)
        return RateAndState(0.6, 0.0, added=lambda t, x: size * np.sin(2.0 * np.pi * x / pitch + phase))

    return Effect({"size": size, "pitch": pitch}, law=law)


@form("unknown", on=SLIDER)
def grains_rotate(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Mair, Frye and Marone 2002 (glass beads: two levels, at random)."""
    size, rate = 0.012 * strength, rng.uniform(0.2, 0.5)

    def law(rng: Generator) -> RateAndState:
        turns = np.cumsum(rng.exponential(1.0 / rate, 200))
        return RateAndState(0.6, 0.0, added=lambda t, x: size * (np.searchsorted(turns, t) % 2))

    return Effect({"size": size, "rate": rate}, law=law)


@form("none", on=SLIDER)
def noise_first_order(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Constant friction, read through an amplifier of first order: 0.1 s."""

    def law(rng: Generator) -> RateAndState:
        def added(t, x):
            path, kept = np.zeros(t.size), np.exp(-(t[1] - t[0]) / 0.1)
            for i in range(1, t.size):
                path[i] = kept * path[i - 1] + 2e-4 * np.sqrt(1.0 - kept**2) * rng.standard_normal()
            return path

        return RateAndState(0.6, 0.0, added=added)

    return Effect(law=law)


@form("none", on=SLIDER)
def another_level(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Constant friction at 1.8 standard deviations from the stated one."""
    return Effect(law=lambda _: RateAndState(0.51, 0.0))
