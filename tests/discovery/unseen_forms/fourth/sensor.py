"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.signal import bilinear, lfilter

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Shepherd 1965 (a battery that runs down, faster at the end)")
def drift_of_a_battery(w: World, a: float) -> None:
    size, span = 0.05 * a * w.nominal.reach, 60.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position - 0.25 * size * (t / span) / (1.25 - np.minimum(t / span, 1.1))


@form("sensor_step", source="Harris and Piersol 2002 (a stand that is pushed, and swings)")
def step_that_swings(w: World, a: float) -> None:
    size, at, period = 0.05 * a * w.nominal.reach, 8.4 * w.nominal.period, w.nominal.period

    def sensor(t, motion, rng):
        u = np.maximum(t - at, 0.0) / period
        return motion.position + size * (t >= at) * (1.0 - np.exp(-2.0 * u) * np.cos(2 * np.pi * u / 0.3))

    w.sensor = sensor


@form("sensor_clipping", source="Horowitz and Hill 1989 (an amplifier whose rail sags and recovers)")
def clipping_at_a_rail(w: World, a: float) -> None:
    if a <= 0.0:
        return
    margin, turn = 0.1 * a * w.nominal.slip_length, 2 * np.pi / (2.9 * w.nominal.period)
    w.sensor = lambda t, motion, rng: np.minimum(
        motion.position, w.nominal.reach - margin * (1.0 + 0.3 * np.sin(turn * t + 0.4))
    )


@form("sensor_outliers", source="Pearson 2005 (what is missing is written as zero)")
def outliers_at_zero(w: World, a: float) -> None:
    w.sensor = lambda t, motion, rng: np.where(rng.random(t.size) < 0.004 * a, 0.0, motion.position)


@form("sensor_delay", source="Oppenheim and Schafer 1989, section 5.5 (an all-pass)", rig="turntable")
def delay_of_an_all_pass(w: World, a: float) -> None:
    velocity_too(w)
    if a <= 0.0:
        return

    def sensor(t, motion, rng):
        tau = 0.5 * a / w.nominal.pulsation
        b, c = bilinear([-0.5 * tau, 1.0], [0.5 * tau, 1.0], 1.0 / (t[1] - t[0]))
        start = motion.position[0]
        return lfilter(b, c, motion.position - start) + start

    w.sensor = sensor
