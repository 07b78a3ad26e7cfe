"""The coefficients are random."""

import numpy as np

from tests.discovery.generator.machine import KINETIC, STATIC, Machine
from tests.discovery.generator.rig import Rig

from .form import Effect, Generator, form


@form("random_coefficients")
def knots(rng: Generator, strength: float, rig: Rig) -> Effect:
    """Independent normal pairs every 0.01 s, linear in time between them: Kang 2015, 2.2."""
    del rng, rig
    sigma_s, sigma_k, spacing = 0.02 * strength, 0.03 * strength, 0.01

    def alter(machine: Machine, rng: Generator) -> Machine:
        time = machine.time
        places = np.arange(time[0], time[-1] + 2.0 * spacing, spacing)
        signals = machine.signals.copy()
        for column, sigma in ((STATIC, sigma_s), (KINETIC, sigma_k)):
            signals[:, column] += np.interp(time, places, sigma * rng.standard_normal(places.size))
        return machine._replace(signals=signals)

    return Effect({"sigma_s": sigma_s, "sigma_k": sigma_k, "spacing": spacing}, alter)


@form("random_coefficients")
def per_slip(rng: Generator, strength: float, rig: Rig) -> Effect:
    """One draw for each stick and one for each slip."""
    del rng, rig
    sigma_s, sigma_k = 0.02 * strength, 0.035 * strength

    def alter(machine: Machine, rng: Generator) -> Machine:
        n = 1000  # more slips than any run has
        return machine._replace(
            static_by_slip=1.0 + sigma_s * rng.standard_normal(n), kinetic_by_slip=1.0 + sigma_k * rng.standard_normal(n)
        )

    return Effect({"relative_sigma_s": sigma_s, "relative_sigma_k": sigma_k}, alter)
