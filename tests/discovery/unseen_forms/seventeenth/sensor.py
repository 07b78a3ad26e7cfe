"""Effects of the position sensor that have a name, as laboratories meet them."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Doebelin 2004 (an amplifier that warms up after it is switched on)")
def drift_of_a_cold_amplifier(w: World, a: float) -> None:
    """An exponential that settles within fifteen cycles at a quarter of a slip."""
    size, tau = 0.25 * a * w.nominal.slip_length, 15.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position - size * np.expm1(-t / tau)


@form("sensor_step", source="Fraden 2016, chapter 3 (somebody knocks against the sensor's stand)")
def step_of_a_knocked_stand(w: World, a: float) -> None:
    """It is moved once, up or down, amid each run at a time of its own."""
    size, time = 0.25 * a * w.nominal.slip_length * w.rng.choice([-1.0, 1.0]), w.rng.uniform(0.3, 0.7) * w.duration
    w.sensor = lambda t, motion, rng: motion.position + size * (t >= time)


@form("sensor_clipping", source="Fraden 2016, chapter 3 (the end of a sensor's range)")
def clipping_at_full_scale(w: World, a: float) -> None:
    """True up to the end, and level from there: the last third of each slip's way is not seen."""
    if a > 0.0:
        end = w.rig.reach - 0.33 * a * w.rig.slip_length
        w.sensor = lambda t, motion, rng: np.minimum(motion.position, end)


@form("sensor_outliers", source="Tukey 1960 (now and then a much wider normal)", rig="caliper")
def outliers_of_a_wide_normal(w: World, a: float) -> None:
    """Nine samples of a thousand are off, by a fifth of a slip or so."""
    size = 0.2 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        return motion.position + size * rng.standard_normal(t.size) * (rng.random(t.size) < 0.009)

    w.sensor = sensor


@form("sensor_delay", source="Horowitz and Hill 2015 (a resistor and a capacitor before the converter)")
def delay_of_a_resistor_and_a_capacitor(w: World, a: float) -> None:
    """A lag of first order, by half of the time in which the rig turns through a radian."""
    velocity_too(w)

    def sensor(t, motion, rng):
        tau, h, first = 0.5 * a / w.nominal.pulsation, t[1] - t[0], motion.position[0]
        left = np.exp(-h / tau) if a > 0.0 else 0.0
        return first + lfilter([1.0 - left], [1.0, -left], motion.position - first)

    w.sensor = sensor
