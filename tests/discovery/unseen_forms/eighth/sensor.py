"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Newton 1701 (somebody switches a lamp on: nothing, then an exponential)")
def drift_of_a_lamp(w: World, a: float) -> None:
    size, on, tau = 0.18 * a * w.nominal.slip_length, 8.0 * w.nominal.period, 7.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * (1.0 - np.exp(-np.maximum(t - on, 0.0) / tau))


@form("sensor_step", source="Basseville and Nikiforov 1993 (a stand that is knocked, and later put right)")
def step_that_is_put_right(w: World, a: float) -> None:
    size, first, last = 0.12 * a * w.nominal.slip_length, 6.3 * w.nominal.period, 17.4 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position - size * ((t >= first) & (t < last))


@form("sensor_clipping", source="Horowitz and Hill 1989 (a rail with the ripple of its rectifier on it)")
def clipping_at_a_rippling_rail(w: World, a: float) -> None:
    if a <= 0.0:
        return
    level, ripple = w.rig.reach - 0.17 * a * w.rig.slip_length, 0.02 * a * w.nominal.slip_length
    beat = 2 * np.pi * 3.7 / w.nominal.period
    w.sensor = lambda t, motion, rng: np.minimum(motion.position, level - ripple * np.mod(beat * t / np.pi, 1.0))


@form("sensor_outliers", source="Godsill and Rayner 1998 (clicks that ring over four samples)")
def outliers_that_ring(w: World, a: float) -> None:
    """As many at any strength, as far off as it says."""

    def sensor(t, motion, rng):
        hit = (rng.random(t.size) < 0.003) * rng.normal(0.0, 0.25 * a * w.nominal.slip_length, t.size)
        return motion.position + lfilter([1.0, -0.7, 0.45, -0.25], [1.0], hit)

    w.sensor = sensor


@form("sensor_delay", source="Ziegler and Nichols 1942 (a dead time, then a lag)", rig="gate")
def delay_and_lag(w: World, a: float) -> None:
    velocity_too(w)
    if a <= 0.0:
        return

    def sensor(t, motion, rng):
        dead, tau = 0.2 * a / w.nominal.pulsation, 0.15 * a / w.nominal.pulsation
        late = np.interp(t - dead, t, motion.position)
        keep = np.exp(-(t[1] - t[0]) / tau)
        return lfilter([1.0 - keep], [1.0, -keep], late, zi=[keep * late[0]])[0]

    w.sensor = sensor
