"""Friction, or another force, depends on where the joint is."""

import numpy as np

from tests.discovery.joint_generator.bench import Bench
from tests.discovery.joint_generator.forms.form import HINGES, LINES, Effect, Generator, either_sign
from tests.discovery.joint_generator.forms.place import force_at, friction_at
from tests.discovery.joint_generator.plant import Array

from .enter import form

TURN = 2.0 * np.pi


@form("position_dependent_friction")
def two_lengths(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Popovici and others 2004 (rollers of a guide and the pitch of its screw)."""
    size, length, phase = 0.35 * strength, bench.reach * rng.uniform(0.5, 0.9), rng.uniform(0.0, TURN)
    return friction_at(
        {"size": size, "length": length},
        lambda q: 1.0 + size * (np.sin(TURN * q / length + phase) + 0.7 * np.sin(TURN * q / (0.37 * length))),
    )


@form("position_dependent_friction")
def dry_end(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Neale 1995 (grease does not reach one end of the stroke: an exponential rise)."""
    size, side = 0.9 * strength, either_sign(rng)
    return friction_at(
        {"size": size, "side": side}, lambda q: 1.0 + size * np.exp(-2.5 * np.maximum(1.0 - side * q / bench.reach, -0.5))
    )


@form("position_dependent_friction")
def wipers(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Ohta and others 2010 (narrow rises, one for each ball that enters)."""
    size, pitch, phase = 0.7 * strength, bench.reach * rng.uniform(0.4, 0.8), rng.uniform(0.0, TURN)
    return friction_at(
        {"size": size, "pitch": pitch}, lambda q: 1.0 + size * np.exp(3.0 * (np.cos(TURN * q / pitch + phase) - 1.0))
    )


@form("position_dependent_force")
def slots_and_poles(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Gieras 2004 (cogging, the third harmonic with the first)."""
    size, pitch, phase = 0.35 * strength * bench.level, bench.reach * rng.uniform(0.5, 0.9), rng.uniform(0.0, TURN)

    def force(q: Array) -> Array:
        angle = TURN * q / pitch + phase
        return size * (np.sin(angle) + 0.5 * np.sin(3.0 * angle + 0.4))

    return force_at({"size": size, "pitch": pitch}, force)


@form("position_dependent_force", on=LINES)
def gas_spring(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Lee 1983 (air shut in: pressure over volume)."""
    size, side = 0.9 * strength * bench.level, either_sign(rng)
    return force_at(
        {"size": size}, lambda q: size * (1.0 / (1.0 - 0.45 * np.clip(side * q / bench.reach, -1.5, 1.5)) - 1.0) * side
    )


@form("position_dependent_force")
def hose(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Irvine 1981 (a hose that hangs: pulls to one side or to the other, and levels off)."""
    size, width = 0.5 * strength * bench.level, bench.reach * rng.uniform(0.25, 0.5)
    return force_at({"size": size, "width": width}, lambda q: size * np.tanh(q / width))


@form("position_dependent_force", on=HINGES)
def balancer(rng: Generator, strength: float, bench: Bench) -> Effect:
    """Hain 1961 (a spring that balances a link: sine of the angle over a square root)."""
    size, share = 0.8 * strength * bench.level, rng.uniform(0.3, 0.6)
    return force_at(
        {"size": size, "share": share},
        lambda q: -size * np.sin(q - 0.4) / np.sqrt(1.0 + share**2 + 2.0 * share * np.cos(q - 0.4)),
    )
