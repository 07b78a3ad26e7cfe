"""Nothing is missing: the stated model explains the data."""

import numpy as np
from scipy.signal import lfilter

from tests.discovery.generator.machine import Machine
from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, Record, form
from .randomness import add_knots


@form("none")
def wrong_parameters(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Only the parameters are off, within their uncertainty, as in every case."""
    del rng, strength, rig
    return Effect({})


@form("none")
def quiet_sensor(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rng, strength, rig
    return Effect({}, noise=1e-6)


@form("none")
def loud_sensor(rng: Generator, strength: float, rig: Rig) -> Effect:
    del rng, strength, rig
    return Effect({}, noise=15e-6)


@form("none")
def declared_scatter(rng: Generator, strength: float, rig: Rig) -> Effect:
    """The coefficients are random as in Kang 2015, and the scenario says so."""
    del rng, strength, rig
    sigma_s, sigma_k, spacing = 0.015, 0.023, 0.01

    def alter(machine: Machine, rng: Generator) -> Machine:
        return add_knots(machine, spacing, sigma_s, sigma_k, rng.standard_normal)

    declared = {"process": "knots", "sigma_s": sigma_s, "sigma_k": sigma_k, "spacing": spacing}
    return Effect({}, alter, nominal=declared)


def _coloured(correlation: float, sigma: float) -> Effect:
    """First-order autoregressive position noise on top of 1 um of white noise."""

    def measure(record: Record, rng: Generator) -> Record:
        shocks = sigma * np.sqrt(1.0 - correlation**2) * rng.standard_normal(record["time [s]"].size)
        return record | {"position [m]": record["position [m]"] + lfilter([1.0], [1.0, -correlation], shocks)}

    return Effect({"correlation": correlation, "sigma": sigma}, measure=measure, noise=1e-6)


@form("none")
def coloured_noise(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Noise correlated over a few samples."""
    del strength, rig
    return _coloured(rng.uniform(0.6, 0.9), 5e-6)


@form("none")
def slow_noise(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Noise correlated over 30 to 100 ms."""
    del strength, rig
    return _coloured(float(np.exp(-1e-3 / rng.uniform(0.03, 0.1))), 4e-6)
