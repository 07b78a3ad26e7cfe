"""The coefficients are random: drawn anew, or wandering slowly."""

from collections.abc import Callable

import numpy as np

from tests.discovery.generator.curve import Array, Curve
from tests.discovery.generator.machine import KINETIC, STATIC, Machine
from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, form

MANY_SLIPS = 1000  # more than any run has


def add_knots(machine: Machine, spacing: float, sigma_s: float, sigma_k: float, draw: Callable[[int], Array]) -> Machine:
    """Independent values at knots, linear in time between them."""
    places = np.arange(machine.start, machine.time[-1] + 2.0 * spacing, spacing)
    signals = machine.signals.copy()
    for column, sigma in ((STATIC, sigma_s), (KINETIC, sigma_k)):
        signals[:, column] += np.interp(machine.time, places, sigma * draw(places.size))
    return machine._replace(signals=signals)


@form("random_coefficients")
def knots(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Normal pairs every 0.01 s: Kang 2015, 2.2."""
    del rng, rig
    sigma_s, sigma_k, spacing = 0.02 * strength, 0.03 * strength, 0.01

    def alter(machine: Machine, rng: Generator) -> Machine:
        return add_knots(machine, spacing, sigma_s, sigma_k, rng.standard_normal)

    return Effect({"sigma_s": sigma_s, "sigma_k": sigma_k, "spacing": spacing}, alter)


@form("random_coefficients")
def uniform_knots(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Uniform instead of normal, on a coarser grid."""
    del rig
    sigma_s, sigma_k, spacing = 0.02 * strength, 0.03 * strength, rng.uniform(0.015, 0.03)

    def alter(machine: Machine, rng: Generator) -> Machine:
        return add_knots(machine, spacing, sigma_s, sigma_k, lambda n: rng.uniform(-np.sqrt(3.0), np.sqrt(3.0), n))

    return Effect({"sigma_s": sigma_s, "sigma_k": sigma_k, "spacing": spacing}, alter)


@form("random_coefficients")
def per_slip(rng: Generator, strength: float, rig: Rig) -> Effect:
    """One draw for each stick and one for each slip."""
    del rng, rig
    sigma_s, sigma_k = 0.03 * strength, 0.05 * strength

    def alter(machine: Machine, rng: Generator) -> Machine:
        static, kinetic = rng.standard_normal((2, MANY_SLIPS))
        return machine._replace(static_by_slip=1.0 + sigma_s * static, kinetic_by_slip=1.0 + sigma_k * kinetic)

    return Effect({"relative_sigma_s": sigma_s, "relative_sigma_k": sigma_k}, alter)


def windowed(shocks: Array, window: Array) -> Array:
    """White noise of unit variance under a window, unit variance again."""
    return np.asarray(np.convolve(shocks, window / np.sqrt(np.sum(window**2)), mode="same"), dtype=np.float64)


def _drifting(machine: Machine, path: Array) -> Machine:
    return machine.scaled(STATIC, 1.0 + path).scaled(KINETIC, 1.0 + path)


@form("correlated_coefficients")
def first_order(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Both coefficients follow one first-order autoregression."""
    del rig
    sigma, time = 0.06 * strength, rng.uniform(2.5, 6.0)

    def alter(machine: Machine, rng: Generator) -> Machine:
        coarse = np.arange(machine.start, machine.time[-1] + 0.1, 0.05)
        kept = np.exp(-0.05 / time)
        path = np.empty(coarse.size)
        path[0] = rng.standard_normal()
        for i, shock in enumerate(np.sqrt(1.0 - kept**2) * rng.standard_normal(coarse.size - 1)):
            path[i + 1] = kept * path[i] + shock
        return _drifting(machine, sigma * np.asarray(np.interp(machine.time, coarse, path), dtype=np.float64))

    return Effect({"relative_sigma": sigma, "correlation_time": time}, alter)


@form("correlated_coefficients")
def smooth(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A smooth random path: white noise under a Gaussian window."""
    del rig
    sigma, time = 0.06 * strength, rng.uniform(1.5, 4.0)

    def alter(machine: Machine, rng: Generator) -> Machine:
        coarse = np.arange(machine.start - 4.0 * time, machine.time[-1] + 4.0 * time, 0.05)
        window = np.exp(-0.5 * (np.arange(-4.0 * time, 4.0 * time, 0.05) / time) ** 2)
        path = windowed(rng.standard_normal(coarse.size), window)
        return _drifting(machine, sigma * np.asarray(np.interp(machine.time, coarse, path), dtype=np.float64))

    return Effect({"relative_sigma": sigma, "window": time}, alter)


@form("correlated_coefficients", also=("position_dependent_friction",))
def belt_field(rng: Generator, strength: float, rig: Rig) -> Effect:
    """A random surface that does not repeat within a run."""
    sigma, length = 0.06 * strength, rig.slip_length * rng.uniform(2.0, 4.0)

    def alter(machine: Machine, rng: Generator) -> Machine:
        spacing = length / 20.0
        window = np.exp(-0.5 * (np.arange(-80, 81) / 20.0) ** 2)
        n = int(0.8 / spacing)  # 0.8 m: longer than any run travels either way
        field = windowed(rng.standard_normal(n), window)
        return machine._replace(belt_surface=Curve(-0.4, spacing, False, 1.0 + sigma * field))

    return Effect({"relative_sigma": sigma, "length": length}, alter)
