"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Andrade 1910 (a soldered joint of the stand creeps: a cube root of time, and a line)")
def drift_of_a_soldered_joint(w: World, a: float) -> None:
    """Half of it within eleven cycles of sixty."""
    size, span = 0.24 * a * w.nominal.slip_length, 60.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * (0.75 * np.cbrt(t / span) + 0.25 * t / span)


@form("sensor_step", source="Barkhausen 1919 (a magnetic scale is knocked: its domains turn over in a burst of small jumps)")
def step_in_a_burst(w: World, a: float) -> None:
    """Nine jumps of one sign within a cycle and a half; each run has times of its own."""
    begins, size = w.rng.uniform(0.3, 0.6) * w.duration, 0.14 * a * w.nominal.slip_length
    times = np.sort(begins + 1.5 * w.nominal.period * w.rng.uniform(0.0, 1.0, 9))
    sizes = w.rng.exponential(1.0, 9)
    level = np.concatenate([[0.0], np.cumsum(sizes) / sizes.sum()])
    w.sensor = lambda t, motion, rng: motion.position + size * level[np.searchsorted(times, t)]


@form("sensor_clipping", source="Herceg 1976 (a transformer whose core leaves its coils: a quarter of a sine, then level)")
def clipping_of_a_transformer(w: World, a: float) -> None:
    """True below; the upper quarter of a slip is not seen."""
    if a <= 0.0:
        return
    most = 0.2 * w.rig.slip_length
    begins = w.rig.reach - (0.2 + 0.25 * a) * w.rig.slip_length

    def sensor(t, motion, rng):
        beyond = np.clip((motion.position - begins) / most, 0.0, 0.5 * np.pi)
        return np.minimum(motion.position, begins) + most * np.sin(beyond)

    w.sensor = sensor


@form("sensor_outliers", source="Middleton 1977 (class A: a number of sources that are on, each for one sample)", rig="bracket")
def outliers_of_class_a(w: World, a: float) -> None:
    """One sample of forty is hit by one source, a few by two; sizes are normal, of the root of that number."""
    size = 0.36 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        sources = rng.poisson(0.025, t.size)
        return motion.position + size * np.sqrt(sources) * rng.standard_normal(t.size)

    w.sensor = sensor


@form("sensor_delay", source="Thomson 1855 (a long cable along which charge diffuses)", rig="ice")
def delay_of_a_long_cable(w: World, a: float) -> None:
    """Poles at odd squares; late by half of the cable's time constant."""
    velocity_too(w)
    if a <= 0.0:
        return
    poles = 4.0 / (np.pi * np.array([1.0, 3.0, 5.0, 7.0, 9.0])) ** 2
    lags = 1.1 * a / w.nominal.pulsation * np.append(poles, 0.5 - poles.sum())  # the last one stands for all that are left

    def sensor(t, motion, rng):
        shown, h = motion.position, t[1] - t[0]
        for lag in lags:
            keep = np.exp(-h / lag)
            now, before = 1.0 - (1.0 - keep) * lag / h, (1.0 - keep) * lag / h - keep  # right for ramps, however fast the pole
            shown = lfilter([now, before], [1.0, -keep], shown, zi=[(before + keep) * shown[0]])[0]
        return shown

    w.sensor = sensor
