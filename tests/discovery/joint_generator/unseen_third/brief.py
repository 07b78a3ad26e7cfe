"""Friction of spring sliders and of short slides."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator
from tests.discovery.joint_generator.slider import RateAndState, slipping
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

SLIDER, THROWN, MU = ("slider",), ("thrown",), 0.24


@form("frictional_lag", on=SLIDER)
def long_and_short_slip(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Blanpied and others 1998 (two memories by the slip law, the second of four times the distance)."""
    a, distance = rng.uniform(0.007, 0.01) * strength, rng.uniform(6e-6, 1e-5)
    return Effect(
        {"a": a, "distance": distance},
        law=lambda _: RateAndState(0.6, a, (0.7 * a, 0.45 * a), (distance, 4.0 * distance), slipping),
    )


@form("distance_drift", also=("friction_drift", "position_dependent_friction"), on=SLIDER)
def bare_rock_polishes(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Byerlee 1967; Scholz 2002 (friction falls exponentially with the displacement)."""
    size, distance = 0.03 * strength, rng.uniform(5e-5, 9e-5)
    return Effect(
        {"size": size, "distance": distance},
        law=lambda _: RateAndState(0.6, 0.0, added=lambda t, x: -size * (1.0 - np.exp(-x / distance))),
    )


@form("unknown", also=("correlated_coefficients", "distance_drift"), on=SLIDER)
def grains_jam(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Dalton and Corcoran 2001 (grains that jam and give way: a saw over random displacements)."""
    size = 0.02 * strength

    def law(rng: Generator) -> RateAndState:
        ends = np.cumsum(rng.uniform(1e-5, 4e-5, 400))

        def added(t: np.ndarray, x: np.ndarray) -> np.ndarray:
            i = np.searchsorted(ends, x)
            begin = np.concatenate([[0.0], ends])[i]
            return size * ((x - begin) / (ends[i] - begin) - 0.5)

        return RateAndState(0.6, 0.0, added=added)

    return Effect({"size": size}, law=law)


@form("none", on=SLIDER)
def low_level(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Constant friction at 1.6 standard deviations below the stated one, read in steps of 2e-4."""

    def law(rng: Generator) -> RateAndState:
        return RateAndState(0.52, 0.0, added=lambda t, x: 2e-4 * np.round(rng.uniform(-1.0, 1.0, t.size)))

    return Effect(law=law)


@form("velocity_weakening", on=THROWN)
def ice(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Evans, Nye and Cheeseman 1976 (melt water: friction as the inverse root of the speed, and a dry part)."""
    share = 0.6 * strength
    return Effect({"share": share}, law=lambda _: Throw(lambda v, x: MU * (1.0 - share + share * (0.6 / max(v, 0.03)) ** 0.5)))


@form("unknown", also=("random_coefficients", "viscous_friction"), on=THROWN)
def spins(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Farkas, Bartels, Unger and Wolf 2003 (a disc that spins, another spin each throw: friction along the path is less)."""
    top = 1.4 * strength

    def law(rng: Generator) -> Throw:
        rim = top * rng.random()
        return Throw(lambda v, x: MU * v / np.hypot(v, rim) if v > 0.0 else MU)

    return Effect({"top": top}, law=law)


@form("none", on=THROWN)
def gentle_throws(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Starts of 0.9 to 1.1 m/s, read twice as badly."""
    return Effect(law=lambda _: Throw(lambda v, x: MU, starts=(0.9, 1.1), noise=1.6e-4))
