"""Friction of short slides."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import Effect, Generator
from tests.discovery.joint_generator.thrown import Throw

from .enter import form

THROWN, MU = ("thrown",), 0.26


@form("random_coefficients", on=THROWN)
def each_throw(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Fazeli, Kolbert, Tedrake and Rodriguez 2017 (planar slides that scatter), lognormal."""
    sigma = 0.08 * strength

    def law(rng: Generator) -> Throw:
        mu = MU * float(np.exp(sigma * rng.standard_normal()))
        return Throw(lambda v, x: mu)

    return Effect({"sigma": sigma}, law=law)


@form("random_coefficients", on=THROWN)
def each_face(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Yu, Bauza, Fazeli and Rodriguez 2016 (it lands on one of three faces)."""
    half = 0.1 * strength

    def law(rng: Generator) -> Throw:
        mu = MU * (1.0 + half * float(rng.integers(-1, 2)))
        return Throw(lambda v, x: mu)

    return Effect({"half": half}, law=law)


@form("viscous_friction", also=("quadratic_damping",), on=THROWN)
def rubber(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Grosch 1963 (rubber: rises with the logarithm of speed)."""
    size = 0.12 * strength
    return Effect({"size": size}, law=lambda _: Throw(lambda v, x: MU * (1.0 + size * np.log1p(max(v, 0.0) / 0.1))))


@form("position_dependent_friction", on=THROWN)
def polished_end(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A table that is polished beyond a place."""
    size = 0.35 * strength
    return Effect({"size": size}, law=lambda _: Throw(lambda v, x: MU * (1.0 - size / (1.0 + np.exp(-(x - 0.12) / 0.01)))))


@form("none", on=THROWN)
def alike(rng: Generator, strength: float, bench: Bench) -> Effect:
    return Effect(law=lambda _: Throw(lambda v, x: MU))


@form("none", on=THROWN)
def alike_but_rough(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Another level than stated."""
    return Effect(law=lambda _: Throw(lambda v, x: 1.4 * MU))
