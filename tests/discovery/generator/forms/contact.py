"""The contact itself differs: with direction, with load, with compliance."""

from collections.abc import Callable

import numpy as np

from tests.discovery.generator.curve import Array, tabulate
from tests.discovery.generator.machine import BELT, KINETIC, LOAD, STATIC, Machine
from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, either_sign, form


@form("direction_asymmetry")
def both_coefficients(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rig
    share = 0.08 * strength * either_sign(rng)

    def alter(machine: Machine, rng: Generator) -> Machine:
        del rng
        return machine._replace(forward_factor=1.0 + share, backward_factor=1.0 - share)

    return Effect({"share": share}, alter)


@form("direction_asymmetry")
def kinetic_only(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A nap: sliding against it is harder, breaking away is not."""
    del rig
    share = 0.12 * strength * either_sign(rng)

    def alter(machine: Machine, rng: Generator) -> Machine:
        del rng
        return machine.scaled(KINETIC, 1.0 + share * np.sign(machine.signals[:, BELT]))

    return Effect({"share": share}, alter)


def _over_load(parameters: dict[str, float], factor: Callable[[Array], Array], rig: Rig) -> Effect:
    def alter(machine: Machine, rng: Generator) -> Machine:
        del rng
        by_load = factor(machine.signals[:, LOAD] / rig.normal_force)
        return machine.scaled(STATIC, by_load).scaled(KINETIC, by_load)

    return Effect(parameters, alter)


@form("load_dependence")
def power_of_load(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Elastic contact of spheres: mu ~ N^-1/3 at full strength."""
    exponent = strength * rng.uniform(0.27, 0.4)
    return _over_load({"exponent": exponent}, lambda ratio: ratio**-exponent, rig)


@form("load_dependence")
def adhesion(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A part of the friction force does not depend on load."""
    share = strength * rng.uniform(0.2, 0.35)
    return _over_load({"share": share}, lambda ratio: 1.0 - share + share / ratio, rig)


@form("load_dependence")
def rising(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A film that is squeezed out: friction grows faster than load."""
    rise = strength * rng.uniform(0.3, 0.45)
    return _over_load({"rise": rise}, lambda ratio: 1.0 + rise * np.log(ratio), rig)


def _compliant(rng: Generator, strength: float, rig: Rig, shape: Callable[[Array], Array]) -> Effect:
    length = strength * rng.uniform(60e-6, 100e-6) * (rig.slip_length / 2.2e-3)
    stiffness = rig.mu_s * rig.normal_force / length
    damping = float(0.6 * np.sqrt(stiffness * rig.mass))
    curve = tabulate(lambda share: shape(share) / shape(np.array(1.0)), -1.5, 1.5, 3001)

    def alter(machine: Machine, rng: Generator) -> Machine:
        del rng
        return machine._replace(contact_length=length, contact_shape=curve, contact_damping=damping)

    return Effect({"length": length, "damping": damping}, alter)


@form("presliding_compliance")
def linear(rng: Generator, strength: float, rig: Rig) -> Effect:
    return _compliant(rng, strength, rig, lambda share: share)


@form("presliding_compliance")
def softening(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Asperities let go one after the other."""
    return _compliant(rng, strength, rig, lambda share: np.tanh(1.5 * share))


@form("presliding_compliance")
def hardening(rng: Generator, strength: float, rig: Rig) -> Effect:
    return _compliant(rng, strength, rig, lambda share: share + 0.5 * share**3)
