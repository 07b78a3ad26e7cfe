"""Friction, or another force, depends on where the joint is."""

from collections.abc import Callable

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.plant import FACTOR_AT, Array

from .form import HINGES, Effect, Generator, either_sign, form


def friction_at(parameters: dict[str, float], factor: Callable[[Array], Array]) -> Effect:
    return Effect(parameters, alter=lambda plant, _: plant.times_at_place(FACTOR_AT, factor))


def force_at(parameters: dict[str, float], force: Callable[[Array], Array]) -> Effect:
    return Effect(parameters, alter=lambda plant, _: plant.add_force_at(force))


@form("position_dependent_friction")
def wave(rng: Generator, strength: float, bench: Bench) -> Effect:
    size, length, phase = 0.45 * strength, bench.reach * rng.uniform(0.3, 0.9), rng.uniform(0.0, 2.0 * np.pi)
    return friction_at({"size": size, "wavelength": length}, lambda q: 1.0 + size * np.sin(2.0 * np.pi * q / length + phase))


@form("position_dependent_friction")
def teeth(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A wave with steep flanks."""
    size, length, phase = 0.35 * strength, bench.reach * rng.uniform(0.4, 0.9), rng.uniform(0.0, 2.0 * np.pi)
    return friction_at(
        {"size": size, "wavelength": length},
        lambda q: 1.0 + size * np.tanh(2.0 * np.sin(2.0 * np.pi * q / length + phase)),
    )


@form("position_dependent_friction")
def tight_spot(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A dent in the rail."""
    size, at, width = 1.0 * strength, bench.reach * rng.uniform(-0.5, 0.5), bench.reach * rng.uniform(0.1, 0.2)
    return friction_at({"size": size, "at": at, "width": width}, lambda q: 1.0 + size * np.exp(-0.5 * ((q - at) / width) ** 2))


@form("position_dependent_friction")
def wedge(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Rails that come together along the stroke."""
    slope = 0.5 * strength * either_sign(rng) / bench.reach
    return friction_at({"slope": slope}, lambda q: np.maximum(1.0 + slope * q, 0.2))


@form("position_dependent_force")
def cogging(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Magnets that pull at iron teeth (Zhu and Howe 2000)."""
    size, pitch, phase = 0.4 * strength * bench.level, bench.reach * rng.uniform(0.2, 0.6), rng.uniform(0.0, 2.0 * np.pi)
    return force_at({"size": size, "pitch": pitch}, lambda q: size * np.sin(2.0 * np.pi * q / pitch + phase))


@form("position_dependent_force")
def two_harmonics(rng: Generator, strength: float, bench: Bench) -> Effect:
    size, pitch, phase = 0.35 * strength * bench.level, bench.reach * rng.uniform(0.4, 0.8), rng.uniform(0.0, 2.0 * np.pi)

    def force(q: Array) -> Array:
        angle = 2.0 * np.pi * q / pitch + phase
        return size * (np.sin(angle) + 0.5 * np.sin(2.0 * angle + 1.0))

    return force_at({"size": size, "pitch": pitch}, force)


@form("position_dependent_force")
def cable(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A cable that is dragged along pulls back like a spring."""
    slope = 0.6 * strength * bench.level / bench.reach
    rest = bench.reach * rng.uniform(-0.3, 0.3)
    return force_at({"slope": slope, "rest": rest}, lambda q: slope * (q - rest))


@form("position_dependent_force", also=("nonlinear_stiffness",))
def hard_stop_spring(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A buffer that stiffens toward the ends."""
    size = 0.8 * strength * bench.level
    return force_at({"size": size}, lambda q: size * (q / bench.reach) ** 3)


@form("position_dependent_force", on=("slide", "mjcf_slide"))
def spring_from_one_side(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A bellows that is compressed beyond a place."""
    slope, from_here = 1.0 * strength * bench.level / bench.reach, bench.reach * rng.uniform(-0.2, 0.2)
    return force_at({"slope": slope, "from": from_here}, lambda q: slope * np.maximum(q - from_here, 0.0))


@form("position_dependent_force", on=HINGES)
def unbalance(rng: Generator, strength: float, bench: Bench) -> Effect:
    """A mass beside the arm: a torque as the cosine of the angle."""
    size = 0.5 * strength * bench.level * either_sign(rng)
    return force_at({"size": size}, lambda q: size * np.cos(q))
