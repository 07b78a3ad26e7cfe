"""Friction, or another force, depends on where the joint is."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, LINES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import Array

from .enter import form

TURN = 2.0 * np.pi


@form("position_dependent_friction")
def worn_rack(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Flodin and Andersson 1997 (flanks that wear on one side: a saw of period one tooth, its edge rounded)."""
    size, length, phase = 0.5 * strength, bench.reach * rng.uniform(0.45, 0.8), rng.uniform(0.0, 1.0)

    def saw(q: Array) -> Array:
        share = (q / length + phase) % 1.0
        return np.where(share < 0.9, share / 0.9, (1.0 - share) / 0.1) - 0.5

    return friction_at({"size": size, "length": length}, lambda q: 1.0 + 2.0 * size * saw(q))


@form("position_dependent_friction")
def three_scratches(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Holmberg and Matthews 2009 (a guide that was scratched at three places, of unequal depth)."""
    at = bench.reach * (np.array([-0.5, 0.0, 0.5]) + rng.uniform(-0.15, 0.15, 3))
    size, width = 1.1 * strength * rng.uniform(0.6, 1.0, 3), 0.09 * bench.reach
    return friction_at(
        {"width": width, "deepest": float(size.max())},
        lambda q: 1.0 + np.sum(size[:, None] * np.exp(-0.5 * ((q - at[:, None]) / width) ** 2), axis=0),
    )


@form("position_dependent_friction", on=(*HINGES, "arm"))
def cardan(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Seherr-Thoss, Schmelz and Aucktor 2006 (a Hooke's joint: two waves a turn)."""
    size, phase = 0.6 * strength, rng.uniform(0.0, TURN)
    return friction_at({"size": size, "phase": phase}, lambda q: 1.0 + size * np.cos(2.0 * q + phase))


@form("position_dependent_force")
def two_pitches(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Bianchi and Bolognani 2002 (slots and magnets whose numbers have no common factor: two wavelengths)."""
    size, pitch, one, two = 0.35 * strength * bench.level, bench.reach * rng.uniform(0.5, 0.8), *rng.uniform(0.0, TURN, 2)
    return force_at(
        {"size": size, "pitch": pitch},
        lambda q: size * (np.sin(TURN * q / pitch + one) + 0.6 * np.sin(TURN * q / (0.71 * pitch) + two)),
    )


@form("position_dependent_force", also=("nonlinear_stiffness",), on=LINES)
def over_centre(rng: Generator, strength: float, bench: Bench) -> Effect:
    """von Mises 1923 (two bars that snap through: unstable in the middle)."""
    size = 1.2 * strength * bench.level

    def force(q: Array) -> Array:
        x = q / bench.reach
        return size * x * (1.0 - 1.25 / np.sqrt(x**2 + 0.25))

    return force_at({"size": size}, force)


@form("position_dependent_force", also=("nonlinear_stiffness",))
def disc_springs(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Almen and Laszlo 1936 (a cubic that falls before it rises, about a zero of its own)."""
    size, zero = 1.3 * strength * bench.level, bench.reach * rng.uniform(-0.25, 0.25)

    def force(q: Array) -> Array:
        x = (q - zero) / bench.reach
        return size * (x**3 - 0.5 * x)

    return force_at({"size": size, "zero": zero}, force)


@form("position_dependent_force", on=(*HINGES, "arm"))
def torsion_bar(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Wahl 1963 (a straight bar that is stress-free away from the middle)."""
    slope, zero = 1.0 * strength * bench.level / bench.reach, bench.reach * rng.uniform(0.2, 0.5) * either_sign(rng)
    return force_at({"slope": slope, "zero": zero}, lambda q: slope * (q - zero))


@form("position_dependent_force", on=LINES)
def end_of_the_iron(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Boldea and Nasar 1997 (a linear motor whose iron leaves the magnets at both ends of the stroke)."""
    size = 1.2 * strength * bench.level
    return force_at({"size": size}, lambda q: size * np.sinh(4.0 * np.clip(q / bench.reach, -1.5, 1.5)) / np.sinh(4.0))
