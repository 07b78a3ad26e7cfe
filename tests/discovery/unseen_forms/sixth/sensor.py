"""An effect of the position sensor that has a name, in a further shape."""

from __future__ import annotations

import numpy as np
from scipy.special import erfc

from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Carslaw and Jaeger 1959 (heat that comes through a wall: an error function)")
def drift_through_a_wall(w: World, a: float) -> None:
    size, tau = 0.25 * a * w.nominal.slip_length, 6.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * erfc(np.sqrt(tau / np.maximum(t, 1e-6 * tau)))
