"""Effects of the position sensor that have a name, in further shapes."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from tests.discovery.unseen_forms.mechanism_forms import velocity_too
from tests.discovery.unseen_forms.motion import World

from .enter import form


@form("sensor_drift", source="Spalding 1953 (dew on the gauge dries off: ever faster, until it is gone)")
def drift_of_dew(w: World, a: float) -> None:
    """A power 2/3 of the time that is left; gone after forty cycles."""
    size, gone = 0.2 * a * w.nominal.slip_length, 40.0 * w.nominal.period
    w.sensor = lambda t, motion, rng: motion.position + size * (1.0 - np.maximum(1.0 - t / gone, 0.0) ** (2 / 3))


@form("sensor_step", source="Holm 1967 (a loose plug that chatters between two levels before it stays)")
def step_that_chatters(w: World, a: float) -> None:
    """There for three short whiles of half a cycle, and then for good."""
    size, period = 0.1 * a * w.nominal.slip_length, w.nominal.period
    turns = period * (7.1 + np.array([0.0, 0.07, 0.16, 0.28, 0.34, 0.47, 0.55]))
    w.sensor = lambda t, motion, rng: motion.position + size * np.mod(np.searchsorted(turns, t, "right"), 2)


@form("sensor_clipping", source="Pease 1991 (an amplifier that latches at its rail until its input has come back some way)")
def clipping_that_latches(w: World, a: float) -> None:
    """On at a level, off at a lower one: each slip begins late."""
    if a <= 0.0:
        return
    on, back = w.rig.reach - 0.17 * a * w.rig.slip_length, 0.06 * a * w.nominal.slip_length

    def sensor(t, motion, rng):
        x = motion.position
        known = np.where((x > on) | (x < on - back), np.arange(t.size), 0)
        latched = x[np.maximum.accumulate(known)] > on
        return np.where(latched, on, x)

    w.sensor = sensor


@form("sensor_outliers", source="Lin and Costello 2004 (words that a serial line garbles: anywhere on the scale)")
def outliers_of_a_serial_line(w: World, a: float) -> None:
    """As many at any strength; at full strength the word says nothing of the position."""
    scale = 1.3 * w.nominal.reach

    def sensor(t, motion, rng):
        word = rng.uniform(0.0, scale, t.size)
        return motion.position + a * (rng.random(t.size) < 0.004) * (word - motion.position)

    w.sensor = sensor


@form("sensor_delay", source="Horowitz and Hill 1989 (one resistor and one capacitor)", rig="stern")
def delay_of_one_pole(w: World, a: float) -> None:
    """The shortest of filters, and late by its time constant."""
    velocity_too(w)
    if a <= 0.0:
        return

    def sensor(t, motion, rng):
        keep = np.exp(-(t[1] - t[0]) * w.nominal.pulsation / (0.4 * a))
        x = motion.position
        return lfilter([1.0 - keep], [1.0, -keep], x, zi=[keep * x[0]])[0]

    w.sensor = sensor
